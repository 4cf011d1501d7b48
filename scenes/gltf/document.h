// SPDX-License-Identifier: MIT
// GltfDocument: a glTF file as data that can be trusted in form. Private to the glTF loader.
//
// After open_gltf_document every field read here has its type, its range and, where it is an
// index, something to point at; every buffer is loaded and as long as it says; each node has one parent at
// most and the graph no cycle. What accessors and images hold is checked when they are read. tinygltf gives
// the types; it never sees bytes from the file, only JSON that checked_gltf_json() has rebuilt.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
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

// The fields of a file that the loader reads.
struct CheckedJson {
  nlohmann::json root;
  std::vector<std::string> unknown_extensions;  // that the file uses, as they stand there
};

// Parses the text and rebuilds it from known fields only, each with its right type, in range, and every index pointing
// at something; so its depth is small and nothing of it can surprise a trusting reader. Extras, unknown extensions and
// morph targets are gone afterwards. Throws GltfError that names the object and the field, also for an extension that
// the file requires and the loader lacks. In validate.cpp.
CheckedJson checked_gltf_json(const std::string& text);

// Returns "accessor 3" or "mesh 1 'Suzanne'".
std::string described(const char* kind, int index, const std::string& name);

bool holds_data(std::string_view uri);  // rather than naming a file

// Returns the encoded bytes of an image. Throws GltfError when they cannot be had.
std::vector<std::uint8_t> image_bytes(const GltfDocument& document, int image);

// Returns the parent of each node, -1 for a root. Throws GltfError for a node with two.
std::vector<int> parents_of(const tinygltf::Model& model);

}  // namespace quincunx::scenes
