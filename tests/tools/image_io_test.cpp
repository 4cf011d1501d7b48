// SPDX-License-Identifier: MIT
#include "tools/image/image_io.h"

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <thread>

#include "temporary_folder.h"
#include "tools/image/display_light.h"
#include "tools/image/image_reader.h"

namespace quincunx::tools {
namespace {

// A half constant is written by its bits, so that the test does not lean on anyone's conversion.
constexpr std::uint16_t kHalfOne = 0x3c00;
constexpr std::uint16_t kHalfMax = 0x7bff;       // 65504
constexpr std::uint16_t kHalfDenormal = 0x0001;  // 2^-24

TEST(Png, ReturnsEveryCode) {
  const testing::TemporaryFolder folder;
  const Extent extent{16, 16};
  std::vector<std::uint8_t> texels(1024);
  for (int i = 0; i < 256; ++i) {
    texels[i * 4] = static_cast<std::uint8_t>(i);
    texels[i * 4 + 1] = static_cast<std::uint8_t>(255 - i);
    texels[i * 4 + 2] = static_cast<std::uint8_t>(i * 7);
    texels[i * 4 + 3] = static_cast<std::uint8_t>(i * 3);
  }
  for (const Alpha alpha : {Alpha::kOpaque, Alpha::kKeep}) {
    const std::string path = folder.file("a.png");
    const Status status = write_picture(path, extent, texels.data(), 0, alpha);
    ASSERT_TRUE(status.ok()) << status.message();
    const Result<LoadedImage> image = read_image(path);
    ASSERT_TRUE(image.ok()) << image.status().message();
    const int channels = alpha == Alpha::kKeep ? 4 : 3;
    ASSERT_EQ(image->channels.size(), static_cast<std::size_t>(channels));
    EXPECT_EQ(image->extent, extent);
    for (int i = 0; i < 256; ++i) {
      for (int c = 0; c < channels; ++c) {
        ASSERT_EQ(std::lround(image->at(i % 16, i / 16, c) * 255.0f), texels[i * 4 + c]) << i << " " << c;
      }
    }
  }
}

TEST(Png, SkipsTheEndOfLongRows) {
  const testing::TemporaryFolder folder;
  std::vector<std::uint8_t> texels(2 * 64, 9);
  texels[64] = 200;
  ASSERT_TRUE(write_picture(folder.file("a.png"), {2, 2}, texels.data(), 64).ok());
  const Result<LoadedImage> image = read_image(folder.file("a.png"));
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(std::lround(image->at(0, 1, 0) * 255.0f), 200);
  EXPECT_EQ(std::lround(image->at(1, 1, 0) * 255.0f), 9);
}

TEST(Png, EncodesInMemoryWhatAFileGivesBack) {
  testing::TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb = {0, 1, 2, 253, 254, 255, 7, 8, 9, 100, 50, 25};
  const auto bytes = encode_png({2, 2}, 3, rgb);
  ASSERT_TRUE(bytes.ok()) << bytes.status().message();
  std::ofstream(folder.file("a.png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
  const auto image = read_image(folder.file("a.png"));
  ASSERT_TRUE(image.ok()) << image.status().message();
  ASSERT_EQ(image->extent, (Extent{2, 2}));
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(std::lround(255 * image->at(i / 3 % 2, i / 6, i % 3)), rgb[static_cast<std::size_t>(i)]);
  }
  EXPECT_TRUE(encode_png({4, 3}, 1, rgb).ok());
  EXPECT_FALSE(encode_png({2, 2}, 4, rgb).ok());
  EXPECT_FALSE(encode_png({3, 2}, 3, rgb).ok());
}

TEST(Exr, ReturnsChannelsTypesAndValues) {
  const testing::TemporaryFolder folder;
  const Extent extent{3, 2};
  std::vector<std::uint16_t> rgba(6 * 4, kHalfOne);
  rgba[0] = kHalfMax;
  rgba[4] = kHalfDenormal;
  std::vector<float> depth = {1, 2, 1e10f, 1.0e-20f, 5.0000005f, -6};
  std::vector<float> velocity = {1.25f, -2, 3, -4, 5, -6, 7, -8, 9, -10, 11, -12};
  const std::vector<float> reactive = {0, 0.25f, 0.5f, 1, 0, 0};
  std::vector<Channel> channels;
  for (int c = 0; c < 4; ++c) {
    channels.push_back({std::string(1, "RGBA"[c]), ChannelType::kHalf, &rgba[c], 8, 24, ChannelType::kHalf});
  }
  channels.push_back({"Z", ChannelType::kFloat, depth.data(), 0, 0, ChannelType::kFloat});
  channels.push_back({"backward.u", ChannelType::kFloat, &velocity[0], 8, 24, ChannelType::kFloat});
  channels.push_back({"backward.v", ChannelType::kFloat, &velocity[1], 8, 24, ChannelType::kFloat});
  channels.push_back({"reactive.mask", ChannelType::kFloat, reactive.data(), 0, 0, ChannelType::kHalf});
  const Status status = write_exr(folder.file("a.exr"), extent, channels);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(folder.entries(), 1);

  const Result<LoadedImage> image = read_image(folder.file("a.exr"));
  ASSERT_TRUE(image.ok()) << image.status().message();
  ASSERT_EQ(image->channels.size(), 8U);
  const int z = image->channel("Z");
  const int u = image->channel("backward.u");
  const int v = image->channel("backward.v");
  const int mask = image->channel("reactive.mask");
  ASSERT_TRUE(z >= 0 && u >= 0 && v >= 0 && mask >= 0);
  EXPECT_EQ(image->channel("nothing"), -1);
  EXPECT_EQ(image->stored[z], ChannelType::kFloat);
  EXPECT_EQ(image->stored[u], ChannelType::kFloat);
  EXPECT_EQ(image->stored[mask], ChannelType::kHalf);
  EXPECT_EQ(image->stored[image->channel("A")], ChannelType::kHalf);
  EXPECT_EQ(image->at(0, 0, image->channel("R")), 65504.0f);
  EXPECT_EQ(image->at(1, 0, image->channel("R")), std::ldexp(1.0f, -24));
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(image->at(i % 3, i / 3, z), depth[i]);
    EXPECT_EQ(image->at(i % 3, i / 3, u), velocity[i * 2]);
    EXPECT_EQ(image->at(i % 3, i / 3, v), velocity[i * 2 + 1]);
    EXPECT_EQ(image->at(i % 3, i / 3, mask), reactive[i]);
  }
}

TEST(Exr, KeepsNonFiniteValues) {
  const testing::TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> values = {std::nanf(""), infinity, -infinity};
  const Channel channel{"Z", ChannelType::kFloat, values.data(), 0, 0, ChannelType::kFloat};
  ASSERT_TRUE(write_exr(folder.file("a.exr"), {3, 1}, {&channel, 1}).ok());
  const Result<LoadedImage> image = read_image(folder.file("a.exr"));
  ASSERT_TRUE(image.ok());
  EXPECT_TRUE(std::isnan(image->at(0, 0, 0)));
  EXPECT_EQ(image->at(1, 0, 0), infinity);
  EXPECT_EQ(image->at(2, 0, 0), -infinity);
}

TEST(Exr, HalvesOfFloatsAreNeverInfinite) {
  const testing::TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> rgba = {1e6f, -1e6f, infinity, 1, 65504, 65519, .5f, 1};
  EXPECT_TRUE(exceed_halves(rgba));
  EXPECT_FALSE(exceed_halves(std::vector<float>{65504, -65504}));
  ASSERT_TRUE(write_light(folder.file("a.exr"), {2, 1}, rgba).ok());
  const Result<LoadedImage> image = read_image(folder.file("a.exr"));
  ASSERT_TRUE(image.ok());
  const std::vector<float> wanted = {65504, -65504, 65504, 1, 65504, 65504, .5f, 1};
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(image->at(i / 4, 0, image->channel(std::string(1, "RGBA"[i % 4]))),
              wanted[static_cast<std::size_t>(i)])
        << i;
}

TEST(Exr, ReturnsAttributes) {
  const testing::TemporaryFolder folder;
  const std::vector<float> values = {1};
  const Channel channel{"Z", ChannelType::kFloat, values.data(), 0, 0, ChannelType::kFloat};
  Matrix matrix{};
  for (int i = 0; i < 16; ++i)
    matrix[i] = static_cast<float>(i) + 0.5f;
  const std::vector<Attribute> attributes = {
      {"quincunx:version", std::string("1")},
      {"quincunx:jitter", Vec2{0.25f, -0.25f}},
      {"quincunx:frameIndex", 120},
      {"quincunx:near", 0.1f},
      {"worldToCamera", matrix},
      {"framesPerSecond", Rational{30000, 1001}},
  };
  ASSERT_TRUE(write_exr(folder.file("a.exr"), {1, 1}, {&channel, 1}, attributes).ok());
  const Result<LoadedImage> image = read_image(folder.file("a.exr"));
  ASSERT_TRUE(image.ok());
  for (const Attribute& wanted : attributes) {
    const Attribute* found = image->attribute(wanted.name);
    ASSERT_NE(found, nullptr) << wanted.name;
    EXPECT_EQ(found->value.index(), wanted.value.index()) << wanted.name;
    EXPECT_TRUE(found->value == wanted.value) << wanted.name;
  }
}

TEST(Exr, RefusesBadChannels) {
  const testing::TemporaryFolder folder;
  const float value = 1;
  const Channel good{"Z", ChannelType::kFloat, &value, 0, 0, ChannelType::kFloat};
  Channel nameless = good;
  nameless.name.clear();
  Channel empty = good;
  empty.data = nullptr;
  const std::vector<std::vector<Channel>> cases = {{}, {nameless}, {empty}, {good, good}};
  for (const std::vector<Channel>& channels : cases) {
    EXPECT_EQ(write_exr(folder.file("a.exr"), {1, 1}, channels).code(), StatusCode::kInvalidArgument);
  }
  EXPECT_EQ(write_exr(folder.file("a.exr"), {0, 1}, {&good, 1}).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(folder.entries(), 0);
}

// Two pixels of grey and alpha: black of alpha 1, white of alpha .5.
const std::uint8_t kGreyAlphaPng[] = {
    137, 80, 78, 71,  13, 10,  26,  10,  0,   0,   0, 13, 73, 72, 68, 82, 0,  0,   0,   2,  0,  0,   0,   1,
    8,   4,  0,  0,   0,  94,  43,  183, 1,   0,   0, 0,  13, 73, 68, 65, 84, 120, 156, 99, 96, 248, 255, 191,
    1,   0,  5,  128, 2,  127, 225, 103, 180, 210, 0, 0,  0,  0,  73, 69, 78, 68,  174, 66, 96, 130};

TEST(Png, GreyComesBeforeAlpha) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.file("a.png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(kGreyAlphaPng), sizeof kGreyAlphaPng);
  const auto image = read_image(folder.file("a.png"));
  ASSERT_TRUE(image.ok()) << image.status().message();
  EXPECT_EQ(image->channels, (std::vector<std::string>{"Y", "A"}));
  EXPECT_EQ(image->at(0, 0, 0), 0);
  EXPECT_EQ(image->at(1, 0, 0), 1);
  EXPECT_EQ(image->at(0, 0, 1), 1);
  EXPECT_NEAR(image->at(1, 0, 1), .5f, .01f);
}

// Formats that this build writes, each with what its numbers may differ by.
TEST(Formats, ReturnThePicture) {
  struct Format {
    const char* ending;
    float step;
  };
  const testing::TemporaryFolder folder;
  const Extent extent{16, 8};
  std::vector<std::uint8_t> texels(static_cast<std::size_t>(extent.area()) * 4, 255);
  for (std::size_t i = 0; i < texels.size() / 4; ++i)
    texels[4 * i] = texels[4 * i + 1] = texels[4 * i + 2] = static_cast<std::uint8_t>(2 * i);
  constexpr float kNone = 0, kTenBits = 1.f / 1023, kJpeg = 4.f / 255;  // of a smooth ramp at quality 95
  int known = 0;
  for (const Format format :
       {Format{".png", kNone}, Format{".tif", kNone}, Format{".dpx", kTenBits}, Format{".jpg", kJpeg}}) {
    const std::string path = folder.file(std::string("a") + format.ending);
    if (!format_of(path)) continue;
    ++known;
    const Status status = write_picture(path, extent, texels.data());
    ASSERT_TRUE(status.ok()) << status.message();
    const auto image = read_image(path);
    ASSERT_TRUE(image.ok()) << image.status().message();
    ASSERT_EQ(image->extent, extent) << path;
    ASSERT_EQ(image->channels, (std::vector<std::string>{"R", "G", "B"})) << path;
    for (int i = 0; i < extent.area(); ++i)
      ASSERT_NEAR(image->at(i % 16, i / 16, 1),
                  static_cast<float>(texels[static_cast<std::size_t>(i) * 4]) / 255, format.step)
          << path;
  }
  EXPECT_TRUE(known == 4 || endings() == ".exr or .png") << endings();
  const Status light = write_picture(folder.file("a.exr"), extent, texels.data());
  EXPECT_EQ(light.code(), StatusCode::kInvalidArgument);
}

// Light comes back as light; a DPX holds it as displayed.
TEST(Formats, ReturnTheLight) {
  const testing::TemporaryFolder folder;
  const std::vector<float> rgba = {0.25f, 0.5f, 4, 1, 1, 0.125f, 100, 0.5f};
  for (const char* name : {"a.exr", "a.tif", "a.hdr", "a.dpx"}) {
    const std::string path = folder.file(name);
    const auto format = format_of(path);
    const Status status = write_light(path, {2, 1}, rgba, ChannelType::kHalf, {ToneMap::kReinhard, 2});
    EXPECT_EQ(status.ok(), format.has_value()) << status.message();
    if (!status.ok()) {
      EXPECT_NE(status.message().find(endings()), std::string::npos) << status.message();
      continue;
    }
    const auto image = read_image(path);
    ASSERT_TRUE(image.ok()) << image.status().message();
    const std::size_t channels = image->channels.size();
    ASSERT_EQ(channels, *format <= FileFormat::kTiff ? 4u : 3u) << path;
    for (int i = 0; i < 8; ++i) {
      if (i % 4 >= static_cast<int>(channels)) continue;
      const float light = rgba[static_cast<std::size_t>(i)], found = image->at(i / 4, 0, i % 4);
      if (holds_light(*format)) {
        EXPECT_NEAR(found, light,
                    *format == FileFormat::kHdr ? 0.01f * rgba[static_cast<std::size_t>(i / 4 * 4 + 2)] : 0)
            << path;
      } else {
        EXPECT_NEAR(linear_of_srgb(found), 2 * light / (1 + 2 * light), 0.002f) << path;
      }
    }
  }
}

TEST(Formats, AnHdrHoldsNoNegativeLight) {
  const testing::TemporaryFolder folder;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<float> rgba = {-0.5f, 1, 2, 1, std::nanf(""), 1, -kInfinity, 1, 1, kInfinity, 0, 1};
  const Status written = write_light(folder.file("a.hdr"), {3, 1}, rgba, ChannelType::kHalf, {});
  if (!format_of("a.hdr")) {  // a build that writes EXR and PNG alone
    EXPECT_NE(written.message().find("must end in"), std::string::npos) << written.message();
    return;
  }
  ASSERT_TRUE(written.ok()) << written.message();
  const auto image = read_image(folder.file("a.hdr"));
  ASSERT_TRUE(image.ok()) << image.status().message();
  const std::vector<float> wanted = {0, 1, 2, 0, 1, 0, 0, 1e38f, 0};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(image->pixels[i], wanted[i], .02f * wanted[i]) << i;
}

TEST(Formats, KeepWhatFramesTellOfThemselves) {
  const testing::TemporaryFolder folder;
  const std::vector<Attribute> attributes = {
      {"owner", std::string("A studio")}, {"pixelAspectRatio", 2.f}, {"timeCode", TimeCode{0x01020304, 5}}};
  const std::vector<float> rgba(4 * 4, 0.5f);
  for (const char* name : {"a.exr", "a.tif", "a.dpx"}) {
    if (!format_of(name)) continue;
    const std::string path = folder.file(name);
    ASSERT_TRUE(write_light(path, {2, 2}, rgba, ChannelType::kHalf, {}, attributes).ok());
    const auto reader = ImageReader::open(path);
    ASSERT_TRUE(reader.ok()) << reader.status().message();
    EXPECT_FLOAT_EQ(reader->header().parts[0].pixel_aspect, 2) << path;
    for (const Attribute& wanted : attributes) {
      if (wanted.name == "timeCode" && path.ends_with("tif")) continue;  // which has no place for it
      const Attribute* found = reader->header().attribute(wanted.name);
      ASSERT_NE(found, nullptr) << path << " " << wanted.name;
      EXPECT_TRUE(found->value == wanted.value) << path << " " << wanted.name;
    }
  }
}

TEST(Formats, TheSamePixelsMakeTheSameFile) {
  const testing::TemporaryFolder folder;
  const std::vector<float> rgba(4 * 4, 0.5f);
  const auto bytes_of_file = [&](const std::string& path) {
    EXPECT_TRUE(write_light(path, {2, 2}, rgba).ok());
    return testing::read_file(path);
  };
  for (const char* name : {"a.exr", "a.tif", "a.hdr", "a.dpx", "a.png"}) {
    if (!format_of(name)) continue;
    const std::string first = bytes_of_file(folder.file(name));
    // Some formats count seconds.
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    EXPECT_EQ(first, bytes_of_file(folder.file(name))) << name;
  }
}

TEST(Formats, AreNamedByTheirEndings) {
  EXPECT_EQ(format_of("a/b.c.PNG"), FileFormat::kPng);
  EXPECT_EQ(format_of("a.exr"), FileFormat::kExr);
  EXPECT_FALSE(format_of("a.gif"));
  EXPECT_FALSE(format_of("exr"));
  EXPECT_EQ(format_of(output_pattern("a.#.Exr").value()), FileFormat::kExr);
  for (const char* bad : {"a.gif", "a.####", "frames"}) {
    const auto pattern = output_pattern(bad);
    ASSERT_FALSE(pattern.ok()) << bad;
    EXPECT_EQ(pattern.status().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(pattern.status().message().find("must end in .exr"), std::string::npos)
        << pattern.status().message();
  }
}

// Colour of files.

ImagePart part_of(const std::string& space) {
  ImagePart part;
  part.colour_space = space;
  return part;
}

std::vector<float> light_of(const ImagePart& part, std::vector<float> rgba, const std::string& named = "") {
  const auto colour = InputColour::of("a.exr", part, named);
  EXPECT_TRUE(colour.ok()) << colour.status().message();
  if (colour.ok()) colour->apply(rgba);
  return rgba;
}

TEST(InputColour, LeavesLinearRec709AsItIs) {
  ImagePart part = part_of("linear");
  EXPECT_TRUE(InputColour::of("a.exr", part)->is_light());
  part.chromaticities = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
  EXPECT_TRUE(InputColour::of("a.exr", part)->is_light());
}

// The matrix that ACES publishes for AP1 with D60 to Rec. 709 with D65.
TEST(InputColour, ConvertsAcesByNameAndByChromaticities) {
  const float wanted[] = {1.70505f, -0.13026f, -0.02400f};
  ImagePart part = part_of("linear");
  const auto named = light_of(part, {1, 0, 0, 1}, "ACEScg");
  part.chromaticities = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  const auto told = light_of(part, {1, 0, 0, 1});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(named[i], wanted[i], 2e-4f);
    EXPECT_EQ(told[i], named[i]);
  }
  EXPECT_EQ(InputColour::of("a.exr", part)->name(), "ACEScg");
  for (const float white : light_of(part, {1, 1, 1, 1}))
    EXPECT_NEAR(white, 1, 1e-5f);  // white stays white
}

TEST(InputColour, PrimariesMayHaveNoLuminance) {
  ImagePart part = part_of("linear");
  constexpr float kThird = 1.f / 3;
  part.chromaticities = {1, 0, 0, 1, 0, 0, kThird, kThird};  // XYZ
  for (const float white : light_of(part, {1, 1, 1, 1}))
    EXPECT_NEAR(white, 1, 1e-5f);
  const auto green = light_of(part, {0, 1, 0, 1});
  EXPECT_LT(green[0], 0);
  EXPECT_GT(green[1], 1);
}

TEST(InputColour, RefusesPrimariesThatSpanNoColours) {
  ImagePart part = part_of("linear");
  for (const Chromaticities& bad : {Chromaticities{},
                                    {.64f, .33f, .64f, .33f, .15f, .06f, .3127f, .329f},
                                    {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, 0},
                                    {std::nanf(""), .33f, .3f, .6f, .15f, .06f, .3127f, .329f}}) {
    part.chromaticities = bad;
    const auto colour = InputColour::of("a.exr", part);
    EXPECT_EQ(colour.status().code(), StatusCode::kIoFailure);
    EXPECT_NE(colour.status().message().find("span no colours; say --input-colour"), std::string::npos)
        << colour.status().message();
    EXPECT_TRUE(InputColour::of("a.exr", part, "linear").ok());
  }
}

TEST(InputColour, KeepsInfiniteAndUnknownLightInItsChannel) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(light_of(part_of("ACEScg"), {infinity, 0, 0, 1}), light_of(part_of("ACEScg"), {65504, 0, 0, 1}));
  EXPECT_EQ(light_of(part_of("ACEScg"), {0, std::nanf(""), 1, 1}), light_of(part_of("ACEScg"), {0, 0, 1, 1}));
}

TEST(InputColour, TakesCurvesBack) {
  EXPECT_NEAR(light_of(part_of("sRGB"), {0.5f, 0, 1, 1})[0], 0.2140411f, 1e-6f);
  const auto film = light_of(part_of("KodakLog"), {95.f / 1023, 685.f / 1023, 445.f / 1023, 1});
  EXPECT_NEAR(film[0], 0, 1e-6f);
  EXPECT_NEAR(film[1], 1, 1e-6f);
  EXPECT_NEAR(film[2], 0.149304f, 1e-5f);
}

TEST(InputColour, TakesAnyGammaBack) {
  EXPECT_NEAR(light_of(part_of("Gamma1.7"), {.5f, 0, 1, 1})[0], .3077861f, 1e-6f);
  EXPECT_EQ(InputColour::of("a.exr", part_of("GammaX")).status().code(), StatusCode::kIoFailure);
}

TEST(InputColour, GainComesBeforeOtherPrimaries) {
  ImagePart part = part_of("linear");
  part.gain = {.5f, 2, .25f};
  EXPECT_EQ(light_of(part, {1e6f, 1, 1, 1}), (std::vector<float>{5e5f, 2, .25f, 1}));
  EXPECT_EQ(light_of(part, {1, 1, 1, 1}, "ACEScg"), light_of(part_of("ACEScg"), {.5f, 2, .25f, 1}));
  EXPECT_EQ(InputColour::of("a.exr", part)->name(), "linear, times 0.5 2 0.25");
}

TEST(InputColour, MultipliesByAlphaAfterTheCurve) {
  ImagePart part = part_of("sRGB");
  part.straight_alpha = true;
  EXPECT_NEAR(light_of(part, {0.5f, 0, 1, 0.5f})[0], 0.2140411f / 2, 1e-6f);
}

TEST(InputColour, UnknownNamesAreOneSentence) {
  const auto asked = InputColour::of("a.exr", part_of("linear"), "ACEScgg");
  EXPECT_EQ(asked.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(asked.status().message().find("ACEScg, ACES2065-1"), std::string::npos)
      << asked.status().message();
  const auto told = InputColour::of("a.exr", part_of("LogSomething"));
  EXPECT_EQ(told.status().code(), StatusCode::kIoFailure);
  EXPECT_NE(told.status().message().find("a.exr"), std::string::npos);
}

TEST(ReadImage, NamesTheFileAndTheReason) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.file("text.exr")) << "this is no picture";
  std::ofstream(folder.file("empty.png")) << "";
  for (const char* name : {"missing.exr", "text.exr", "empty.png", "."}) {
    const Result<LoadedImage> image = read_image(folder.file(name));
    ASSERT_FALSE(image.ok()) << name;
    EXPECT_EQ(image.status().code(), StatusCode::kIoFailure);
    EXPECT_NE(image.status().message().find(folder.file(name)), std::string::npos)
        << image.status().message();
    EXPECT_EQ(image.status().message().find('\n'), std::string::npos) << image.status().message();
  }
}

TEST(WriteImage, LeavesNothingBehindOnFailure) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.file("plain")) << "x";
  const std::vector<std::uint8_t> texel(4);
  const Status status = write_picture(folder.file("plain/a.png"), {1, 1}, texel.data());
  EXPECT_EQ(status.code(), StatusCode::kIoFailure);
  EXPECT_NE(status.message().find("plain/a.png"), std::string::npos);
  EXPECT_EQ(folder.entries(), 1);
}

}  // namespace
}  // namespace quincunx::tools
