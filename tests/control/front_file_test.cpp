// SPDX-License-Identifier: MIT
#include "quincunx/front_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "../tools/own_cache.h"
#include "../tools/temporary_folder.h"
#include "quincunx/cache_folder.h"

namespace quincunx {
namespace {

namespace fs = std::filesystem;

// A cache folder of its own.
class FrontFile : public ::testing::Test {
 protected:
  // The figures that are built in, as if measured for `source` and written where those of `place` are looked for.
  static void write(const FrontKey& place, const FrontKey& source) {
    const auto points = ErrorFront::built_in().points();
    const auto front = ErrorFront::create({.device = source.device,
                                           .driver = source.driver,
                                           .scene = source.scene,
                                           .date = "now",
                                           .command = {},
                                           .truth = {},
                                           .output = {640, 360}},
                                          {points.begin(), points.end()});
    ASSERT_TRUE(front.ok()) << front.status().message();
    std::ofstream(*front_path(place)) << front->to_json();
  }

  static constexpr const char* kScene = "courtyard";
  const FrontKey any_ = {"platform device", "1.2", ""};
  const FrontKey scene_ = {"platform device", "1.2", kScene};

 private:
  testing::TemporaryFolder folder_;
  testing::OwnCache cache_{folder_.file(".")};
};

TEST_F(FrontFile, LiesInTheCacheFolderByDeviceDriverAndScene) {
  EXPECT_EQ(front_path(any_)->parent_path(), *cache_folder());
  EXPECT_NE(*front_path(any_), *front_path(scene_));
  EXPECT_NE(*front_path(any_), *front_path({"platform device", "1.3", ""}));
  EXPECT_NE(*front_path(any_), *front_path({"another device", "1.2", ""}));
  const testing::OwnCache none("");
  EXPECT_FALSE(front_path(any_));
  EXPECT_TRUE(find_front(any_).front.is_built_in());
}

TEST_F(FrontFile, TheScenesGoesBeforeTheDevicesGoesBeforeTheBuiltIn) {
  EXPECT_TRUE(find_front(scene_).front.is_built_in());
  EXPECT_EQ(find_front(scene_).explanation.rfind("built in", 0), 0u);
  write(any_, any_);
  EXPECT_FALSE(find_front(scene_).front.is_built_in());
  EXPECT_EQ(find_front(scene_).front.source().scene, "");
  write(scene_, scene_);
  EXPECT_EQ(find_front(scene_).front.source().scene, kScene);
  EXPECT_EQ(
      find_front(scene_).explanation,
      "measured on platform device, driver 1.2, now, for scene courtyard; " + front_path(scene_)->string());
  EXPECT_EQ(find_front(any_).front.source().scene, "");
}

TEST_F(FrontFile, WhatIsDamagedOrOfSomethingElseIsPassedOverAndSaidSo) {
  write(any_, any_);
  std::ofstream(*front_path(scene_)) << "{";
  const FoundFront device = find_front(scene_);
  EXPECT_EQ(device.front.source().scene, "");
  EXPECT_FALSE(device.front.is_built_in());
  EXPECT_NE(device.explanation.find(front_path(scene_)->string() + "' was not taken: error front: "),
            std::string::npos)
      << device.explanation;
  write(any_, {"another device", "1.2", ""});
  const FoundFront built_in = find_front(any_);
  EXPECT_TRUE(built_in.front.is_built_in());
  EXPECT_NE(built_in.explanation.find("was not taken: it is of 'another device'"), std::string::npos)
      << built_in.explanation;
}

}  // namespace
}  // namespace quincunx
