// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/regions.h"
#include "catalog/scene_catalog.h"

namespace quincunx::bench {
namespace {

BenchOptions parsed(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "quincunx-bench");
  std::vector<char*> argv;
  for (std::string& argument : arguments)
    argv.push_back(argument.data());
  BenchOptions options;
  EXPECT_FALSE(parse_command_line(static_cast<int>(argv.size()), argv.data(), options).has_value());
  return options;
}

void expect_refused(const std::vector<std::string>& arguments, const std::string& part) {
  const auto plan = plan_from(parsed(arguments));
  ASSERT_FALSE(plan.ok()) << part;
  EXPECT_NE(plan.status().message().find(part), std::string::npos) << plan.status().message();
}

TEST(Plan, MeasuresEveryMethodOfTheTableOnce) {
  std::set<std::string> forms;
  for (const VariantInfo& info : all_variants())
    forms.insert(info.name);
  std::set<std::string> measured;
  for (const BenchMethod& method : all_methods()) {
    EXPECT_TRUE(measured.insert(method.name).second) << method.name;
    EXPECT_FALSE(method.summary.empty()) << method.name;
  }
  EXPECT_EQ(measured, forms);
}

TEST(Plan, TakesEverythingWhereNothingIsChosen) {
  const auto plan = plan_from(parsed({}));
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  EXPECT_EQ(plan->methods.size(), all_methods().size());
  EXPECT_EQ(plan->scenes.size(), scenes::list_scenes().size());
  EXPECT_EQ(plan->conditions.output, (Extent{1280, 720}));
  EXPECT_TRUE(plan->methods[plan->frame_method].is_default);
}

TEST(Plan, AMethodMayHaveEightBitColour) {
  const auto plan = plan_from(parsed({"--methods", "temporal,temporal@rgba8"}));
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  EXPECT_EQ(plan->methods[1].name, plan->methods[0].name + "@rgba8");
  EXPECT_EQ(plan->methods[0].resolve.colour, PixelFormat::kRGBA16F);
  EXPECT_EQ(plan->methods[1].resolve.colour, PixelFormat::kRGBA8);
  EXPECT_EQ(plan->methods[1].resolve.output.tone_map, ToneMap::kReinhard)
      << "the curve that the metrics have";
  EXPECT_EQ(plan->methods[1].jitter, plan->methods[0].jitter);
  EXPECT_EQ(plan->frame_method, 0u);
  const auto both = plan_from(parsed({"--methods", "checkerboard/bilinear@rgba8"}));
  ASSERT_TRUE(both.ok()) << both.status().message();
  EXPECT_EQ(both->methods[0].name, "checkerboard/bilinear@rgba8");
  EXPECT_EQ(both->methods[0].resolve.targets.shading, Shading::kCheckerboard);
  EXPECT_EQ(both->methods[0].resolve.colour, PixelFormat::kRGBA8);
  const auto dual = plan_from(parsed({"--methods", "temporal,dual0.8/temporal"}));
  ASSERT_TRUE(dual.ok()) << dual.status().message();
  EXPECT_EQ(dual->methods[1].name, "dual0.8/" + dual->methods[0].name);
  EXPECT_FALSE(sequence_for(dual.value(), 0.5, dual->methods[0]).outputs);
  auto outputs = sequence_for(dual.value(), 0.5, dual->methods[1]).outputs;
  ASSERT_TRUE(outputs);
  EXPECT_EQ(outputs->min_output(), outputs->next({64, 64}));
  const auto focused = plan_from(parsed({"--methods", "dual0.8/focus/temporal", "--focus", "9,9,90,90"}));
  ASSERT_TRUE(focused.ok()) << focused.status().message();
  EXPECT_EQ(focused->methods[0].dual, "0.8");
  EXPECT_TRUE(focused->methods[0].focuses);
  const auto two_way = plan_from(parsed({"--methods", "two-way/temporal@rgba8"}));
  ASSERT_TRUE(two_way.ok()) << two_way.status().message();
  EXPECT_EQ(two_way->methods[0].name, "two-way/temporal:balanced@rgba8");
  EXPECT_TRUE(two_way->methods[0].two_way);
  expect_refused({"--methods", "two-way/quincunx"}, "'two-way/quincunx:velocity' has no history to merge");
  expect_refused({"--methods", "dual0.8/two-way/temporal"}, "both ways there is one output");
  expect_refused({"--methods", "dual1.5/temporal"}, "is no resolution of the output");
  expect_refused({"--methods", "quincunx@rgba4"}, "no method 'quincunx@rgba4'");
}

TEST(Plan, NoiseIsOfAllFramesAndKnownToWhatDenoises) {
  const auto plan = plan_from(parsed({"--methods", "bilinear,temporal,two-way/denoised/temporal", "--noise",
                                      "4", "--history-warm-up", "7"}));
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  EXPECT_EQ(plan->conditions.noise, 4);
  EXPECT_EQ(plan->methods[1].resolve.temporal.noise, 0);
  EXPECT_EQ(plan->methods[2].resolve.temporal.noise, .25f);
  EXPECT_TRUE(plan->methods[2].two_way);
  EXPECT_EQ(plan->methods[2].name, "two-way/denoised/temporal:balanced");
  EXPECT_FALSE(plan_from(parsed({}))->conditions.noise);
  expect_refused({"--methods", "denoised/temporal"}, "'denoised/temporal:balanced' needs --noise");
  expect_refused({"--methods", "denoised/quincunx", "--noise", "4"},
                 "'denoised/quincunx:velocity' needs --noise");
  expect_refused({"--methods", "temporal@rgba8", "--noise", "4"},
                 "'temporal:balanced@rgba8' has frames of 8 bits");
}

TEST(Plan, AFocusIsOfTheMethodsThatAskForIt) {
  const auto plan = plan_from(parsed({"--methods", "bilinear,focus/bilinear,focus/temporal@rgba8", "--focus",
                                      "8,8,40,30", "--focus-scale", "1.5"}));
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  EXPECT_FALSE(focus_for(plan->conditions, plan->methods[0]).target.has_value());
  EXPECT_EQ(plan->methods[1].name, "focus/bilinear");
  const scenes::FocusOptions focus = focus_for(plan->conditions, plan->methods[1]);
  EXPECT_EQ(focus.target->rectangle, (Rectangle{8, 8, 40, 30}));
  EXPECT_EQ(focus.scale, 1.5f);
  EXPECT_EQ(plan->methods[2].name, "focus/temporal:balanced@rgba8");
  EXPECT_EQ(plan->methods[2].resolve.colour, PixelFormat::kRGBA8);
  expect_refused({"--methods", "focus/bilinear"}, "'focus/bilinear' needs --focus OBJECT or X,Y,W,H");
  expect_refused({"--focus", "8,8,4000,30"}, "is no rectangle within the picture of 1280x720");
  expect_refused({"--focus", "pointer"}, "--focus pointer is for a window");
}

TEST(Plan, QuickIsOnlyWhatWasNotGiven) {
  const auto plan = plan_from(parsed({"--quick", "--frames", "9", "--scenes", "pan"}));
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->scenes, std::vector<std::string>{"pan"});
  EXPECT_EQ(plan->conditions.frames, 9);
  EXPECT_EQ(plan->conditions.output, (Extent{320, 180}));
  EXPECT_EQ(plan->scales, (std::vector<double>{0.5, 0.71, 1}));
}

TEST(Plan, KeepsTheGivenMethodsAndSortsScales) {
  const auto plan = plan_from(parsed({"--methods", "quincunx:mean,point", "--scales", "1,0.5"}));
  ASSERT_TRUE(plan.ok());
  ASSERT_EQ(plan->methods.size(), 2u);
  EXPECT_EQ(plan->methods[0].name, "quincunx:mean");
  EXPECT_EQ(plan->methods[0].jitter, scenes::Jitter::kQuincunx);
  EXPECT_EQ(plan->methods[1].jitter, scenes::Jitter::kNone);
  EXPECT_EQ(plan->scales, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(plan->frame_method, 1u);  // the default is not there: the last
  const auto sequence = sequence_for(plan.value(), 0.5, plan->methods[0]);
  EXPECT_EQ(sequence.jitter, scenes::Jitter::kQuincunx);
  EXPECT_EQ(sequence.detail, (scenes::TextureDetail{.lod_bias = -0.5f}));
}

TEST(Plan, ShortNamesStandForTheUsualForm) {
  const auto plan = plan_from(parsed({"--methods", "quincunx,temporal"}));
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  EXPECT_EQ(plan->methods[0].name, "quincunx:velocity");
  EXPECT_EQ(plan->methods[1].name, "temporal:balanced");
  expect_refused({"--methods", "temporal,temporal:balanced"}, "twice");
}

TEST(Plan, WhatAccumulatesBeginsEarlierAndWithHaltonJitter) {
  const auto plan = plan_from(parsed({"--methods", "temporal:fast,quincunx", "--start", "1", "--fps", "10"}));
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  const Conditions& conditions = plan->conditions;
  EXPECT_EQ(plan->methods[0].jitter, scenes::Jitter::kHalton);
  EXPECT_EQ(conditions.history_warm_up, 24);
  EXPECT_EQ(first_frame_for(conditions, plan->methods[0]), conditions.warm_up - 24);
  EXPECT_EQ(first_frame_for(conditions, plan->methods[1]), 0);
  EXPECT_DOUBLE_EQ(seconds_of(conditions, -5), 0.5);
  // Both draw the same moments, the last of them included.
  EXPECT_DOUBLE_EQ(sequence_for(plan.value(), 1, plan->methods[0]).start_seconds, 1 - 2.2);
  EXPECT_DOUBLE_EQ(sequence_for(plan.value(), 1, plan->methods[1]).start_seconds, 1);
  EXPECT_EQ(sequence_for(plan.value(), 1, plan->methods[0]).frames, frames_of(conditions) + 22);
  EXPECT_EQ(sequence_for(plan.value(), 1, plan->methods[1]).frames, frames_of(conditions));
  // Never fewer than the others have.
  const auto few = plan_from(parsed({"--history-warm-up", "3", "--warm-up", "7"}));
  ASSERT_TRUE(few.ok());
  EXPECT_EQ(few->conditions.history_warm_up, 7);
}

TEST(Plan, MeasuresASceneWithCutsFromTheFirstFrameOfAShot) {
  const auto plan = plan_from(parsed({"--start", "1.5", "--fps", "60"}));
  ASSERT_TRUE(plan.ok());
  const scenes::Scene scene = scenes::open_scene("cut").value();
  const Conditions conditions = conditions_for(plan->conditions, scene);
  const int first = conditions.warm_up;
  EXPECT_TRUE(scenes::is_cut(scene, seconds_of(conditions, first - 1), seconds_of(conditions, first)));
  for (int frame = first - 24; frame < first + conditions.frames; ++frame) {
    const bool cut = scenes::is_cut(scene, seconds_of(conditions, frame - 1), seconds_of(conditions, frame));
    EXPECT_EQ(cut, frame == first) << frame;
  }
  EXPECT_GE(seconds_of(conditions, first), 1.5);
  EXPECT_EQ(conditions_for(plan->conditions, scenes::open_scene("pan").value()), plan->conditions);
}

TEST(Plan, RefusesWhatIsNone) {
  expect_refused({"--methods", "bilinaer"}, "bilinaer");
  expect_refused({"--scenes", "nowhere"}, "nowhere");
  expect_refused({"--scales", "0"}, "--scales");
  expect_refused({"--scales", "0.5,0.5"}, "twice");
  expect_refused({"--methods", "point,point"}, "twice");
  expect_refused({"--output", "8x8"}, "too small");
}

TEST(Gallery, CropsFitTheirRoomAndThePicture) {
  const Extent crop = crop_for({1280, 720}, 200, 1.3e6);
  EXPECT_LE(crop.area() * 200, 1'000'000);
  EXPECT_GE(crop.width, 64);
  EXPECT_EQ(crop_for({32, 16}, 1, 1e9), (Extent{32, 16}));
}

TEST(Disocclusion, IsWhatANearerSurfaceHid) {
  // Four columns: the near surface (depth 0.5) stood on columns 1 and 2; now it has left, all is far (0.1).
  constexpr Extent extent{4, 2};
  Geometry now{extent, std::vector<float>(8, 0.1f), std::vector<Vec2>(8)};
  Geometry before = now;
  for (const std::size_t i : {1u, 2u, 5u, 6u})
    before.depth[i] = 0.5f;
  const auto mask = disoccluded_since(now, before);
  EXPECT_EQ(mask, (std::vector<std::uint8_t>{0, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(disoccluded_since(now, now), std::vector<std::uint8_t>(8, 0));
  // Pixels that came from outside were not hidden, nor were those that are as near as before.
  now.velocity.assign(8, {2, 0});
  EXPECT_EQ(disoccluded_since(now, before), std::vector<std::uint8_t>(8, 0));
}

}  // namespace
}  // namespace quincunx::bench
