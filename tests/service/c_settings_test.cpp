// SPDX-License-Identifier: MIT
// Settings pass through the C interface whole, and programs and libraries of different age understand each other.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "c_interface_fixture.h"

namespace quincunx {
namespace {

using testing::COwner;

// Does not compile once a struct has a field more: c_settings.h then wants it at its end, too, and here.
// It knows nothing of particles of their own viewport, of a dynamic output, of a focus, and of changes of method.
SceneNeeds other_needs() {
  SceneNeeds needs;
  auto& [moving_objects, camera_motion, transparents, background] = needs;
  moving_objects = camera_motion = transparents = background = false;
  return needs;
}

ResolveSettings other_settings() {
  ResolveSettings settings;
  auto& [method, output, least_output, target, particle_target, colour, velocity, resolved, storage, targets,
         shading, present, clear, tone_map, dither, clamp_ringing, grain, noise_moves, drawn_velocity, far,
         quincunx, temporal, blur, sharpness, focus, measures_content, fades] = settings;
  method = Method::kTemporal;
  output = {3, 4};
  target = {5, 6};
  colour = PixelFormat::kRGBA8;
  velocity = PixelFormat::kRG32F;
  resolved = PixelFormat::kRGBA16F;
  storage = Storage::kImage;
  targets = Targets::kPlaced;
  shading = Shading::kCheckerboard;
  present = dither = clamp_ringing = noise_moves = false;
  clear = true;
  tone_map = ToneMap::kReinhard;
  grain = 0.125f;
  drawn_velocity = DrawnVelocity::kDilated;
  far = FarMotion::kEvidence;
  sharpness = 0.75f;
  auto& [form, sampling, velocity_weight, residual_weight] = quincunx;
  form = TwoFrameForm::kReprojected;
  sampling = Sampling::kPoint;
  velocity_weight = 2;
  residual_weight = 3;
  auto& [preset, view, history] = temporal;
  preset = TemporalPreset::kQuality;
  view = TemporalView::kFar;
  history = PixelFormat::kRGBA32F;
  auto& [shutter, samples] = blur;
  shutter = 1.5f;
  samples = 64;
  return settings;
}

quincunx_settings sized(quincunx_settings settings) {
  settings.struct_size = sizeof(settings);
  return settings;
}

TEST(CSettings, EveryFieldArrives) {
  const quincunx_settings settings = sized(c::to_c({other_needs(), other_settings()}));
  const auto back = c::from_c(&settings);
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back->needs, other_needs());
  EXPECT_EQ(back->resolve, other_settings());
}

TEST(CSettings, DefaultsAreThoseOfTheLibrary) {
  quincunx_settings settings;
  std::memset(&settings, 0xff, sizeof(settings));
  settings.struct_size = sizeof(settings);
  ASSERT_EQ(quincunx_settings_init(&settings), QUINCUNX_OK) << quincunx_last_error();
  const auto read = c::from_c(&settings);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->needs, SceneNeeds());
  EXPECT_EQ(read->resolve, ResolveSettings());
}

TEST(CSettings, ANumberThatNamesNothingIsRefused) {
  quincunx_settings settings = sized(c::to_c({}));
  settings.method = 99;
  const auto read = c::from_c(&settings);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.status().message(), "settings.method is 99; it must lie in [0, 10]");
  settings.method = 0;
  settings.colour_format = 0;
  EXPECT_EQ(c::from_c(&settings).status().message(), "settings.colour_format is 0; it must lie in [1, 7]");
}

TEST(CSettings, MethodsAreKnownByName) {
  EXPECT_STREQ(quincunx_method_name(QUINCUNX_TWO_FRAMES), "quincunx");
  EXPECT_STREQ(quincunx_method_name(QUINCUNX_TEMPORAL), "temporal");
  EXPECT_EQ(quincunx_method_name(-1), nullptr);
  EXPECT_EQ(quincunx_method_name(static_cast<int>(methods().size())), nullptr);
}

// A program of a later version, whose struct has fields that this library does not know.
struct LaterSettings {
  quincunx_settings settings;
  std::int64_t later;
};

TEST(CSettings, AProgramThatIsNewerIsUnderstoodUntilItUsesWhatIsNew) {
  LaterSettings later = {c::to_c({{}, {.output = {64, 36}, .target = {64, 36}}}), 0};
  later.settings.struct_size = sizeof(later);
  quincunx_plan* plan = nullptr;
  ASSERT_EQ(quincunx_plan_create(&later.settings, &plan), QUINCUNX_OK) << quincunx_last_error();
  COwner<quincunx_plan> owner(plan);
  later.later = 1;
  EXPECT_EQ(quincunx_plan_create(&later.settings, &plan), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(plan, nullptr);
  EXPECT_NE(std::string(quincunx_last_error()).find("a field beyond the 144 bytes that this library knows"),
            std::string::npos)
      << quincunx_last_error();
  later.later = 12345;
  ASSERT_EQ(quincunx_settings_init(&later.settings), QUINCUNX_OK);
  EXPECT_EQ(later.later, 12345);
  EXPECT_EQ(later.settings.struct_size, sizeof(later));
}

TEST(CSettings, AStructWithoutItsSizeIsRefused) {
  quincunx_settings settings = {};
  EXPECT_EQ(quincunx_settings_init(&settings), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_STREQ(quincunx_last_error(),
               "settings.struct_size is 0; it must be the sizeof of the struct, at least 144");
}

TEST(CSettings, NeedsAreThoseOfThePlan) {
  const auto plan = testing::c_plan(
      {.moving_objects = false},
      {.method = Method::kTemporal, .output = {64, 36}, .target = {64, 36}, .blur = {.shutter = 0.5f}});
  quincunx_needs needs = {};
  needs.struct_size = sizeof(needs);
  ASSERT_EQ(quincunx_plan_needs(plan.get(), &needs), QUINCUNX_OK) << quincunx_last_error();
  EXPECT_EQ(needs.reads_depth, 1);
  EXPECT_EQ(needs.reads_velocity, 0);
  EXPECT_EQ(needs.reads_reactive, 1);
  EXPECT_EQ(needs.reads_camera, 1);
  EXPECT_EQ(needs.keeps_previous_frame, 1);
  EXPECT_EQ(needs.accumulates, 1);
  EXPECT_EQ(needs.blurs, 1);
  EXPECT_GT(needs.frame_bytes, 64u * 36 * 12);
  EXPECT_NE(std::string(quincunx_plan_text(plan.get())).find("velocity_from_depth"), std::string::npos);
}

TEST(CSettings, VersionsAreTold) {
  EXPECT_EQ(quincunx_api_version(), QUINCUNX_API_VERSION);
  EXPECT_NE(std::string(quincunx_version()).find('.'), std::string::npos);
}

}  // namespace
}  // namespace quincunx
