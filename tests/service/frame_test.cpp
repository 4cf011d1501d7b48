// SPDX-License-Identifier: MIT
// What a program needs before its first frame: jitter, the bias of its textures, and results that are asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "quincunx/frame.h"
#include "quincunx/quincunx.h"

namespace quincunx {
namespace {

constexpr Extent kOutput = {1280, 720};

TEST(Jitter, HasAsManyPlacesAsTheScaleNeeds) {
  EXPECT_EQ(jitter_phases(kOutput, kOutput), 8);
  EXPECT_EQ(jitter_phases({640, 360}, kOutput), 32);
  EXPECT_EQ(jitter_phases({640, 720}, kOutput), 16);
  EXPECT_EQ(jitter_phases({2, 2}, {3, 3}), 18) << "exactly 8 * 2.25";
  EXPECT_EQ(jitter_phases({908, 512}, kOutput), 16) << "15.86 rounded up";
  EXPECT_EQ(jitter_phases({2560, 1440}, kOutput), 2);
  EXPECT_EQ(jitter_phases({1, 1}, {32768, 32768}), 512);
  EXPECT_EQ(jitter_phases({1, 1}, {2147483647, 2147483647}), 512);
}

TEST(Jitter, IsHaltonsAboutItsMean) {
  const double means[] = {(1. / 2 + 1. / 4 + 3. / 4 + 1. / 8 + 5. / 8 + 3. / 8 + 7. / 8 + 1. / 16) / 8,
                          (1. / 3 + 2. / 3 + 1. / 9 + 4. / 9 + 7. / 9 + 2. / 9 + 5. / 9 + 8. / 9) / 8};
  EXPECT_EQ(jitter(2, kOutput, kOutput),
            (Vec2{static_cast<float>(3. / 4 - means[0]), static_cast<float>(1. / 9 - means[1])}));
}

TEST(Jitter, GoesRoundThroughPlacesThatDifferWithoutAMean) {
  for (const Extent render : {kOutput, Extent{908, 512}, Extent{640, 360}, Extent{422, 238}}) {
    const auto phases = static_cast<std::uint64_t>(jitter_phases(render, kOutput));
    double x = 0, y = 0;
    for (std::uint64_t i = 0; i < phases; ++i) {
      const Vec2 place = jitter(i, render, kOutput);
      EXPECT_LT(std::max(std::abs(place.x), std::abs(place.y)), .5f);
      for (std::uint64_t before = 0; before < i; ++before)
        EXPECT_NE(place, jitter(before, render, kOutput)) << before << " and " << i;
      EXPECT_EQ(place, jitter(i + 1000 * phases, render, kOutput));
      x += place.x;
      y += place.y;
    }
    EXPECT_NEAR(x, 0, 1e-5);
    EXPECT_NEAR(y, 0, 1e-5);
  }
}

TEST(Jitter, AnEmptyExtentHasNone) {
  for (const Extent empty : {Extent{}, Extent{0, 5}, Extent{5, -1}}) {
    for (const auto& [render, output] : {std::pair{empty, kOutput}, {kOutput, empty}}) {
      EXPECT_EQ(jitter(3, render, output), Vec2());
      EXPECT_EQ(jitter_phases(render, output), 1);
      EXPECT_EQ(texture_lod_bias(render, output), 0);
    }
  }
}

TEST(TextureLodBias, IsLog2OfTheScaleLessOne) {
  EXPECT_EQ(texture_lod_bias(kOutput, kOutput), -1);
  EXPECT_EQ(texture_lod_bias({640, 360}, kOutput), -2);
  EXPECT_EQ(texture_lod_bias({640, 720}, kOutput), -1.5f) << "the mean of both axes";
}

TEST(Jitter, IsTheSameInC) {
  float place[2] = {9, 9};
  quincunx_jitter(7, 640, 360, kOutput.width, kOutput.height, place);
  EXPECT_EQ((Vec2{place[0], place[1]}), jitter(7, {640, 360}, kOutput));
  quincunx_jitter(7, 640, 360, kOutput.width, kOutput.height, nullptr);
  EXPECT_EQ(quincunx_jitter_phases(640, 360, kOutput.width, kOutput.height), 32);
  EXPECT_EQ(quincunx_texture_lod_bias(640, 360, kOutput.width, kOutput.height), -2);
}

TEST(Result, GivesItsValueOrSaysWhyThereIsNone) {
  Result<Extent> good = kOutput;
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, kOutput);
  EXPECT_EQ(good->width, kOutput.width);
  EXPECT_EQ(good.error(), "");
  const Result<Extent> bad = Status::unsupported("there are no pixels");
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.error(), "there are no pixels");
}

TEST(ResultDeathTest, AValueThatIsNotThereEndsTheProcessWithTheReason) {
  const Result<Extent> bad = Status::unsupported("there are no pixels");
  EXPECT_DEATH((void)bad.value(), "a result without a value is used: there are no pixels");
  EXPECT_DEATH((void)*bad, "there are no pixels");
  EXPECT_DEATH((void)bad->width, "there are no pixels");
}

}  // namespace
}  // namespace quincunx
