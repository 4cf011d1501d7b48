// SPDX-License-Identifier: MIT
// Placed targets make the same pictures as a viewport in larger ones, bit for bit, whatever unused memory holds.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::random_frame;
using testing::ServiceRig;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{96, 54};

struct PlacedRun {
  const char* name;
  ResolveSettings settings;
  SceneNeeds needs = {};
  int frames = 200;
};

class PlacedTargets : public ::testing::TestWithParam<PlacedRun> {};

// 0xff is NaN in every float; 0x7b a large one.
TEST_P(PlacedTargets, SamePicturesAsAViewport) {
  const PlacedRun& run = GetParam();
  ResolveSettings settings = run.settings;
  ServiceRig viewport(run.needs, settings, kOutput, kTarget);
  settings.targets.placement = Targets::kPlaced;
  ServiceRig placed(run.needs, settings, kOutput, kTarget);
  std::mt19937 random(2018);
  for (int i = 0; i < run.frames; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    frame.camera.clip_to_previous_clip[8] = static_cast<float>(random() % 64) / 512;
    placed.flood_half(i % 2 == 0 ? 0xff : 0x7b);
    const std::vector<Pixel> expected = viewport.resolve(frame);
    const std::vector<Pixel> actual = placed.resolve(frame);
    ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0)
        << "frame " << i << ", " << frame.render.width << "x" << frame.render.height;
    ASSERT_EQ(viewport.presented(), placed.presented()) << "frame " << i;
  }
}

constexpr SceneNeeds kOpaque = {.transparents = false};
constexpr SceneNeeds kCameraOnly = {.moving_objects = false};

const PlacedRun kRuns[] = {
    {.name = "bilinear", .settings = {.method = Method::kBilinear}},
    {.name = "lanczos3", .settings = {.method = Method::kLanczos3}},
    {.name = "noise_offset", .settings = {.method = Method::kNoiseOffset}},
    {.name = "quincunx", .settings = {.method = Method::kQuincunx}},
    {.name = "quincunx_camera", .settings = {.method = Method::kQuincunx}, .needs = kCameraOnly},
    {.name = "reprojected_blurred",
     .settings = {.method = Method::kQuincunx,
                  .sharpness = 0.5f,
                  .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1},
                  .blur = {.shutter = 0.5f}}},
    {.name = "fast",
     .settings = {.method = Method::kTemporal, .temporal = {.preset = TemporalPreset::kFast}}},
    {.name = "balanced_layers", .settings = {.method = Method::kTemporal}, .needs = kOpaque},
    {.name = "quality",
     .settings = {.method = Method::kTemporal, .temporal = {.preset = TemporalPreset::kQuality}}},
    {.name = "temporal_camera", .settings = {.method = Method::kTemporal}, .needs = kCameraOnly},
    {.name = "far_camera",
     .settings = {.method = Method::kTemporal, .conventions = {.sky_motion = SkyMotion::kCamera}}},
    {.name = "far_evidence",
     .settings = {.method = Method::kQuincunx, .conventions = {.sky_motion = SkyMotion::kEvidence}}},
    {.name = "quincunx_images",
     .settings = {.method = Method::kQuincunx, .targets = {.storage = Storage::kImage}},
     .frames = 30},
    {.name = "temporal_images",
     .settings = {.method = Method::kTemporal, .targets = {.storage = Storage::kImage}},
     .needs = kOpaque,
     .frames = 30},
    {.name = "temporal_camera_images",
     .settings = {.method = Method::kTemporal, .targets = {.storage = Storage::kImage}},
     .needs = kCameraOnly,
     .frames = 30},
};

INSTANTIATE_TEST_SUITE_P(Methods, PlacedTargets, ::testing::ValuesIn(kRuns),
                         [](const auto& instance) { return instance.param.name; });

TEST(PlacedPlan, RefusesImagesOfAnotherSize) {
  ServiceRig rig({}, {.method = Method::kBilinear, .targets = {.placement = Targets::kPlaced}}, kOutput,
                 kTarget);
  HostFrame frame;
  frame.render = {20, 10};
  FrameInputs inputs = rig.upload(frame);
  ASSERT_TRUE(rig.dispatch(inputs).ok());
  inputs.render_extent = {20, 9};
  const FrameReport report = rig.dispatch(inputs);
  EXPECT_EQ(report.status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(report.status.message().find("placed targets have exactly the viewport's 20x9"),
            std::string::npos)
      << report.status.message();
}

TEST(PlacedPlan, IsTheSamePassesAndSaysSo) {
  ResolveSettings settings = {
      .method = Method::kTemporal, .output_extent = kOutput, .target_extent = kTarget};
  const ResolvePlan viewport = plan_for({}, settings).value();
  settings.targets.placement = Targets::kPlaced;
  const ResolvePlan placed = plan_for({}, settings).value();
  EXPECT_EQ(placed.passes, viewport.passes);
  EXPECT_EQ(placed.buffers, viewport.buffers);
  // RGBA16F, R32F, RG16F and R8: 17 bytes a sample.
  EXPECT_EQ(placed.frame_bytes(), static_cast<std::uint64_t>(kTarget.area()) * 17);
  EXPECT_NE(placed.explain().find("Targets        placed"), std::string::npos);
  EXPECT_NE(viewport.explain().find("Targets        viewport"), std::string::npos);
}

TEST(PlacedPlan, PresentsIntoABuffer) {
  ResolveSettings settings = {
      .output_extent = kOutput, .target_extent = kTarget, .targets = {.storage = Storage::kImage}};
  EXPECT_EQ(plan_for({}, settings)->presented_storage(), Storage::kImage);
  settings.targets.placement = Targets::kPlaced;
  const ResolvePlan plan = plan_for({}, settings).value();
  EXPECT_EQ(plan.presented_storage(), Storage::kBuffer);
  EXPECT_NE(plan.passes.back().options.find("OUTPUT_STORAGE=BUFFER"), std::string::npos);
}

}  // namespace
}  // namespace quincunx
