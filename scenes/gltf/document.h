// SPDX-License-Identifier: MIT
// GltfDocument: a glTF file as data that can be trusted in form. Private to the glTF loader.
//
// After open_gltf_document every field read here has its type, its range and, where it is an
// index, something to point at; every buffer is loaded and as long as it says; each node has one parent at
// most and the graph no cycle. What accessors and images hold is checked when they are read. tinygltf gives
// the types; it never sees bytes from the file, only JSON that gltf_schema has checked and rebuilt.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace quincunx::scenes {

// Thrown inside the loader only; what() is a sentence without the path, which load_gltf puts in front.
class GltfError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct GltfDocument {
  std::filesystem::path path;
  tinygltf::Model model;  // buffers hold their bytes; images hold only uri, bufferView, mimeType and name

  // Logs a warning with the path in front; the same sentence only once a document.
  void warn(const std::string& sentence);

 private:
  std::set<std::string> warned_;
};

// Throws GltfError for everything that is wrong with the file.
GltfDocument open_gltf_document(const std::filesystem::path& path);

// "accessor 3", "mesh 1 'Suzanne'".
std::string described(const char* kind, int index, const std::string& name);

// The encoded bytes of an image. Throws GltfError when they cannot be had.
std::vector<std::uint8_t> image_bytes(const GltfDocument& document, int image);

// The parent of each node, -1 for a root.
std::vector<int> parents_of(const tinygltf::Model& model);

}  // namespace quincunx::scenes
