// SPDX-License-Identifier: MIT
// One file as the library wants it: which bits arrive.
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequence_fixture.h"
#include "tools/exr_files.h"
#include "tools/program/jitter.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {
namespace {

constexpr std::uint16_t kOneHalf = 0x3c00;

class ReadFrame : public testing::SequenceTest {
 protected:
  SequenceFrame read(const SequenceFormat& format, Extent extent,
                     PixelFormat colour = PixelFormat::kRGBA16F) {
    SequenceFrame frame;
    const Status status = read_frame(input(1), format, {.number = 1, .render = extent}, colour, frame);
    EXPECT_TRUE(status.ok()) << status.message();
    return frame;
  }

  template <typename Texel>
  static std::vector<Texel> texels_of(const SequenceFrame& frame) {
    std::vector<Texel> texels(frame.texels[InputPlane::kColour].size() / sizeof(Texel));
    std::memcpy(texels.data(), frame.texels[InputPlane::kColour].data(),
                frame.texels[InputPlane::kColour].size());
    return texels;
  }
};

// Every half there is, NaNs and infinities too.
TEST_F(ReadFrame, HalvesStayBitForBit) {
  const Extent extent{128, 128};
  std::vector<std::uint16_t> halves(65536);
  for (std::size_t i = 0; i < halves.size(); ++i)
    halves[i] = static_cast<std::uint16_t>(i);
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < 4; ++c)
    channels.push_back({.name = std::string(1, "RGBA"[c]), .data = halves.data() + c, .pixel_stride = 8});
  ASSERT_TRUE(write_exr(input(1), extent, channels).ok());
  EXPECT_EQ(texels_of<std::uint16_t>(read({}, extent)), halves);
}

TEST_F(ReadFrame, AlphaThatIsNotThereIsOne) {
  testing::FrameFile file = frame(1);
  file.alpha = file.velocity = false;
  write_frame(input(1), file);
  const auto halves = texels_of<std::uint16_t>(read({}, file.extent));
  const auto floats = texels_of<float>(read({}, file.extent, PixelFormat::kRGBA32F));
  for (std::size_t i = 3; i < halves.size(); i += 4) {
    ASSERT_EQ(halves[i], kOneHalf);
    ASSERT_EQ(floats[i], 1.0f);
  }
}

TEST_F(ReadFrame, EachKindOfValueGoesToItsPlane) {
  testing::FrameFile file = frame(1);
  file.depth = file.reactive = true;
  file.colour = ChannelType::kFloat;
  write_frame(input(1), file);
  SequenceFormat format;
  format.motion = MotionSource::kChannels;
  format.channels[InputPlane::kVelocity] = kBackwardChannels;
  format.channels[InputPlane::kDepth] = {"Z"};
  format.channels[InputPlane::kReactive] = {"reactive.mask"};
  format.near_plane = 0.5f;
  const SequenceFrame got = read(format, file.extent, PixelFormat::kRGBA32F);
  const auto colour = texels_of<float>(got);
  const auto width = static_cast<float>(file.extent.width);
  const auto height = static_cast<float>(file.extent.height);
  const LoadedImage stored = image(input(1));
  ASSERT_EQ(got.velocity().size(), static_cast<std::size_t>(file.extent.area()));
  for (int y = 0; y < file.extent.height; ++y) {
    for (int x = 0; x < file.extent.width; ++x) {
      const auto i = static_cast<std::size_t>(y * file.extent.width + x);
      const auto value = [&](const char* name) { return stored.at(x, y, stored.channel(name)); };
      ASSERT_EQ(colour[4 * i + 1], value("G"));
      ASSERT_EQ(colour[4 * i + 3], value("A"));
      ASSERT_EQ(got.velocity()[i], (Vec2{-value("backward.u") / width, value("backward.v") / height}));
      ASSERT_EQ(got.depth()[i], 0.5f / value("Z"));
      ASSERT_EQ(std::to_integer<int>(got.texels[InputPlane::kReactive][i]),
                static_cast<int>(value("reactive.mask") * 255 + 0.5f));
    }
  }
}

TEST_F(ReadFrame, JitterIsTakenOutOfMotion) {
  testing::FrameFile file = frame(1);
  write_frame(input(1), file);
  SequenceFormat format;
  format.motion = MotionSource::kChannels;
  format.channels[InputPlane::kVelocity] = kBackwardChannels;
  const SequenceFrame read_once = read(format, file.extent);
  const std::vector<Vec2> jittered(read_once.velocity().begin(), read_once.velocity().end());
  format.units.jittered = true;
  SequenceFrame got;
  const ScannedFrame scanned = {
      .number = 1, .render = file.extent, .jitter_since = {.25f, -.125f}, .jitter_until = {-.5f, .0625f}};
  for (const bool to_next : {false, true}) {
    format.units.to_next = to_next;
    const Vec2 step = to_next ? scanned.jitter_until : scanned.jitter_since;
    const float turned = to_next ? -1 : 1;
    ASSERT_TRUE(read_frame(input(1), format, scanned, PixelFormat::kRGBA16F, got).ok());
    for (std::size_t i = 0; i < jittered.size(); ++i) {
      const Vec2 v = {turned * jittered[i].x, turned * jittered[i].y};
      ASSERT_EQ(got.velocity()[i], (Vec2{v.x + step.x, v.y + step.y})) << i;
    }
  }
}

// R8 values are written as k / 255 in half and must come back as k.
TEST_F(ReadFrame, ReactiveCodesReturn) {
  const Extent extent{16, 16};
  std::vector<float> zero(256);
  std::vector<float> mask(256);
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask[i] = static_cast<float>(i) / 255.0f;
  std::vector<Channel> channels;
  for (const char* name : {"R", "G", "B"})
    channels.push_back({.name = name, .type = ChannelType::kFloat, .data = zero.data()});
  channels.push_back({.name = "reactive.mask", .type = ChannelType::kFloat, .data = mask.data()});
  ASSERT_TRUE(write_exr(input(1), extent, channels).ok());
  SequenceFormat format;
  format.channels[InputPlane::kReactive] = {"reactive.mask"};
  const SequenceFrame frame = read(format, extent);
  for (std::size_t i = 0; i < 256; ++i)
    ASSERT_EQ(std::to_integer<std::size_t>(frame.texels[InputPlane::kReactive][i]), i);
}

// The first read fills the memory with other values, which must not shine through.
TEST_F(ReadFrame, OutsideTheDataWindowThereIsNothing) {
  testing::ExrPart part =
      testing::simple_part({2, 1}, {"R", "G", "B", "A", "u", "v", "Z"}, std::vector<float>(14, 2.0f));
  part.display = {0, 0, {4, 3}};
  part.data = {1, 1, {2, 1}};
  SequenceFormat format;
  format.motion = MotionSource::kChannels;
  format.channels[InputPlane::kVelocity] = {"u", "v"};
  format.units = {VelocityConvention::kScale, {1, 1}};
  format.channels[InputPlane::kDepth] = {"Z"};
  format.near_plane = 1;
  testing::ExrPart full = testing::simple_part({4, 3}, part.channels, std::vector<float>(84, 3.0f));
  SequenceFrame frame;
  for (const testing::ExrPart& file : {full, part}) {
    testing::write_exr_parts(input(1), {file});
    ASSERT_TRUE(
        read_frame(input(1), format, {.number = 1, .render = {4, 3}}, PixelFormat::kRGBA32F, frame).ok());
  }
  const auto colour = texels_of<float>(frame);
  for (std::size_t i = 0; i < 12; ++i) {
    const bool covered = i == 5 || i == 6;
    EXPECT_EQ(colour[4 * i], covered ? 2.0f : 0.0f) << i;
    EXPECT_EQ(colour[4 * i + 3], covered ? 2.0f : 0.0f) << i;
    EXPECT_EQ(frame.velocity()[i].x, covered ? 2.0f : 0.0f) << i;
    EXPECT_EQ(frame.depth()[i], covered ? 0.5f : 0.0f) << i;
  }
}

TEST_F(ReadFrame, SeveralPartsAndTiles) {
  testing::ExrPart beauty = testing::simple_part({20, 10}, {"R", "G", "B"}, std::vector<float>(600, 1.0f));
  beauty.name = "beauty";
  beauty.tile = 16;
  testing::ExrPart motion = testing::simple_part({20, 10}, {"X", "Y"}, std::vector<float>(400, 5.0f));
  motion.name = "motion";
  motion.tile = 16;
  testing::write_exr_parts(input(1), {beauty, motion});
  SequenceFormat format;
  format.motion = MotionSource::kChannels;
  format.channels[InputPlane::kVelocity] = {"motion.X", "motion.Y"};
  format.units = {VelocityConvention::kFsr2, {}};
  const SequenceFrame frame = read(format, {20, 10});
  EXPECT_EQ(texels_of<std::uint16_t>(frame), std::vector<std::uint16_t>(800, kOneHalf));
  for (const Vec2& velocity : frame.velocity())
    ASSERT_EQ(velocity, (Vec2{-5.0f / 20, -5.0f / 10}));
}

TEST_F(ReadFrame, KeepsWhatHoldsForTheResolvedFrameToo) {
  testing::FrameFile file = frame(1);
  Matrix matrix = {};
  matrix[5] = 3;
  file.attributes.push_back({"worldToNDC", matrix});
  file.attributes.push_back({"framesPerSecond", Rational{24000, 1001}});
  write_frame(input(1), file);
  const SequenceFrame got = read({}, file.extent);
  ASSERT_TRUE(got.world_to_ndc);
  EXPECT_EQ(*got.world_to_ndc, matrix);
  bool rate = false;
  for (const Attribute& attribute : got.kept) {
    rate |= attribute.name == "framesPerSecond" && attribute.value == AttributeValue(Rational{24000, 1001});
    EXPECT_NE(attribute.name, "quincunx:jitter");  // which the resolve takes out
  }
  EXPECT_TRUE(rate);
}

TEST_F(ReadFrame, AFileThatChangedMeanwhileIsRefused) {
  write_frame(input(1), frame(1));
  SequenceFrame into;
  const Status status =
      read_frame(input(1), {}, {.number = 1, .render = {5, 5}}, PixelFormat::kRGBA16F, into);
  EXPECT_NE(status.message().find("changed"), std::string::npos) << status.message();
}

}  // namespace

// Faults that show only in the pixels: motion that a renderer did not write, a sky that should have some.

namespace {

constexpr Extent kExtent = {64, 48};

ResolvePlan plan(SkyMotion far = SkyMotion::kAsDrawn) {
  ResolveSettings settings;
  settings.method = Method::kTemporal;
  settings.output_extent = settings.target_extent = {128, 96};
  settings.colour = PixelFormat::kRGBA32F;
  settings.conventions.sky_motion = far;
  return plan_for({}, settings).value();
}

// A white square of 20 pixels with its upper left corner there, before black stripes that are finer than a pixel.
SequenceFrame square(std::int64_t number, Vec2 at, Vec2 jitter, Vec2 motion = {}) {
  SequenceFrame frame;
  frame.number = number;
  frame.render = kExtent;
  frame.texels[InputPlane::kVelocity].resize(static_cast<std::size_t>(kExtent.area()) * sizeof(Vec2));
  frame.velocity()[77] = motion;
  std::vector<float> colour;
  for (int y = 0; y < kExtent.height; ++y) {
    for (int x = 0; x < kExtent.width; ++x) {
      const float px = static_cast<float>(x) + .5f + jitter.x, py = static_cast<float>(y) + .5f + jitter.y;
      const bool inside = px >= at.x && px < at.x + 20 && py >= at.y && py < at.y + 20;
      const float value = inside ? 1e6f : std::sin(px * 9.7f + py) > 0 ? .2f : 0;
      colour.insert(colour.end(), {value, value, value, 1});
    }
  }
  frame.texels[InputPlane::kColour].resize(colour.size() * sizeof(float));
  std::memcpy(frame.texels[InputPlane::kColour].data(), colour.data(),
              frame.texels[InputPlane::kColour].size());
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
        watch.see(square(i, {15.6f, 16.3f}, jitter_of(Jitter::kHalton, i, {1, 1}, {2, 2})), i == 0).empty())
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
    std::memcpy(frame.texels[InputPlane::kColour].data() + 4 * sizeof(float) * static_cast<std::size_t>(i),
                odd, sizeof odd);
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

std::vector<std::string> said_of_sky(double degrees, Vec2 motion, float depth, SkyMotion far) {
  SequenceWatch watch(plan(far), 1);
  std::vector<std::string> said;
  for (int i = 0; i < 4; ++i) {
    SequenceFrame frame = square(i, {16, 16}, {});
    std::ranges::fill(frame.velocity(), motion);
    frame.velocity()[0] = {.5f, 0};  // something moves
    frame.texels[InputPlane::kDepth].resize(frame.velocity().size() * sizeof(float));
    std::ranges::fill(frame.depth(), depth);
    frame.world_to_ndc = camera(degrees * i);
    const auto now = watch.see(frame, i == 0);
    said.insert(said.end(), now.begin(), now.end());
  }
  return said;
}

TEST(Watch, ASkyThatStandsStillBeforeATurningCameraIsNamedOnce) {
  const auto said = said_of_sky(2, {}, 0, SkyMotion::kAsDrawn);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0],
            "the sky of frame 1 has a motion of 0, although the camera turns: --sky-motion camera moves it");
  EXPECT_TRUE(said_of_sky(0, {}, 0, SkyMotion::kAsDrawn).empty()) << "the camera does not turn";
  EXPECT_TRUE(said_of_sky(2, {.01f, 0}, 0, SkyMotion::kAsDrawn).empty()) << "the sky has motion";
  EXPECT_TRUE(said_of_sky(2, {}, .1f, SkyMotion::kAsDrawn).empty()) << "there is no sky";
  EXPECT_TRUE(said_of_sky(2, {}, 0, SkyMotion::kCamera).empty()) << "it is moved already";
}

class WatchedRun : public testing::SequenceTest {};

// From file to terminal and report.
TEST_F(WatchedRun, SaysWhatThePixelsTell) {
  for (int number = 1; number <= 3; ++number) {
    const SequenceFrame picture = square(number, {4 + 8.0f * static_cast<float>(number), 12}, {});
    std::vector<float> colour(picture.texels[InputPlane::kColour].size() / sizeof(float)),
        still(colour.size());
    std::memcpy(colour.data(), picture.texels[InputPlane::kColour].data(),
                picture.texels[InputPlane::kColour].size());
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
