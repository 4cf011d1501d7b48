// SPDX-License-Identifier: MIT
// Alpha is resolved as a colour is, and never taken for what a surface hides: soft, additive, of cut-outs and holdouts.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "passes/two_way.h"
#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::Place;
using testing::ServiceRig;
using testing::Surface;
using testing::TemporalScene;

using Pixels = std::vector<Pixel>;

constexpr Extent kRender = {80, 48};
constexpr SceneNeeds kOpen = {.background = false};

// What becomes of a surface's colour.
using Veil = std::function<Pixel(Pixel colour, bool is_disc, Place local, int frame)>;

// A disc before a ground that moves another way.
TemporalScene disc_before_a_ground(const Veil& veil, int frame) {
  const auto veiled = [&veil, frame](const testing::Texture& texture, bool is_disc) {
    return [=](Place local) { return veil(texture(local), is_disc, local, frame); };
  };
  TemporalScene scene;
  scene.surfaces.push_back({.shape = Surface::Shape::kDisc,
                            .half_size = 22,
                            .centre = {100, 40},
                            .velocity = {-1.7, .6},
                            .distance = 4,
                            .texture = veiled(testing::noise_texture(5, 3), true)});
  scene.surfaces.push_back({.velocity = {.9, .4}, .texture = veiled(testing::noise_texture(12), false)});
  return scene;
}

Veil with_alpha(float alpha) {
  return [=](const Pixel& colour, bool, Place, int) { return Pixel{colour[0], colour[1], colour[2], alpha}; };
}

struct Path {
  std::string name;
  ResolveSettings settings;
  bool both_ways = false;
};

void PrintTo(const Path& path, std::ostream* out) {
  *out << path.name;
}

constexpr int kLast = 12, kShownBothWays = 8;

Pixels both_ways(const Veil& veil, const ResolveSettings& settings) {
  ServiceRig rig(kOpen, settings, TemporalScene().output, kRender);
  auto forward = TwoWay::create(rig.device(), rig.service().plan());
  auto backward = TwoWay::create(rig.device(), rig.service().plan());
  KeptHistory kept, unused;
  FrameInputs inputs;
  const auto add = [&](ResolveService& service, int index, double direction, KeptHistory& history) {
    const TemporalScene scene = disc_before_a_ground(veil, index);
    HostFrame frame = scene.render(index, kRender, testing::halton_jitter(index, 32));
    frame.velocity = [=, velocity = frame.velocity](int x, int y) {
      const Vec2 v = velocity(x, y);
      return Vec2{static_cast<float>(direction) * v.x, static_cast<float>(direction) * v.y};
    };
    inputs = rig.upload(frame);
    inputs.reset = index == (direction > 0 ? 0 : kLast);
    EXPECT_TRUE(TwoWay::add(service, inputs, &history == &kept && direction < 0, &history).ok());
  };
  for (int index = 0; index <= kShownBothWays; ++index)
    add(forward.value(), index, 1, index == kShownBothWays ? kept : unused);
  for (int index = kLast; index >= kShownBothWays; --index)
    add(backward.value(), index, -1, index == kShownBothWays ? kept : unused);
  inputs.colour = inputs.velocity = inputs.depth = inputs.reactive = {};
  EXPECT_TRUE(TwoWay::show(backward.value(), inputs, kept, {rig.resolved_view(), rig.presented_view()}).ok());
  return rig.resolved();
}

// The last of some frames, in the middle of which the output's size changes where it may.
Pixels picture_of(const Path& path, const Veil& veil) {
  if (path.both_ways) return both_ways(veil, path.settings);
  ServiceRig rig(kOpen, path.settings, TemporalScene().output, kRender);
  const bool is_dual = path.settings.output.min_extent.width > 0;
  Pixels shown;
  for (int index = 0; index <= kLast; ++index) {
    const TemporalScene scene = disc_before_a_ground(veil, index);
    HostFrame frame = scene.render(index, kRender, testing::halton_jitter(index, 32));
    frame.parity = index % 2;
    if (is_dual && index < kLast / 2) frame.output = {140, 84};
    shown = rig.resolve(frame);
  }
  return shown;
}

// Root mean square of a channel's distance from that of the truth.
double error_of(const Path& path, const Veil& veil, int channel) {
  const Pixels shown = picture_of(path, veil);
  const int frame = path.both_ways ? kShownBothWays : kLast;
  const Pixels truth = disc_before_a_ground(veil, frame).truth(frame);
  double sum = 0;
  for (std::size_t i = 0; i < shown.size(); ++i)
    sum += std::pow(static_cast<double>(shown[i][channel]) - static_cast<double>(truth[i][channel]), 2);
  return std::sqrt(sum / static_cast<double>(shown.size()));
}

class Alpha : public ::testing::TestWithParam<Path> {};

TEST_P(Alpha, ColourIsTheSameWhateverItIs) {
  const Pixels opaque = picture_of(GetParam(), with_alpha(1));
  for (const float alpha : {.5f, 0.f}) {
    const Pixels shown = picture_of(GetParam(), with_alpha(alpha));
    for (std::size_t i = 0; i < shown.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(shown[i][c], opaque[i][c]) << alpha << " " << i;
      ASSERT_NEAR(shown[i][3], alpha, 2e-3) << i;  // halves of history
    }
  }
}

// It is as near to the truth as red is, where red has its values. Blur is not in the truth.
TEST_P(Alpha, ItIsAsGoodAsAColour) {
  if (GetParam().settings.blur.shutter > 0) return;
  const auto soft = [](Place local) {
    return static_cast<float>(.5 + .4 * std::sin(local.real() / 5) * std::sin(local.imag() / 4));
  };
  const struct {
    const char* name;
    std::function<float(bool is_disc, Place local)> alpha;
  } kinds[] = {{"smoke before a wall", [=](bool is_disc, Place local) { return is_disc ? soft(local) : 1; }},
               {"holdout", [](bool is_disc, Place) { return is_disc ? 0.f : 1.f; }},
               {"cut-out", [](bool is_disc, Place) { return is_disc ? 1.f : 0.f; }}};
  for (const auto& kind : kinds) {
    const auto red = [&](const Pixel&, bool is_disc, Place local, int) {
      const float value = kind.alpha(is_disc, local);
      return Pixel{value, value, value, 1};
    };
    const auto premultiplied = [&](const Pixel& colour, bool is_disc, Place local, int) {
      const float alpha = kind.alpha(is_disc, local);
      return Pixel{colour[0] * alpha, colour[1] * alpha, colour[2] * alpha, alpha};
    };
    EXPECT_LT(error_of(GetParam(), premultiplied, 3), 1.15 * error_of(GetParam(), red, 0) + 2e-3)
        << kind.name;
  }
}

// The whole frame's alpha, to nearly nothing and back to all.
TEST_P(Alpha, ItFollowsAFade) {
  const int frame = GetParam().both_ways ? kShownBothWays : kLast;
  for (const float step : {-.03f, .03f}) {
    const auto alpha_of = [step](int index) {
      return (step < 0 ? 1 : 1 - step * kLast) + step * static_cast<float>(index);
    };
    const Pixels shown = picture_of(GetParam(), [&](const Pixel& colour, bool, Place, int index) {
      const float alpha = alpha_of(index);
      return Pixel{colour[0] * alpha, colour[1] * alpha, colour[2] * alpha, alpha};
    });
    for (std::size_t i = 0; i < shown.size(); ++i)
      ASSERT_NEAR(shown[i][3], alpha_of(frame), .02) << step << " " << i;
  }
}

std::vector<Path> paths() {
  using enum TemporalPreset;
  constexpr auto kMethod = Method::kTemporal;
  return {{"temporal_fast", {.method = kMethod, .temporal = {.preset = kFast}}},
          {"temporal", {.method = kMethod}},
          {"temporal_quality", {.method = kMethod, .temporal = {.preset = kQuality}}},
          {"float_history", {.method = kMethod, .temporal = {.history = PixelFormat::kRGBA32F}}},
          {"denoised", {.method = kMethod, .temporal = {.noise = .05f}}},
          {"sharp", {.method = kMethod, .sharpness = .7f}},
          {"blurred", {.method = kMethod, .blur = {.shutter = .6f}}},
          {"checkerboard", {.method = kMethod, .targets = {.shading = Shading::kCheckerboard}}},
          {"resized", {.method = kMethod, .output = {.min_extent = {1, 1}}}},
          {"both_ways", {.method = kMethod}, true},
          {"both_ways_fast", {.method = kMethod, .temporal = {.preset = kFast}}, true},
          {"two_frames", {.method = Method::kQuincunx}},
          {"two_frames_reprojected",
           {.method = Method::kQuincunx, .quincunx = {.form = TwoFrameForm::kReprojected}}}};
}

INSTANTIATE_TEST_SUITE_P(Paths, Alpha, ::testing::ValuesIn(paths()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace quincunx
