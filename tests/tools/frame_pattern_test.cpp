// SPDX-License-Identifier: MIT
#include <fstream>

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include "tools/program/frame_pattern.h"

namespace quincunx::tools {
namespace {

std::string expanded(const std::string& pattern, std::int64_t frame) {
  const Result<FramePattern> parsed = FramePattern::parse(pattern);
  return parsed.ok() ? parsed->expand(frame) : "error: " + parsed.status().message();
}

TEST(FramePattern, FillsInTheNumber) {
  EXPECT_EQ(expanded("out/frame.%04d.png", 7), "out/frame.0007.png");
  EXPECT_EQ(expanded("a%d.png", 7), "a7.png");
  EXPECT_EQ(expanded("a%3d.png", 7), "a  7.png");
  EXPECT_EQ(expanded("a.#.png", 7), "a.0007.png");
  EXPECT_EQ(expanded("a.@.png", 7), "a.7.png");
  EXPECT_EQ(expanded("a.@@@.png", 7), "a.007.png");
  EXPECT_EQ(expanded("a.##.png", 7), "a.07.png");
  EXPECT_EQ(expanded("a.####.png", 7), "a.0007.png");
  EXPECT_EQ(expanded("a.#@.exr", 7), "a.00007.exr");
  EXPECT_EQ(expanded("%04d.EXR", 12345), "12345.EXR");
  EXPECT_EQ(expanded("bob@studio/100%/a#b/%02d.png", 1), "bob@studio/100%/a#b/01.png");
  EXPECT_EQ(expanded("a%#b%@%%.#.png", 1), "a#b@%.0001.png");
  EXPECT_EQ(expanded("one.png", 9), "one.png");
  EXPECT_EQ(expanded("50%%.png", 9), "50%.png");
}

TEST(FramePattern, RefusesWhatItCannotDo) {
  const struct {
    const char* pattern;
    const char* says;
  } cases[] = {
      {"", "empty"}, {"a.#.#.png", "two frame numbers"},         {"a.%s.png", "'%'"},
      {"a%", "'%'"}, {"a.%99999999999999999999d.png", "digits"},
  };
  for (const auto& one : cases) {
    const Result<FramePattern> parsed = FramePattern::parse(one.pattern);
    ASSERT_FALSE(parsed.ok()) << one.pattern;
    EXPECT_EQ(parsed.status().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(parsed.status().message().find(one.says), std::string::npos) << parsed.status().message();
  }
}

TEST(FramePattern, OneNameIsNotForManyFrames) {
  EXPECT_TRUE(FramePattern::parse("a.png")->check_count(1).ok());
  EXPECT_TRUE(FramePattern::parse("a.#.png")->check_count(240).ok());
  const Status status = FramePattern::parse("a.png")->check_count(240);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("240"), std::string::npos);
  EXPECT_NE(status.message().find("%04d"), std::string::npos);
}

TEST(FramePattern, MessagesNameWhatItIsFor) {
  const Result<FramePattern> parsed = FramePattern::parse("a.%s.jpg", "input pattern");
  EXPECT_EQ(parsed.status().message().rfind("input pattern 'a.%s.jpg'", 0), 0u) << parsed.status().message();
}

TEST(FramePattern, FindsTheNumberInAPath) {
  const FramePattern padded = FramePattern::parse("a/f.%04d.exr").value();
  EXPECT_EQ(padded.number_in("a/f.0007.exr"), 7);
  EXPECT_EQ(padded.number_in("a/f.12345.exr"), 12345);
  EXPECT_EQ(padded.number_in("a/f.-003.exr"), -3);
  EXPECT_EQ(padded.expand(-3), "a/f.-003.exr");
  EXPECT_EQ(padded.number_in("a/f.3000000001.exr"), 3'000'000'001);
  for (const char* other : {"a/f.7.exr", "a/f.00007.exr", "a/f.exr", "a/f..exr", "a/f.-1.exr", "a/f.-000.exr",
                            "b/f.0007.exr", "a/f.0007.exr.tmp", "a/f.00x7.exr", "a/f.0007_.exr", ""}) {
    EXPECT_FALSE(padded.number_in(other)) << other;
  }
  EXPECT_EQ(FramePattern::parse("f%3d.exr")->number_in("f  7.exr"), 7);
  EXPECT_EQ(FramePattern::parse("f%d.exr")->number_in("f120.exr"), 120);
  EXPECT_FALSE(FramePattern::parse("f.exr")->number_in("f.exr"));
}

TEST(FramePattern, ListsWhatIsOnDisk) {
  testing::TemporaryFolder folder;
  for (const char* name : {"f.0003.exr", "f.0001.exr", "f.12345.exr", "f.2.exr", "g.0002.exr", "f.0002.png"})
    std::ofstream(folder.file(name)) << name;
  using Frames = std::vector<std::int64_t>;
  EXPECT_EQ(FramePattern::parse(folder.file("f.%04d.exr"))->frames_on_disk().value(), (Frames{1, 3, 12345}));
  EXPECT_EQ(FramePattern::parse(folder.file("") + "//f.#.exr")->frames_on_disk().value(),
            (Frames{1, 3, 12345}));
  EXPECT_EQ(FramePattern::parse(folder.file("none/f.#.exr"))->frames_on_disk().value(), Frames{});
  const std::string padded = folder.file("g.-0001.exr");
  std::ofstream(padded) << "other programs count digits without the sign";
  EXPECT_EQ(FramePattern::parse(folder.file("g.%04d.exr"))->frames_on_disk().status().message(),
            "output pattern '" + folder.file("g.%04d.exr") + "' leaves out '" + padded +
                "': it has frame -1 as '" + folder.file("g.-001.exr") + "'; rename it");
  EXPECT_FALSE(FramePattern::parse(folder.file("f.exr"))->frames_on_disk().ok());
  EXPECT_FALSE(FramePattern::parse(folder.file("#/f.exr"))->frames_on_disk().ok());
}

using Frames = std::vector<std::int64_t>;

TEST(FrameNumbers, ReadsFramesRangesAndSteps) {
  EXPECT_EQ(parse_frame_numbers("7").value(), (Frames{7}));
  EXPECT_EQ(parse_frame_numbers("1-4").value(), (Frames{1, 2, 3, 4}));
  EXPECT_EQ(parse_frame_numbers("1-10x2,20").value(), (Frames{1, 3, 5, 7, 9, 20}));
  EXPECT_EQ(parse_frame_numbers("1-10x4").value(), (Frames{1, 5, 9}));
  EXPECT_EQ(parse_frame_numbers("5-5").value(), (Frames{5}));
  EXPECT_EQ(parse_frame_numbers("-3").value(), (Frames{-3}));
  EXPECT_EQ(parse_frame_numbers("-3--1").value(), (Frames{-3, -2, -1}));
  EXPECT_EQ(parse_frame_numbers("-5-1x3,7").value(), (Frames{-5, -2, 1, 7}));
  EXPECT_EQ(parse_frame_numbers("3000000001").value(), (Frames{3'000'000'001}));
  EXPECT_EQ(parse_frame_numbers("20,3-4,4-5,0003").value(), (Frames{3, 4, 5, 20}));
}

TEST(FrameNumbers, RefusesTheRest) {
  for (const char* text : {"", "a", "1-", "--1", "1--2", "+1", "1-2-3", "5-1", "1-10x0", "1-10x", "1,,2",
                           "1,", "1 2", "1.5", "1x2", "1-10x-1", "99999999999999999999"}) {
    const auto frames = parse_frame_numbers(text);
    ASSERT_FALSE(frames.ok()) << text;
    EXPECT_EQ(frames.status().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(frames.status().message().find("1-10x2"), std::string::npos) << frames.status().message();
  }
  EXPECT_FALSE(parse_frame_numbers("0-9223372036854775807").ok());
  EXPECT_FALSE(parse_frame_numbers("1-6000000,1-6000000").ok());
  EXPECT_FALSE(parse_frame_numbers("1000000000000000000").ok());
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
  for (const char* text : {"1-10x2,20", "3", "0-4,6-8,20-100x5", "2,4,7", "-3--1", "-9--1x4,0"}) {
    const Frames frames = parse_frame_numbers(text).value();
    EXPECT_EQ(parse_frame_numbers(frame_numbers_text(frames)).value(), frames) << text;
  }
}

}  // namespace

}  // namespace quincunx::tools
