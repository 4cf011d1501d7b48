// SPDX-License-Identifier: MIT
// Which frames a run reads, and what it finds out about them beforehand.
#include "tools/sequence/sequence_scan.h"

#include <gtest/gtest.h>

#include "sequence_fixture.h"

namespace quincunx::tools {
namespace {

using Frames = std::vector<std::int64_t>;

TEST(History, ReachesBackBeforeEveryWantedFrame) {
  EXPECT_EQ(with_history(Frames{5, 6, 7}, 0, 1), (Frames{5, 6, 7}));
  EXPECT_EQ(with_history(Frames{5, 6, 7}, 2, 1), (Frames{3, 4, 5, 6, 7}));
  EXPECT_EQ(with_history(Frames{5, 9, 20}, 1, 1), (Frames{4, 5, 8, 9, 19, 20}));
  EXPECT_EQ(with_history(Frames{5, 7}, 3, 1), (Frames{2, 3, 4, 5, 6, 7}));
}

TEST(History, EndsWhereTheSequenceBegins) {
  EXPECT_EQ(with_history(Frames{3, 4}, 32, 1), (Frames{1, 2, 3, 4}));
  EXPECT_EQ(with_history(Frames{3}, 2, 3), (Frames{3}));
}

class Scan : public testing::SequenceTest {
 protected:
  FramePattern pattern() const { return FramePattern::parse(folder_.file("f.%04d.exr")).value(); }

  static SequenceFormat format() {
    SequenceFormat format;
    format.output = kOutput;
    return format;
  }
};

TEST_F(Scan, AllFramesReachFromTheFirstFileToTheLast) {
  EXPECT_FALSE(all_frames(pattern()).ok());
  write_frames(3, 4);
  write_frames(6, 6);
  EXPECT_EQ(all_frames(pattern()).value(), (Frames{3, 4, 5, 6}));
}

TEST_F(Scan, TheSequenceBeginsWithItsFirstFile) {
  write_frames(3, 6);
  EXPECT_EQ(first_in_reach(pattern(), 6, 32), 3);
  EXPECT_EQ(first_in_reach(pattern(), 6, 1), 5);
  EXPECT_EQ(first_in_reach(pattern(), 3, 5), 3);
  EXPECT_EQ(first_in_reach(pattern(), 2, 5), 2);
}

TEST_F(Scan, SizesTypesAndJitterOfEachFrame) {
  for (int number = 1; number <= 3; ++number) {
    testing::FrameFile file = frame(number);
    file.extent = {20 + number, 30 - number};
    if (number == 2) file.colour = ChannelType::kFloat;
    write_frame(input(number), file);
  }
  SequenceFormat all = format();
  all.jitter = JitterSource::parse("attribute").value();
  const SequenceScan scan = scan_sequence(pattern(), all, Frames{1, 2, 3}, Frames{2, 3}, 3);
  ASSERT_TRUE(scan.problem().ok()) << scan.problem().message();
  EXPECT_EQ(scan.target(), (Extent{23, 29}));
  EXPECT_FALSE(scan.half_colour());
  EXPECT_TRUE(scan.frames[0].half_colour);
  EXPECT_EQ(scan.wanted(), (Frames{2, 3}));
  EXPECT_EQ(scan.history(), (Frames{1}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(scan.frames[i].render, (Extent{21 + i, 29 - i}));
    EXPECT_EQ(scan.frames[i].jitter, testing::quincunx_jitter(i + 1));
    EXPECT_EQ(scan.frames[i].reset, i == 0);
  }
}

TEST_F(Scan, WhatFollowsNothingIsReset) {
  write_frames(1, 8);
  testing::FrameFile cut = frame(3);
  cut.attributes.push_back({"quincunx:reset", 1});
  write_frame(input(3), cut);
  std::filesystem::remove(input(7));
  const SequenceScan scan =
      scan_sequence(pattern(), format(), Frames{1, 2, 3, 4, 6, 7, 8}, Frames{1, 2, 3, 4, 6, 7, 8}, 2);
  const std::vector<bool> wanted = {true, false, true, false, true, false, true};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_EQ(scan.frames[i].reset, wanted[i]) << scan.frames[i].number;
  EXPECT_EQ(scan.bad(), (Frames{7}));
}

TEST_F(Scan, ProblemsAreCounted) {
  write_frames(1, 5);
  std::filesystem::remove(input(2));
  std::filesystem::remove(input(4));
  const Frames all = {1, 2, 3, 4, 5};
  const std::string message = scan_sequence(pattern(), format(), all, all, 1).problem().message();
  EXPECT_NE(message.find("frame 2 is missing"), std::string::npos) << message;
  EXPECT_NE(message.find("1 more"), std::string::npos) << message;
}

}  // namespace
}  // namespace quincunx::tools
