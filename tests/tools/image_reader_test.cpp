// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <fstream>

#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include "exr_files.h"
#include "temporary_folder.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/image/image_reader.h"

namespace quincunx::tools {
namespace {

using testing::ExrPart;
using testing::simple_part;
using testing::write_exr_parts;

constexpr float kUntouched = -7;

// Values that every half and float holds: distinct for each pixel and channel.
std::vector<float> ramp(std::int64_t count, float first) {
  std::vector<float> values;
  for (std::int64_t i = 0; i < count; ++i)
    values.push_back(first + static_cast<float>(i % 1500));
  return values;
}

// Channel `name` of the display window as floats.
std::vector<float> channel(ImageReader& reader, const std::string& name) {
  const auto place = reader.header().find(name);
  EXPECT_TRUE(place) << name;
  if (!place) return {};
  const Extent extent = reader.header().parts[place->part].display.extent;
  std::vector<float> values(extent.area(), kUntouched);
  const ChannelTarget target = {*place, ChannelType::kFloat, values.data(), sizeof(float),
                                sizeof(float) * extent.width};
  const Status status = reader.read({&target, 1});
  EXPECT_TRUE(status.ok()) << status.message();
  return values;
}

std::vector<float> every(std::size_t step, std::size_t first, const std::vector<float>& values) {
  std::vector<float> result;
  for (std::size_t i = first; i < values.size(); i += step)
    result.push_back(values[i]);
  return result;
}

class Reading : public ::testing::Test {
 protected:
  ImageReader open(const std::vector<ExrPart>& parts) {
    write_exr_parts(folder_.file("a.exr"), parts);
    auto reader = ImageReader::open(folder_.file("a.exr"));
    EXPECT_TRUE(reader.ok()) << reader.status().message();
    return std::move(reader).value();
  }

  testing::TemporaryFolder folder_;
};

// More rows than a band, and a block of 256 lines, which bands cut through.
TEST_F(Reading, EveryChannelOfLongFilesInAnyCompression) {
  const Extent extent{7, 300};
  for (const char* compression : {"none", "rle", "zips", "zip", "piz", "dwab"}) {
    ExrPart part = simple_part(extent, {"R", "G", "B", "Z"}, ramp(extent.area() * 4, 0));
    part.types[3] = Imf::FLOAT;
    part.compression = compression;
    ImageReader reader = open({part});
    for (std::size_t c = 0; c < 4; ++c) {
      const bool lossy = std::string(compression) == "dwab" && c < 3;
      const std::vector<float> values = channel(reader, part.channels[c]);
      EXPECT_TRUE(lossy || values == every(4, c, part.pixels)) << compression << " " << c;
    }
  }
}

TEST_F(Reading, SeveralChannelsAtOnceKeepTheirTypes) {
  const Extent extent{5, 70};
  ExrPart part = simple_part(extent, {"R", "G", "B", "A", "u", "v"}, ramp(extent.area() * 6, 1));
  part.types[4] = part.types[5] = Imf::FLOAT;
  ImageReader reader = open({part});
  const auto pixels = static_cast<std::size_t>(extent.area());
  std::vector<std::uint16_t> colour(pixels * 4);
  std::vector<float> motion(pixels * 2);
  std::vector<ChannelTarget> targets;
  for (std::size_t c = 0; c < 4; ++c)
    targets.push_back(
        {*reader.header().find(part.channels[c]), ChannelType::kHalf, colour.data() + c, 8, 40});
  for (std::size_t c = 0; c < 2; ++c)
    targets.push_back(
        {*reader.header().find(part.channels[4 + c]), ChannelType::kFloat, motion.data() + c, 8, 40});
  ASSERT_TRUE(reader.read(targets).ok());
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      // The ramp holds small integers: a half's exponent and mantissa by frexp.
      const float value = part.pixels[i * 6 + c];
      int exponent = 0;
      const float mantissa = std::frexp(value, &exponent);
      const auto bits =
          value == 0 ? 0 : ((exponent + 14) << 10) + static_cast<int>((mantissa * 2 - 1) * 1024);
      ASSERT_EQ(colour[i * 4 + c], bits) << value;
    }
    ASSERT_EQ(motion[i * 2], part.pixels[i * 6 + 4]);
    ASSERT_EQ(motion[i * 2 + 1], part.pixels[i * 6 + 5]);
  }
}

TEST_F(Reading, Tiles) {
  const Extent extent{37, 150};
  ExrPart part = simple_part(extent, {"R", "G", "B"}, ramp(extent.area() * 3, 0));
  part.tile = 16;
  ImageReader reader = open({part});
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_EQ(channel(reader, part.channels[c]), every(3, c, part.pixels));
}

TEST_F(Reading, PartsAreFoundByChannelAndByPartAndChannel) {
  ExrPart beauty = simple_part({4, 3}, {"R", "G", "B"}, ramp(36, 0));
  beauty.name = "beauty";
  ExrPart motion = simple_part({4, 3}, {"X", "Y"}, ramp(24, 100));
  motion.name = "motion";
  ImageReader reader = open({beauty, motion});
  EXPECT_EQ(channel(reader, "G"), every(3, 1, beauty.pixels));
  EXPECT_EQ(channel(reader, "Y"), every(2, 1, motion.pixels));
  EXPECT_EQ(channel(reader, "motion.X"), every(2, 0, motion.pixels));
  EXPECT_FALSE(reader.header().find("beauty.X"));
  EXPECT_FALSE(reader.header().find("motion"));
  EXPECT_EQ(reader.header().channel_names(), "beauty.R, beauty.G, beauty.B, motion.X, motion.Y");
}

TEST_F(Reading, FlatPartsAmongDeepOnesAndMipmaps) {
  ExrPart deep = simple_part({20, 18}, {"R", "G", "B", "A"}, {});
  deep.name = "deep", deep.deep = true;
  ExrPart tiles = simple_part({20, 18}, {"R", "G"}, ramp(720, 3));
  tiles.name = "tiles", tiles.tile = 8, tiles.mipmaps = true;
  ExrPart flat = simple_part({9, 7}, {"R", "Z"}, ramp(126, 500));  // with another data window
  flat.name = "flat", flat.data = {5, 4, {9, 7}}, flat.display = deep.display;
  ImageReader reader = open({deep, tiles, flat});
  EXPECT_TRUE(check_whole(folder_.file("a.exr")).ok());
  EXPECT_TRUE(reader.header().parts[0].deep);
  EXPECT_FALSE(reader.header().parts[1].deep || reader.header().parts[2].deep);
  EXPECT_EQ(channel(reader, "tiles.G"), every(2, 1, tiles.pixels));
  const std::vector<float> values = channel(reader, "flat.R");
  EXPECT_EQ(values[4 * 20 + 5], flat.pixels[0]);
  EXPECT_EQ(values[0], kUntouched);
}

TEST_F(Reading, ViewsAndAttributesOfEachPart) {
  ExrPart left = simple_part({2, 2}, {"R"}, ramp(4, 0)), right = left;
  left.name = "left", right.name = "right";
  left.view = "L", right.view = "R";
  EXPECT_EQ(open({left, right}).header().parts[1].view, "R");
  ExrPart both = simple_part({2, 2}, {"R", "b.R"}, ramp(8, 0));
  both.views = {"a", "b"};
  EXPECT_EQ(open({both}).header().views, both.views);
  EXPECT_EQ(open({left, right}).header().views, std::vector<std::string>());
}

// Cropped on two sides and reaching over the other two.
TEST_F(Reading, ADataWindowThatIsNotTheDisplayWindow) {
  for (const int tile : {0, 16}) {
    ExrPart part = simple_part({6, 90}, {"R"}, ramp(540, 0));
    part.data = {12, 23, {6, 90}};
    part.display = {10, 20, {5, 100}};
    part.tile = tile;
    ImageReader reader = open({part});
    const std::vector<float> values = channel(reader, "R");
    ASSERT_EQ(values.size(), 500u);
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 5; ++x) {
        const bool covered = x >= 2 && y >= 3 && y < 93;
        const float wanted = covered ? part.pixels[(y - 3) * 6 + x - 2] : kUntouched;
        ASSERT_EQ(values[y * 5 + x], wanted) << x << " " << y;
      }
    }
  }
}

TEST_F(Reading, WhatCannotBeUsedIsSaidInTheHeader) {
  ExrPart part = simple_part({2, 2}, {"R", "id"}, ramp(8, 0));
  part.types[1] = Imf::UINT;
  const ImageReader reader = open({part});
  EXPECT_FALSE(reader.header().parts[0].channels[0].integer);
  EXPECT_TRUE(reader.header().parts[0].channels[1].integer);
  testing::write_deep_exr(folder_.file("deep.exr"), {3, 2});
  const auto deep = ImageReader::open(folder_.file("deep.exr"));
  ASSERT_TRUE(deep.ok()) << deep.status().message();
  EXPECT_TRUE(deep->header().parts[0].deep);
}

TEST_F(Reading, SubsampledChannelsAreToldAtOnce) {
  Imf::Header header(4, 4);
  std::vector<half> texels(4);
  Imf::FrameBuffer buffer;
  for (const char* name : {"BY", "RY"}) {
    header.channels().insert(name, Imf::Channel(Imf::HALF, 2, 2));
    buffer.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(texels.data()), 2, 4, 2, 2));
  }
  {
    Imf::OutputFile file(folder_.file("a.exr").c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(4);
  }
  const auto reader = ImageReader::open(folder_.file("a.exr"));
  if (reader.ok()) {
    EXPECT_EQ(reader->header().parts[0].channels[0].sampling, (std::array<int, 2>{2, 2}));
  } else {
    const std::string message = reader.status().message();
    EXPECT_NE(message.find("ubsampled"), std::string::npos) << message;
    EXPECT_TRUE(message.ends_with("; render it at full size")) << message;
  }
}

// Whatever another program has remarked in an EXR, its colour is linear and multiplied by alpha.
TEST_F(Reading, AttributesOfALibraryLeaveTheColourOfAnExrAsItIs) {
  Imf::Header header(1, 1);
  header.insert("oiio:ColorSpace", Imf::StringAttribute("sRGB"));
  header.insert("oiio:UnassociatedAlpha", Imf::IntAttribute(1));
  for (const char* name : {"R", "G", "B", "A"})
    header.channels().insert(name, Imf::Channel(Imf::HALF));
  Imf::OutputFile(folder_.file("a.exr").c_str(), header);
  const auto reader = ImageReader::open(folder_.file("a.exr"));
  ASSERT_TRUE(reader.ok()) << reader.status().message();
  EXPECT_EQ(reader->header().parts[0].colour_space, "linear");
  EXPECT_FALSE(reader->header().parts[0].straight_alpha);
}

TEST_F(Reading, AttributesOfSeveralTypesReturn) {
  const float red = 1;
  const Channel channels[] = {{.name = "R", .type = ChannelType::kFloat, .data = &red}};
  const Chromaticities primaries = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
  const Attribute attributes[] = {
      {"jitter", Vec2{0.25f, -0.5f}}, {"chromaticities", primaries}, {"note", std::string("x y")}};
  ASSERT_TRUE(write_exr(folder_.file("a.exr"), {1, 1}, channels, attributes).ok());
  const auto reader = ImageReader::open(folder_.file("a.exr"));
  ASSERT_TRUE(reader.ok());
  for (const Attribute& attribute : attributes) {
    const Attribute* found = reader->header().attribute(attribute.name);
    ASSERT_NE(found, nullptr) << attribute.name;
    EXPECT_TRUE(found->value == attribute.value) << attribute.name;
  }
  EXPECT_EQ(reader->header().attribute("none"), nullptr);
}

TEST_F(Reading, BadFilesAreOneSentence) {
  const auto expect_bad = [&](const std::string& name, const std::string& reason) {
    const auto reader = ImageReader::open(folder_.file(name));
    ASSERT_FALSE(reader.ok()) << name;
    EXPECT_EQ(reader.status().code(), StatusCode::kIoFailure);
    const std::string message = reader.status().message();
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  expect_bad("none.exr", "no such file");
  std::filesystem::create_directory(folder_.file("folder.exr"));
  expect_bad("folder.exr", "folder");
  std::ofstream(folder_.file("text.exr")) << "this is no picture";
  expect_bad("text.exr", "cannot be read");
  std::ofstream(folder_.file("empty.exr"));
  expect_bad("empty.exr", "cannot be read");
}

// Cut off at every length: opening or reading fails with a sentence, and nothing worse happens.
TEST_F(Reading, TruncatedFilesAreRefused) {
  const Extent extent{16, 80};
  open({simple_part(extent, {"R", "G"}, ramp(extent.area() * 2, 0))});
  const std::string whole = testing::read_file(folder_.file("a.exr"));
  for (std::size_t length = 0; length < whole.size(); length += 1 + length / 20) {
    std::ofstream(folder_.file("cut.exr"), std::ios::binary | std::ios::trunc) << whole.substr(0, length);
    auto reader = ImageReader::open(folder_.file("cut.exr"));
    if (!reader.ok()) continue;
    std::vector<float> values(extent.area());
    const auto place = reader->header().find("G");
    ASSERT_TRUE(place);
    const ChannelTarget target = {*place, ChannelType::kFloat, values.data(), 4, 64};
    const Status status = reader->read({&target, 1});
    EXPECT_FALSE(status.ok()) << length << " of " << whole.size();
    EXPECT_NE(status.message().find("cut.exr"), std::string::npos);
  }
}

TEST(Png, SaysByCicpWhatItsCodesAre) {
  using namespace std::string_literals;
  struct Case {
    std::string numbers_and_sum, space, unapplied;
    bool is_known = true;
  };
  const Case cases[] = {{"\x01\x0d\x00\x01"
                         "\x9c\x69\x3b\x32"s,
                         "sRGB", ""},
                        {"\x01\x08\x00\x01"
                         "\x9a\xa2\xf9\xd9"s,
                         "linear", ""},
                        {"\x0c\x0d\x00\x01"
                         "\x6e\x03\xe3\xef"s,
                         "sRGB", "cICP 12/13"},
                        {"\x09\x10\x00\x01"
                         "\x4d\x23\x23\xfe"s,
                         "cICP 9/16", "", false},
                        {"\x01\x0d\x00\x00"
                         "\xeb\x6e\x0b\xa4"s,
                         "cICP 1/13 of a narrow range", "", false}};
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("f.png");
  ASSERT_TRUE(write_picture(path, {4, 3}, std::vector<std::uint8_t>(48, 99).data()).ok());
  std::ifstream written(path, std::ios::binary);
  const std::string plain(std::istreambuf_iterator<char>(written), {});
  constexpr std::size_t kHeader = 8 + 25;  // the signature and IHDR
  for (const Case& coding : cases) {
    std::ofstream(path, std::ios::binary)
        << std::string(plain).insert(kHeader, "\0\0\0\4cICP"s + coding.numbers_and_sum);
    const auto file = ImageReader::open(path);
    ASSERT_TRUE(file.ok()) << file.status().message();
    const ImagePart& part = file.value().header().parts[0];
    EXPECT_EQ(part.colour_space, coding.space);
    EXPECT_EQ(part.unapplied, coding.unapplied);
    const auto colour = InputColour::of(path, part, "");
    EXPECT_EQ(colour.ok(), coding.is_known) << coding.space;
    if (!colour.ok()) {
      EXPECT_NE(colour.status().message().find("not known here; --input-colour takes"), std::string::npos);
    }
  }
}

}  // namespace

}  // namespace quincunx::tools
