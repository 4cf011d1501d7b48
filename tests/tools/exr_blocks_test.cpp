// SPDX-License-Identifier: MIT
// Whole files and files that were broken off, in every shape.
#include "tools/image/exr_blocks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "exr_files.h"
#include "temporary_folder.h"

namespace quincunx::tools {
namespace {

using testing::ExrPart;

class ExrBlocks : public ::testing::Test {
 protected:
  static ExrPart part_of(Extent extent, const std::string& compression, int tile) {
    std::vector<float> pixels;
    for (std::int64_t i = 0; i < extent.area() * 2; ++i)
      pixels.push_back(static_cast<float>(i * 7919 % 251));  // that does not compress to nothing
    ExrPart part = testing::simple_part(extent, {"R", "G"}, pixels);
    part.compression = compression;
    part.tile = tile;
    return part;
  }

  // The file is whole; without its last byte, or half of it, it is not.
  void expect_told(const std::vector<ExrPart>& parts, const std::string& what) {
    testing::write_exr_parts(path_, parts);
    EXPECT_TRUE(check_blocks(path_).ok()) << what << ": " << check_blocks(path_).message();
    const auto whole = std::filesystem::file_size(path_);
    for (const auto size : {whole - 1, whole * 2 / 3}) {
      std::filesystem::resize_file(path_, size);
      const Status status = check_blocks(path_);
      EXPECT_EQ(status.code(), StatusCode::kIoFailure) << what << " " << size;
      EXPECT_EQ(status.message().rfind("'" + path_ + "' is cut short: ", 0), 0u) << status.message();
    }
  }

  testing::TemporaryFolder folder_;
  const std::string path_ = folder_.file("a.exr");
};

TEST_F(ExrBlocks, OfEveryCompressionAndSize) {
  for (const char* compression :
       {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    for (const Extent extent : {Extent{40, 30}, Extent{33, 257}, Extent{300, 16}})
      expect_told({part_of(extent, compression, 0)}, compression);
  }
}

TEST_F(ExrBlocks, OfTilesAndSeveralParts) {
  expect_told({part_of({70, 45}, "zip", 16)}, "tiles");
  for (const int tile : {0, 16}) {
    std::vector<ExrPart> parts = {part_of({40, 30}, "zip", tile), part_of({40, 30}, "piz", tile),
                                  part_of({40, 30}, "zip", tile)};
    parts[0].name = "one", parts[1].name = "two", parts[2].name = "three";
    expect_told(parts, "parts");
  }
}

TEST_F(ExrBlocks, TheMessageCountsThem) {
  testing::write_exr_parts(path_, {part_of({64, 160}, "zip", 0)});
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  EXPECT_EQ(check_blocks(path_).message(),
            "'" + path_ + "' is cut short: 1 of its 10 blocks of pixels is missing; render or copy it again");
  // A renderer that is not through has written no offset.
  testing::write_exr_parts(path_, {part_of({64, 160}, "zip", 0)});
  std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  const std::size_t table =
      bytes.find(std::string("screenWindowWidth") + '\0' + "float" + '\0') + 24 + 4 + 4 + 1;
  file.clear();
  file.seekp(static_cast<std::streamoff>(table + 8 * 7));
  file.write(std::string(24, '\0').data(), 24);
  file.close();
  EXPECT_EQ(
      check_blocks(path_).message(),
      "'" + path_ + "' is cut short: 3 of its 10 blocks of pixels are missing; render or copy it again");
}

TEST_F(ExrBlocks, WhatItDoesNotKnowIsLeftToOthers) {
  std::ofstream(path_) << "no picture";
  EXPECT_TRUE(check_blocks(path_).ok());
  EXPECT_TRUE(check_blocks(folder_.file("none.exr")).ok());
  testing::write_deep_exr(path_, {24, 14});
  EXPECT_TRUE(check_blocks(path_).ok());
}

// Whatever bytes a header holds, the check ends.
TEST_F(ExrBlocks, DamagedHeadersDoNoHarm) {
  testing::write_exr_parts(path_, {part_of({40, 30}, "zip", 0)});
  std::ifstream file(path_, std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(file), {});
  for (std::size_t at = 4; at < 400; ++at) {
    for (const char value : {'\0', '\x7f', '\xff'}) {
      std::string bytes = whole;
      bytes[at] = value;
      std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
      const Status status = check_blocks(path_);
      EXPECT_TRUE(status.ok() || status.code() == StatusCode::kIoFailure) << at;
    }
  }
}

}  // namespace
}  // namespace quincunx::tools
