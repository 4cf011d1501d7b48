// SPDX-License-Identifier: MIT
// Frames in which every other pixel is shaded, through the whole service.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;

constexpr Extent kExtent{33, 21};
constexpr SceneNeeds kMoving = {.transparents = false};

bool has_pass(const ResolvePlan& plan, const std::string& kernel) {
  return std::any_of(plan.passes.begin(), plan.passes.end(),
                     [&](const PlannedPass& pass) { return pass.kernel == kernel; });
}

const PlannedBuffer* buffer_of(const ResolvePlan& plan, const std::string& name) {
  const auto found = std::find_if(plan.buffers.begin(), plan.buffers.end(),
                                  [&](const PlannedBuffer& buffer) { return buffer.name == name; });
  return found != plan.buffers.end() ? &*found : nullptr;
}

ResolvePlan plan_of(Method method, Shading shading, const SceneNeeds& needs) {
  return plan_for(needs, {.method = method,
                          .output_extent = kExtent,
                          .target_extent = kExtent,
                          .targets = {.shading = shading}})
      .value();
}

// Rises along both axes: each pixel lies in the range of its neighbours. Nothing is shaded where it is NaN.
HostFrame ramp(int parity, float offset = 0) {
  HostFrame frame;
  frame.render = kExtent;
  frame.parity = parity;
  frame.colour = [=](int x, int y) {
    const float value =
        (x + y) % 2 == parity ? offset + static_cast<float>(3 * x + 5 * y) / 256 : std::nanf("");
    return Pixel{value, value, value, 1};
  };
  return frame;
}

TEST(CheckerboardPlan, FillsFirstWhatIsReadLater) {
  const ResolvePlan full = plan_of(Method::kBilinear, Shading::kFull, kMoving);
  EXPECT_FALSE(has_pass(full, "resolve_checkerboard"));
  const ResolvePlan plan = plan_of(Method::kBilinear, Shading::kCheckerboard, kMoving);
  EXPECT_EQ(plan.passes.front().kernel, "resolve_checkerboard");
  EXPECT_TRUE(plan.reads_depth);
  EXPECT_FALSE(plan.reads_reactive);
  EXPECT_FALSE(plan.keeps_previous_frame()) << "the caller's images are read once";
  EXPECT_TRUE(plan.reads_history(kExtent));
  EXPECT_EQ(plan.velocity, VelocitySource::kTarget);
  EXPECT_EQ(buffer_of(plan, "velocity"), nullptr) << "no pass reads it filled";
  ASSERT_NE(buffer_of(plan, "colour"), nullptr);
  EXPECT_TRUE(buffer_of(plan, "colour")->owned);
  EXPECT_FALSE(buffer_of(plan, "shaded colour")->owned);
  EXPECT_NE(plan.explain().find("resolve_checkerboard"), std::string::npos);
}

TEST(CheckerboardPlan, ACameraAloneNeedsNoVelocityTarget) {
  const SceneNeeds needs{.moving_objects = false, .transparents = false};
  const ResolvePlan plan = plan_of(Method::kBilinear, Shading::kCheckerboard, needs);
  EXPECT_TRUE(plan.reads_camera());
  EXPECT_EQ(buffer_of(plan, "shaded velocity"), nullptr);
  EXPECT_FALSE(has_pass(plan, "velocity_from_depth"));
  EXPECT_TRUE(has_pass(plan_of(Method::kQuincunx, Shading::kCheckerboard, needs), "velocity_from_depth"));
}

// Two frames hold every pixel of a picture that stands still; but a corner is not in the range of its two neighbours.
TEST(Checkerboard, TwoFramesMakeAStillPictureWhole) {
  ServiceRig rig(kMoving, {.method = Method::kPoint, .targets = {.shading = Shading::kCheckerboard}}, kExtent,
                 kExtent);
  rig.resolve(ramp(0));
  const std::vector<Pixel> picture = rig.resolve(ramp(1));
  for (int i = 0; i < kExtent.area(); ++i) {
    const int x = i % kExtent.width, y = i / kExtent.width;
    const bool corner = (x == 0 || x + 1 == kExtent.width) && (y == 0 || y + 1 == kExtent.height);
    if (corner) continue;
    ASSERT_EQ(picture[static_cast<std::size_t>(i)][0], static_cast<float>(3 * x + 5 * y) / 256)
        << x << " " << y;
  }
}

// Codes that are copied stay what they are, and what lies between codes is one of them again.
TEST(Checkerboard, TwoFramesOfEightBitsMakeAStillPictureWhole) {
  const ResolveSettings settings{.method = Method::kPoint,
                                 .colour = PixelFormat::kRGBA8,
                                 .targets = {.shading = Shading::kCheckerboard}};
  ServiceRig rig(kMoving, settings, kExtent, kExtent);
  HostFrame frame = ramp(0);
  const auto light_of = [](int x, int y) { return static_cast<float>(3 * x + 5 * y) / 256; };
  const auto half_of = [&](int parity) {
    frame.parity = parity;
    frame.colour = [=](int x, int y) {
      const float light = (x + y) % 2 == parity ? light_of(x, y) : std::nanf("");
      return Pixel{light, light, light, 1};
    };
    return frame;
  };
  rig.resolve(half_of(0));
  rig.resolve(half_of(1));
  const auto shown = rig.presented();
  for (int i = 0; i < kExtent.area(); ++i) {
    const int x = i % kExtent.width, y = i / kExtent.width;
    const bool corner = (x == 0 || x + 1 == kExtent.width) && (y == 0 || y + 1 == kExtent.height);
    if (corner) continue;
    const float light = light_of(x, y);
    ASSERT_EQ(shown[4 * static_cast<std::size_t>(i)], testing::codes_of({light, light, light, 1})[0])
        << x << " " << y;
  }
}

TEST(CheckerboardPlan, OfEightBitsFillsCodes) {
  const ResolveSettings settings{.method = Method::kBilinear,
                                 .output_extent = kExtent,
                                 .target_extent = kExtent,
                                 .colour = PixelFormat::kRGBA8,
                                 .targets = {.shading = Shading::kCheckerboard}};
  const auto plan = plan_for(kMoving, settings);
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  const auto area = static_cast<std::size_t>(kExtent.area());
  EXPECT_EQ(buffer_of(plan.value(), "shaded colour")->bytes, area * 4);
  EXPECT_EQ(buffer_of(plan.value(), "colour")->bytes, area * 4);
  const std::string text = plan->explain();
  EXPECT_NE(text.find("SOURCE_FORMAT=SRGB8"), std::string::npos) << text;
  EXPECT_NE(text.find("RGBA8, sRGB encoded"), std::string::npos) << text;
}

// Without history, and from it where everything has become brighter, each pixel lies in its neighbours' range.
TEST(Checkerboard, WhatIsFilledLiesInTheRangeOfItsNeighbours) {
  ServiceRig rig(kMoving, {.method = Method::kPoint, .targets = {.shading = Shading::kCheckerboard}}, kExtent,
                 kExtent);
  for (const float offset : {0.f, 4.f}) {
    const std::vector<Pixel> picture = rig.resolve(ramp(0, offset));
    for (int y = 1; y + 1 < kExtent.height; ++y) {
      for (int x = 1; x + 1 < kExtent.width; ++x) {
        const float about = offset + static_cast<float>(3 * x + 5 * y) / 256;
        ASSERT_NEAR(picture[static_cast<std::size_t>(y * kExtent.width + x)][0], about, 5.01 / 256)
            << x << " " << y;
      }
    }
  }
}

TEST(Checkerboard, AResetForgetsWhatCameBefore) {
  const ResolveSettings settings{.method = Method::kBilinear, .targets = {.shading = Shading::kCheckerboard}};
  ServiceRig used(kMoving, settings, kExtent, kExtent), fresh(kMoving, settings, kExtent, kExtent);
  used.resolve(ramp(0, 7));
  HostFrame frame = ramp(1);
  const std::vector<Pixel> expected = fresh.resolve(frame);
  frame.reset = true;
  const std::vector<Pixel> actual = used.resolve(frame);
  EXPECT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0);
}

// Where targets are images, so are the service's own filled ones.
TEST(Checkerboard, ImagesMakeThePicturesOfBuffers) {
  for (const SceneNeeds& needs : {kMoving, SceneNeeds{}}) {
    ResolveSettings settings{.method = Method::kTemporal, .targets = {.shading = Shading::kCheckerboard}};
    ServiceRig buffers(needs, settings, kExtent, kExtent);
    settings.targets.storage = Storage::kImage;
    ServiceRig images(buffers.device(), needs, settings, kExtent, kExtent);
    for (int i = 0; i < 3; ++i) {
      HostFrame frame = ramp(i % 2);
      frame.reset = i == 2;
      const std::vector<Pixel> expected = buffers.resolve(frame);
      const std::vector<Pixel> actual = images.resolve(frame);
      EXPECT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0) << i;
    }
  }
}

// The caller may use the same images for each frame: the service has its own of the previous one.
TEST(Checkerboard, TheSameImagesMayHoldEveryFrame) {
  ServiceRig rig(kMoving, {.method = Method::kQuincunx, .targets = {.shading = Shading::kCheckerboard}},
                 kExtent, kExtent);
  const FrameInputs inputs = rig.upload(ramp(0));
  EXPECT_TRUE(rig.dispatch(inputs).ok());
  const FrameReport report = rig.dispatch(inputs);
  EXPECT_TRUE(report.ok()) << report.status.message();
  EXPECT_TRUE(report.used_previous);
}

}  // namespace
}  // namespace quincunx
