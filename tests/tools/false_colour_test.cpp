// SPDX-License-Identifier: MIT
#include "tools/image/false_colour.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace quincunx::tools {
namespace {

int brightness(Rgb colour) {
  return 2126 * colour.r + 7152 * colour.g + 722 * colour.b;
}

Rgb pixel(const Canvas& canvas, int x, int y) {
  const auto i = static_cast<std::size_t>(y * canvas.extent.width + x) * 3;
  return {canvas.rgb[i], canvas.rgb[i + 1], canvas.rgb[i + 2]};
}

bool same(Rgb a, Rgb b) {
  return a.r == b.r && a.g == b.g && a.b == b.b;
}

TEST(FalseColour, RampsGrowBrighterAllTheWay) {
  for (const ColourMap map : {ColourMap::kGrey, ColourMap::kViridis, ColourMap::kMagma}) {
    int previous = -1;
    for (int i = 0; i <= 64; ++i) {
      const int now = brightness(colour_of(map, static_cast<float>(i) / 64));
      EXPECT_GT(now, previous) << "step " << i;
      previous = now;
    }
    EXPECT_TRUE(same(colour_of(map, -3), colour_of(map, 0)));
    EXPECT_TRUE(same(colour_of(map, 7), colour_of(map, 1)));
  }
}

TEST(FalseColour, HueIsTheDirectionAndBrightnessTheLength) {
  EXPECT_TRUE(same(colour_of(Vec2{2, 0}, 2), Rgb{255, 0, 0}));
  EXPECT_TRUE(same(colour_of(Vec2{-2, 0}, 2), Rgb{0, 255, 255}));
  EXPECT_TRUE(same(colour_of(Vec2{9, 0}, 2), Rgb{255, 0, 0}));
  EXPECT_TRUE(same(colour_of(Vec2{0, 0}, 2), Rgb{0, 0, 0}));
  const Rgb down = colour_of(Vec2{0, 2}, 2);
  const Rgb up = colour_of(Vec2{0, -2}, 2);
  EXPECT_GT(down.g, down.b);
  EXPECT_GT(up.b, up.g);
  EXPECT_LT(brightness(colour_of(Vec2{1, 0}, 2)), brightness(colour_of(Vec2{2, 0}, 2)));
}

TEST(FalseColour, TheScaleCoversWhatIsThere) {
  const std::vector<float> values = {3, 7, 1e10f, std::numeric_limits<float>::quiet_NaN(), -5};
  const ScalarScale scale = scale_over(values, ColourMap::kViridis, true, {0.01f, 1e6f});
  EXPECT_EQ(scale.low, 3);
  EXPECT_EQ(scale.high, 7);
  const ScalarScale none = scale_over({}, ColourMap::kViridis, false, {0, 1});
  EXPECT_LT(none.low, none.high);
  const std::vector<float> one = {4};
  const ScalarScale single = scale_over(one, ColourMap::kViridis, false, {0, 10});
  EXPECT_LT(single.low, single.high);
}

TEST(FalseColour, PicturesAreMagnifiedAndKeepTheirPlaces) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values = {0, 1, nan, 0.5f};
  const Canvas canvas =
      scalar_picture({2, 2}, values, {.low = 0, .high = 1, .map = ColourMap::kMagma}, "error");
  EXPECT_GE(canvas.extent.width, 480);
  const int half = canvas.extent.width / 2;
  EXPECT_TRUE(same(pixel(canvas, 0, 0), colour_of(ColourMap::kMagma, 0)));
  EXPECT_TRUE(same(pixel(canvas, half, 0), colour_of(ColourMap::kMagma, 1)));
  EXPECT_TRUE(same(pixel(canvas, half - 1, half), kNotFinite));
  EXPECT_TRUE(same(pixel(canvas, half, half), colour_of(ColourMap::kMagma, 0.5f)));
  // Under the picture lies the legend: its bar runs from the dark to the bright end.
  EXPECT_GT(canvas.extent.height, canvas.extent.width);
}

TEST(FalseColour, LogarithmicScalesMeetTheirEnds) {
  const std::vector<float> values = {0.1f, 1, 10};
  const Canvas canvas = scalar_picture(
      {3, 1}, values, {.low = 0.1f, .high = 10, .logarithmic = true, .map = ColourMap::kGrey}, "");
  const int third = canvas.extent.width / 3;
  EXPECT_EQ(pixel(canvas, 0, 0).r, 0);
  EXPECT_NEAR(pixel(canvas, third, 0).r, 128, 1);
  EXPECT_EQ(pixel(canvas, 2 * third, 0).r, 255);
}

TEST(FalseColour, ClassesTakeTheirColours) {
  const std::vector<ClassColour> palette = {{"copy", {10, 20, 30}}, {"full", {200, 100, 50}}};
  const std::vector<int> classes = {0, 1, 5};
  const Canvas canvas = class_picture({3, 1}, classes, palette, "tiles");
  const int third = canvas.extent.width / 3;
  EXPECT_TRUE(same(pixel(canvas, 0, 0), palette[0].colour));
  EXPECT_TRUE(same(pixel(canvas, third, 0), palette[1].colour));
  EXPECT_TRUE(same(pixel(canvas, 2 * third, 0), kNotFinite));
}

TEST(FalseColour, VectorsThatAreNotFiniteStandOut) {
  const std::vector<Vec2> vectors = {{1, 0}, {std::numeric_limits<float>::infinity(), 0}};
  const Canvas canvas = vector_picture({2, 1}, vectors, 1, "velocity", "px a frame");
  EXPECT_TRUE(same(pixel(canvas, 0, 0), Rgb{255, 0, 0}));
  EXPECT_TRUE(same(pixel(canvas, canvas.extent.width / 2, 0), kNotFinite));
}

}  // namespace
}  // namespace quincunx::tools
