// SPDX-License-Identifier: MIT
// RGBA8 colour: what its 8 bits cost, and who makes the picture's light.
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "service_fixture.h"

namespace quincunx::testing {
namespace {

constexpr Extent kOutput = {67, 41};

// Any light of the screen, in steps of 2^-10: RGBA16F would hold it without rounding.
HostFrame noise_frame(Extent render, Vec2 jitter, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Pixel> light(static_cast<std::size_t>(render.area()));
  for (Pixel& pixel : light) {
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(random() % 1025) / 1024;
    pixel[3] = 1;
  }
  HostFrame frame;
  frame.render = render;
  frame.jitter = jitter;
  frame.colour = [light, render](int x, int y) {
    return light[static_cast<std::size_t>(y * render.width + x)];
  };
  return frame;
}

struct Case {
  const char* name;
  ResolveSettings settings;
  double weight_sum;  // sum of the weights' magnitudes on one axis, at most
};

const Case kCases[] = {
    {"point", {.method = Method::kPoint}, 1},
    {"bilinear", {.method = Method::kBilinear}, 1},
    {"b_spline", {.method = Method::kBSpline}, 1},
    {"noise_offset", {.method = Method::kNoiseOffset}, 1},
    {"mean", {.method = Method::kQuincunx, .quincunx = {.form = TwoFrameForm::kMean}}, 1},
    {"velocity", {.method = Method::kQuincunx}, 1},
    {"catmull_rom", {.method = Method::kCatmullRom}, 1.3},
    {"mitchell", {.method = Method::kMitchell}, 1.3},
    {"lanczos2", {.method = Method::kLanczos2}, 1.3},
    {"lanczos3", {.method = Method::kLanczos3}, 1.56},
};

class EncodedColour : public ::testing::TestWithParam<Case> {};

// docs/lab/numerics.md derives both bounds: half a code at the bright end, where sRGB is steepest, times the sum of the
// weights' magnitudes; and half a code of the picture where no weight is negative, so that rounding to whole codes
// leaves one.
TEST_P(EncodedColour, StaysWithinTheQuantisation) {
  const Case& c = GetParam();
  const double half_code = 1 - std::pow((1 - 0.5 / 255 + 0.055) / 1.055, 2.4);
  const double bound = c.weight_sum * c.weight_sum * half_code;
  ResolveSettings settings = c.settings;
  settings.output.tone_map = ToneMap::kClamp;
  for (const Extent render : {Extent{1, 1}, Extent{7, 5}, Extent{47, 29}, Extent{67, 41}, Extent{90, 50}}) {
    ServiceRig linear({.transparents = false}, settings, kOutput, {96, 64});
    settings.colour = PixelFormat::kRGBA8;
    ServiceRig encoded({.transparents = false}, settings, kOutput, {96, 64});
    settings.colour = PixelFormat::kRGBA16F;
    double largest = 0;
    int largest_code = 0;
    for (unsigned frame = 0; frame < 3; ++frame) {
      const float side = frame % 2 == 0 ? .25f : -.25f;
      const HostFrame drawn = noise_frame(render, {side, side}, frame + 1);
      const std::vector<Pixel> expected = linear.resolve(drawn);
      const std::vector<Pixel> actual = encoded.resolve(drawn);
      const auto wanted = linear.presented();
      const auto shown = encoded.presented();
      for (std::size_t i = 0; i < expected.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
          largest = std::max(largest, static_cast<double>(std::abs(expected[i][k] - actual[i][k])));
          largest_code = std::max(largest_code, std::abs(wanted[4 * i + k] - shown[4 * i + k]));
        }
      }
    }
    EXPECT_LE(largest, bound) << render.width << "x" << render.height;
    EXPECT_GT(largest, bound / 20) << "8 bits cost nothing?";
    if (c.weight_sum == 1) {
      EXPECT_LE(largest_code, 1) << render.width << "x" << render.height;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EncodedColour, ::testing::ValuesIn(kCases),
                         [](const auto& instance) { return instance.param.name; });

// The picture is what was drawn: neither exposed nor tone mapped again, whatever the frame and the settings say.
TEST(EncodedColourPicture, IsShownAsItWasDrawn) {
  ServiceRig rig(
      {}, {.method = Method::kPoint, .colour = PixelFormat::kRGBA8, .output = {.tone_map = ToneMap::kAces}},
      {16, 16}, {16, 16});
  HostFrame frame;
  frame.render = {16, 16};
  frame.colour = [](int x, int y) {
    const float light = static_cast<float>(16 * y + x) / 255;
    return Pixel{light, light * light, 1 - light, 1};
  };
  FrameInputs inputs = rig.upload(frame);
  inputs.exposure = 4;
  ASSERT_TRUE(rig.dispatch(inputs).ok());
  const auto shown = rig.presented();
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const Codes codes = codes_of(frame.colour(x, y));
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_EQ(shown[4 * static_cast<std::size_t>(16 * y + x) + c], codes[c]) << x << ", " << y;
    }
  }
}

TEST(EncodedColourPlan, SaysWhoToneMaps) {
  const ResolveSettings settings{
      .output_extent = {64, 64}, .target_extent = {64, 64}, .colour = PixelFormat::kRGBA8};
  const auto plan = plan_for({}, settings);
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  const std::string text = plan->explain();
  for (const char* part : {"RGBA8, sRGB encoded; the renderer exposes and tone maps (aces)", "SRGB8",
                           "TONE_MAP=TONE_CLAMP", "RGBA8 colour has both when it is drawn"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in:\n" << text;
  }
  EXPECT_EQ(plan->buffers.front().name, "colour");
  EXPECT_EQ(plan->buffers.front().bytes, 64u * 64 * 4);
}

}  // namespace
}  // namespace quincunx::testing
