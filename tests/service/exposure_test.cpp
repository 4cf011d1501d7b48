// SPDX-License-Identifier: MIT
// Exposed light: the unit of light changes no picture, nor does an exposure that jumps; what is very bright stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;

constexpr Extent kOutput = {96, 64}, kRender = {48, 32};
constexpr int kFrames = 8;

// A striped strip that moves before a wavy wall that moves otherwise, with highlights.
HostFrame frame_of(int index, double unit) {
  const Vec2 jitter = {.3f * static_cast<float>(index % 3 - 1), .2f * static_cast<float>(index % 4) - .3f};
  const auto is_strip = [](int x) { return x % 16 < 3; };
  return {.render = kRender,
          .jitter = jitter,
          .colour =
              [=](int x, int y) {
                const double u = x + static_cast<double>(jitter.x) - .75 * index,
                             v = y + static_cast<double>(jitter.y);
                const double wave = std::sin(.9 * u + .4 * v);
                const double red = is_strip(x) ? .9 : .3 + .25 * wave;
                return Pixel{static_cast<float>(unit * red), static_cast<float>(unit * (wave > .95 ? 6 : .1)),
                             static_cast<float>(unit * .02 * (y % 7)), 1};
              },
          .velocity =
              [=](int x, int) {
                return Vec2{is_strip(x) ? 0.f : .75f / 48, 0};
              },
          .depth = [=](int x, int) { return is_strip(x) ? .5f : .1f; },
          .reset = index == 0};
}

struct Case {
  std::string name;
  SceneNeeds needs = {};
  ResolveSettings settings;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Method method :
       {Method::kPoint, Method::kBilinear, Method::kBSpline, Method::kCatmullRom, Method::kMitchell,
        Method::kLanczos2, Method::kLanczos3, Method::kNoise, Method::kNoiseOffset})
    all.push_back({name_of(method), {}, {.method = method, .sharpness = .5f}});
  for (const TwoFrameForm form : {TwoFrameForm::kMean, TwoFrameForm::kVelocity, TwoFrameForm::kReprojected}) {
    all.push_back({"quincunx", {}, {.method = Method::kQuincunx, .quincunx = {.form = form}}});
    all.back().name += std::to_string(static_cast<int>(form));
  }
  for (const TemporalPreset preset :
       {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality}) {
    all.push_back({"temporal", {}, {.method = Method::kTemporal, .temporal = {.preset = preset}}});
    all.back().name += std::to_string(static_cast<int>(preset));
  }
  ResolveSettings settings = {.method = Method::kTemporal};
  all.push_back({"alpha", {.background = false}, settings});
  settings.sharpness = 1;
  settings.temporal.noise = .1f;
  all.push_back({"noisy frames", {}, settings});
  settings = {.method = Method::kTemporal};
  settings.targets.shading = Shading::kCheckerboard;
  all.push_back({"checkerboard", {}, settings});
  settings = {.method = Method::kTemporal};
  settings.conventions.sky_motion = SkyMotion::kEvidence;
  all.push_back({"sky", {}, settings});
  for (Case& one : all) {
    one.needs.moving_objects = one.needs.camera_motion = true;
    one.settings.temporal.history = PixelFormat::kRGBA32F;
    one.settings.output.linear = PixelFormat::kRGBA32F;
  }
  return all;
}

// The last picture, in units of `unit`. `exposure`: of each frame.
std::vector<Pixel> last_picture(const Case& one, double unit, const std::vector<float>& exposures = {}) {
  ServiceRig rig(one.needs, one.settings, kOutput, kRender);
  std::vector<Pixel> picture;
  for (int i = 0; i < kFrames; ++i) {
    FrameInputs inputs = rig.upload(frame_of(i, unit));
    if (!exposures.empty()) inputs.exposure = exposures[static_cast<std::size_t>(i)];
    const FrameReport report = rig.dispatch(inputs);
    EXPECT_TRUE(report.ok()) << report.status.message();
  }
  picture = rig.resolved();
  for (Pixel& pixel : picture) {
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(static_cast<double>(pixel[c]) / unit);
  }
  return picture;
}

// The root of the mean squared difference of what is shown.
double difference_of(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
  const auto shown = [](float light) { return static_cast<double>(light / (1 + std::max(light, 0.f))); };
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c)
      sum += std::pow(shown(a[i][c]) - shown(b[i][c]), 2);
  }
  return std::sqrt(sum / (4 * static_cast<double>(a.size())));
}

class UnitOfLight : public ::testing::TestWithParam<Case> {};

TEST_P(UnitOfLight, APowerOfTwoGivesTheSameBits) {
  const std::vector<Pixel> usual = last_picture(GetParam(), 1);
  for (const double unit : {0x1p-17, 0x1p20})
    EXPECT_EQ(last_picture(GetParam(), unit), usual) << unit;
}

TEST_P(UnitOfLight, AnyGivesTheSamePicture) {
  const std::vector<Pixel> usual = last_picture(GetParam(), 1);
  for (const double unit : {1e-5, 1e-3, 10., 1e3, 1e6})
    EXPECT_LT(difference_of(last_picture(GetParam(), unit), usual), 1e-4) << unit;
}

// With the exposure that belongs to the unit.
TEST_P(UnitOfLight, AGivenExposureTellsIt) {
  const std::vector<float> shown(kFrames, .8f), dark(kFrames, .8e-4f);
  EXPECT_LT(difference_of(last_picture(GetParam(), 1e4, dark), last_picture(GetParam(), 1, shown)), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Settings, UnitOfLight, ::testing::ValuesIn(cases()), [](const auto& instance) {
  std::string name = instance.param.name;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
});

Case usual_temporal() {
  for (const Case& one : cases()) {
    if (one.name == "temporal" + std::to_string(static_cast<int>(TemporalPreset::kBalanced))) return one;
  }
  return {};
}

TEST(ServiceExposure, OneThatJumpsForAFrameLeavesNoTrace) {
  std::vector<float> exposures(kFrames, 1);
  const std::vector<Pixel> steady = last_picture(usual_temporal(), 1, exposures);
  exposures[kFrames - 3] *= 4;
  EXPECT_EQ(last_picture(usual_temporal(), 1, exposures), steady);
  exposures[kFrames - 3] /= 16;
  EXPECT_EQ(last_picture(usual_temporal(), 1, exposures), steady);
}

// History follows it: the scene has not changed.
TEST(ServiceExposure, OneThatRisesForGoodIsFollowed) {
  std::vector<float> exposures(kFrames, 1);
  const std::vector<Pixel> steady = last_picture(usual_temporal(), 1, exposures);
  std::fill(exposures.begin() + 2, exposures.end(), 4);
  const std::vector<Pixel> followed = last_picture(usual_temporal(), 1, exposures);
  EXPECT_NE(followed, steady);
  EXPECT_LT(difference_of(followed, steady), .05);
}

// A lamp of 4x4 samples among .01, still.
std::vector<Pixel> lamp(const ResolveSettings& settings, float light) {
  ServiceRig rig({.camera_motion = true}, settings, kOutput, kRender);
  HostFrame frame = frame_of(0, 1);
  frame.colour = [=](int x, int y) {
    const float value = x >= 20 && x < 24 && y >= 12 && y < 16 ? light : .01f;
    return Pixel{value, value, value, 1};
  };
  frame.velocity = [](int, int) { return Vec2{}; };
  for (int i = 0; i < kFrames; ++i) {
    frame.jitter = frame_of(i, 1).jitter;
    frame.reset = i == 0;
    rig.resolve(frame);
  }
  return rig.resolved();
}

TEST(ServiceExposure, ALampStaysBrightAndWhatIsAroundItDark) {
  for (const TemporalPreset preset :
       {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality}) {
    const ResolveSettings settings = {.method = Method::kTemporal, .temporal = {.preset = preset}};
    for (const float light : {7e4f, 1e6f, 3e38f, std::numeric_limits<float>::infinity()}) {
      const std::vector<Pixel> picture = lamp(settings, light);
      const auto at = [&](int x, int y) {
        return picture[static_cast<std::size_t>(y * kOutput.width + x)][1];
      };
      EXPECT_GT(at(44, 28), 1000) << light;
      for (int y = 0; y < kOutput.height; ++y) {
        for (int x = 0; x < kOutput.width; ++x) {
          const bool is_near = x >= 36 && x < 52 && y >= 20 && y < 36;
          if (is_near) continue;
          ASSERT_NEAR(at(x, y), .01f, .01f) << light << " at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(ServiceExposure, HalvesAreNeverInfinite) {
  for (const Case& one : cases()) {
    ResolveSettings settings = one.settings;
    settings.output.linear = PixelFormat::kRGBA16F;
    ServiceRig rig(one.needs, settings, kOutput, kRender);
    for (int i = 0; i < 3; ++i) {
      const FrameReport report = rig.dispatch(rig.upload(frame_of(i, 1e6)));
      ASSERT_TRUE(report.ok()) << report.status.message();
    }
    std::vector<std::uint16_t> halves(static_cast<std::size_t>(kOutput.area()) * 4);
    ASSERT_TRUE(rig.device().download(rig.resolved_view(), kOutput, halves.data()).ok());
    for (const std::uint16_t half : halves)
      ASSERT_LT(half & 0x7fff, 0x7c00) << one.name;
  }
}

}  // namespace
}  // namespace quincunx
