// SPDX-License-Identifier: MIT
// Frames in other formats and colour spaces than linear EXR: read, made light, and written.
#include "sequence_fixture.h"
#include "tools/image/display_light.h"
#include "tools/image/image_reader.h"
#include "tools/sequence/sequence_input.h"

namespace quincunx::testing {
namespace {

using tools::Attribute;
using tools::LoadedImage;

constexpr tools::Chromaticities kAcesCg = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};

class Formats : public SequenceTest {
 protected:
  static constexpr Extent kRender = {16, 12};
  // Frames are shown as they are: a point of the same size is the identity.
  static constexpr const char* kPoint = "--output 16x12 --method point --two-way 0";
  static constexpr const char* kSame = "--output 16x12 --method point --two-way 0 --store float";

  static std::vector<std::uint8_t> codes() {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < kRender.area(); ++i) {
      const auto code = [i](int step) { return static_cast<std::uint8_t>(i * step % 256); };
      texels.insert(texels.end(), {code(1), code(7), code(13), 255});
    }
    return texels;
  }

  // Red, green and blue of a pixel that a file of these bytes becomes.
  std::vector<float> light_of(const std::string& ending, const std::string& bytes) {
    std::ofstream(folder_.file("f.0001." + ending), std::ios::binary) << bytes;
    const auto result =
        resolve(fmt::format("'{{}}/f.%04d.{0}' --out '{{}}/{0}.%04d.exr' -q {1}", ending, kSame));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    if (result.exit_code != 0) return {};
    const LoadedImage made = image(output(1, ending));
    std::vector<float> light;
    for (const char* name : {"R", "G", "B"})
      light.push_back(made.at(3, 2, made.channel(name)));
    return light;
  }

  static tools::ImageReader opened(const std::string& path) {
    auto reader = tools::ImageReader::open(path);
    EXPECT_TRUE(reader.ok()) << reader.status().message();
    return std::move(reader).value();
  }
};

TEST_F(Formats, CodesAreReadAsLight) {
  const std::vector<std::uint8_t> texels = codes();
  for (const std::string ending : {"png", "tif"}) {
    ASSERT_TRUE(tools::write_picture(folder_.file("f.0001." + ending), kRender, texels.data()).ok());
    const auto result =
        resolve(fmt::format("'{{}}/f.%04d.{0}' --out '{{}}/{0}.%04d.exr' {1}", ending, kSame));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("colour is sRGB"), std::string::npos) << result.err;
    const LoadedImage made = image(output(1, ending));
    for (int i = 0; i < kRender.area(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const float code = static_cast<float>(texels[static_cast<std::size_t>(4 * i + c)]) / 255;
        ASSERT_EQ(made.at(i % kRender.width, i / kRender.width, made.channel(std::string(1, "RGB"[c]))),
                  tools::linear_of_srgb(code))
            << ending << " " << i;
      }
    }
  }
}

// The file's chromaticities, and the option that overrides them.
TEST_F(Formats, OtherPrimariesBecomeRec709) {
  FrameFile file = frame(1);
  file.extent = kRender;
  file.alpha = file.velocity = false;
  write_frame(input(1), file);
  file.attributes.push_back({"chromaticities", kAcesCg});
  write_frame(input(2), file);
  resolve_to("asked", fmt::format("--frames 1 {} --input-colour ACEScg", kSame));
  resolve_to("told", fmt::format("--frames 2 {}", kSame));
  resolve_to("left", fmt::format("--frames 2 {} --input-colour linear", kSame));
  resolve_to("plain", fmt::format("--frames 1 {}", kSame));
  const LoadedImage asked = image(output(1, "asked")), told = image(output(2, "told"));
  const LoadedImage left = image(output(2, "left")), plain = image(output(1, "plain"));
  EXPECT_EQ(asked.pixels, told.pixels);
  EXPECT_EQ(left.pixels, plain.pixels);
  for (int i = 0; i < kRender.area(); ++i) {
    const auto at = [i](const LoadedImage& one, const char* name) {
      return one.at(i % kRender.width, i / kRender.width, one.channel(name));
    };
    const float red = 1.70505f * at(plain, "R") - 0.62179f * at(plain, "G") - 0.08326f * at(plain, "B");
    ASSERT_NEAR(at(told, "R"), red, 2e-3f) << i;
  }
  // What is written says what it is.
  const Attribute* primaries = told.attribute("chromaticities");
  ASSERT_NE(primaries, nullptr);
  EXPECT_TRUE(primaries->value == tools::AttributeValue(tools::kRec709));
}

// The PNG of ACES frames is the PNG of the light that they become.
TEST_F(Formats, APngOfAcesHasTheRightColour) {
  FrameFile file = frame(1);
  file.extent = kRender;
  file.alpha = file.velocity = false;
  file.attributes.push_back({"chromaticities", kAcesCg});
  write_frame(input(1), file);
  resolve_to("light", kSame);
  for (const std::string from : {"f", "light"}) {
    const auto result =
        resolve(fmt::format("'{{}}/{0}.%04d.exr' --out '{{}}/{0}.%04d.png' -q {1}", from, kPoint));
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  EXPECT_EQ(image(folder_.file("f.0001.png")).pixels, image(folder_.file("light.0001.png")).pixels);
}

TEST_F(Formats, EveryFormatIsWrittenAndKeepsWhatItCan) {
  FrameFile file = frame(1);
  file.attributes.insert(file.attributes.end(), {{"owner", std::string("A studio")},
                                                 {"pixelAspectRatio", 2.f},
                                                 {"timeCode", tools::TimeCode{0x01020304, 5}}});
  write_frame(input(1), file);
  for (const std::string ending : {"exr", "tif", "hdr", "png", "jpg", "dpx"}) {
    const auto result = resolve("'{}/f.%04d.exr' --out '{}/o.%04d." + ending + "' -q");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto reader = opened(folder_.file("o.0001." + ending));
    EXPECT_EQ(reader.header().parts[0].display.extent, kOutput) << ending;
    const Attribute* owner = reader.header().attribute("owner");
    if (ending != "hdr") {
      ASSERT_NE(owner, nullptr) << ending;
      EXPECT_TRUE(owner->value == tools::AttributeValue(std::string("A studio"))) << ending;
    }
    if (ending == "exr" || ending == "dpx") {
      const Attribute* code = reader.header().attribute("timeCode");
      ASSERT_NE(code, nullptr) << ending;
      EXPECT_TRUE(code->value == tools::AttributeValue(tools::TimeCode{0x01020304, 5})) << ending;
    }
    const std::string space = reader.header().parts[0].colour_space;
    EXPECT_EQ(space == "sRGB", ending == "png" || ending == "jpg" || ending == "dpx")
        << ending << " " << space;
  }
}

TEST_F(Formats, MasksMayBeImagesOfTheirOwn) {
  for (int number = 1; number <= 3; ++number) {
    FrameFile file = frame(number);
    write_frame(input(number), file);
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(file.extent.area()) * 4, 255);
    ASSERT_TRUE(
        tools::write_picture(folder_.file(fmt::format("m.{:04}.png", number)), file.extent, mask.data())
            .ok());
    // The same in a channel of each frame.
    const LoadedImage loaded = image(input(number));
    const std::vector<float> ones(static_cast<std::size_t>(file.extent.area()), 1.f);
    std::vector<tools::Channel> channels = {{"reactive.mask", tools::ChannelType::kFloat, ones.data()}};
    for (std::size_t c = 0; c < loaded.channels.size(); ++c) {
      channels.push_back({loaded.channels[c], tools::ChannelType::kFloat, loaded.pixels.data() + c,
                          loaded.channels.size() * sizeof(float), 0, loaded.stored[c]});
    }
    ASSERT_TRUE(tools::write_exr(folder_.file(fmt::format("c.{:04}.exr", number)), file.extent, channels,
                                 file.attributes)
                    .ok());
  }
  const std::string arguments = "--method quincunx -q --out '{}/";
  ASSERT_EQ(resolve("'{}/f.%04d.exr' --reactive '{}/m.%04d.png' " + arguments + "files.%04d.exr'").exit_code,
            0);
  ASSERT_EQ(resolve("'{}/c.%04d.exr' " + arguments + "channel.%04d.exr'").exit_code, 0);
  ASSERT_EQ(resolve("'{}/f.%04d.exr' " + arguments + "none.%04d.exr'").exit_code, 0);
  const LoadedImage files = image(output(3, "files"));
  EXPECT_EQ(files.pixels, image(output(3, "channel")).pixels);
  EXPECT_NE(files.pixels, image(output(3, "none")).pixels);
  expect_refused("'{}/f.%04d.exr' --reactive '{}/x.%04d.png' --out '{}/u.%04d.exr'", 1, "x.0001.png");
}

// Alpha is no mask.
TEST_F(Formats, AMaskOfGreyAndAlphaIsItsGrey) {
  std::vector<std::uint8_t> grey_alpha;
  for (int i = 0; i < kRender.area(); ++i)
    grey_alpha.insert(grey_alpha.end(), {static_cast<std::uint8_t>(i % 2 * 255), 255});
  const auto bytes = tools::backend::encode(
      tools::FileFormat::kPng,
      {.extent = kRender, .channels = 2, .data = grey_alpha.data(), .pixel_stride = 2, .row_stride = 32}, {});
  ASSERT_TRUE(bytes.ok()) << bytes.status().message();
  std::ofstream(folder_.file("m.png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
  auto mask = tools::open_mask(folder_.file("m.png"), kRender, "");
  ASSERT_TRUE(mask.ok()) << mask.status().message();
  std::vector<float> values(static_cast<std::size_t>(kRender.area()));
  const tools::ChannelTarget target = {mask->place, tools::ChannelType::kFloat, values.data(), 4, 64};
  ASSERT_TRUE(mask->reader.read({&target, 1}).ok());
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_EQ(values[i], static_cast<float>(i % 2)) << i;
}

// A copy that was broken off: as a frame, a mask, a truth, and as a result that --resume would keep.
TEST_F(Formats, CutPicturesAreRefusedBeforeTheFirstFrame) {
  const std::vector<std::uint8_t> texels = codes();
  for (const std::string ending : {"png", "jpg", "dpx", "tif"}) {
    for (const char* name : {"a.0001.", "cut.0001."})
      ASSERT_TRUE(tools::write_picture(folder_.file(name + ending), kRender, texels.data()).ok());
    const std::string cut = folder_.file("cut.0001." + ending);
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) - 20);
    const std::string out = fmt::format(" --out '{{}}/o.%04d.exr' -q {}", kSame);
    expect_refused("'{}/cut.%04d." + ending + "'" + out, 1, "cut.0001." + ending);
    expect_refused("'{}/a.%04d.png' --truth '{}/cut.%04d." + ending + "'" + out, 1, "truth '" + cut);
    EXPECT_FALSE(tools::open_mask(cut, kRender, "").ok()) << ending;
  }
  const auto resume = [&] {
    return resolve(fmt::format("'{{}}/a.%04d.png' --out '{{}}/r.%04d.png' --resume -q {}", kPoint));
  };
  ASSERT_EQ(resume().exit_code, 0);
  const LoadedImage whole = image(folder_.file("r.0001.png"));
  std::filesystem::resize_file(folder_.file("r.0001.png"), 100);
  ASSERT_EQ(resume().exit_code, 0);
  EXPECT_EQ(image(folder_.file("r.0001.png")).pixels, whole.pixels);
}

template <typename Value>
std::string bytes_of(const Value& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// An ICC profile of version 2 that has a name and nothing else.
std::string icc_profile(const std::string& name) {
  const auto big = [](std::uint32_t value) {
    const std::string little = bytes_of(value);
    return std::string(little.rbegin(), little.rend());
  };
  const std::string text = "desc" + big(0) + big(static_cast<std::uint32_t>(name.size()) + 1) + name +
                           std::string(1 + 4 + 4 + 2 + 1 + 67, '\0');
  std::string header(128, '\0');
  header.replace(8, 1, "\x02").replace(12, 12, "mntrRGB XYZ ").replace(36, 4, "acsp");
  const std::string rest = big(1) + "desc" + big(144) + big(static_cast<std::uint32_t>(text.size())) + text;
  return header.replace(0, 4, big(static_cast<std::uint32_t>(header.size() + rest.size()))) + rest;
}

using Tags = std::vector<std::pair<std::uint16_t, std::uint32_t>>;

// A TIFF of kRender in one strip: codes of `bits` with `channels` each, and an ICC profile.
std::string tiff_of(std::uint32_t bits, std::uint32_t channels, Tags tags, const std::string& pixels,
                    const std::string& profile = "") {
  constexpr std::uint16_t kLong = 4, kBytes = 7, kProfile = 34675;
  const auto size = static_cast<std::uint32_t>(pixels.size());
  const auto profile_size = static_cast<std::uint32_t>(profile.size());
  tags.insert(tags.end(),
              {{256, 16}, {257, 12}, {258, bits}, {259, 1}, {277, channels}, {278, 12}, {279, size}});
  const std::size_t entries = tags.size() + (profile.empty() ? 1 : 2);
  const auto first = static_cast<std::uint32_t>(8 + 2 + entries * 12 + 4);
  tags.emplace_back(273, first);
  if (!profile.empty()) tags.emplace_back(kProfile, first + size);
  std::sort(tags.begin(), tags.end());
  std::string tiff("II*\0\x8\0\0\0", 8);
  tiff += bytes_of(static_cast<std::uint16_t>(tags.size()));
  for (const auto& [tag, value] : tags)
    tiff += tag == kProfile ? bytes_of(tag) + bytes_of(kBytes) + bytes_of(profile_size) + bytes_of(value)
                            : bytes_of(tag) + bytes_of(kLong) + bytes_of(std::uint32_t{1}) + bytes_of(value);
  return tiff + bytes_of(std::uint32_t{0}) + pixels + profile;
}
constexpr std::uint16_t kPhotometric = 262, kSampleFormat = 339;

TEST_F(Formats, FloatsOfOtherFormatsAreLinear) {
  std::string map = "Pf\n16 12\n-1.0\n", doubles;
  for (int i = 0; i < kRender.area(); ++i)
    map += bytes_of(.25f), doubles += bytes_of(.25);
  const std::vector<float> quarter(3, .25f);
  EXPECT_EQ(light_of("pfm", map), quarter);
  EXPECT_EQ(light_of("tif", tiff_of(64, 1, {{kPhotometric, 1}, {kSampleFormat, 3}}, doubles)), quarter);
}

// A picture that would come out as another one ends before the first frame.
TEST_F(Formats, PicturesThatAreReadWronglyAreRefused) {
  const auto expect_sentence = [&](const std::string& ending, const std::string& bytes,
                                   const std::string& why) {
    std::ofstream(folder_.file("f.0001." + ending), std::ios::binary) << bytes;
    for (const char* what : {"-n", "-q"})
      expect_refused(fmt::format("'{{}}/f.%04d.{}' --out '{{}}/o.%04d.exr' {} {}", ending, kSame, what), 1,
                     fmt::format("f.0001.{}' cannot be read: {}", ending, why));
  };
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", texels(16 * 12 * 4, '\x7f');
  for (const char* order : {"+Y 12 +X 16", "+X 16 -Y 12"})
    expect_sentence("hdr", fmt::format("{}\n{}\n{}", head, order, texels),
                    "it is stored turned or mirrored (orientation ");
  for (const char* line : {"EXPOSURE=0", "EXPOSURE=x", "COLORCORR=1 1"})
    expect_sentence("hdr", fmt::format("{}{}\n\n-Y 12 +X 16\n{}", head, line, texels),
                    fmt::format("its header has '{}'", line));
  const auto pixels = [](std::size_t bytes) { return std::string(kRender.area() * bytes, '\x7f'); };
  expect_sentence("tif", tiff_of(8, 3, {{kPhotometric, 8}}, pixels(3)),
                  "its colour is CIELAB; write it as RGB");
  expect_sentence("tif", tiff_of(8, 4, {{kPhotometric, 5}}, pixels(4)),
                  "its colour is CMYK; write it as RGB");
  expect_sentence("tif", tiff_of(16, 1, {{kPhotometric, 0}}, pixels(2)), "its white is 0; write black as 0");
  expect_sentence("tif", tiff_of(24, 1, {{kPhotometric, 1}, {kSampleFormat, 3}}, pixels(3)),
                  "it holds floats of 24 bits; write 16 or 32");
}

TEST_F(Formats, AGammaHasItsNumber) {
  const std::string path = folder_.file("f.0001.png");
  const std::vector<Attribute> attributes = {{"oiio:ColorSpace", std::string("GammaCorrected")},
                                             {"oiio:Gamma", 1.7f}};
  ASSERT_TRUE(tools::write_picture(path, kRender, codes().data(), 0, tools::Alpha::kOpaque, attributes).ok());
  EXPECT_EQ(opened(path).header().parts[0].colour_space, "Gamma1.7");
}

// Light that would come out in other colours is told, and sRGB's own profile is no news.
TEST_F(Formats, AnIccProfileThatIsNotAppliedIsTold) {
  const std::string linear(static_cast<std::size_t>(kRender.area()) * sizeof(float), '\0');
  for (const std::string name : {"Display P3", "sRGB IEC61966-2.1"}) {
    const std::string profile = icc_profile(name), picture = folder_.file("f.0001.jpg");
    ASSERT_TRUE(tools::write_picture(picture, kRender, codes().data()).ok());
    std::string jpeg = read_file(picture);
    const std::string segment = std::string("ICC_PROFILE\0\1\1", 14) + profile;
    const auto length = static_cast<std::uint16_t>(segment.size() + 2);
    jpeg.insert(2, std::string("\xff\xe2") + static_cast<char>(length >> 8) +
                       static_cast<char>(length & 255) + segment);
    std::ofstream(picture, std::ios::binary) << jpeg;
    std::ofstream(folder_.file("f.0001.tif"), std::ios::binary)
        << tiff_of(32, 1, {{kPhotometric, 1}, {kSampleFormat, 3}}, linear, profile);
    for (const auto& [ending, space] : {std::pair("jpg", "sRGB"), std::pair("tif", "linear")}) {
      const auto result =
          resolve(fmt::format("'{{}}/f.%04d.{0}' --out '{{}}/{0}.%04d.exr' {1}", ending, kSame));
      ASSERT_EQ(result.exit_code, 0) << result.err;
      const bool is_told = result.err.find(fmt::format("{} (its ICC profile 'Display P3' is not applied)",
                                                       space)) != std::string::npos;
      EXPECT_EQ(is_told, name == "Display P3") << result.err;
    }
  }
}

// What the exposures of all programs that changed it have multiplied is taken back.
TEST_F(Formats, ARadianceFileIsDividedByItsExposures) {
  std::string texels;
  for (int i = 0; i < kRender.area(); ++i)
    texels += "\x80\x40\x20\x81";
  const auto resolved = [&](const std::string& lines) {
    return light_of("hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y 12 +X 16\n" + texels);
  };
  const std::vector<float> plain = resolved("");
  EXPECT_EQ(resolved("EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR= 1 2 .5\n"),
            (std::vector{plain[0] / 8, plain[1] / 16, plain[2] / 4}));
  EXPECT_NE(resolved("PRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n"), plain);
}

TEST_F(Formats, SubsampledChannelsAreRefused) {
  tools::ImageHeader header;
  header.parts.emplace_back().display.extent = kRender;
  for (const char* name : {"R", "G", "B"})
    header.parts[0].channels.push_back({.name = name});
  header.parts[0].channels[1].sampling = {2, 1};
  EXPECT_EQ(tools::find_channels("a.exr", header, {}).status().message(),
            "'a.exr' has channel 'G' subsampled 2x1; render it at full size");
}

// A truth that says nothing of its colour has the frames'; one that does keeps it.
TEST_F(Formats, TruthIsInTheColourThatIsAsked) {
  FrameFile file = frame(1);
  file.extent = kRender;
  file.alpha = file.velocity = false;
  write_frame(input(1), file);
  ASSERT_TRUE(tools::write_picture(folder_.file("f.0001.png"), kRender, codes().data()).ok());
  const auto is_its_own_truth = [&](const std::string& ending, const std::string& space) {
    const auto result =
        resolve(fmt::format("'{{}}/f.%04d.{0}' --truth '{{}}/f.%04d.{0}' {1} {2}", ending, kPoint, space));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out.find("       1       inf ") != std::string::npos;  // its PSNR
  };
  EXPECT_TRUE(is_its_own_truth("exr", ""));
  EXPECT_TRUE(is_its_own_truth("exr", "--input-colour ACEScg"));
  EXPECT_TRUE(is_its_own_truth("png", ""));
  EXPECT_FALSE(is_its_own_truth("png", "--input-colour linear"));
}

TEST_F(Formats, UnknownSpacesAreOneSentence) {
  write_frames(1, 1);
  expect_refused("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --input-colour ACES_cg", 2,
                 "no colour space 'ACES_cg' here; near ones: ACEScg");
}

}  // namespace
}  // namespace quincunx::testing
