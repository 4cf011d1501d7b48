// SPDX-License-Identifier: MIT
// Sharpening within the service: of every method's picture, before the blur, never of what the next frame
// reads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;

constexpr Extent kOutput = {48, 36};

// Halton-like places of a picture with edges and highlights, so that every method has something to do.
HostFrame frame_of(int index) {
  const Vec2 jitter = {.3f * static_cast<float>(index % 3 - 1), .2f * static_cast<float>(index % 4) - .3f};
  return {.render = {30, 24}, .jitter = jitter, .colour = [jitter](int x, int y) {
            const float u = static_cast<float>(x) + jitter.x;
            const float v = static_cast<float>(y) + jitter.y;
            const float wave = std::sin(.9f * u + .4f * v);
            return Pixel{.5f + .5f * wave, wave > 0 ? 6.f : .1f, .02f * u, .5f + .01f * v};
          }};
}

std::vector<Pixel> third_picture(Method method, float sharpness) {
  ServiceRig rig({}, {.method = method, .sharpness = sharpness}, kOutput, {48, 36});
  rig.resolve(frame_of(0));
  rig.resolve(frame_of(1));
  return rig.resolve(frame_of(2));
}

const Pixel& at(const std::vector<Pixel>& picture, int x, int y) {
  const int column = std::clamp(x, 0, kOutput.width - 1);
  const int row = std::clamp(y, 0, kOutput.height - 1);
  return picture[static_cast<std::size_t>(row * kOutput.width + column)];
}

std::vector<std::string> kernels_of(const FrameReport& report) {
  std::vector<std::string> kernels;
  for (const PassReport& pass : report.passes)
    kernels.emplace_back(pass.kernel);
  return kernels;
}

// The third frame: were its history sharpened too, it would leave the range of what sharpness 0 gives.
TEST(ServiceSharpen, EveryMethodsPictureWithinItsOwnRange) {
  for (const Method method : {Method::kPoint, Method::kBilinear, Method::kBSpline, Method::kCatmullRom,
                              Method::kMitchell, Method::kLanczos2, Method::kLanczos3, Method::kNoise,
                              Method::kNoiseOffset, Method::kQuincunx, Method::kTemporal}) {
    const std::vector<Pixel> plain = third_picture(method, 0);
    const std::vector<Pixel> sharp = third_picture(method, 1);
    int changed = 0;
    for (int y = 0; y < kOutput.height; ++y) {
      for (int x = 0; x < kOutput.width; ++x) {
        EXPECT_EQ(at(sharp, x, y)[3], at(plain, x, y)[3]) << "alpha";
        for (std::size_t c = 0; c < 3; ++c) {
          const auto [low, high] =
              std::minmax({at(plain, x, y)[c], at(plain, x - 1, y)[c], at(plain, x + 1, y)[c],
                           at(plain, x, y - 1)[c], at(plain, x, y + 1)[c]});
          ASSERT_GE(at(sharp, x, y)[c], low) << name_of(method) << " at " << x << ", " << y;
          ASSERT_LE(at(sharp, x, y)[c], high) << name_of(method) << " at " << x << ", " << y;
          changed += at(sharp, x, y)[c] != at(plain, x, y)[c] ? 1 : 0;
        }
      }
    }
    EXPECT_GT(changed, kOutput.area() / 4) << name_of(method);
  }
}

TEST(ServiceSharpen, ItRunsAfterTheResolveAndBeforeTheBlur) {
  ServiceRig rig({}, {.method = Method::kTemporal, .sharpness = .5f, .blur = {.shutter = .5f}}, kOutput,
                 kOutput);
  const FrameReport report = rig.dispatch(rig.upload(frame_of(0)));
  ASSERT_TRUE(report.ok()) << report.status.message();
  const std::vector<std::string> kernels = kernels_of(report);
  const std::vector<std::string> last = {"display_layers",    "sharpen",     "motion_tiles",
                                         "motion_neighbours", "motion_blur", "present"};
  ASSERT_GE(kernels.size(), last.size());
  EXPECT_TRUE(std::equal(last.rbegin(), last.rend(), kernels.rbegin())) << ::testing::PrintToString(kernels);
  ASSERT_TRUE(rig.service().finish().ok());
  const auto finished = rig.service().next_completed();
  ASSERT_TRUE(finished.has_value());
  for (const PassReport& pass : finished->passes) {
    EXPECT_GE(pass.ms, 0) << pass.kernel;
    if (std::strcmp(pass.kernel, "sharpen") != 0) continue;
    EXPECT_EQ(pass.bytes, 48u * 36 * 16 * 2 + 16) << "and Exposure";
  }
}

// The 8-bit picture is that of the sharpened one, whether the caller takes that or not.
TEST(ServiceSharpen, WhatIsPresentedIsSharpened) {
  ServiceRig plain({}, {.method = Method::kBilinear}, kOutput, kOutput);
  ServiceRig sharp({}, {.method = Method::kBilinear, .sharpness = 1}, kOutput, kOutput);
  plain.resolve(frame_of(0));
  sharp.resolve(frame_of(0));
  const std::vector<std::uint8_t> both = sharp.presented();
  EXPECT_NE(both, plain.presented());
  const FrameReport alone =
      sharp.service().dispatch(sharp.upload(frame_of(0)), {.presented = sharp.presented_view()});
  ASSERT_TRUE(alone.ok()) << alone.status.message();
  EXPECT_EQ(sharp.presented(), both);
}

TEST(ServiceSharpen, ZeroAndViewsRunNothing) {
  ServiceRig off({}, {.method = Method::kTemporal}, kOutput, kOutput);
  ServiceRig view({},
                  {.method = Method::kTemporal, .sharpness = 1, .temporal = {.view = TemporalView::kPhase}},
                  kOutput, kOutput);
  for (ServiceRig* rig : {&off, &view}) {
    const std::vector<std::string> kernels = kernels_of(rig->dispatch(rig->upload(frame_of(0))));
    EXPECT_GT(kernels.size(), 2u);
    EXPECT_EQ(std::count(kernels.begin(), kernels.end(), "sharpen"), 0);
  }
}

}  // namespace
}  // namespace quincunx
