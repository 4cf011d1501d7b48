// SPDX-License-Identifier: MIT
#include "tools/sequence/frame_numbers.h"

#include <gtest/gtest.h>

namespace quincunx::tools {
namespace {

using Frames = std::vector<std::int64_t>;

TEST(FrameNumbers, ReadsFramesRangesAndSteps) {
  EXPECT_EQ(parse_frame_numbers("7").value(), (Frames{7}));
  EXPECT_EQ(parse_frame_numbers("1-4").value(), (Frames{1, 2, 3, 4}));
  EXPECT_EQ(parse_frame_numbers("1-10x2,20").value(), (Frames{1, 3, 5, 7, 9, 20}));
  EXPECT_EQ(parse_frame_numbers("1-10x4").value(), (Frames{1, 5, 9}));
  EXPECT_EQ(parse_frame_numbers("5-5").value(), (Frames{5}));
  EXPECT_EQ(parse_frame_numbers("20,3-4,4-5,0003").value(), (Frames{3, 4, 5, 20}));
}

TEST(FrameNumbers, RefusesTheRest) {
  for (const char* text : {"", "a", "1-", "-1", "1-2-3", "5-1", "1-10x0", "1-10x", "1,,2", "1,", "1 2", "1.5",
                           "1x2", "1-10x-1", "99999999999999999999"}) {
    const auto frames = parse_frame_numbers(text);
    ASSERT_FALSE(frames.ok()) << text;
    EXPECT_EQ(frames.status().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(frames.status().message().find("1-10x2"), std::string::npos) << frames.status().message();
  }
  EXPECT_FALSE(parse_frame_numbers("0-9223372036854775807").ok());
  EXPECT_FALSE(parse_frame_numbers("1-6000000,1-6000000").ok());
}

TEST(FrameNumbers, WritesTheShortestText) {
  EXPECT_EQ(frame_numbers_text(Frames{}), "");
  EXPECT_EQ(frame_numbers_text(Frames{7}), "7");
  EXPECT_EQ(frame_numbers_text(Frames{1, 2}), "1-2");
  EXPECT_EQ(frame_numbers_text(Frames{1, 9}), "1,9");
  EXPECT_EQ(frame_numbers_text(Frames{1, 2, 3, 7, 9, 11}), "1-3,7-11x2");
  EXPECT_EQ(frame_numbers_text(Frames{1, 5, 6, 7}), "1,5-7");
}

TEST(FrameNumbers, TextAndNumbersAreOne) {
  for (const char* text : {"1-10x2,20", "3", "0-4,6-8,20-100x5", "2,4,7"}) {
    const Frames frames = parse_frame_numbers(text).value();
    EXPECT_EQ(parse_frame_numbers(frame_numbers_text(frames)).value(), frames) << text;
  }
}

}  // namespace
}  // namespace quincunx::tools
