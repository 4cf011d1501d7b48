// SPDX-License-Identifier: MIT
#include "tools/sequence/frame_pattern.h"

#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.h"

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
  EXPECT_EQ(expanded("100%%/#.png", 1), "100%/0001.png");
  EXPECT_EQ(expanded("one.png", 9), "one.png");
  EXPECT_EQ(expanded("50%%.png", 9), "50%.png");
}

TEST(FramePattern, ExtensionDecidesTheFormat) {
  EXPECT_EQ(FramePattern::parse("a.png")->format(), FileFormat::kPng);
  EXPECT_EQ(FramePattern::parse("a.#.Exr")->format(), FileFormat::kExr);
}

TEST(FramePattern, RefusesWhatItCannotDo) {
  const struct {
    const char* pattern;
    const char* says;
  } cases[] = {
      {"", "empty"},
      {"a.jpg", "'.jpg'"},
      {"a.####", "must end in .png or .exr"},
      {"frames", "no extension"},
      {"a.#.#.png", "two frame numbers"},
      {"#/a.%04d.png", "two frame numbers"},
      {"a.%s.png", "'%'"},
      {"a%", "'%'"},
      {"a.%99999999999999999999d.png", "digits"},
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
  const Result<FramePattern> parsed = FramePattern::parse("a.jpg", "input pattern");
  EXPECT_EQ(parsed.status().message().rfind("input pattern 'a.jpg'", 0), 0u) << parsed.status().message();
}

TEST(FramePattern, FindsTheNumberInAPath) {
  const FramePattern padded = FramePattern::parse("a/f.%04d.exr").value();
  EXPECT_EQ(padded.number_in("a/f.0007.exr"), 7);
  EXPECT_EQ(padded.number_in("a/f.12345.exr"), 12345);
  for (const char* other : {"a/f.7.exr", "a/f.00007.exr", "a/f.exr", "a/f..exr", "a/f.-001.exr",
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
  EXPECT_FALSE(FramePattern::parse(folder.file("f.exr"))->frames_on_disk().ok());
  EXPECT_FALSE(FramePattern::parse(folder.file("#/f.exr"))->frames_on_disk().ok());
}

}  // namespace
}  // namespace quincunx::tools
