// SPDX-License-Identifier: MIT
#include "tools/frame_pattern.h"

#include <gtest/gtest.h>

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
  EXPECT_EQ(expanded("a.##.png", 7), "a.00000007.png");
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

}  // namespace
}  // namespace quincunx::tools
