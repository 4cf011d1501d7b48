// SPDX-License-Identifier: MIT
#include "quincunx/resolve_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "plan/pass_spec.h"
#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

ResolveSettings settings(Method method) {
  ResolveSettings result;
  result.method = method;
  result.output_extent = {1280, 720};
  result.target_extent = {1280, 720};
  return result;
}

ResolvePlan plan(const SceneNeeds& needs, const ResolveSettings& wanted) {
  auto result = plan_for(needs, wanted);
  EXPECT_TRUE(result.ok()) << result.status().message();
  return result.value();
}

bool has_pass(const ResolvePlan& plan, const std::string& kernel) {
  return std::any_of(plan.passes.begin(), plan.passes.end(),
                     [&](const auto& pass) { return pass.kernel == kernel; });
}

bool has_buffer(const ResolvePlan& plan, const std::string& name) {
  return std::any_of(plan.buffers.begin(), plan.buffers.end(),
                     [&](const auto& buffer) { return buffer.name == name; });
}

bool leaves_out(const ResolvePlan& plan, const std::string& what) {
  return std::any_of(plan.left_out.begin(), plan.left_out.end(),
                     [&](const auto& left) { return left.what == what; });
}

// By numbers alone: nothing of that size is allocated.
TEST(ResolvePlan, SizesStayWhereKernelsCanCountTo) {
  const auto status = [](Method method, TemporalPreset preset, Extent output, Extent target) {
    ResolveSettings wanted = settings(method);
    wanted.output_extent = output;
    wanted.target_extent = target;
    wanted.temporal.preset = preset;
    return plan_for({}, wanted).status();
  };
  constexpr Extent kMost = {32768, 16384}, kMore = {32768, 16385}, kMostRecords = {16384, 16384};
  using enum TemporalPreset;
  EXPECT_TRUE(status(Method::kBilinear, kBalanced, kMost, kMost).ok());
  EXPECT_EQ(status(Method::kBilinear, kBalanced, kMore, kMost).message(),
            "settings.output_extent is 32768x16385; it must have at most 536870912 pixels, as many as "
            "32768x16384");
  EXPECT_EQ(status(Method::kBilinear, kBalanced, kMost, kMore).message(),
            "settings.target_extent is 32768x16385; it must have at most 536870912 pixels, as many as "
            "32768x16384");
  EXPECT_EQ(status(Method::kBilinear, kBalanced, {32769, 1}, kMost).message(),
            "settings.output_extent is 32769x1; both sides must lie in [1, 32768]");
  // Records of samples are counted in 28 bits.
  EXPECT_TRUE(status(Method::kTemporal, kBalanced, kMost, kMostRecords).ok());
  EXPECT_TRUE(status(Method::kTemporal, kFast, kMost, kMost).ok());
  EXPECT_EQ(
      status(Method::kTemporal, kBalanced, kMost, {16384, 16385}).message(),
      "settings.target_extent is 16384x16385; with two layers of history it must have at most 268435456 "
      "samples, as many as 16384x16384; settings.temporal.preset fast has one layer");
  ResolveSettings focused = settings(Method::kTemporal);
  focused.focus.extent = {64, 64};
  focused.focus.target_extent = {16384, 16385};
  EXPECT_EQ(plan_for({}, focused).status().code(), StatusCode::kInvalidArgument);
  focused.output_extent = kMost;
  focused.focus = {.extent = {16384, 16384}};
  ASSERT_TRUE(plan_for({}, focused).ok());
  EXPECT_TRUE(plan_for({}, focused)->focus_plan().has_value());
  focused.focus.extent = {32768, 8193};
  EXPECT_NE(plan_for({}, focused).error().find("settings.focus.extent is 32768x8193"), std::string::npos);
}

TEST(ResolvePlan, MovingObjectsNeedAVelocityTarget) {
  const ResolvePlan p = plan({.moving_objects = true}, settings(Method::kQuincunx));
  EXPECT_EQ(p.velocity, VelocitySource::kTarget);
  EXPECT_TRUE(has_buffer(p, "velocity"));
  EXPECT_TRUE(has_buffer(p, "velocity of the previous frame"));
  EXPECT_FALSE(p.reads_depth);
  EXPECT_FALSE(has_buffer(p, "depth"));
}

TEST(ResolvePlan, OnlyACameraMeansDepthInsteadOfAVelocityTarget) {
  const ResolvePlan p = plan({.moving_objects = false, .camera_motion = true}, settings(Method::kQuincunx));
  EXPECT_EQ(p.velocity, VelocitySource::kCamera);
  EXPECT_TRUE(p.reads_depth);
  EXPECT_TRUE(has_buffer(p, "depth"));
  EXPECT_FALSE(has_buffer(p, "depth of the previous frame")) << "its velocity is kept instead";
  EXPECT_EQ(p.passes.front().kernel, "velocity_from_depth");
  for (const PlannedBuffer& buffer : p.buffers)
    EXPECT_EQ(buffer.owned, buffer.name.starts_with("velocity") || buffer.name == "resolved") << buffer.name;
  EXPECT_TRUE(leaves_out(p, "velocity target"));
}

TEST(ResolvePlan, FarMotionCompletesTheDrawnVelocity) {
  ResolveSettings wanted = settings(Method::kQuincunx);
  wanted.conventions.sky_motion = SkyMotion::kCamera;
  const ResolvePlan p = plan({}, wanted);
  EXPECT_EQ(p.passes.front().kernel, "far_velocity");
  EXPECT_TRUE(p.reads_depth);
  EXPECT_TRUE(p.reads_camera());
  for (const PlannedBuffer& buffer : p.buffers)
    EXPECT_EQ(buffer.owned, buffer.name.starts_with("velocity") || buffer.name == "resolved") << buffer.name;
  EXPECT_TRUE(has_buffer(p, "drawn velocity"));
  const Status missing = validate(p, {.render_extent = {640, 360}}, {});
  EXPECT_NE(missing.message().find("velocity is missing"), std::string::npos) << missing.message();
  EXPECT_EQ(missing.message().find("drawn velocity"), std::string::npos) << missing.message();
}

TEST(ResolvePlan, FarMotionFromEvidenceNeedsNoCameraButTwoFrames) {
  ResolveSettings wanted = settings(Method::kTemporal);
  wanted.conventions.sky_motion = SkyMotion::kEvidence;
  const ResolvePlan p = plan({}, wanted);
  for (const char* kernel : {"far_surroundings", "far_fit", "far_match", "far_velocity"})
    EXPECT_TRUE(has_pass(p, kernel)) << kernel;
  EXPECT_FALSE(p.reads_camera());
  EXPECT_TRUE(has_buffer(p, "colour of the previous frame"));
  wanted.method = Method::kBilinear;
  wanted.blur.shutter = .5;
  const ResolvePlan single = plan({}, wanted);
  EXPECT_TRUE(leaves_out(single, "far_velocity"));
  EXPECT_FALSE(has_pass(single, "far_fit"));
}

TEST(ResolvePlan, FarMotionIsLeftOutWhereItTellsNothing) {
  ResolveSettings wanted = settings(Method::kQuincunx);
  wanted.conventions.sky_motion = SkyMotion::kCamera;
  EXPECT_TRUE(leaves_out(plan({.camera_motion = false}, wanted), "far_velocity"));
  EXPECT_TRUE(leaves_out(plan({.moving_objects = false}, wanted), "far_velocity"));
  wanted.method = Method::kBilinear;
  EXPECT_TRUE(leaves_out(plan({}, wanted), "far_velocity"));
  EXPECT_FALSE(leaves_out(plan({}, settings(Method::kQuincunx)), "far_velocity")) << "nobody asked for it";
}

TEST(ResolvePlan, ADilatedVelocityIsTakenBackFirst) {
  ResolveSettings wanted = settings(Method::kQuincunx);
  wanted.conventions.drawn_velocity = DrawnVelocity::kDilated;
  const ResolvePlan p = plan({}, wanted);
  EXPECT_EQ(p.passes.front().kernel, "undilate_velocity");
  EXPECT_TRUE(p.undilates_velocity());
  EXPECT_TRUE(p.reads_depth);
  EXPECT_FALSE(p.reads_camera()) << "it is of use, not needed";
  EXPECT_TRUE(has_buffer(p, "dilated velocity"));
  EXPECT_FALSE(has_buffer(p, "drawn velocity"));
  wanted.conventions.sky_motion = SkyMotion::kCamera;
  wanted.targets.shading = Shading::kCheckerboard;
  const ResolvePlan all = plan({}, wanted);
  ASSERT_GE(all.passes.size(), 3u);
  EXPECT_EQ(all.passes[0].kernel, "resolve_checkerboard");
  EXPECT_EQ(all.passes[1].kernel, "undilate_velocity");
  EXPECT_EQ(all.passes[2].kernel, "far_velocity");
  for (const char* velocity : {"shaded velocity", "dilated velocity", "drawn velocity", "velocity"})
    EXPECT_TRUE(has_buffer(all, velocity)) << velocity;
}

TEST(ResolvePlan, ADilatedVelocityIsLeftOutWhereNoneIsDrawnOrRead) {
  ResolveSettings wanted = settings(Method::kTemporal);
  wanted.conventions.drawn_velocity = DrawnVelocity::kDilated;
  EXPECT_TRUE(leaves_out(plan({.moving_objects = false}, wanted), "undilate_velocity"));
  wanted.method = Method::kBilinear;
  EXPECT_TRUE(leaves_out(plan({}, wanted), "undilate_velocity"));
  EXPECT_FALSE(leaves_out(plan({}, settings(Method::kTemporal)), "undilate_velocity"))
      << "nobody asked for it";
}

TEST(ResolvePlan, NothingMovingReadsNeitherVelocityNorDepth) {
  const ResolvePlan p = plan({.moving_objects = false, .camera_motion = false, .transparents = false},
                             settings(Method::kQuincunx));
  EXPECT_EQ(p.velocity, VelocitySource::kNone);
  EXPECT_FALSE(p.reads_depth);
  EXPECT_FALSE(p.reads_reactive);
  for (const char* name : {"velocity", "depth", "reactive"})
    EXPECT_FALSE(has_buffer(p, name)) << name;
  EXPECT_TRUE(leaves_out(p, "reactive values"));
  EXPECT_TRUE(leaves_out(p, "velocity"));
}

TEST(ResolvePlan, TheMeanReadsNoVelocity) {
  ResolveSettings wanted = settings(Method::kQuincunx);
  wanted.quincunx.form = TwoFrameForm::kMean;
  const ResolvePlan p = plan({}, wanted);
  EXPECT_EQ(p.velocity, VelocitySource::kNone);
  EXPECT_FALSE(has_buffer(p, "velocity"));
  EXPECT_TRUE(p.reads_reactive);
}

TEST(ResolvePlan, SingleFrameMethodsKeepNoHistory) {
  for (const Method method : {Method::kPoint, Method::kBilinear}) {
    const ResolvePlan p = plan({}, settings(method));
    EXPECT_FALSE(p.keeps_previous_frame());
    EXPECT_FALSE(has_buffer(p, "colour of the previous frame"));
    EXPECT_FALSE(has_pass(p, "resolve_quincunx"));
    EXPECT_TRUE(has_pass(p, method == Method::kPoint ? "scale_point" : "scale_bilinear"));
    EXPECT_TRUE(leaves_out(p, "the previous frame"));
  }
}

TEST(ResolvePlan, ClearIsThereOnlyWhenWantedAndNeeded) {
  ResolveSettings wanted = settings(Method::kBilinear);
  EXPECT_FALSE(has_pass(plan({.background = false}, wanted), "clear_region"));
  wanted.targets.clear = true;
  EXPECT_TRUE(has_pass(plan({.background = false}, wanted), "clear_region"));
  EXPECT_FALSE(has_pass(plan({.background = true}, wanted), "clear_region"));
}

TEST(ResolvePlan, PresentIsThereOnlyWhenWanted) {
  ResolveSettings wanted = settings(Method::kBilinear);
  EXPECT_TRUE(has_pass(plan({}, wanted), "present"));
  wanted.output.present = false;
  EXPECT_FALSE(has_pass(plan({}, wanted), "present"));
  EXPECT_FALSE(has_buffer(plan({}, wanted), "presented"));
}

TEST(ResolvePlan, SharpenIsThereOnlyWhenWanted) {
  ResolveSettings wanted = settings(Method::kTemporal);
  const ResolvePlan without = plan({}, wanted);
  EXPECT_FALSE(has_pass(without, "sharpen"));
  EXPECT_FALSE(has_buffer(without, "unsharpened"));
  EXPECT_TRUE(leaves_out(without, "sharpen"));
  wanted.sharpness = .25f;
  const ResolvePlan with = plan({}, wanted);
  EXPECT_TRUE(has_pass(with, "sharpen"));
  EXPECT_TRUE(has_buffer(with, "unsharpened"));
  EXPECT_FALSE(leaves_out(with, "sharpen"));
  EXPECT_NE(with.explain().find("sharpness 0.25"), std::string::npos) << with.explain();
  wanted.temporal.view = TemporalView::kConfidence;
  EXPECT_FALSE(has_pass(plan({}, wanted), "sharpen")) << "what is known is no picture";
  EXPECT_TRUE(leaves_out(plan({}, wanted), "sharpen"));
}

// The views of one layer are true of one layer: the plan has no second one then, and says so.
TEST(ResolvePlan, ViewsOfOneLayerSayThatTheSecondIsLeftOut) {
  ResolveSettings wanted = settings(Method::kTemporal);
  using enum TemporalView;
  for (const TemporalView view : {kPicture, kLayers, kCoverage, kNear, kFar}) {
    wanted.temporal.view = view;
    EXPECT_TRUE(has_pass(plan({}, wanted), "resolve_layers")) << name_of(view);
    EXPECT_FALSE(leaves_out(plan({}, wanted), "second layer of history")) << name_of(view);
  }
  for (const TemporalView view : {kConfidence, kRejection, kPhase}) {
    wanted.temporal.view = view;
    EXPECT_FALSE(has_pass(plan({}, wanted), "resolve_layers")) << name_of(view);
    EXPECT_TRUE(leaves_out(plan({}, wanted), "second layer of history")) << name_of(view);
  }
  wanted.temporal = {.preset = TemporalPreset::kFast};
  EXPECT_TRUE(leaves_out(plan({}, wanted), "second layer of history"));
  EXPECT_FALSE(leaves_out(plan({}, settings(Method::kQuincunx)), "second layer of history"));
}

TEST(ResolvePlan, SharpnessAndNoiseBeyondZeroToOneAreRefused) {
  for (const float bad : {-.01f, 1.01f, std::nanf(""), INFINITY}) {
    ResolveSettings wanted = settings(Method::kBilinear);
    wanted.sharpness = wanted.temporal.noise = bad;
    const auto result = plan_for({}, wanted);
    ASSERT_FALSE(result.ok()) << bad;
    EXPECT_NE(result.status().message().find("settings.sharpness"), std::string::npos);
    EXPECT_NE(result.status().message().find("settings.temporal.noise"), std::string::npos);
    EXPECT_NE(result.status().message().find("[0, 1]"), std::string::npos);
  }
}

TEST(ResolvePlan, APictureIsDenoisedOnlyWhereNoiseIsTold) {
  for (const TemporalPreset preset :
       {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality}) {
    ResolveSettings wanted = settings(Method::kTemporal);
    wanted.temporal.preset = preset;
    EXPECT_FALSE(has_pass(plan({}, wanted), "temporal_denoise"));
    EXPECT_FALSE(has_buffer(plan({}, wanted), "noisy"));
    wanted.temporal.noise = 1;
    EXPECT_TRUE(has_pass(plan({}, wanted), "temporal_denoise"));
    wanted.temporal.view = TemporalView::kConfidence;
    EXPECT_FALSE(has_pass(plan({}, wanted), "temporal_denoise")) << "what is known is no picture";
  }
}

TEST(ResolvePlan, EachBufferSaysHowItFollowsTheResolution) {
  ResolveSettings wanted = settings(Method::kQuincunx);
  wanted.target_extent = {2560, 1440};
  for (const PlannedBuffer& buffer : plan({}, wanted).buffers) {
    const bool history = buffer.name.ends_with("of the previous frame");
    const bool output = buffer.name == "resolved" || buffer.name == "presented";
    EXPECT_EQ(buffer.scaling, output    ? Scaling::kFixed
                              : history ? Scaling::kHistory
                                        : Scaling::kScales)
        << buffer.name;
    EXPECT_EQ(buffer.extent, output ? wanted.output_extent : wanted.target_extent) << buffer.name;
  }
}

// Counted by hand at 1280x720: two frames of 8-byte colour and 4-byte velocity, one of 1-byte reactive, 16
// bytes out.
TEST(ResolvePlan, BytesFollowFromTheFormats) {
  const ResolvePlan p = plan({}, settings(Method::kQuincunx));
  constexpr std::uint64_t kPixels = 1280 * 720;
  EXPECT_EQ(p.passes[0].kernel, "resolve_quincunx");
  EXPECT_EQ(p.passes[0].bytes, kPixels * (2 * 8 + 2 * 4 + 2 * 1 + 16));
  EXPECT_EQ(p.passes.back().kernel, "present");
  EXPECT_EQ(p.passes.back().bytes, kPixels * (16 + 4));
}

TEST(ResolvePlan, VariantFollowsFromTheScene) {
  const auto options = [](const SceneNeeds& needs) {
    const ResolvePlan p = plan(needs, settings(Method::kQuincunx));
    const auto resolve = std::find_if(p.passes.begin(), p.passes.end(),
                                      [](const auto& pass) { return pass.kernel == "resolve_quincunx"; });
    return resolve->options;
  };
  const std::string moving = options({});
  const std::string still = options({.moving_objects = false, .camera_motion = false, .transparents = false});
  const std::string camera = options({.moving_objects = false});
  EXPECT_NE(moving, still);
  EXPECT_EQ(moving, camera) << "either way it reads a velocity target";
}

TEST(ResolvePlan, ExplainSaysEverything) {
  const std::string text = plan({.moving_objects = false}, settings(Method::kQuincunx)).explain();
  for (const char* part : {"resolve_quincunx", "present", "depth", "WEIGHT", "MiB", "velocity target",
                           "nothing but the camera moves", "1280x720", "Left out"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in:\n" << text;
  }
}

TEST(ResolvePlan, EveryBadFieldIsNamed) {
  ResolveSettings bad = settings(Method::kQuincunx);
  bad.output_extent = {0, 720};
  bad.target_extent = {1280, -1};
  bad.colour = PixelFormat::kR8;
  bad.velocity = PixelFormat::kRGBA16F;
  bad.output.linear = PixelFormat::kRGBA8;
  bad.quincunx.velocity_weight = std::nanf("");
  const auto result = plan_for({}, bad);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.status().code(), StatusCode::kInvalidArgument);
  for (const char* field :
       {"settings.output_extent", "settings.target_extent", "settings.colour", "settings.velocity",
        "settings.output.linear", "settings.quincunx.velocity_weight"}) {
    EXPECT_NE(result.status().message().find(field), std::string::npos) << field;
  }
}

TEST(ResolvePlan, ValuesThatHaveNoNameAreRefused) {
  const std::pair<const char*, void (*)(ResolveSettings&)> cases[] = {
      {"method is 99; it must lie in [0, 10]", [](auto& s) { s.method = Method(99); }},
      {"method is -1; it must lie in [0, 10]", [](auto& s) { s.method = Method(-1); }},
      {"conventions.depth is 9; it must lie in [0, 4]",
       [](auto& s) { s.conventions.depth = DepthConvention(9); }},
      {"conventions.clip_space is 3; it must lie in [0, 2]",
       [](auto& s) { s.conventions.clip_space = ClipSpace(3); }},
      {"conventions.velocity_unit is 3; it must lie in [0, 2]",
       [](auto& s) { s.conventions.velocity_unit = VelocityUnit(3); }},
      {"conventions.origin is 2; it must lie in [0, 1]", [](auto& s) { s.conventions.origin = Origin(2); }},
      {"conventions.drawn_velocity is 2; it must lie in [0, 1]",
       [](auto& s) { s.conventions.drawn_velocity = DrawnVelocity(2); }},
      {"conventions.sky_motion is 3; it must lie in [0, 2]",
       [](auto& s) { s.conventions.sky_motion = SkyMotion(3); }},
      {"targets.storage is 2; it must lie in [0, 1]", [](auto& s) { s.targets.storage = Storage(2); }},
      {"targets.placement is 255; it must lie in [0, 1]",
       [](auto& s) { s.targets.placement = Targets(255); }},
      {"targets.shading is 2; it must lie in [0, 1]", [](auto& s) { s.targets.shading = Shading(2); }},
      {"output.tone_map is 3; it must lie in [0, 2]", [](auto& s) { s.output.tone_map = ToneMap(3); }},
      {"quincunx.form is 3; it must lie in [0, 2]", [](auto& s) { s.quincunx.form = TwoFrameForm(3); }},
      {"quincunx.sampling is 2; it must lie in [0, 1]", [](auto& s) { s.quincunx.sampling = Sampling(2); }},
      {"temporal.preset is 9; it must lie in [0, 2]", [](auto& s) { s.temporal.preset = TemporalPreset(9); }},
      {"temporal.view is 8; it must lie in [0, 7]", [](auto& s) { s.temporal.view = TemporalView(8); }},
      {"colour is unknown; it must be RGBA8, RGBA16F or RGBA32F",
       [](auto& s) { s.colour = PixelFormat(99); }},
      {"velocity is unknown; it must be RG16F or RG32F", [](auto& s) { s.velocity = PixelFormat(99); }},
      {"output.linear is unknown; it must be RGBA16F or RGBA32F",
       [](auto& s) { s.output.linear = PixelFormat(99); }},
      {"temporal.history is unknown; it must be RGBA16F or RGBA32F",
       [](auto& s) { s.temporal.history = PixelFormat(99); }},
  };
  for (const auto& [complaint, spoil] : cases) {
    ResolveSettings bad = settings(Method::kTemporal);
    spoil(bad);
    EXPECT_EQ(plan_for({}, bad).status().message(), std::string("settings.") + complaint);
  }
}

// Nobody's change to a plan is passed over: what differs from the planner's own is refused by name.
TEST(ResolvePlan, AnEditedPlanIsRefusedByName) {
  Result<Device> device = Device::open();
  ASSERT_TRUE(device.ok()) << device.status().message();
  const ResolvePlan own = plan({}, settings(Method::kTemporal));
  ASSERT_TRUE(ResolveService::create(device.value(), own).ok());
  const std::pair<const char*, void (*)(ResolvePlan&)> edits[] = {
      {"passes", [](ResolvePlan& p) { p.passes.pop_back(); }},
      {"passes", [](ResolvePlan& p) { p.passes.front().options += " -D EXTRA"; }},
      {"buffers", [](ResolvePlan& p) { p.buffers.front().owned = true; }},
      {"left_out", [](ResolvePlan& p) { p.left_out.clear(); }},
      {"velocity", [](ResolvePlan& p) { p.velocity = VelocitySource::kNone; }},
      {"reads_depth", [](ResolvePlan& p) { p.reads_depth = false; }},
      {"reads_reactive", [](ResolvePlan& p) { p.reads_reactive = false; }},
      {"passes", [](ResolvePlan& p) { p.settings.method = Method::kPoint; }},
      {"passes", [](ResolvePlan& p) { p.needs.moving_objects = p.needs.camera_motion = false; }},
  };
  for (const auto& [what, edit] : edits) {
    ResolvePlan edited = own;
    edit(edited);
    const auto service = ResolveService::create(device.value(), edited);
    ASSERT_FALSE(service.ok()) << what;
    EXPECT_NE(service.status().message().find(what), std::string::npos) << service.status().message();
  }
}

// plan_for() makes no plan that leaves anything out; see also the plans of settings_combinations_test.cpp, which are
// all made.
TEST(ResolvePlan, WhatIsKeptOverADynamicOutputIsResized) {
  ResolveSettings wanted = settings(Method::kTemporal);
  wanted.output.min_extent = {640, 360};
  const std::vector<PassSpec> passes =
      list_passes(PlanFacts({.transparents = false, .background = false}, wanted)).passes;
  EXPECT_EQ(unresized(passes), std::nullopt);
  int resizing = 0;
  for (const std::string kernel : {"resize_history", "resize_tiles", "resize_layers"}) {
    std::vector<PassSpec> fewer = passes;
    resizing +=
        static_cast<int>(std::erase_if(fewer, [&](const PassSpec& pass) { return pass.kernel == kernel; }));
    EXPECT_NE(unresized(fewer), std::nullopt) << kernel;
  }
  EXPECT_EQ(resizing, 3);
}

}  // namespace
}  // namespace quincunx
