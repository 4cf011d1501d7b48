// SPDX-License-Identifier: MIT
// docs/examples/openscenegraph.cpp: an engine's own textures make a better picture than its viewport alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "program_run.h"
#include "skip.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "xvfb.h"

namespace quincunx::testing {
namespace {

constexpr Extent kOutput = {480, 270};
constexpr int kSide = 4;  // of a pixel, in samples of truth

// A textured wall behind 40 leaning bars, half as wide as a pixel.
void write_model(const TemporaryFolder& folder) {
  constexpr int kTexels = 256;
  std::ofstream texture(folder.file("wall.ppm"), std::ios::binary);
  texture << "P6\n" << kTexels << ' ' << kTexels << "\n255\n";
  for (int y = 0; y < kTexels; ++y) {
    for (int x = 0; x < kTexels; ++x) {
      const bool line = x % 32 < 4 || y % 32 < 4;
      const int grey = line ? 10 : (x / 32 + y / 32) % 2 == 0 ? 230 : 90;
      for (const int value : {grey, grey * x / kTexels, grey * y / kTexels})
        texture.put(static_cast<char>(value));
    }
  }
  std::ofstream(folder.file("model.mtl"))
      << "newmtl wall\nKd 1 1 1\nmap_Kd wall.ppm\nnewmtl bar\nKd .8 .6 .3\n";
  std::ofstream model(folder.file("model.obj"));
  model << "mtllib model.mtl\nvt 0 0\nvt 3 0\nvt 3 3\nvt 0 3\nvn 0 0 1\nusemtl wall\n";
  const std::string face = "f -4/1/1 -3/2/1 -2/3/1 -1/4/1\n";
  model << "v -2 -1 -1\nv 2 -1 -1\nv 2 1 -1\nv -2 1 -1\n" << face << "usemtl bar\n";
  for (int i = 0; i < 40; ++i) {
    const double x = -1.9 + i * 3.8 / 39;
    model << fmt::format("v {} -1 0\nv {} -1 0\nv {} 1 0\nv {} 1 0\n", x, x + 0.012, x + 0.212, x + 0.2)
          << face;
  }
}

class OpenSceneGraphExample : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed("Xvfb")) QUINCUNX_SKIP("Xvfb is not installed");
    server_ = std::make_unique<Xvfb>(folder_);
    write_model(folder_);
  }

  ProgramResult run(const std::string& arguments) {
    return run_program(
        folder_, arguments,
        ("env -u WAYLAND_DISPLAY DISPLAY=" + server_->name() + " " + QUINCUNX_OSG_EXAMPLE).c_str());
  }

  // The codes of the last of 40 frames: R G B, each in [0, 1].
  std::vector<float> picture(Extent extent, const std::string& scale_and_method) {
    const ProgramResult result = run(fmt::format("{{}}/model.obj {} {} 40 {{}}/picture.png {}", extent.width,
                                                 extent.height, scale_and_method));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto image = tools::read_image(folder_.file("picture.png"));
    EXPECT_TRUE(image.ok()) << image.status().message();
    EXPECT_EQ(image->extent, extent);
    EXPECT_EQ(image->pixels.size(), static_cast<std::size_t>(extent.area()) * 3);
    return image->pixels;
  }

  TemporaryFolder folder_;
  std::unique_ptr<Xvfb> server_;
};

// The mean of kSide x kSide pixels of light.
std::vector<float> reduced(const std::vector<float>& codes) {
  std::vector<float> means;
  const std::size_t row = static_cast<std::size_t>(kOutput.width) * kSide * 3;
  for (int y = 0; y < kOutput.height; ++y) {
    for (int i = 0; i < kOutput.width * 3; ++i) {
      float sum = 0;
      for (int j = 0; j < kSide * kSide; ++j) {
        const int x = i / 3 * kSide + j % kSide;
        sum += tools::linear_of_srgb(codes[(y * kSide + j / kSide) * row + x * 3 + i % 3]);
      }
      const float mean = sum / (kSide * kSide);
      means.push_back(mean <= 0.0031308f ? 12.92f * mean : 1.055f * std::pow(mean, 1 / 2.4f) - 0.055f);
    }
  }
  return means;
}

double psnr(const std::vector<float>& picture, const std::vector<float>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += std::pow(static_cast<double>(picture[i]) - static_cast<double>(truth[i]), 2);
  return -10 * std::log10(sum / static_cast<double>(truth.size()));
}

// Against the engine's own 16 samples a pixel, under a camera that moves by a pixel a frame. Measured: 30.7 against
// 26.1 dB.
TEST_F(OpenSceneGraphExample, ItsPictureIsThreeDecibelsBetterThanBilinear) {
  const auto truth = reduced(picture({kSide * kOutput.width, kSide * kOutput.height}, "1 bilinear"));
  const double bilinear = psnr(picture(kOutput, "0.5 bilinear"), truth);
  const double temporal = psnr(picture(kOutput, "0.5 temporal"), truth);
  EXPECT_GT(bilinear, 20) << "another picture";
  EXPECT_LT(bilinear, 35) << "there is nothing in the picture";
  EXPECT_GT(temporal, bilinear + 3);
}

TEST_F(OpenSceneGraphExample, TheControllerChoosesItsViewports) {
  const auto codes = picture(kOutput, "");
  EXPECT_NE(*std::min_element(codes.begin(), codes.end()), *std::max_element(codes.begin(), codes.end()));
}

TEST_F(OpenSceneGraphExample, WhatItCannotDoItSays) {
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  refused("", "openscenegraph MODEL");
  refused("{}/none.obj", "reads no model from '");
  refused("{}/model.obj 0 270", "output_extent is 0x270");
  server_->close();
  refused("{}/model.obj", "OpenSceneGraph finds no display");
}

}  // namespace
}  // namespace quincunx::testing
