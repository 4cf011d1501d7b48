// SPDX-License-Identifier: MIT
// A run's account of itself: which method it takes and why, and what its frames suffer from.
#include <nlohmann/json.hpp>

#include "sequence_fixture.h"
#include "tools/exr_files.h"
#include "tools/program/jitter.h"
#include "tools/sequence/resolve_advice.h"

namespace quincunx {
namespace {

using tools::JitterKind;

std::vector<Vec2> pattern(tools::Jitter jitter, int count) {
  std::vector<Vec2> places;
  for (int i = 0; i < count; ++i)
    places.push_back(tools::jitter_of(jitter, i, {1, 1}, {2, 2}));
  return places;
}

TEST(JitterKinds, TellPatternsApart) {
  EXPECT_EQ(tools::kind_of(pattern(tools::Jitter::kNone, 9)), JitterKind::kNone);
  EXPECT_EQ(tools::kind_of(pattern(tools::Jitter::kQuincunx, 9)), JitterKind::kFew);
  EXPECT_EQ(tools::kind_of(pattern(tools::Jitter::kHalton, 9)), JitterKind::kMany);
  EXPECT_EQ(tools::kind_of(std::vector<Vec2>()), JitterKind::kNone);
  EXPECT_EQ(tools::kind_of(pattern(tools::Jitter::kQuincunx, 1)), JitterKind::kFew);
  EXPECT_EQ(tools::kind_of(pattern(tools::Jitter::kNone, 1)), JitterKind::kNone);
  const Vec2 trembling[] = {{.25f, .25f}, {.2505f, .2495f}};  // one place, written with three digits
  EXPECT_EQ(tools::kind_of(trembling), JitterKind::kNone);
}

TEST(JitterKinds, OnlyTheQuincunxAlternates) {
  EXPECT_TRUE(tools::alternates(pattern(tools::Jitter::kQuincunx, 8)));
  EXPECT_TRUE(tools::alternates(pattern(tools::Jitter::kQuincunxHalf, 8)));
  EXPECT_FALSE(tools::alternates(pattern(tools::Jitter::kHalton, 32)));
  EXPECT_FALSE(tools::alternates(pattern(tools::Jitter::kNone, 8)));
  EXPECT_FALSE(tools::alternates(pattern(tools::Jitter::kQuincunx, 1)));
}

class Advice : public testing::SequenceTest {
 protected:
  enum class Has { kNothing, kMotion, kMotionAndDepth };

  void write(Has has, tools::Jitter jitter, int last = 6) {
    for (int number = 1; number <= last; ++number) {
      testing::FrameFile file = frame(number);
      file.velocity = has != Has::kNothing;
      file.depth = has == Has::kMotionAndDepth;
      file.attributes[0] = {"quincunx:jitter", tools::jitter_of(jitter, number, {1, 1}, {2, 2})};
      write_frame(input(number), file);
    }
  }

  nlohmann::json listing(const std::string& arguments) {
    const auto result = resolve("'{}/f.%04d.exr' -n --json " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? nlohmann::json::parse(result.out) : nlohmann::json();
  }

  std::vector<std::string> warnings(const std::string& arguments) { return listing(arguments)["warnings"]; }

  void expect_warning(const std::string& arguments, const std::string& part) {
    const std::vector<std::string> said = warnings(arguments);
    ASSERT_EQ(said.size(), 1u) << arguments << ": " << nlohmann::json(said).dump();
    EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
  }
};

TEST_F(Advice, TheMethodFollowsFromWhatTheFramesOffer) {
  using tools::Jitter;
  const struct {
    Has has;
    Jitter jitter;
    const char* method;
    const char* why;
  } cases[] = {
      {Has::kMotionAndDepth, Jitter::kHalton, "temporal:balanced", "motion, depth and a jitter"},
      {Has::kMotionAndDepth, Jitter::kQuincunx, "temporal:balanced", "motion, depth and a jitter"},
      {Has::kMotionAndDepth, Jitter::kNone, "quincunx:reprojected", "but no jitter"},
      {Has::kMotion, Jitter::kHalton, "quincunx:velocity", "but no depth"},
      {Has::kMotion, Jitter::kNone, "catmull-rom", "neither depth nor a jitter"},
      {Has::kNothing, Jitter::kHalton, "catmull-rom", "no motion"},
  };
  for (const auto& one : cases) {
    write(one.has, one.jitter);
    const nlohmann::json said = listing("");
    EXPECT_EQ(said["method"], one.method);
    EXPECT_NE(said["method_reason"].get<std::string>().find(one.why), std::string::npos)
        << said["method_reason"];
    EXPECT_EQ(listing("--method point")["method_reason"], "");
  }
}

TEST_F(Advice, TheMethodIsSaidOnTheTerminalAndInTheReport) {
  write(Has::kMotion, tools::Jitter::kQuincunx, 2);
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --json");
  EXPECT_NE(result.err.find("method quincunx:velocity: motion and a jitter are known, but no depth"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["settings"]["method chosen"],
            "motion and a jitter are known, but no depth");
  const auto named = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --json --method quincunx");
  EXPECT_EQ(named.err, "");
  EXPECT_FALSE(nlohmann::json::parse(named.out)["settings"].contains("method chosen"));
}

TEST_F(Advice, EveryChunkTakesTheSameMethod) {
  write(Has::kMotionAndDepth, tools::Jitter::kHalton, 9);
  for (int number = 1; number <= 9; ++number)
    EXPECT_EQ(listing(fmt::format("--frames {}", number))["method"], "temporal:balanced") << number;
}

TEST_F(Advice, AJitterThatSuitsNeedsNoWord) {
  write(Has::kMotionAndDepth, tools::Jitter::kHalton);
  EXPECT_TRUE(warnings("--method temporal").empty());
  EXPECT_TRUE(warnings("--method temporal --jitter halton").empty());
  EXPECT_TRUE(warnings("--method bilinear --jitter none").empty());
  EXPECT_TRUE(warnings("--method quincunx --frames 1").empty());  // alone
  expect_warning("--method temporal --jitter none", "no jitter is known (--jitter): to temporal:balanced");
  expect_warning("--method temporal --jitter quincunx", "has but two or three places");
  expect_warning("--method quincunx", "is not half a pixel from that of the frame before");
  expect_warning("--method quincunx:reprojected --jitter none", "no jitter is known");
  EXPECT_TRUE(warnings("--method quincunx --jitter quincunx").empty());
}

TEST_F(Advice, NoMotionIsNamedWithTheCameraWhereItIsKnown) {
  write(Has::kNothing, tools::Jitter::kQuincunx);
  expect_warning("--method quincunx", "no motion is known (--velocity): frames are taken together");
  expect_warning("--method bilinear --blur 1", "nothing is blurred");
  for (int number = 1; number <= 2; ++number) {
    testing::FrameFile file = frame(number);
    file.velocity = false;
    file.attributes.push_back({"worldToNDC", tools::Matrix{}});
    write_frame(input(number), file);
  }
  expect_warning("--method quincunx --frames 1-2", "or --velocity camera if only the camera moves");
}

TEST_F(Advice, DwaIsNamedWithWhatItLoses) {
  for (const char* compression : {"zip", "dwaa", "dwab"}) {
    testing::ExrPart part = testing::simple_part({24, 14}, {"R", "G", "B", "backward.u", "backward.v"},
                                                 std::vector<float>(24 * 14 * 5));
    part.compression = compression;
    testing::write_exr_parts(input(1), {part});
    if (compression == std::string("zip")) {
      EXPECT_TRUE(warnings("--output 24x14 --method quincunx").empty());
      continue;
    }
    expect_warning("--output 24x14 --method quincunx",
                   input(1) +
                       "' is compressed with DWA, which loses something of "
                       "colour, and of motion and depth");
    expect_warning("--output 24x14 --method bilinear", "something of colour; render with ZIP");
  }
}

// The listing names alpha, data windows and the camera of the files, as the run understands them.
TEST_F(Advice, TheListingSaysWhatTheFramesAre) {
  const auto expect_said = [&](const testing::ExrPart& part, const std::string& what) {
    testing::write_exr_parts(input(1), {part});
    const auto result = resolve("'{}/f.%04d.exr' -n --output 24x14");
    EXPECT_NE(result.out.find("at most 24x14, half colour, " + what + "\n"), std::string::npos) << result.out;
  };
  testing::ExrPart part = testing::simple_part({24, 14}, {"R", "G", "B"}, std::vector<float>(24 * 14 * 3));
  expect_said(part, "opaque, camera not known");
  part.data = {-1, -2, {26, 18}};  // overscan
  part.pixels.resize(26 * 18 * 3);
  expect_said(part, "opaque, camera not known");
  part.data = {1, 0, {24, 14}};  // which leaves the left column open
  expect_said(part, "with alpha, camera not known");
  part.data = part.display;
  part.channels.emplace_back("A");
  part.types.push_back(Imf::HALF);
  part.pixels.resize(24 * 14 * 4);
  expect_said(part, "with alpha, camera not known");
  testing::FrameFile file = frame(1);
  file.attributes.push_back({"worldToNDC", tools::Matrix{}});
  write_frame(input(1), file);
  const auto said = listing("");
  EXPECT_EQ(said["opaque"], false);
  EXPECT_EQ(said["camera_known"], true);
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --json");
  EXPECT_EQ(nlohmann::json::parse(result.out)["settings"]["frames are"],
            "at most 24x14, half colour, with alpha, camera known");
}

TEST_F(Advice, SizesThatNobodyPlannedAreNamed) {
  write(Has::kNothing, tools::Jitter::kNone, 1);  // 24x14
  EXPECT_TRUE(warnings("").empty());              // 34x20, as the frames ask
  EXPECT_TRUE(warnings("--output 48x28").empty());
  EXPECT_TRUE(warnings("--output 36x21").empty());
  EXPECT_TRUE(warnings("--output 1920x1080").empty());  // 24.9x14
  expect_warning("--output 48x36",
                 "frame 1 is 24x14 pixels and the output 48x36: the picture is stretched; 48x28");
  expect_warning("--output 12x7", "the output, 12x7, is smaller than frame 1, 24x14");
  testing::FrameFile large = frame(1);  // which asks for 34x20 itself
  large.extent = {50, 20};
  write_frame(input(1), large);
  EXPECT_TRUE(warnings("").empty());
}

}  // namespace
}  // namespace quincunx
