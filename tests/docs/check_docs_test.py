#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_docs finds each kind of fault, and nothing else."""
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_docs import Check  # noqa: E402

LONG = "word " * 30


class CheckDocs(unittest.TestCase):
    def findings(self, **texts):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in texts.items():
                with open(os.path.join(folder, name.replace("_DOT_", ".")), "w", encoding="utf-8") as file:
                    file.write(text)
            return Check(folder).run()

    def expect_one(self, text, words):
        found = self.findings(a_DOT_md=text, b_DOT_md="# Known heading\n", code_DOT_h="int a;\n")
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_sound_texts_have_no_findings(self):
        self.assertEqual(
            self.findings(
                a_DOT_md=f"# Top\n[a](b.md#known-heading), [b](#top), <https://x>\n| {LONG} |\n[{LONG}](b.md)\n"
                "```\n[not a link](gone.md)\n```\n`out/my.png`, `a/b`, `[x](gone.md)`\n",
                b_DOT_md="# Known heading\n",
                code_DOT_h=f'// short\nconst char* url = "http://{LONG}";\n'), [])

    def test_long_lines_of_texts(self):
        self.expect_one(LONG, "a.md:1: 150 characters")

    def test_long_lines_within_blocks(self):
        self.expect_one(f"```\n{LONG}\n```\n", "a.md:2: 150 characters")

    def test_links_to_missing_files(self):
        self.expect_one("a [link](gone.md)\n", "gone.md leads nowhere")

    def test_links_whose_text_began_a_line_before(self):
        self.expect_one("a [link\nof two lines](gone.md)\n", "gone.md leads nowhere")

    def test_missing_pictures(self):
        self.expect_one("![a picture](images/gone.png)\n", "gone.png leads nowhere")

    def test_links_to_missing_headings(self):
        self.expect_one("a [link](b.md#unknown)\n", "b.md has no heading #unknown")

    def test_paths_of_missing_files(self):
        self.expect_one("`kernels/gone.cl`\n", "there is no file kernels/gone.cl")

    def test_long_comments(self):
        for name, comment in {"x_DOT_cpp": f"// {LONG}", "x_DOT_cl": f"int a;  // {LONG}", "x_DOT_sh": f"# {LONG}",
                              "x_DOT_h": f"/* a\n {LONG} */", "CMakeLists_DOT_txt": f"project(x)  # {LONG}"}.items():
            found = self.findings(a_DOT_md="", **{name: comment + "\n"})
            self.assertEqual(len(found), 1, (name, found))
            self.assertIn("a comment of", found[0])


if __name__ == "__main__":
    unittest.main()
