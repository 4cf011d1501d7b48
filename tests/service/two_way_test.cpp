// SPDX-License-Identifier: MIT
// TwoWay: histories that are kept, merged with those of another direction, and shown.
#include "passes/two_way.h"

#include <gtest/gtest.h>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;
using testing::TemporalScene;

constexpr Extent kRender = {80, 48};

HostFrame frame_of(const TemporalScene& scene, int index) {
  return scene.render(index, kRender, testing::halton_jitter(index, 32));
}

FrameInputs without_images(FrameInputs inputs) {
  inputs.colour = inputs.velocity = inputs.depth = inputs.reactive = {};
  return inputs;
}

TEST(TwoWay, AHistoryThatIsKeptAndShownIsThePictureOfDispatch) {
  const TemporalScene scene = testing::wires_before_a_wall();  // of two layers, and at no pixels' centres
  for (const TemporalPreset preset :
       {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality}) {
    // Both ways `balanced` is refined, too; its history is another from the second frame on.
    const bool refined = preset == TemporalPreset::kBalanced;
    ResolveSettings settings = {.method = Method::kTemporal,
                                .sharpness = .4f,
                                .temporal = {.preset = refined ? TemporalPreset::kQuality : preset,
                                             .history = PixelFormat::kRGBA32F}};  // nothing is rounded
    ServiceRig rig({}, settings, scene.output, kRender);
    settings = rig.service().plan().settings;
    settings.temporal.preset = preset;
    const auto plan = plan_for(rig.service().plan().needs, settings);
    ASSERT_TRUE(plan.ok()) << plan.status().message();
    auto created = TwoWay::create(rig.device(), plan.value());
    ASSERT_TRUE(created.ok()) << created.status().message();
    KeptHistory kept;
    for (int index = 0; index < (refined ? 1 : 4); ++index) {
      FrameInputs inputs = rig.upload(frame_of(scene, index));
      inputs.exposure = 1;  // exposed by a power of two, so that pictures are divided by it without rounding
      ASSERT_TRUE(rig.dispatch(inputs).ok());
      const std::vector<Pixel> expected = rig.resolved();
      const FrameReport added = TwoWay::add(created.value(), inputs, false, &kept);
      ASSERT_TRUE(added.ok()) << added.status.message();
      EXPECT_EQ(added.used_previous, index > 0);
      const FrameReport shown = TwoWay::show(created.value(), without_images(inputs), kept,
                                             {rig.resolved_view(), rig.presented_view()});
      ASSERT_TRUE(shown.ok()) << shown.status.message();
      EXPECT_TRUE(rig.resolved() == expected) << name_of(preset) << " " << index;
    }
  }
}

// The next frame finds what the last add() left, whatever was shown in between; and a backward service that has turned
// round begins with all that the forward one knew.
TEST(TwoWay, ATurnedServiceGoesOnFromTheOtherHistory) {
  const TemporalScene scene = testing::wires_before_a_wall();
  const ResolveSettings settings = {.method = Method::kTemporal};
  ServiceRig rig({}, settings, scene.output, kRender);
  auto forward = TwoWay::create(rig.device(), rig.service().plan());
  auto backward = TwoWay::create(rig.device(), rig.service().plan());
  ASSERT_TRUE(forward.ok() && backward.ok());
  constexpr int kLast = 12;
  KeptHistory kept, alone;
  for (int index = 0; index <= kLast; ++index)
    ASSERT_TRUE(TwoWay::add(forward.value(), rig.upload(frame_of(scene, index)), false, &kept).ok());
  const auto error_of = [&](const KeptHistory& history, const FrameInputs& inputs, int index) {
    EXPECT_TRUE(TwoWay::show(forward.value(), without_images(inputs), history,
                             {rig.resolved_view(), rig.presented_view()})
                    .ok());
    return testing::squared_error(rig.resolved(), scene.truth(index), scene.output);
  };
  // Time runs backwards: velocity is that to the next frame, which is the same here but for its sign.
  HostFrame before = frame_of(scene, kLast - 1);
  before.velocity = [velocity = before.velocity](int x, int y) {
    const Vec2 v = velocity(x, y);
    return Vec2{-v.x, -v.y};
  };
  const auto error_backwards = [&](bool turns) {
    FrameInputs inputs = rig.upload(frame_of(scene, kLast));
    inputs.reset = true;
    EXPECT_TRUE(TwoWay::add(backward.value(), inputs, false, nullptr).ok());
    EXPECT_TRUE(!turns || TwoWay::turn(backward.value(), forward.value()).ok());
    inputs = rig.upload(before);
    EXPECT_TRUE(TwoWay::add(backward.value(), inputs, false, &alone).ok());
    return error_of(alone, inputs, kLast - 1);
  };
  EXPECT_LT(error_backwards(true), .7 * error_backwards(false));
}

TEST(TwoWay, ABadFrameIsRefusedAsByDispatch) {
  const TemporalScene scene = testing::wires_before_a_wall();
  ServiceRig rig({}, ResolveSettings{.method = Method::kTemporal}, scene.output, kRender);
  auto service = TwoWay::create(rig.device(), rig.service().plan());
  ASSERT_TRUE(service.ok());
  FrameInputs inputs = rig.upload(frame_of(scene, 0));
  inputs.jitter.x = 2;
  const FrameReport report = TwoWay::add(service.value(), inputs, false, nullptr);
  EXPECT_EQ(report.status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(report.status.message().find("jitter.x is 2"), std::string::npos) << report.status.message();
}

}  // namespace
}  // namespace quincunx
