#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_parity.py reads headers as they are written, and finds what it is there to find."""
import unittest
from unittest import mock

import check_parity

CPP = """
struct Group {
  int depth = 0;  // int commented = 0;
  friend bool operator==(const Group&, const Group&) = default;
};
struct Settings {
  static constexpr int kMax = 4;
  Extent target_extent = {};
  Vec2 jitter = {};
  std::optional<double> known = std::nullopt;
  std::array<double, 2> pair{};
  Group group = {};
  bool is_good() const { return known > 0; }
};
class QUINCUNX_API Thing : public Base {
 public:
  static Result<Thing> create(const Settings& settings = {});
  explicit Thing(int x) : x_(x) {}
  int size() const { return x_; }
  virtual ~Thing();

 protected:
  void hidden();
 private:
  int x_ = 0;
};
QUINCUNX_API const char* name_of(Thing thing);
inline int not_exported();
"""
C = """
typedef struct quincunx_settings {
  size_t struct_size; /* sizeof(quincunx_settings) */
  int32_t target_width, target_height;
  float jitter_x, jitter_y;
  double known;
  double pair[2];
  int32_t depth;
  int32_t padding;
} quincunx_settings;
QUINCUNX_API quincunx_status quincunx_thing_create(const quincunx_settings* settings,
                                                   quincunx_thing** thing);
"""
PYTHON = """
class Thing:
    def __init__(self, depth): pass
"""
TABLE = """
Settings.* | settings.* | |
Thing::create | thing_create | Thing(depth) |
Thing::size | | | as many as there are
name_of | | | C has numbers
"""


@mock.patch.object(check_parity, "ROOTS", ("Settings",))
class CheckParity(unittest.TestCase):
    def found(self, cpp=CPP, c=C, python=PYTHON, table=TABLE):
        names, missing = check_parity.names_of_cpp([cpp])
        return missing + check_parity.compare(check_parity.rows_of(table), names, check_parity.names_of_c([c]),
                                              check_parity.names_of_python(python))

    def one(self, words, **texts):
        self.assertEqual([words in finding for finding in self.found(**texts)], [True], self.found(**texts))

    def test_headers_are_read(self):
        self.assertEqual(self.found(), [])
        names, _ = check_parity.names_of_cpp([CPP])
        self.assertEqual(names, {"Settings.target_extent", "Settings.jitter", "Settings.known", "Settings.pair",
                                 "Settings.group.depth", "Thing::create", "Thing::size", "name_of"})
        self.assertEqual(check_parity.names_of_c([C]), {
            "settings.target_width", "settings.target_height", "settings.jitter_x", "settings.jitter_y", "settings.known",
            "settings.pair", "settings.depth", "thing_create"})

    def test_what_c_lacks_is_found(self):
        self.one("C++ has Settings.fresh,", cpp=CPP.replace("Extent target", "int fresh = 0;\n  Extent target"))
        self.one("C++ has Settings.group.fresh,", cpp=CPP.replace("int depth", "float fresh = 1;\n  int depth"))
        self.one("C++ has Thing::fresh,", cpp=CPP.replace(" protected", "  Status fresh();\n protected"))
        self.one("C++ has fresh,", cpp=CPP + "[[nodiscard]] QUINCUNX_API int fresh(Thing thing);")

    def test_what_the_table_lacks_is_found(self):
        self.one("C has quincunx_settings.fresh,", c=C.replace("double known", "int32_t fresh;\n  double known"))
        self.one("C has quincunx_fresh,", c=C + "QUINCUNX_API void quincunx_fresh(void);")

    def test_a_stale_row_is_found(self):
        self.one("row old is stale: C++", table=TABLE + "old | | | for no reason")
        self.one("C has no quincunx_old", table=TABLE.replace("thing_create", "thing_create old"))
        self.one("quincunx.py has no Thing(width)", table=TABLE.replace("Thing(depth)", "Thing(width)"))
        self.one("row Other::* is stale", table=TABLE + "Other::* | | | gone")
        self.assertIn("ROOTS", self.found(cpp=CPP.replace("struct Settings", "struct Renamed"))[0])

    def test_a_field_that_stands_for_two_is_found(self):
        twice = CPP.replace("Extent target", "int depth = 0;\n  Extent target")
        self.assertTrue(any("stands for another field" in each for each in self.found(cpp=twice)))

    def test_an_empty_side_wants_a_reason(self):
        self.one("row name_of leaves a side empty", table=TABLE.replace("C has numbers", ""))


if __name__ == "__main__":
    unittest.main()
