#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_abi.py finds what it is there to find."""
import os
import tempfile
import unittest

import check_abi


class CheckAbi(unittest.TestCase):
    def test_what_is_ours_may_be_exported(self):
        self.assertEqual(check_abi.foreign({"a": "quincunx::Device::open(char const*)", "b": "quincunx_version",
                                            "c": "vtable for quincunx::ResolutionController"}), [])

    def test_templates_of_other_libraries_are_found(self):
        for name in ("fmt::v9::format_error::what() const", "std::vector<int>::push_back(int)", "main",
                     "quincunx::log(spdlog::logger&)", "quincunx::Device::Impl::Impl()"):
            self.assertEqual(len(check_abi.foreign({"a": name})), 1, name)

    def test_a_symbol_that_users_lack_is_found(self):
        defined = {"a": "quincunx::a()", "b": "quincunx::b()"}
        self.assertEqual(len(check_abi.hidden_but_needed(defined, {"a": ""}, ["a", "b", "puts"])), 1)
        self.assertEqual(check_abi.hidden_but_needed(defined, {"a": ""}, ["a", "puts"]), [])

    def test_the_list_of_the_c_interface_is_kept(self):
        def found(exported, soname="lib.so.1", version=2):
            return check_abi.differs_from_list("lib.so.1\nquincunx_a 1\nquincunx_b 2\n", exported, soname, version)

        both = {"quincunx_a": "", "quincunx_b": "", "_ZN8quincunx1cEv": ""}
        self.assertEqual(found(both), [])
        self.assertIn("exports 'quincunx_c'", found({**both, "quincunx_c": ""})[0])
        self.assertIn("lacks 'quincunx_b'", found({"quincunx_a": ""})[0])
        self.assertIn("the library is lib.so.2", found(both, soname="lib.so.2")[0])
        self.assertIn("QUINCUNX_API_VERSION is 3", found(both, version=3)[0])

    def test_functions_of_the_c_interface_are_known(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "a.h"), "w", encoding="utf-8") as header:
                header.write("QUINCUNX_API const char* quincunx_a(void); /* x */\nQUINCUNX_API quincunx_status "
                             "quincunx_b(quincunx_plan* plan,\n    int c);\nQUINCUNX_API Result<Device> open();\n")
            self.assertEqual(check_abi.functions_of_c(folder), {"quincunx_a", "quincunx_b"})

    def test_a_header_that_leaks_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (("bad.h", "#include <fmt/format.h>\n"), ("good.h", "#include <cstdint>  // fmt\n")):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as header:
                    header.write(text)
            found = check_abi.headers_that_leak(folder)
        self.assertEqual(len(found), 1)
        self.assertIn("bad.h:1", found[0])


if __name__ == "__main__":
    unittest.main()
