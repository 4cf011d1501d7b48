// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bench/front.h"
#include "catalog/scene_catalog.h"

namespace quincunx::bench {
namespace {

TEST(FrontScenes, EachClassHasScenesOfBothKindsAndNoSceneIsThereTwice) {
  std::set<std::string> known;
  for (const scenes::SceneEntry& entry : scenes::list_scenes())
    known.insert(entry.name);
  std::set<std::string> seen;
  ASSERT_EQ(class_scenes().size(), kSceneClasses);
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    const ClassScenes& members = class_scenes()[i];
    EXPECT_EQ(members.scene_class, static_cast<SceneClass>(i));
    EXPECT_FALSE(members.measured.empty());
    EXPECT_FALSE(members.held_out.empty());
    for (const auto& names : {members.measured, members.held_out}) {
      for (const std::string_view name : names) {
        EXPECT_TRUE(known.contains(std::string(name))) << name;
        EXPECT_TRUE(seen.insert(std::string(name)).second) << name;
      }
    }
  }
}

// Returns a result of bilinear at scale 0.5 and 1, in each measured scene and one that is held out.
BenchResult result(double flip, double ms) {
  BenchResult result;
  result.conditions.output = {1000, 500};
  const auto add = [&](std::string_view scene, double worse) {
    for (const double scale : {0.5, 1.0}) {
      Row row;
      row.scene = scene;
      row.scale = scale;
      row.method = "bilinear";
      row.quality.flip = flip * worse / scale;
      row.quality.psnr = 30;
      row.speed.ms.median = 100;
      row.speed.least_ms = ms * scale;
      result.rows.push_back(row);
    }
  };
  for (const ClassScenes& members : class_scenes()) {
    double worse = 1;
    for (const std::string_view scene : members.measured) {
      add(scene, worse);
      worse += 1;
    }
    add(members.held_out.front(), 5);
  }
  return result;
}

TEST(FrontPoints, AreMeansOverTheScenesOfTheClassAndTheViews) {
  BenchResult views[] = {result(0.1, 2), result(0.2, 4)};
  const auto points = front_points(views);
  ASSERT_TRUE(points.ok()) << points.status().message();
  ASSERT_EQ(points->size(), 2 * kSceneClasses);
  for (const FrontPoint& point : points.value()) {
    EXPECT_EQ(point.method.method, Method::kBilinear);
    EXPECT_DOUBLE_EQ(point.ms_per_megapixel, 3 * point.scale / 0.5);  // the picture has half a megapixel
    EXPECT_DOUBLE_EQ(point.psnr_db, 30);
    EXPECT_EQ(point.psnr_spread, 0);
  }
  const FrontPoint& pan = points.value()[3];  // one scene in two views: 0.1 and 0.2
  EXPECT_EQ(pan.scene_class, SceneClass::kPan);
  EXPECT_DOUBLE_EQ(pan.flip, 0.15);
  EXPECT_DOUBLE_EQ(pan.flip_spread, std::sqrt(0.005));
  EXPECT_DOUBLE_EQ(pan.ms_spread, 2 * std::sqrt(2));  // 4 and 8
  const FrontPoint& objects = points.value()[5];      // two scenes, the second twice as wrong
  EXPECT_EQ(objects.scene_class, SceneClass::kObjects);
  EXPECT_DOUBLE_EQ(objects.flip, (0.1 + 0.2 + 0.2 + 0.4) / 4);
}

TEST(FrontPoints, NoErrorAtAllHasTheHighestFigure) {
  BenchResult view = result(0, 2);
  for (Row& row : view.rows)
    row.quality.psnr = std::numeric_limits<double>::infinity();
  const auto points = front_points({&view, 1});
  ASSERT_TRUE(points.ok());
  EXPECT_EQ(points->front().psnr_db, FrontPoint::kMaxPsnr);
  EXPECT_EQ(points->front().flip_spread, 0);
}

TEST(FrontPoints, OtherMethodsAreRefusedByName) {
  BenchResult view = result(0.1, 2);
  for (Row& row : view.rows)
    row.method = "bilinear@rgba8";
  EXPECT_NE(front_points({&view, 1}).status().message().find("no method 'bilinear@rgba8'"),
            std::string::npos);
}

TEST(FrontPoints, TheTableMarksWhatIsOnTheFront) {
  BenchResult view = result(0.1, 2);
  auto points = front_points({&view, 1});
  ASSERT_TRUE(points.ok());
  for (FrontPoint point : std::vector<FrontPoint>(points.value())) {
    point.method = {.method = Method::kLanczos3};
    point.flip += 0.01;
    points->push_back(point);
  }
  const auto front = ErrorFront::create({.device = "a",
                                         .driver = "b",
                                         .scene = {},
                                         .date = "c",
                                         .command = {},
                                         .truth = {},
                                         .output_extent = {1000, 500}},
                                        points.value());
  ASSERT_TRUE(front.ok()) << front.status().message();
  const std::string text = text_of(front.value());
  EXPECT_NE(text.find("still    bilinear"), std::string::npos) << text;
  EXPECT_NE(text.find("1.00:0.1000 30.00   4.00*"), std::string::npos) << text;
  EXPECT_NE(text.find("1.00:0.1100 30.00   4.00 "), std::string::npos) << text;
}

}  // namespace
}  // namespace quincunx::bench
