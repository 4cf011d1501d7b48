// SPDX-License-Identifier: MIT
// GltfFile: builds small glTF files for tests, right or wrong on purpose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace quincunx::testing {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;

enum Component : int {
  kByte = 5120,
  kUByte = 5121,
  kShort = 5122,
  kUShort = 5123,
  kUInt = 5125,
  kFloat = 5126
};

inline void write_bytes(const std::string& path, const void* bytes, std::size_t size) {
  std::ofstream(path, std::ios::binary)
      .write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
}

inline std::string base64(const Bytes& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

// A PNG of RGBA pixels.
inline Bytes png(int width, int height, const Bytes& rgba) {
  Bytes result;
  stbi_write_png_to_func(
      [](void* context, void* data, int size) {
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        static_cast<Bytes*>(context)->insert(static_cast<Bytes*>(context)->end(), bytes, bytes + size);
      },
      &result, width, height, 4, rgba.data(), width * 4);
  return result;
}

inline const char* type_name(int components) {
  constexpr const char* kNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kNames[components - 1];
}

class GltfFile {
 public:
  json root = {{"asset", {{"version", "2.0"}}}};
  Bytes binary;

  int append(const char* list, json object) {
    root[list].push_back(std::move(object));
    return static_cast<int>(root[list].size()) - 1;
  }

  int view(const Bytes& bytes, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    json object = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) object["byteStride"] = stride;
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return append("bufferViews", std::move(object));
  }

  template <typename T>
  static Bytes bytes_of(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }

  template <typename T>
  int accessor(const std::vector<T>& values, int components, Component type, bool normalised = false) {
    json object = {{"bufferView", view(bytes_of(values))},
                   {"componentType", static_cast<int>(type)},
                   {"count", values.size() / static_cast<std::size_t>(components)},
                   {"type", type_name(components)}};
    if (normalised) object["normalized"] = true;
    return append("accessors", std::move(object));
  }

  int floats(const std::vector<float>& values, int components) {
    return accessor(values, components, kFloat);
  }

  // A mesh of one primitive, shown by a node of its own in scene 0; returns the node.
  int show(json primitive, const std::string& name = "Thing") {
    const int mesh = append("meshes", {{"name", name}, {"primitives", json::array({std::move(primitive)})}});
    const int node = append("nodes", {{"name", name + " node"}, {"mesh", mesh}});
    list_in_scene(node);
    return node;
  }

  void list_in_scene(int node) {
    if (!root.contains("scenes")) append("scenes", {{"nodes", json::array()}});
    root["scenes"][0]["nodes"].push_back(node);
  }

  // One triangle (0,0,0) (1,0,0) (0,1,0) with `extra` members; returns the node.
  int triangle(const json& extra = json::object(), const std::string& name = "Thing") {
    json primitive = {{"attributes", {{"POSITION", floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)}}}};
    primitive.update(extra);
    return show(std::move(primitive), name);
  }

  // With the buffer as data URI.
  std::string save_gltf(const std::string& path) const {
    json copy = root;
    if (!binary.empty() && !copy.contains("buffers")) {
      copy["buffers"] = json::array({{{"byteLength", binary.size()},
                                      {"uri", "data:application/octet-stream;base64," + base64(binary)}}});
    }
    const std::string text = copy.dump();
    write_bytes(path, text.data(), text.size());
    return path;
  }

  Bytes glb() const {
    json copy = root;
    if (!copy.contains("buffers")) copy["buffers"] = json::array({{{"byteLength", binary.size()}}});
    std::string text = copy.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    Bytes padded = binary;
    padded.resize((padded.size() + 3) / 4 * 4);
    Bytes file;
    const auto word = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8)
        file.push_back(static_cast<std::uint8_t>(value >> shift & 255));
    };
    word(0x46546c67);
    word(2);
    word(12 + 8 + text.size() + 8 + padded.size());
    word(text.size());
    word(0x4e4f534a);
    file.insert(file.end(), text.begin(), text.end());
    word(padded.size());
    word(0x004e4942);
    file.insert(file.end(), padded.begin(), padded.end());
    return file;
  }

  std::string save_glb(const std::string& path) const {
    const Bytes bytes = glb();
    write_bytes(path, bytes.data(), bytes.size());
    return path;
  }
};

}  // namespace quincunx::testing
