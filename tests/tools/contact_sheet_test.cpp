// SPDX-License-Identifier: MIT
#include "tools/image/contact_sheet.h"

#include <algorithm>

#include "temporary_folder.h"
#include "tools/image/image_io.h"

namespace quincunx::tools {
namespace {

std::vector<std::uint8_t> plain(Extent extent, std::uint8_t code) {
  return std::vector<std::uint8_t>(static_cast<std::size_t>(extent.area()) * 4, code);
}

int code_at(const LoadedImage& image, int x, int y, int channel) {
  return static_cast<int>(image.at(x, y, channel) * 255.0f + 0.5f);
}

TEST(EvenlySpaced, TakesBothEnds) {
  EXPECT_EQ(evenly_spaced(240, 3), (std::vector<int>{0, 120, 239}));
  EXPECT_EQ(evenly_spaced(3, 24), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(evenly_spaced(9, 1), (std::vector<int>{0}));
  EXPECT_TRUE(evenly_spaced(0, 5).empty());
}

// Lines of black and white average to half the light, which sRGB encodes as 188, not 128.
TEST(ContactSheet, FiltersInLinearLight) {
  const testing::TemporaryFolder folder;
  const Extent extent{64, 64};
  std::vector<std::uint8_t> lines = plain(extent, 0);
  for (int y = 0; y < 64; y += 2)
    std::fill_n(lines.begin() + y * 256, 256, std::uint8_t{255});
  ContactSheet sheet({.title = "", .subtitle = "", .columns = 1, .thumbnail_width = 16});
  ASSERT_TRUE(sheet.add(extent, lines.data(), {}).ok());
  ASSERT_TRUE(sheet.write(folder.file("sheet.png")).ok());
  const Result<LoadedImage> image = read_image(folder.file("sheet.png"));
  ASSERT_TRUE(image.ok()) << image.status().message();
  int found = 0;
  for (int y = 0; y < image->extent.height; ++y) {
    for (int x = 0; x < image->extent.width; ++x)
      found += code_at(image.value(), x, y, 0) == 188 ? 1 : 0;
  }
  EXPECT_EQ(found, 16 * 16);
}

// Sizes that do not divide: a constant must stay that constant, to the last code.
TEST(ContactSheet, KeepsAConstant) {
  const testing::TemporaryFolder folder;
  const Extent extent{257, 129};
  ContactSheet sheet({.title = "", .subtitle = "", .columns = 1, .thumbnail_width = 100});
  ASSERT_TRUE(sheet.add(extent, plain(extent, 201).data(), {}).ok());
  ASSERT_TRUE(sheet.write(folder.file("sheet.png")).ok());
  const Result<LoadedImage> image = read_image(folder.file("sheet.png"));
  ASSERT_TRUE(image.ok());
  int found = 0;
  for (int y = 0; y < image->extent.height; ++y) {
    for (int x = 0; x < image->extent.width; ++x)
      found += code_at(image.value(), x, y, 1) == 201 ? 1 : 0;
  }
  EXPECT_EQ(found, 100 * 50);
}

TEST(ContactSheet, HoldsFramesOfManySizesAndLongText) {
  const testing::TemporaryFolder folder;
  ContactSheet sheet({.title = std::string(400, 'W'), .subtitle = "1280×720 · größe", .thumbnail_width = 64});
  for (const Extent extent : {Extent{1, 1}, Extent{7, 500}, Extent{500, 7}, Extent{1280, 720}}) {
    ASSERT_TRUE(sheet
                    .add(extent, plain(extent, 90).data(),
                         {.left = "frame 0001 and a long story", .right = "0.71 · 909×511", .bar = 3.0f})
                    .ok());
  }
  EXPECT_EQ(sheet.size(), 4);
  EXPECT_TRUE(sheet.write(folder.file("sheet.png")).ok());
}

TEST(ContactSheet, ReadsRowsThatAreApart) {
  const testing::TemporaryFolder folder;
  const Extent extent{8, 8};
  std::vector<std::uint8_t> wide = plain({16, 8}, 255);  // the right half must not be seen
  for (int y = 0; y < 8; ++y)
    std::fill_n(wide.begin() + y * 64, 32, std::uint8_t{77});
  ContactSheet sheet({.title = "", .subtitle = "", .columns = 1, .thumbnail_width = 4});
  ASSERT_TRUE(sheet.add(extent, wide.data(), {}, 64).ok());
  ASSERT_TRUE(sheet.write(folder.file("sheet.png")).ok());
  const Result<LoadedImage> image = read_image(folder.file("sheet.png"));
  ASSERT_TRUE(image.ok());
  int found = 0;
  for (const float value : image->pixels)
    found += static_cast<int>(value * 255.0f + 0.5f) == 77 ? 1 : 0;
  EXPECT_EQ(found, 4 * 4 * 3);
}

TEST(ContactSheet, RefusesNothing) {
  const testing::TemporaryFolder folder;
  ContactSheet sheet({});
  EXPECT_EQ(sheet.write(folder.file("sheet.png")).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(sheet.add({0, 4}, plain({1, 1}, 0).data(), {}).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(sheet.add({4, 4}, nullptr, {}).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace quincunx::tools
