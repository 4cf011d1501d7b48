#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that the project's texts can be read and that what they name exists.

    check_docs.py FOLDER [--list N]

Fails, with one line for each finding, on
- a line of a *.md file above 120 characters; rows of tables and lines that are only a link, a picture or an address
  are exempt
- a comment of a source file above 120 characters
- a relative link or picture of a *.md file that leads nowhere, or whose #anchor no heading of its file has
- a path in `backticks` of a *.md file, with a slash and an extension of ours, that no file has
"""
import argparse
import os
import re
import sys

LONGEST_LINE = 120
SOURCES = (".h", ".cpp", ".cl", ".glsl", ".sh", ".cmake", "CMakeLists.txt", ".py")
SLASH_COMMENTS = (".h", ".cpp", ".cl", ".glsl")
# Files of ours; what a user names freely (`out/my.png`, `seq/frame.%04d.exr`) has other extensions.
NAMED = r"\.(?:h|cpp|cl|glsl|sh|cmake|py|md|svg|json|txt)"
# Where a path of the text may begin, besides the root and the text's own folder.
ROOTS = ("", "host/", "host/include/", "host/include/quincunx/", "host/control/include/quincunx/",
         "host/src/", "gl_interop/include/", "kernels/",
         "kernels/include/", "scenes/", "tests/")

ONLY_A_LINK = re.compile(r"^\s*(?:[-*]\s+)?(?:!?\[[^\]]*\]\([^)]*\)|<?https?://\S+>?)[.,;]?\s*$")
LINK = re.compile(r"\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)")  # its text may begin on an earlier line
CODE_SPAN = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"^[\w.-]+(?:/[\w.-]+)+" + NAMED + "$")
STRING = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'')


def files_of(folder):
    """The files of the project: all that do not lie in a folder that is hidden or made by a build."""
    found = []
    for path, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".") and name not in ("build", "out")]
        found += [os.path.relpath(os.path.join(path, name), folder) for name in names]
    return found


def anchor_of(heading):
    """As GitHub makes it: lower case, no punctuation, a dash for each space."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors_of(path):
    return {anchor_of(line.lstrip("#")) for line, code in lines_of(path) if not code and line.startswith("#")}


def lines_of(path):
    """Each line of a Markdown file and whether it stands in a fenced block."""
    fenced = False
    with open(path, encoding="utf-8") as text:
        for line in text.read().splitlines():
            if line.lstrip().startswith("```"):
                fenced = not fenced
                yield line, True
            else:
                yield line, fenced


def comments_of(name, text):
    """Each line that holds a comment, with its number."""
    in_block = False
    for number, line in enumerate(text.splitlines(), 1):
        bare = STRING.sub('""', line)
        if name.endswith(SLASH_COMMENTS):
            is_comment = in_block or "//" in bare or "/*" in bare
            in_block = (in_block or "/*" in bare) and "*/" not in bare.split("/*")[-1]
        else:
            is_comment = re.search(r"(?:^|\s)#", bare) is not None
        if is_comment:
            yield number, line


class Check:
    def __init__(self, folder):
        self.folder = folder
        self.files = files_of(folder)
        self.known = set(self.files)
        self.findings = []

    def find(self, name, number, what):
        self.findings.append(f"{name}:{number}: {what}")

    def markdown(self, name):
        for number, (line, fenced) in enumerate(lines_of(os.path.join(self.folder, name)), 1):
            if len(line) > LONGEST_LINE and not line.startswith("|") and not ONLY_A_LINK.match(line):
                self.find(name, number, f"{len(line)} characters; at most {LONGEST_LINE}")
            if fenced:
                continue
            for target in LINK.findall(CODE_SPAN.sub("", line)):
                self.link(name, number, target)
            for span in CODE_SPAN.findall(line):
                if PATH.match(span) and not self.names_a_file(name, span):
                    self.find(name, number, f"there is no file {span}")

    def link(self, name, number, target):
        if re.match(r"^[a-z]+:", target):
            return
        path, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
        if not os.path.exists(os.path.join(self.folder, file)):
            self.find(name, number, f"the link {target} leads nowhere")
        elif anchor and file.endswith(".md") and anchor not in anchors_of(os.path.join(self.folder, file)):
            self.find(name, number, f"{file} has no heading #{anchor}")

    def names_a_file(self, name, path):
        if path.startswith(("build/", "out/", "report/", "old/", "./", "../")):
            return True  # made by a command, or somebody else's
        own = os.path.normpath(os.path.join(os.path.dirname(name), path))
        return own in self.known or any(root + path in self.known for root in ROOTS) or any(
            file.endswith("/include/" + path) for file in self.files)

    def source(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as text:
            for number, line in comments_of(name, text.read()):
                if len(line) > LONGEST_LINE:
                    self.find(name, number, f"a comment of {len(line)} characters; at most {LONGEST_LINE}")

    def run(self):
        for name in sorted(self.files):
            if name.endswith(".md"):
                self.markdown(name)
            elif name.endswith(SOURCES):
                self.source(name)
        return self.findings


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--list", type=int, default=100, help="how many findings are printed")
    options = parser.parse_args()
    check = Check(options.folder)
    findings = check.run()
    for finding in findings[: options.list]:
        print(finding)
    texts = sum(name.endswith(".md") for name in check.files)
    sources = sum(name.endswith(SOURCES) for name in check.files)
    print(f"{len(findings)} findings in {texts} texts and {sources} sources")
    if texts == 0 or sources == 0:
        print("that is no folder of the project")
        return 2
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
