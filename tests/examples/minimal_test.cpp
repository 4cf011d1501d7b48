// SPDX-License-Identifier: MIT
// docs/examples/minimal.cpp: its picture is nearer to the truth than one frame's. Its main() is called here.
#define main minimal_main
#include "../../docs/examples/minimal.cpp"
#undef main

#include <gtest/gtest.h>

#include <string>

#include "picture_file.h"
#include "tools/temporary_folder.h"

namespace {

using quincunx::testing::mean_square_error;

// The method's picture of one frame, as the screen shows it.
std::string shown(Method method, Extent render, const std::vector<float>& rgba) {
  const Device device = Device::open().value();
  const ResolvePlan plan = plan_for({.transparents = false}, {.method = method,
                                                              .output_extent = kOutput,
                                                              .target_extent = render,
                                                              .colour = PixelFormat::kRGBA32F})
                               .value();
  ResolveService service = ResolveService::create(device, plan).value();
  const Image colour = device.allocate(render, PixelFormat::kRGBA32F).value();
  const Image picture = device.allocate(kOutput, PixelFormat::kRGBA8).value();
  EXPECT_TRUE(device.upload(colour.view(), render, rgba.data()).ok());
  EXPECT_TRUE(
      service.dispatch({.colour = colour.view(), .render_extent = render}, {.presented = picture.view()})
          .ok());
  std::string codes(static_cast<std::size_t>(kOutput.area()) * 4, '\0');
  EXPECT_TRUE(device.download(picture.view(), kOutput, codes.data()).ok());
  std::string rgb;
  for (std::size_t i = 0; i < codes.size(); i += 4)
    rgb.append(codes, i, 3);
  return rgb;
}

// Each pixel's mean of 8x8 places.
std::vector<float> truth(int frame) {
  std::vector<float> rgba(static_cast<std::size_t>(kOutput.area()) * 4, 0);
  constexpr int kSide = 8;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec2 at = {(static_cast<float>(i % kSide) + .5f) / kSide - .5f,
                     (static_cast<float>(i / kSide) + .5f) / kSide - .5f};
    const std::vector<float> sample = draw(kOutput, at, frame);
    for (std::size_t k = 0; k < rgba.size(); ++k)
      rgba[k] += sample[k] / (kSide * kSide);
  }
  return rgba;
}

// Measured: 212 against 1543 codes squared.
TEST(MinimalExample, ItsPictureHasHalfTheErrorOfBilinearAtMost) {
  quincunx::testing::TemporaryFolder folder;
  std::string path = folder.file("picture.ppm");
  char* arguments[] = {path.data(), path.data()};
  ASSERT_EQ(minimal_main(2, arguments), 0);
  const std::string picture = quincunx::testing::ppm_texels(quincunx::testing::read_file(path), kOutput);
  const std::string wanted = shown(Method::kPoint, kOutput, truth(63));
  const std::string bilinear = shown(Method::kBilinear, kRender, draw(kRender, {}, 63));
  EXPECT_GT(mean_square_error(wanted, std::string(wanted.size(), '\0')), 1000) << "the picture is black";
  EXPECT_LT(mean_square_error(picture, wanted), .5 * mean_square_error(bilinear, wanted));
}

}  // namespace
