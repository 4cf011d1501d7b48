// SPDX-License-Identifier: MIT
// One file as the library wants it: which bits arrive.
#include "tools/sequence/sequence_reader.h"

#include <gtest/gtest.h>

#include <cstring>

#include "sequence_fixture.h"
#include "tools/exr_files.h"

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
    std::vector<Texel> texels(frame.colour.size() / sizeof(Texel));
    std::memcpy(texels.data(), frame.colour.data(), frame.colour.size());
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
  format.channels.velocity = kBackwardChannels;
  format.channels.depth = "Z";
  format.channels.reactive = "reactive.mask";
  format.near_plane = 0.5f;
  const SequenceFrame got = read(format, file.extent, PixelFormat::kRGBA32F);
  const auto colour = texels_of<float>(got);
  const auto width = static_cast<float>(file.extent.width);
  const auto height = static_cast<float>(file.extent.height);
  const LoadedImage stored = image(input(1));
  ASSERT_EQ(got.velocity.size(), static_cast<std::size_t>(file.extent.area()));
  for (int y = 0; y < file.extent.height; ++y) {
    for (int x = 0; x < file.extent.width; ++x) {
      const auto i = static_cast<std::size_t>(y * file.extent.width + x);
      const auto value = [&](const char* name) { return stored.at(x, y, stored.channel(name)); };
      ASSERT_EQ(colour[4 * i + 1], value("G"));
      ASSERT_EQ(colour[4 * i + 3], value("A"));
      ASSERT_EQ(got.velocity[i], (Vec2{-value("backward.u") / width, value("backward.v") / height}));
      ASSERT_EQ(got.depth[i], 0.5f / value("Z"));
      ASSERT_EQ(got.reactive[i], static_cast<int>(value("reactive.mask") * 255 + 0.5f));
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
  format.channels.reactive = "reactive.mask";
  const SequenceFrame frame = read(format, extent);
  for (std::size_t i = 0; i < 256; ++i)
    ASSERT_EQ(frame.reactive[i], i);
}

// The first read fills the memory with other values, which must not shine through.
TEST_F(ReadFrame, OutsideTheDataWindowThereIsNothing) {
  testing::ExrPart part =
      testing::simple_part({2, 1}, {"R", "G", "B", "A", "u", "v", "Z"}, std::vector<float>(14, 2.0f));
  part.display = {0, 0, {4, 3}};
  part.data = {1, 1, {2, 1}};
  SequenceFormat format;
  format.motion = MotionSource::kChannels;
  format.channels.velocity = {"u", "v"};
  format.units = {VelocityConvention::kScale, {1, 1}};
  format.channels.depth = "Z";
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
    EXPECT_EQ(frame.velocity[i].x, covered ? 2.0f : 0.0f) << i;
    EXPECT_EQ(frame.depth[i], covered ? 0.5f : 0.0f) << i;
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
  format.channels.velocity = {"motion.X", "motion.Y"};
  format.units = {VelocityConvention::kFsr2, {}};
  const SequenceFrame frame = read(format, {20, 10});
  EXPECT_EQ(texels_of<std::uint16_t>(frame), std::vector<std::uint16_t>(800, kOneHalf));
  for (const Vec2& velocity : frame.velocity)
    ASSERT_EQ(velocity, (Vec2{-5.0f / 20, -5.0f / 10}));
}

TEST_F(ReadFrame, KeepsWhatHoldsForTheResolvedFrameToo) {
  testing::FrameFile file = frame(1);
  Matrix matrix = {};
  matrix[5] = 3;
  file.attributes.push_back({"worldToNDC", matrix});
  file.attributes.push_back({"FramesPerSecond", Rational{24000, 1001}});
  write_frame(input(1), file);
  const SequenceFrame got = read({}, file.extent);
  ASSERT_TRUE(got.world_to_ndc);
  EXPECT_EQ(*got.world_to_ndc, matrix);
  bool rate = false;
  for (const Attribute& attribute : got.kept) {
    rate |= attribute.name == "FramesPerSecond" && attribute.value == AttributeValue(Rational{24000, 1001});
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
}  // namespace quincunx::tools
