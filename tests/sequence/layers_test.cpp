// SPDX-License-Identifier: MIT
// Files as Blender has them, of many layers, and files of one grey channel: as input and as truth.
#include <nlohmann/json.hpp>

#include "sequence_fixture.h"
#include "tools/exr_files.h"

namespace quincunx {
namespace {

const std::vector<std::string> kBlenderChannels = {
    "ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
    "ViewLayer.Depth.Z",    "ViewLayer.DiffCol.R",  "ViewLayer.DiffCol.G",  "ViewLayer.DiffCol.B",
    "ViewLayer.Vector.X",   "ViewLayer.Vector.Y"};

class Layers : public testing::SequenceTest {
 protected:
  static void write_channels(const std::string& path, Extent extent,
                             const std::vector<std::string>& channels) {
    testing::FrameFile file;
    file.extent = extent;
    std::vector<float> pixels = plane(file, 0, 4, 0);
    pixels.resize(pixels.size() * channels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = testing::noise(1, 0, static_cast<std::uint32_t>(i));
    testing::write_exr_parts(path, {testing::simple_part(extent, channels, pixels)});
  }

  std::vector<float> channel(const std::string& path, const std::string& name) const {
    const tools::LoadedImage picture = image(path);
    std::vector<float> values;
    for (int y = 0; y < picture.extent.height; ++y) {
      for (int x = 0; x < picture.extent.width; ++x)
        values.push_back(picture.at(x, y, picture.channel(name)));
    }
    return values;
  }

  static constexpr const char* kSame = "--output 24x14 --method bilinear --jitter none";  // the identity
};

TEST_F(Layers, ALayerOfManyIsTakenAndNamedWhereItIsMissing) {
  write_channels(input(1), {24, 14}, kBlenderChannels);
  resolve_to("u", fmt::format("--colour ViewLayer.DiffCol {}", kSame));
  EXPECT_EQ(channel(output(1), "G"), channel(input(1), "ViewLayer.DiffCol.G"));
  resolve_to("u", kSame);  // by the usual name of a picture
  EXPECT_EQ(channel(output(1), "G"), channel(input(1), "ViewLayer.Combined.G"));
  expect_refused(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/o/u.%04d.exr' --colour C {}", kSame), 1,
                 "; --colour takes a layer of it: ViewLayer.Combined, ViewLayer.DiffCol");
}

TEST_F(Layers, GreyIsReadAsGrey) {
  for (const std::string prefix : {"", "key."}) {
    write_channels(input(1), {24, 14}, {prefix + "A", prefix + "Y", "depth.Z"});
    resolve_to("u", prefix.empty() ? kSame : fmt::format("--colour key {}", kSame));
    for (const char* name : {"R", "G", "B"})
      EXPECT_EQ(channel(output(1), name), channel(input(1), prefix + "Y")) << name;
    EXPECT_EQ(channel(output(1), "A"), channel(input(1), prefix + "A"));
    const auto listing =
        resolve(fmt::format("'{{}}/f.%04d.exr' -n {} {}", kSame, prefix.empty() ? "" : "--colour key"));
    EXPECT_NE(listing.out.find("grey " + prefix + "Y," + prefix + "A"), std::string::npos) << listing.out;
  }
}

// Y beside X is a direction.
TEST_F(Layers, AChannelNamedYBesideXIsNotGrey) {
  write_channels(input(1), {24, 14}, {"X", "Y"});
  expect_refused(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/o/u.%04d.exr' {}", kSame), 1,
                 "has no channel 'R'");
}

// Y beside RY and BY is the luminance of a colour. OpenImageIO 2.4 shows the three. 2.5 shows R, G and B in their
// place, and then misses that RY and BY are subsampled.
TEST_F(Layers, LuminanceOfAColourIsNotGrey) {
  write_channels(input(1), {24, 14}, {"BY", "RY", "Y"});
  const auto result = resolve(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/o/u.%04d.exr' {}", kSame));
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const auto says = [&](const char* what) { return result.err.find(what) != std::string::npos; };
  EXPECT_TRUE(says("f.0001.exr' has no channel 'R'") || says("f.0001.exr' cannot be read")) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("o/u.0001.exr")));
}

class TruthLayers : public Layers {
 protected:
  // Scores of the truth, which is the input: null stands for an infinite PSNR.
  nlohmann::json scores(const std::string& arguments) {
    const auto result =
        resolve(fmt::format("'{{}}/f.%04d.exr' --truth '{{}}/t.%04d.exr' --json {} {}", kSame, arguments));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? nlohmann::json::parse(result.out)["scores"]["frames"][0]
                                 : nlohmann::json();
  }
  std::string truth(int number) const { return folder_.file(fmt::format("t.{:04}.exr", number)); }
};

TEST_F(TruthLayers, TruthMayHaveManyLayers) {
  write_channels(input(1), {24, 14}, kBlenderChannels);
  std::filesystem::copy_file(input(1), truth(1));
  EXPECT_TRUE(
      scores("--colour ViewLayer.Combined --truth-colour ViewLayer.Combined")["psnr_linear"].is_null());
  EXPECT_LT(scores("--colour ViewLayer.Combined --truth-colour ViewLayer.DiffCol")["psnr_linear"], 20);
  const auto result =
      resolve(fmt::format("'{{}}/f.%04d.exr' --truth '{{}}/t.%04d.exr' --truth-colour C -q -n {}", kSame));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("truth '" + truth(1) + "' has no channel 'C.R'"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("; --truth-colour takes a layer of it: ViewLayer.Combined, ViewLayer.DiffCol"),
            std::string::npos)
      << result.err;
  expect_refused("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --truth-colour A", 2, "--truth");
}

TEST_F(TruthLayers, TruthMayBeGreyAndHaveAnyDataWindow) {
  write_channels(input(1), {24, 14}, {"Y"});
  std::filesystem::copy_file(input(1), truth(1));
  EXPECT_TRUE(scores("")["psnr_linear"].is_null());
  for (const std::string& path : {input(1), truth(1)}) {
    testing::ExrPart part = testing::simple_part({30, 10}, {"R", "G", "B"}, {});
    part.data = {-2, 3, {30, 10}};
    part.display = {0, 0, {24, 14}};
    for (std::uint32_t i = 0; i < 900; ++i)
      part.pixels.push_back(testing::noise(5, 0, i));
    testing::write_exr_parts(path, {part});
  }
  EXPECT_TRUE(scores("")["psnr_linear"].is_null());
}

}  // namespace
}  // namespace quincunx
