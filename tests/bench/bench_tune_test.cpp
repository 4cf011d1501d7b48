// SPDX-License-Identifier: MIT
#include "bench/tune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quincunx::bench {
namespace {

constexpr WorkShape kPlain = {.group_width = 1, .group_height = 4, .pixels_per_item = 0};
constexpr WorkShape kWide = {.group_width = 64, .group_height = 1, .pixels_per_item = 1};
constexpr WorkShape kTile = {.group_width = 8, .group_height = 8, .pixels_per_item = 1};

TEST(TuneChoice, TheDefaultIsTriedFirstAndNoneTwice) {
  for (const WorkShape& plain :
       {kPlain, WorkShape{.group_width = 16, .group_height = 8, .pixels_per_item = 1},
        WorkShape{.group_width = 5, .group_height = 5, .pixels_per_item = 5}}) {
    const auto shapes = shapes_to_try(plain, 256);
    EXPECT_EQ(shapes.front(), plain);
    for (const WorkShape& shape : shapes)
      EXPECT_EQ(std::count(shapes.begin(), shapes.end(), shape), 1);
    EXPECT_GT(shapes.size(), 5u);
  }
  for (const WorkShape& shape : shapes_to_try(kPlain, 16))
    EXPECT_LE(shape.group_width * shape.group_height, 16);
}

// Another program stretches whole rounds: the quotients within each round are as they were.
TEST(TuneChoice, ABusyMachineChangesNothing) {
  const std::vector<ShapeTimes> cases = {
      {{{"present", {1, 4, 1, 9, 1}}}, {{"present", {.5, 2, .5, 4.5, 3}}}}};
  const auto quotients = quotients_of(cases);
  ASSERT_EQ(quotients.at("present").size(), 2u);
  EXPECT_DOUBLE_EQ(quotients.at("present")[0], 1);
  EXPECT_DOUBLE_EQ(quotients.at("present")[1], .5);
}

TEST(TuneChoice, EachPassGetsItsOwnAndTheOthersTheBestOfAll) {
  // The second shape halves `a`, the third takes a quarter off both.
  const std::vector<ShapeTimes> cases = {{{{"a", {4, 4}}}, {{"a", {2, 2}}}, {{"a", {3, 3}}}},
                                         {{{"b", {4, 4}}}, {{"b", {8, 8}}}, {{"b", {3, 3}}}}};
  const DeviceProfile profile = choose_profile({kPlain, kWide, kTile}, quotients_of(cases));
  EXPECT_EQ(profile.passes.at("a"), kWide);
  EXPECT_EQ(profile.passes.at("b"), kTile);
  EXPECT_EQ(profile.shape, kTile);
}

TEST(TuneChoice, AShapeThatOneCaseWasRefusedIsNotChosen) {
  const std::vector<ShapeTimes> cases = {{{{"a", {4, 4}}}, {{"a", {1, 1}}}, {{"a", {3, 3}}}},
                                         {{{"a", {4, 4}}}, {}, {{"a", {3, 3}}}}};
  const auto quotients = quotients_of(cases);
  EXPECT_TRUE(std::isinf(quotients.at("a")[1]));
  const DeviceProfile profile = choose_profile({kPlain, kWide, kTile}, quotients);
  EXPECT_EQ(profile.passes.at("a"), kTile);
  EXPECT_EQ(profile.shape, kTile);
}

TEST(TuneChoice, WhatDoesNotGainWhenMeasuredAgainGoesBack) {
  DeviceProfile profile;
  profile.passes = {{"gains", kWide}, {"hardly", kWide}, {"loses", kTile}, {"refused", kTile}};
  keep_what_gains(profile, kPlain,
                  {{{{"gains", {10, 10}}, {"hardly", {10, 10}}, {"loses", {10, 10}}, {"refused", {10, 10}}},
                    {{"gains", {9, 9}}, {"hardly", {9.9, 9.9}}, {"loses", {12, 12}}}}});
  EXPECT_EQ(profile.passes.at("gains"), kWide);
  EXPECT_EQ(profile.passes.at("hardly"), kPlain);
  EXPECT_EQ(profile.passes.at("loses"), kPlain);
  EXPECT_EQ(profile.passes.at("refused"), kPlain);
}

}  // namespace
}  // namespace quincunx::bench
