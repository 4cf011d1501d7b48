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
