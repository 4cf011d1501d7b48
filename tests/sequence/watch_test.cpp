// SPDX-License-Identifier: MIT
// What shows only in the pixels: motion that a renderer did not write, a sky that should have some.
#include "tools/sequence/sequence_watch.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "sequence_fixture.h"
#include "tools/program/jitter.h"

namespace quincunx::tools {
namespace {

constexpr Extent kExtent = {64, 48};

ResolvePlan plan(FarMotion far = FarMotion::kAsDrawn) {
  ResolveSettings settings;
  settings.method = Method::kTemporal;
  settings.output = settings.target = {128, 96};
  settings.colour = PixelFormat::kRGBA32F;
  settings.far = far;
  return plan_for({}, settings).value();
}

// A white square of 20 pixels with its upper left corner there, before black stripes that are finer than a pixel.
SequenceFrame square(std::int64_t number, Vec2 at, Vec2 jitter, Vec2 motion = {}) {
  SequenceFrame frame;
  frame.number = number;
  frame.render = kExtent;
  frame.velocity.assign(static_cast<std::size_t>(kExtent.area()), Vec2{});
  frame.velocity[77] = motion;
  std::vector<float> colour;
  for (int y = 0; y < kExtent.height; ++y) {
    for (int x = 0; x < kExtent.width; ++x) {
      const float px = static_cast<float>(x) + .5f + jitter.x, py = static_cast<float>(y) + .5f + jitter.y;
      const bool inside = px >= at.x && px < at.x + 20 && py >= at.y && py < at.y + 20;
      const float value = inside ? 1e6f : std::sin(px * 9.7f + py) > 0 ? .2f : 0;
      colour.insert(colour.end(), {value, value, value, 1});
    }
  }
  frame.colour.resize(colour.size() * sizeof(float));
  std::memcpy(frame.colour.data(), colour.data(), frame.colour.size());
  return frame;
}

TEST(Watch, APictureThatMovesWithoutMotionIsNamedOnce) {
  SequenceWatch watch(plan(), 1);
  std::vector<std::string> said;
  for (int i = 0; i < 12; ++i) {
    const auto now = watch.see(square(i, {10 + 1.5f * static_cast<float>(i), 12}, {}), i == 0);
    said.insert(said.end(), now.begin(), now.end());
  }
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("motion is 0 in every pixel of frames 0 to "), std::string::npos) << said[0];
}

// Stripes finer than a sample flicker with the jitter, and edges step; that is no motion.
TEST(Watch, AStillPictureWithJitterIsNot) {
  SequenceWatch watch(plan(), 1);
  for (int i = 0; i < 64; ++i)
    EXPECT_TRUE(
        watch.see(square(i, {15.6f, 16.3f}, jitter_of(Jitter::kHalton, i, {.5f, .5f})), i == 0).empty())
        << i;
}

TEST(Watch, NeitherIsOneWithMotionNorOneAfterACut) {
  SequenceWatch moving(plan(), 1), cut(plan(), 1);
  for (int i = 0; i < 12; ++i) {
    const Vec2 at = {10 + 1.5f * static_cast<float>(i), 12};
    EXPECT_TRUE(moving.see(square(i, at, {}, {i > 0 ? .01f : 0, 0}), i == 0).empty());
    EXPECT_TRUE(cut.see(square(i, at, {}), true).empty());
  }
}

TEST(Watch, ValuesThatAreNotFiniteDoNoHarm) {
  SequenceWatch watch(plan(), 1);
  for (int i = 0; i < 3; ++i) {
    SequenceFrame frame = square(i, {16, 16}, {});
    const float odd[] = {std::nanf(""), std::numeric_limits<float>::infinity(), -1};
    std::memcpy(frame.colour.data() + 4 * sizeof(float) * static_cast<std::size_t>(i), odd, sizeof odd);
    EXPECT_TRUE(watch.see(frame, i == 0).empty());
  }
}

// A camera that looks along -z with a field of 90 degrees, turned by so many degrees about the vertical axis.
Matrix camera(double degrees) {
  const double angle = degrees * 3.14159265358979 / 180;
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  Matrix m = {};
  m[0] = c, m[8] = s;
  m[5] = 1;
  m[3] = s, m[11] = -c;
  m[14] = 1;
  return m;
}

std::vector<std::string> said_of_sky(double degrees, Vec2 motion, float depth, FarMotion far) {
  SequenceWatch watch(plan(far), 1);
  std::vector<std::string> said;
  for (int i = 0; i < 4; ++i) {
    SequenceFrame frame = square(i, {16, 16}, {});
    frame.velocity.assign(frame.velocity.size(), motion);
    frame.velocity[0] = {.5f, 0};  // something moves
    frame.depth.assign(frame.velocity.size(), depth);
    frame.world_to_ndc = camera(degrees * i);
    const auto now = watch.see(frame, i == 0);
    said.insert(said.end(), now.begin(), now.end());
  }
  return said;
}

TEST(Watch, ASkyThatStandsStillBeforeATurningCameraIsNamedOnce) {
  const auto said = said_of_sky(2, {}, 0, FarMotion::kAsDrawn);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0],
            "the sky of frame 1 has a motion of 0, although the camera turns: --far camera moves it");
  EXPECT_TRUE(said_of_sky(0, {}, 0, FarMotion::kAsDrawn).empty()) << "the camera does not turn";
  EXPECT_TRUE(said_of_sky(2, {.01f, 0}, 0, FarMotion::kAsDrawn).empty()) << "the sky has motion";
  EXPECT_TRUE(said_of_sky(2, {}, .1f, FarMotion::kAsDrawn).empty()) << "there is no sky";
  EXPECT_TRUE(said_of_sky(2, {}, 0, FarMotion::kCamera).empty()) << "it is moved already";
}

class WatchedRun : public testing::SequenceTest {};

// From file to terminal and report.
TEST_F(WatchedRun, SaysWhatThePixelsTell) {
  for (int number = 1; number <= 3; ++number) {
    const SequenceFrame picture = square(number, {4 + 8.0f * static_cast<float>(number), 12}, {});
    std::vector<float> colour(picture.colour.size() / sizeof(float)), still(colour.size());
    std::memcpy(colour.data(), picture.colour.data(), picture.colour.size());
    std::vector<Channel> channels;
    for (std::size_t c = 0; c < 3; ++c) {
      channels.push_back({.name = std::string(1, "RGB"[c]),
                          .type = ChannelType::kFloat,
                          .data = colour.data() + c,
                          .pixel_stride = 4 * sizeof(float)});
    }
    for (const std::string& name : kBackwardChannels)
      channels.push_back({.name = name, .type = ChannelType::kFloat, .data = still.data()});
    ASSERT_TRUE(write_exr(input(number), kExtent, channels).ok());
  }
  const auto result = resolve(
      "'{}/f.%04d.exr' --out '{}/u.%04d.exr' --output 128x96 --method quincunx --jitter quincunx --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("warning: motion is 0 in every pixel of frames 1 to 2"), std::string::npos)
      << result.err;
  const auto said = nlohmann::json::parse(result.out)["warnings"];
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].get<std::string>().rfind("motion is 0 in every pixel of frames 1 to 2", 0), 0u);
}

}  // namespace
}  // namespace quincunx::tools
