#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_arrows finds each kind of fault, and nothing else."""
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_arrows import Arrows  # noqa: E402

ROOMS = (("OpenCL", "<CL/", ""), ("low", "host/include", ""), ("low/src", "host/src", "low"),
         ("middle", "host/tools", "low OpenCL"), ("high", "scenes", "middle"), ("high/room", "scenes/room", "high"))
SOUND = {
    "host/include/low.h": "#include <cstdint>\n",
    "host/src/inside.h": '#include "low.h"\n',
    "host/src/inside.cpp": '#include "inside.h"\n',
    "host/tools/middle.h": '#include "low.h"\n#include <CL/cl.h>\n',
    "host/tools/CMakeLists.txt": "quincunx_embed(middle FUNCTION ns::embedded_texts FILES a.txt)\n",
    "scenes/high.h": '#include "tools/middle.h"\n#include "low.h"\n#include "embedded_texts.h"\n',
    "scenes/room/part.cpp": '#include "high.h"\n#include <CL/cl.h>\n',
}


class CheckArrows(unittest.TestCase):
    def findings(self, rooms=ROOMS, **changes):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**SOUND, **{key.replace("__", "/") + ".h": text for key, text in changes.items()}}.items():
                os.makedirs(os.path.join(folder, os.path.dirname(name)), exist_ok=True)
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            return Arrows(folder, rooms).run()

    def expect_one(self, words, **changes):
        found = self.findings(**changes)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_sound_includes_have_no_findings(self):
        self.assertEqual(self.findings(), [])

    def test_an_arrow_upwards(self):
        self.expect_one("host/tools/new.h:2: middle must not use high (scenes/high.h)",
                        host__tools__new='int a;\n#include "high.h"\n')

    def test_an_arrow_between_rooms(self):
        self.expect_one("high must not use high/room", scenes__room__part="",
                        scenes__new='  #  include "room/part.h"\n')

    def test_the_inside_of_a_library(self):
        self.expect_one("middle must not use low/src (host/src/inside.h)", host__tools__new='#include "inside.h"\n')

    def test_another_projects_header(self):
        self.expect_one("low must not use OpenCL (<CL/cl.h>)", host__include__new="#include <CL/cl.h>\n")

    def test_an_include_that_leads_nowhere(self):
        self.expect_one("gone.h leads nowhere", scenes__new='#include "gone.h"\n')

    def test_a_folder_without_a_row(self):
        self.expect_one("kernels/new.h lies in no folder", kernels__new="int a;\n")

    def test_a_row_that_no_include_needs(self):
        self.expect_one("low/src uses OpenCL, and no file of it does",
                        rooms=[(n, f, u + " OpenCL" if n == "low/src" else u) for n, f, u in ROOMS])

    def test_a_table_that_points_upwards(self):
        self.expect_one("low uses high, which is no row above it",
                        rooms=[(n, f, "high" if n == "low" else u) for n, f, u in ROOMS])


if __name__ == "__main__":
    unittest.main()
