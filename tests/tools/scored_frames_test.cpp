// SPDX-License-Identifier: MIT
#include "tools/page/scored_frames.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quincunx::tools {
namespace {

constexpr Extent kExtent = {16, 12};

MeasuredPicture flat(float value) {
  return {kExtent, std::vector<float>(static_cast<std::size_t>(kExtent.area()) * 4, value)};
}

std::vector<std::int64_t> numbers(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> frames;
  for (std::int64_t frame = first; frame <= last; ++frame)
    frames.push_back(frame);
  return frames;
}

TEST(ScoredFrames, KeepsPicturesAtEvenDistancesAndTheLast) {
  const ScoredFrames scored(numbers(1, 60), true);
  for (const std::int64_t frame : numbers(1, 60))
    EXPECT_EQ(scored.keeps(frame), frame % 10 == 0) << frame;
  const ScoredFrames few(numbers(7, 9), true);
  for (const std::int64_t frame : numbers(7, 9))
    EXPECT_TRUE(few.keeps(frame));
  const ScoredFrames none(numbers(7, 9), false);
  EXPECT_FALSE(none.keeps(9));
}

TEST(ScoredFrames, FlickerIsKnownAfterTheFrameBefore) {
  ScoredFrames scored(std::vector<std::int64_t>{3, 4, 6}, true);
  const std::vector<Vec2> still(1);
  for (const std::int64_t frame : {3, 4, 6})
    ASSERT_TRUE(scored.add(frame, flat(static_cast<float>(frame)), flat(1), {{1, 1}, still}).ok());
  ASSERT_EQ(scored.rows().size(), 3u);
  EXPECT_EQ(scored.rows()[0].flicker, -1);
  // The truth rests. Luma of the pictures is sRGB of 3/4 and of 4/5.
  const auto srgb = [](double value) { return 1.055 * std::pow(value, 1 / 2.4) - .055; };
  EXPECT_NEAR(scored.rows()[1].flicker, srgb(.8) - srgb(.75), 1e-5);
  EXPECT_EQ(scored.rows()[2].flicker, -1) << "frame 5 is not known";
  ASSERT_EQ(scored.pictures().frames.size(), 3u);
  EXPECT_EQ(scored.pictures().frames[2].index, 6);
  EXPECT_EQ(scored.pictures().kinds.back().name, "ghosts");
}

TEST(ScoredFrames, ARepeatedFrameIsMeasuredAgainstTheTruthOfEachRefresh) {
  ScoredFrames scored(std::vector<std::int64_t>{0, 1}, false);
  scored.repeat(flat(1));
  EXPECT_TRUE(scored.rows().empty()) << "nothing was shown before the first frame";
  ASSERT_TRUE(scored.add(0, flat(1), flat(1), {}).ok());
  scored.repeat(flat(1));
  scored.repeat(flat(2));
  ASSERT_TRUE(scored.add(1, flat(2), flat(2), {}).ok());
  const std::vector<double>& repeated = scored.rows()[0].repeated_flip;
  ASSERT_EQ(repeated.size(), 2u);
  EXPECT_EQ(repeated[0], 0) << "the truth rests";
  EXPECT_GT(repeated[1], 0) << "it went on";
  const ShownError shown = shown_error(scored.rows());
  EXPECT_EQ(shown.refreshes, 4);
  EXPECT_EQ(shown.flip, repeated[1] / 4);
}

TEST(ScoredFrames, SmallPicturesAreRefusedByTheOptionsName) {
  EXPECT_TRUE(ScoredFrames::check({11, 11}, "--score").ok());
  EXPECT_EQ(ScoredFrames::check({640, 10}, "--score").message(),
            "--score needs an output of at least 11x11 pixels; this is 640x10");
}

}  // namespace
}  // namespace quincunx::tools
