// SPDX-License-Identifier: MIT
#include "quincunx/control/cost_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quincunx {
namespace {

CostTable make(double half_life_frames = 100) {
  Result<CostTable> table = CostTable::create(half_life_frames);
  EXPECT_TRUE(table.ok()) << table.status().message();
  return std::move(table).value();
}

TEST(CostTable, EmptyKnowsNothing) {
  const CostTable table = make();
  EXPECT_TRUE(table.empty());
  EXPECT_EQ(table.confidence(1), 0);
  EXPECT_FALSE(table.predict(1).has_value());
  EXPECT_FALSE(table.fixed_part().has_value());
}

TEST(CostTable, ConfidenceHalvesInAHalfLife) {
  CostTable table = make(100);
  ASSERT_TRUE(table.record(10, 1, 20).ok());
  EXPECT_EQ(table.confidence(1), 1);
  ASSERT_TRUE(table.record(110, 0.5, 12).ok());
  EXPECT_DOUBLE_EQ(table.confidence(1), 0.5);
  EXPECT_EQ(table.confidence(0.5), 1);
  ASSERT_TRUE(table.record(210, 0.5, 12).ok());
  EXPECT_DOUBLE_EQ(table.confidence(1), 0.25);
  EXPECT_EQ(table.confidence(0.75), 0);
  EXPECT_EQ(table.confidence(std::nan("")), 0);
}

TEST(CostTable, TimesOfOneResolutionAreAveragedByAge) {
  CostTable table = make(100);
  ASSERT_TRUE(table.record(0, 1, 10).ok());
  ASSERT_TRUE(table.record(0, 1, 20).ok());
  EXPECT_DOUBLE_EQ(*table.predict(1), 15);
  ASSERT_TRUE(table.record(100, 1, 30).ok());  // the two now weigh 2 * .5 = 1
  EXPECT_DOUBLE_EQ(*table.predict(1), 22.5);
}

TEST(CostTable, WhatWasNotRecordedIsExtrapolated) {
  CostTable table = make(100);
  ASSERT_TRUE(table.record(0, 1, 20).ok());
  // A quarter of 20 ms is fixed: 5 + 15 / 2.
  EXPECT_DOUBLE_EQ(*table.predict(0.5, 0.25), 12.5);
  // A second entry a half life later, 10 ms at a quarter: 10 * (.25 + .75 * .5) / (.25 + .75 * .25)
  // = 14.2857.
  ASSERT_TRUE(table.record(100, 0.25, 10).ok());
  EXPECT_NEAR(*table.predict(0.5, 0.25), (0.5 * 12.5 + 14.285714285714286) / 1.5, 1e-12);
  // An old entry is predicted half from itself and half from all that the table holds.
  const double from_both = (0.5 * 20 + 10 * 1 / (0.25 + 0.75 * 0.25)) / 1.5;
  EXPECT_NEAR(*table.predict(1, 0.25), 0.5 * 20 + 0.5 * from_both, 1e-12);
}

TEST(CostTable, NoTimeIsLongerThanOneThatCanBeRecorded) {
  CostTable table = CostTable::create(1).value();
  ASSERT_TRUE(table.record(0, 1e-320, 10).ok());
  EXPECT_EQ(table.predict(4, 0), 60000);
  ASSERT_TRUE(table.record(100'000, 4, 20).ok());
  EXPECT_EQ(table.predict(4, 0), 20);
}

TEST(CostTable, FixedPartIsTheLinesIntercept) {
  CostTable table = make(1e6);
  for (const double area : {0.25, 0.5, 0.75, 1.0})
    ASSERT_TRUE(table.record(0, area, 6 + 14 * area).ok());
  EXPECT_NEAR(*table.fixed_part(), 0.3, 1e-9);
  CostTable narrow = make();
  ASSERT_TRUE(narrow.record(0, 0.9, 10).ok());
  ASSERT_TRUE(narrow.record(0, 1.0, 11).ok());
  EXPECT_FALSE(narrow.fixed_part().has_value());
}

TEST(CostTable, JsonKeepsEverything) {
  CostTable table = make(100);
  ASSERT_TRUE(table.record(0, 0.3, 7.1).ok());
  ASSERT_TRUE(table.record(50, 1.0, 19.3).ok());
  ASSERT_TRUE(table.record(60, 1.0 / 3, 8).ok());
  const Result<CostTable> loaded = CostTable::from_json(table.to_json());
  ASSERT_TRUE(loaded.ok()) << loaded.status().message();
  EXPECT_EQ(loaded->to_json(), table.to_json());
  for (const double area : {0.3, 0.6, 1.0}) {
    EXPECT_EQ(loaded->confidence(area), table.confidence(area));
    EXPECT_EQ(loaded->predict(area), table.predict(area));
  }
  EXPECT_EQ(loaded->fixed_part(), table.fixed_part());
}

TEST(CostTable, LoadedTableGoesOnFromAnyFrameNumber) {
  CostTable table = make(100);
  ASSERT_TRUE(table.record(5000, 1, 20).ok());
  Result<CostTable> loaded = CostTable::from_json(table.to_json());
  ASSERT_TRUE(loaded.ok());
  EXPECT_TRUE(loaded->record(1, 0.5, 12).ok());
  EXPECT_EQ(loaded->confidence(1), 1);
}

TEST(CostTable, BadRecordsChangeNothing) {
  CostTable table = make();
  ASSERT_TRUE(table.record(10, 1, 20).ok());
  const std::string before = table.to_json();
  const auto refused = [&](std::uint64_t frame, double area, double time, const char* field) {
    const Status status = table.record(frame, area, time);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message().rfind(field, 0), 0u) << status.message();
    EXPECT_EQ(table.to_json(), before);
  };
  for (const double bad : {0.0, -1.0, std::nan(""), 1.0 / 0.0, 70000.0}) {
    refused(11, bad, 20, "area_fraction");
    refused(11, 1, bad, "gpu_ms");
  }
  refused(9, 1, 20, "frame");
  for (const double bad : {0.0, -1.0, std::nan(""), 1.0 / 0.0})
    EXPECT_FALSE(CostTable::create(bad).ok());
}

TEST(CostTable, BadJsonIsRefused) {
  const std::string start = R"({"quincunx_cost_table": 1, "half_life_frames": 100, "entries": [)";
  const std::string entry = R"({"area_fraction": 0.5, "gpu_ms": 8, "weight": 1, "age_frames": 0})";
  ASSERT_TRUE(CostTable::from_json(start + entry + "]}").ok());
  for (const std::string& text : {
           std::string(),
           std::string("[]"),
           std::string("{}"),
           std::string(R"({"quincunx_cost_table": 2, "half_life_frames": 100, "entries": []})"),
           std::string(R"({"quincunx_cost_table": 1, "half_life_frames": 0, "entries": []})"),
           start + "7]}",
           start + entry + "," + entry + "]}",  // the same resolution twice
           start + R"({"area_fraction": -1, "gpu_ms": 8, "weight": 1, "age_frames": 0}]})",
           start + R"({"area_fraction": 1e9, "gpu_ms": 8, "weight": 1, "age_frames": 0}]})",
           start + R"({"area_fraction": 0.5, "gpu_ms": 0, "weight": 1, "age_frames": 0}]})",
           start + R"({"area_fraction": 0.5, "gpu_ms": 8, "weight": 0, "age_frames": 0}]})",
           start + R"({"area_fraction": 0.5, "gpu_ms": 8, "weight": 1, "age_frames": -1}]})",
           start + R"({"area_fraction": 0.5, "gpu_ms": "8", "weight": 1, "age_frames": 0}]})",
       }) {
    const Result<CostTable> table = CostTable::from_json(text);
    EXPECT_FALSE(table.ok()) << text;
    EXPECT_EQ(table.status().code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(table.status().message().rfind("cost table: ", 0), 0u) << table.status().message();
    EXPECT_EQ(table.status().message().find("json.exception"), std::string::npos) << table.status().message();
  }
  EXPECT_EQ(CostTable::from_json("x").status().message().rfind(
                "cost table: it must be the JSON that a table gave, and is not: parse error at line 1", 0),
            0u);
}

}  // namespace
}  // namespace quincunx
