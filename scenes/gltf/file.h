// SPDX-License-Identifier: MIT
// Files and URIs of glTF: containers, percent encoding, base64. Private to the glTF loader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace quincunx::scenes {

// No file, buffer or offset may be larger, so that sums of two sizes never overflow 32 unsigned bits.
constexpr std::uint64_t kMaxGltfBytes = (std::uint64_t{1} << 31) - 1;

// The two parts of a .glb; a .gltf has only the first.
struct GltfContainer {
  std::string json;
  std::vector<std::uint8_t> binary;
};

// Reads a .gltf or .glb, told apart by their first bytes. Throws GltfError.
GltfContainer read_gltf_container(const std::filesystem::path& path);

// The whole of a regular file. `what` begins the sentence of the GltfError: "image 2".
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, const std::string& what);

// The bytes behind a URI: data (base64 or percent encoded) or a file relative to `folder`. Throws GltfError.
std::vector<std::uint8_t> read_uri(const std::filesystem::path& folder, const std::string& uri,
                                   const std::string& what);

// Throws GltfError for a % without two hexadecimal digits.
std::string percent_decoded(std::string_view text, const std::string& what);

// Standard alphabet, padding optional. Throws GltfError for any other character or a bad length.
std::vector<std::uint8_t> base64_decoded(std::string_view text, const std::string& what);

}  // namespace quincunx::scenes
