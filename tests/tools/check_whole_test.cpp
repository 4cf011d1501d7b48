// SPDX-License-Identifier: MIT
// Whole files and files that were broken off or damaged, in every shape.
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "exr_files.h"
#include "temporary_folder.h"
#include "tools/image/image_io.h"
#include "tools/image/image_reader.h"

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
    EXPECT_TRUE(check_whole(path_).ok()) << what << ": " << check_whole(path_).message();
    const auto whole = std::filesystem::file_size(path_);
    for (const auto size : {whole - 1, whole * 2 / 3}) {
      std::filesystem::resize_file(path_, size);
      const Status status = check_whole(path_);
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
  ExrPart levels = part_of({70, 45}, "zip", 16);
  levels.mipmaps = true;
  expect_told({levels}, "mipmaps");
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
  EXPECT_EQ(check_whole(path_).message(),
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
      check_whole(path_).message(),
      "'" + path_ + "' is cut short: 3 of its 10 blocks of pixels are missing; render or copy it again");
}

TEST_F(ExrBlocks, WhatItDoesNotKnowIsLeftToOthers) {
  std::ofstream(path_) << "no picture";
  EXPECT_TRUE(check_whole(path_).ok());
  testing::write_deep_exr(path_, {24, 14});
  EXPECT_TRUE(check_whole(path_).ok());
  ASSERT_EQ(::mkfifo(folder_.file("pipe").c_str(), 0600), 0);
  EXPECT_FALSE(check_whole(folder_.file("pipe")).ok());  // at once
}

// The check ends whatever bytes a header holds.
TEST_F(ExrBlocks, DamagedHeadersDoNoHarm) {
  testing::write_exr_parts(path_, {part_of({40, 30}, "zip", 0)});
  const std::string whole = testing::read_file(path_);
  for (std::size_t at = 4; at < 400; ++at) {
    for (const char value : {'\0', '\x7f', '\xff'}) {
      std::string bytes = whole;
      bytes[at] = value;
      std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
      const Status status = check_whole(path_);
      EXPECT_TRUE(status.ok() || status.code() == StatusCode::kIoFailure) << at;
    }
  }
}

TEST(CheckWhole, TellsCutFilesOfEveryFormatThatIsWritten) {
  const testing::TemporaryFolder folder;
  std::vector<std::uint8_t> texels(64 * 64 * 4);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = static_cast<std::uint8_t>(i * i * 7919 >> 8);
  for (const char* name : {"a.png", "a.jpg", "a.dpx", "a.tif"}) {
    if (!format_of(name)) continue;
    const std::string path = folder.file(name);
    ASSERT_TRUE(write_picture(path, {64, 64}, texels.data()).ok());
    EXPECT_TRUE(check_whole(path).ok()) << check_whole(path).message();
    const auto size = std::filesystem::file_size(path);
    for (const auto part : {size - 16, size / 2}) {
      std::filesystem::resize_file(path, part);
      EXPECT_EQ(check_whole(path).message(),
                "'" + path + "' is cut short: its end is missing; render or copy it again");
    }
  }
}

TEST(CheckWhole, KnowsTheEndsOfOtherPrograms) {
  using namespace std::string_literals;
  const testing::TemporaryFolder folder;
  const auto is_whole = [&](const std::string& bytes) {
    std::ofstream(folder.file("a"), std::ios::binary | std::ios::trunc) << bytes;
    return check_whole(folder.file("a")).ok();
  };
  EXPECT_TRUE(is_whole("\xff\xd8\xff\xe0 \xff\xd9\0\0\0"s));
  EXPECT_FALSE(is_whole("\xff\xd8\xff\xe0 \xff\xd9 "s));
  const std::string dpx = "V1.0\0\0\0\0"s;  // between the offset of the pixels and the size of the file
  EXPECT_TRUE(is_whole("SDPX\0\0\0\0"s + dpx + "\0\0\0\x16  "s));
  EXPECT_FALSE(is_whole("SDPX\0\0\0\0"s + dpx + "\0\0\0\x17  "s));
  EXPECT_FALSE(is_whole("XPDS\0\0\0\0"s + dpx + "\x17\0\0\0  "s));
  EXPECT_TRUE(is_whole("XPDS\0\0\0\0"s + dpx + "\xff\xff\xff\xff  "s));
  // The directory of a TIFF before its pixels: two strips of four bytes, at 42 and 46.
  const std::string tiff =
      "II*\0\x08\0\0\0\2\0"
      "\x11\1\3\0\2\0\0\0\x2a\0\x2e\0"
      "\x17\1\4\0\2\0\0\0\x22\0\0\0"
      "\4\0\0\0\4\0\0\0pixelpix"s;
  EXPECT_TRUE(is_whole(tiff));
  for (std::size_t size = 4; size < tiff.size(); ++size)
    EXPECT_FALSE(is_whole(tiff.substr(0, size))) << size;
  EXPECT_TRUE(
      is_whole("MM\0*\0\0\0\x08\0\2"
               "\1\x44\0\4\0\0\0\1\0\0\0\x22"
               "\1\x45\0\3\0\0\0\1\0\2\0\0pi"s));
  EXPECT_FALSE(
      is_whole("MM\0*\0\0\0\x08\0\2"
               "\1\x44\0\4\0\0\0\1\0\0\0\x22"
               "\1\x45\0\3\0\0\0\1\0\3\0\0pi"s));
}

// Those whose size follows from their header. Each is whole, and has pixels to its last byte.
TEST(CheckWhole, CountsPixelsThatAreNotCompressed) {
  using namespace std::string_literals;
  const testing::TemporaryFolder folder;
  const std::pair<const char*, std::string> files[] = {
      {"a.ppm", "P6 # 3x2\n3\n2 255\n" + std::string(18, 'x')},
      {"a.pgm", "P5\n3 2\n65535 " + std::string(12, 'x')},
      {"a.pbm", "P4\n9 2\n" + std::string(4, 'x')},
      {"a.pfm", "PF\n3 2\n-1.0\n" + std::string(72, 'x')},
      {"b.pfm", "Pf\n3 2\n1e0\n" + std::string(24, 'x')},
      {"a.bmp", "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\3\0\0\0\xfe\xff\xff\xff\1\0\x18\0"s +
                    std::string(24, '\0') + std::string(24, 'x')},
      {"b.bmp", "BM\0\0\0\0\0\0\0\0\x1a\0\0\0\x0c\0\0\0\3\0\2\0\1\0\x18\0"s + std::string(24, 'x')},
      {"a.tga", "\2\0\2\0\0\0\0\0\0\0\0\0\3\0\2\0\x20\0id"s + std::string(24, 'x')},
      {"b.TGA", "\0\1\1\0\0\2\0\x18\0\0\0\0\3\0\2\0\x08\0"s + std::string(6 + 6, 'x')},
      {"a.webp", "RIFF\6\0\0\0WEBPxx"s}};
  for (const auto& [name, bytes] : files) {
    std::ofstream(folder.file(name), std::ios::binary) << bytes;
    EXPECT_TRUE(check_whole(folder.file(name)).ok()) << name;
    for (std::size_t size = bytes.size() - 1; size > 4; --size) {
      std::filesystem::resize_file(folder.file(name), size);
      EXPECT_EQ(check_whole(folder.file(name)).message(),
                "'" + folder.file(name) + "' is cut short: its end is missing; render or copy it again")
          << size;
    }
  }
}

TEST(ReadImage, RefusesTruncatedFiles) {
  const testing::TemporaryFolder folder;
  std::vector<float> noise(64 * 64);
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = std::sin(static_cast<float>(i * i));
  const Channel channel{"Z", ChannelType::kFloat, noise.data(), 0, 0, ChannelType::kFloat};
  const std::string path = folder.file("a.exr");
  ASSERT_TRUE(write_exr(path, {64, 64}, {&channel, 1}).ok());
  const auto size = std::filesystem::file_size(path);
  for (const auto part : {size / 2, size / 8, std::uintmax_t{100}, std::uintmax_t{5}}) {
    std::filesystem::resize_file(path, part);
    const Result<LoadedImage> image = read_image(path);
    EXPECT_FALSE(image.ok()) << part;
    EXPECT_EQ(image.status().message().find('\n'), std::string::npos) << image.status().message();
  }
}

// libjpeg fills what is missing with grey.
TEST(ReadImage, RefusesWhatALibraryOnlyWarnsOf) {
  if (!format_of("a.jpg")) return;
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("a.jpg");
  std::vector<std::uint8_t> texels(64 * 64 * 4);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = static_cast<std::uint8_t>(i * i * 7919 >> 8);
  ASSERT_TRUE(write_picture(path, {64, 64}, texels.data()).ok());
  std::string bytes = testing::read_file(path);
  bytes.replace(bytes.size() / 2, 2, "\xff\xd9");  // an end before the end
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_TRUE(check_whole(path).ok());
  const std::string message = read_image(path).status().message();
  EXPECT_EQ(message.rfind("'" + path + "' cannot be read: ", 0), 0u) << message;
}

}  // namespace
}  // namespace quincunx::tools
