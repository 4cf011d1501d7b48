// SPDX-License-Identifier: MIT
// Demands of a controller that chooses methods on a service: what frames show, and pictures that fade into each other.
#include <gtest/gtest.h>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;

constexpr Extent kOutput = {64, 64};

FrameReport completed(ServiceRig& rig, const FrameInputs& inputs) {
  EXPECT_TRUE(rig.dispatch(inputs).ok());
  EXPECT_TRUE(rig.service().finish().ok());
  const auto report = rig.service().next_completed();
  EXPECT_TRUE(report.has_value());
  return report.value_or(FrameReport());
}

TEST(QualityFrames, TheReportSaysWhatEachFrameShowsWhateverTheMethod) {
  for (const Method method : {Method::kBilinear, Method::kQuincunx, Method::kTemporal}) {
    ServiceRig rig({}, {.method = method, .control = {.measures_content = true}}, kOutput, kOutput);
    for (const float pixels : {2.f, 0.f, 4.f}) {
      const HostFrame frame = {.render = {48, 40}, .velocity = [&](int, int) {
                                 return Vec2{pixels / 64, 0};
                               }};
      const FrameReport report = completed(rig, rig.upload(frame));
      ASSERT_TRUE(report.content.has_value()) << name_of(method);
      EXPECT_EQ(report.content->moving, pixels > 0 ? 1 : 0) << "sums of one frame do not reach the next";
      EXPECT_NEAR(report.content->speed_px, static_cast<double>(pixels), 1e-2);
      EXPECT_EQ(report.content->light, 0);
    }
    const HostFrame glows = {.render = {48, 40}, .reactive = [](int x, int) { return x < 24 ? 255 : 0; }};
    EXPECT_EQ(completed(rig, rig.upload(glows)).content->light, .5);
  }
}

TEST(QualityFrames, NothingMovesWhereNothingCan) {
  const SceneNeeds still = {.moving_objects = false, .camera_motion = false};
  ServiceRig rig(still, {.method = Method::kBilinear, .control = {.measures_content = true}}, kOutput,
                 kOutput);
  const FrameReport report = completed(rig, rig.upload({.render = kOutput}));
  ASSERT_TRUE(report.content.has_value());
  EXPECT_EQ(report.content->moving, 0);
  EXPECT_EQ(report.passes.size(), 2u) << "the filter and the present pass";
}

// Shadows of bars go over a wall that moves, too: the judge of history sees where. A wall alone shows it nothing.
TEST(QualityFrames, LightThatMovesIsSeenWhereHistoryIsJudged) {
  using testing::Place;
  const auto light_of = [](Method method, double in_shadow) {
    testing::TemporalScene scene;
    scene.surfaces = {{.velocity = {1.25, -.5}, .texture = testing::noise_texture(6)}};
    scene.light = [in_shadow](Place place, int frame) {
      return std::fmod(place.real() + 2.5 * frame, 40) < 20 ? in_shadow : 1;
    };
    ServiceRig rig({}, {.method = method, .control = {.measures_content = true}}, scene.output, {320, 192});
    double light = 0;
    for (int frame = 0; frame < 30; ++frame) {
      const Vec2 jitter = testing::halton_jitter(frame, 32);
      const FrameReport report = completed(rig, rig.upload(scene.render(frame, {80, 48}, jitter)));
      EXPECT_EQ(report.content->judged, method == Method::kTemporal && frame > 0) << frame;
      if (frame >= 10) light += report.content->light / 20;
    }
    EXPECT_FALSE(completed(rig, rig.upload(scene.render(30, {320, 192}, {}))).content->judged)
        << "history has no part in a dense frame";
    return light;
  };
  const double shadows = light_of(Method::kTemporal, .4), none = light_of(Method::kTemporal, 1);
  RecordProperty("light_with_shadows_and_without", std::to_string(shadows) + " " + std::to_string(none));
  EXPECT_GT(shadows, .1);
  EXPECT_LT(none, .02);
  EXPECT_EQ(light_of(Method::kBilinear, .4), 0);
}

TEST(QualityFrames, WhatNobodyAsksForIsNotMeasured) {
  ServiceRig rig({}, Method::kTemporal, kOutput, kOutput);
  EXPECT_FALSE(completed(rig, rig.upload({.render = kOutput})).content.has_value());
}

TEST(QualityFrames, TheFinishedPictureFadesFromAnother) {
  ServiceRig rig({}, {.method = Method::kBilinear, .control = {.fades = true}}, kOutput, kOutput);
  const auto grey = [](float value) {
    return HostFrame{.render = kOutput, .colour = [value](int, int) {
                       return Pixel{value, value, value, 1};
                     }};
  };
  rig.resolve(grey(.25f));
  Image other = rig.device().allocate(kOutput, PixelFormat::kRGBA32F).value();
  const std::vector<Pixel> before(static_cast<std::size_t>(kOutput.area()), Pixel{1, 0, .5f, 1});
  ASSERT_TRUE(rig.device().upload(other.view(), kOutput, before.data()).ok());
  FrameInputs inputs = rig.upload(grey(.25f));
  inputs.fading_from = other.view();
  inputs.fade_weight = .75f;
  ASSERT_TRUE(rig.dispatch(inputs).ok());
  for (const Pixel& pixel : rig.resolved()) {
    const Pixel mixed = {.75f * .25f + .25f, .75f * .25f, .75f * .25f + .125f, 1};
    ASSERT_EQ(pixel, mixed);
  }
  EXPECT_EQ(rig.resolve(grey(.25f)).front()[0], .25f) << "and only in that frame";
}

TEST(QualityFrames, AFadeThatCannotBeIsRefused) {
  ServiceRig rig({}, {.method = Method::kBilinear, .control = {.fades = true}}, kOutput, kOutput);
  ServiceRig without(rig.device(), {}, {.method = Method::kBilinear}, kOutput, kOutput);
  Image other = rig.device().allocate(kOutput, PixelFormat::kRGBA32F).value();
  FrameInputs inputs = without.upload({.render = kOutput});
  inputs.fading_from = other.view();
  EXPECT_NE(without.dispatch(inputs).status.message().find("set settings.control.fades"), std::string::npos);
  inputs = rig.upload({.render = kOutput});
  inputs.fading_from = other.view();
  inputs.fade_weight = 1.5f;
  EXPECT_NE(rig.dispatch(inputs).status.message().find("fade_weight is 1.5"), std::string::npos);
  inputs.fade_weight = .5f;
  inputs.fading_from.extent = {8, 8};
  EXPECT_NE(rig.dispatch(inputs).status.message().find("fading_from.extent is 8x8"), std::string::npos);
}

}  // namespace
}  // namespace quincunx
