// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/sample_result.h"
#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/bench_plot.h"
#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {
namespace {

using testing::sample_result;

TEST(Result, ComesBackFromJson) {
  const auto back = from_json(to_json(sample_result()), "x.json");
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back.value(), sample_result());
  EXPECT_EQ(to_json(back.value()), to_json(sample_result()));
}

TEST(Result, ComesBackFromTables) {
  const std::string text = to_tables(sample_result());
  const auto back = from_json(text, "x.json");
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back.value(), sample_result());
  EXPECT_EQ(to_tables(back.value()), text);
}

TEST(Result, TablesNameAFieldOnceAndHaveALineARow) {
  const std::string text = to_tables(sample_result());
  EXPECT_EQ(text.find("worst_window"), text.rfind("worst_window"));
  EXPECT_LT(text.size(), to_json(sample_result()).size() / 2);
  for (const char* begin : {"\n[\"pan\",0.5,\"bilinear\",", "\n[\"pan\",0.7,\"quincunx:mean\","})
    EXPECT_NE(text.find(begin), std::string::npos) << begin;
  // An empty list is no table.
  EXPECT_EQ(from_json(to_tables(BenchResult()), "x.json").value(), BenchResult());
}

TEST(Result, RefusesARowThatDoesNotFillItsTable) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(to_tables(sample_result()));
  json["rows"]["data"][1].erase(0);
  const auto back = from_json(json.dump(), "short.json");
  ASSERT_FALSE(back.ok());
  EXPECT_NE(back.status().message().find("short.json"), std::string::npos);
}

TEST(Result, ReadsTheFormatBefore) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(to_json(sample_result()));
  json["format"] = 1;
  for (auto& scene : json["scenes"]) {
    scene["uncovered"] = scene["disoccluded"];
    scene.erase("disoccluded");
  }
  const auto back = from_json(json.dump(), "old.json");
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back.value(), sample_result());
}

TEST(Result, JsonHasNoNumberThatIsNone) {
  const auto json = nlohmann::json::parse(to_json(sample_result()));
  EXPECT_TRUE(json["rows"][1]["quality"]["psnr"].is_null());     // infinite
  EXPECT_TRUE(json["rows"][0]["quality"]["flicker"].is_null());  // absent
  EXPECT_EQ(json["rows"][1]["quality"]["flicker"], 0.25);
}

void expect_refused(const std::string& text) {
  const auto result = from_json(text, "old.json");
  ASSERT_FALSE(result.ok()) << text;
  EXPECT_NE(result.status().message().find("old.json"), std::string::npos);
}

TEST(Result, RefusesWhatIsNone) {
  expect_refused("");
  expect_refused("{}");
  expect_refused("[1, 2]");
  expect_refused(R"({"program": "quincunx-render", "format": 1})");
  nlohmann::json json = nlohmann::json::parse(to_json(sample_result()));
  json["format"] = kResultFormat + 1;
  expect_refused(json.dump());
  json["format"] = kResultFormat;
  ASSERT_TRUE(from_json(json.dump(), "x").ok());
  json["rows"][2]["quality"].erase("flip");
  expect_refused(json.dump());
  json = nlohmann::json::parse(to_json(sample_result()));
  json["rows"][2]["speed"]["kernels"] = 3;
  expect_refused(json.dump());
  EXPECT_FALSE(read_result("/no/such/file.json").ok());
}

TEST(Result, ReadsOneOfBeforeThereWasHistory) {
  nlohmann::json json = nlohmann::json::parse(to_json(sample_result()));
  json["conditions"].erase("history_warm_up");
  const auto old = from_json(json.dump(), "old.json");
  ASSERT_TRUE(old.ok()) << old.status().message();
  EXPECT_FALSE(old->conditions.history_warm_up.has_value());
}

TEST(Result, ReadsOneOfBeforeThereWereRegions) {
  nlohmann::json json = nlohmann::json::parse(to_json(sample_result()));
  EXPECT_EQ(json["rows"][0]["quality"]["psnr_thin"], 20);
  EXPECT_TRUE(json["rows"][0]["quality"]["psnr_edge"].is_null());
  for (const char* region : {"thin", "behind_thin", "disoccluded", "edge", "rest"}) {
    for (auto& row : json["rows"])
      ASSERT_EQ(row["quality"].erase(std::string("psnr_") + region), 1u);
    for (auto& scene : json["scenes"])
      ASSERT_EQ(scene.erase(std::string("part_") + region), 1u);
  }
  const auto old = from_json(json.dump(), "old.json");
  ASSERT_TRUE(old.ok()) << old.status().message();
  EXPECT_EQ(old->rows[0].quality.region_psnr, RegionFigures());
  EXPECT_EQ(old->scenes[0].region_part, RegionFigures());
}

TEST(Result, CsvHasALineARowAndQuotesItsText) {
  BenchResult result = sample_result();
  result.rows[0].scene = "a \"b\", c";
  const std::string csv = to_csv(result);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<int>(result.rows.size()));
  const std::string names = csv.substr(0, csv.find('\n'));
  EXPECT_EQ(names.rfind("scene,scale,method,render_width,", 0), 0u) << names;
  EXPECT_NE(names.find(",quality_flip,"), std::string::npos);
  EXPECT_NE(names.find(",speed_ms_median,"), std::string::npos);
  EXPECT_NE(names.find(",quality_psnr_behind_thin,"), std::string::npos);
  EXPECT_NE(csv.find("\n\"a \"\"b\"\", c\",0.5,bilinear,32,18,"), std::string::npos) << csv;
  const std::string last = csv.substr(csv.rfind('\n', csv.size() - 2) + 1);
  EXPECT_EQ(std::count(last.begin(), last.end(), ','), std::count(names.begin(), names.end(), ','));
}

TEST(Plot, HasAPointAMethodAndNoBadNumber) {
  const std::string svg = plot_of(sample_result());
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
    ++circles;
  EXPECT_EQ(circles, sample_result().methods.size());
  EXPECT_NE(svg.find(">quincunx:mean</text>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(plot_of(BenchResult{}), "");
}

TEST(Page, IsOneFileThatNothingInItEnds) {
  const std::string page = page_of(sample_result(), {});
  const auto count = [&page](const std::string& text) {
    int found = 0;
    for (std::size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("</script>"), 2);  // data and script; the scene's words hold one more
  EXPECT_EQ(count("<!--"), 0);
  for (const char* mark : {"/*style*/", "/*script*/", "/*data*/", "src=\"", "https://", "url("})
    EXPECT_EQ(count(mark), 0) << mark;
  EXPECT_GT(count("http://www.w3.org/2000/svg"), 0);  // a name, nothing that is loaded
  EXPECT_EQ(count("http://"), count("http://www.w3.org/2000/svg"));
}

}  // namespace
}  // namespace quincunx::bench
