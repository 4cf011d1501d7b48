// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <string>

#include "gltf/contents.h"

// Our own copy of the decoder, with the two formats of glTF only: the less of it a file can reach, the
// better.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#include <stb/stb_image.h>

namespace quincunx::scenes {
namespace {

constexpr int kMaxSide = 16384;  // what GL 4.5 drivers offer at least

bool is_png(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 8 && std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8) == 0;
}

bool is_jpeg(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

// The chunks of a PNG up to IEND, without empty IDATs: those are legal, but stb_image copies their no bytes
// to a null pointer. Lengths that leave the file never reach the decoder.
std::vector<std::uint8_t> sound_png(const std::vector<std::uint8_t>& bytes, const std::string& who) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kAroundData = 12;  // length, type, checksum
  std::vector<std::uint8_t> result(bytes.begin(), bytes.begin() + kSignature);
  for (std::size_t at = kSignature; bytes.size() - at >= kAroundData;) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = length << 8 | bytes[at + i];
    if (length > bytes.size() - at - kAroundData) break;
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto last = first + static_cast<std::ptrdiff_t>(length + kAroundData);
    const bool is_empty_data = length == 0 && std::memcmp(&bytes[at + 4], "IDAT", 4) == 0;
    if (!is_empty_data) result.insert(result.end(), first, last);
    if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return result;
    at += length + kAroundData;
  }
  throw GltfError(who + " cannot be decoded (it is truncated or broken); an intact PNG or JPEG is needed");
}

struct StbDeleter {
  void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

DecodedImage decode_image(const GltfDocument& document, int image) {
  const tinygltf::Image& source = document.model.images[static_cast<std::size_t>(image)];
  const bool is_file = source.bufferView < 0 && !holds_data(source.uri);
  const std::string who =
      described("image", image, source.name) + (is_file ? " ('" + source.uri + "')" : std::string());
  std::vector<std::uint8_t> bytes = image_bytes(document, image);
  if (is_png(bytes)) {
    bytes = sound_png(bytes, who);
  } else if (!is_jpeg(bytes)) {
    throw GltfError(who + " is neither PNG nor JPEG, as glTF 2.0 demands");
  }

  const auto* data = bytes.data();
  const int size = static_cast<int>(bytes.size());  // below kMaxGltfBytes
  int width = 0;
  int height = 0;
  int channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
    throw GltfError(fmt::format("{} cannot be decoded ({}); an intact PNG or JPEG is needed", who,
                                stbi_failure_reason()));
  }
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw GltfError(
        fmt::format("{} has {}x{} pixels; 1 to {} on each side can be read", who, width, height, kMaxSide));
  }
  const std::unique_ptr<stbi_uc, StbDeleter> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4));
  if (!pixels) {
    throw GltfError(fmt::format("{} cannot be decoded ({}); an intact PNG or JPEG is needed", who,
                                stbi_failure_reason()));
  }
  DecodedImage result{width, height, {}};
  result.rgba.assign(pixels.get(),
                     pixels.get() + static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  return result;
}

}  // namespace quincunx::scenes
