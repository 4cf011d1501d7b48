// SPDX-License-Identifier: MIT
// The document, and files and URIs of glTF: containers, percent encoding, base64.
#include "gltf/document.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace quincunx::scenes {
namespace {

// No file, buffer or offset may be larger, so that sums of two sizes never overflow 32 unsigned bits.
constexpr std::uint64_t kMaxGltfBytes = (std::uint64_t{1} << 31) - 1;

// The two parts of a .glb; a .gltf has only the first.
struct GltfContainer {
  std::string json;
  std::vector<std::uint8_t> binary;
};

constexpr std::uint32_t kGlbMagic = 0x46546c67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;
constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t word_at(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16 |
         static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

GltfContainer split_glb(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < kGlbHeaderBytes + kChunkHeaderBytes) {
    throw GltfError(
        fmt::format("the binary glTF ends after {} bytes; its headers alone take 20", bytes.size()));
  }
  if (const std::uint32_t version = word_at(bytes, 4); version != 2) {
    throw GltfError(fmt::format("the binary glTF has version {}; only version 2 can be read", version));
  }
  const std::uint64_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    throw GltfError(fmt::format("the file is truncated: it has {} bytes of the {} that its header states",
                                bytes.size(), length));
  }
  GltfContainer container;
  std::uint64_t offset = kGlbHeaderBytes;
  for (int chunk = 0; offset + kChunkHeaderBytes <= length; ++chunk) {
    const std::uint64_t size = word_at(bytes, static_cast<std::size_t>(offset));
    const std::uint32_t type = word_at(bytes, static_cast<std::size_t>(offset + 4));
    offset += kChunkHeaderBytes;
    if (size > length - offset) {
      throw GltfError(fmt::format("chunk {} of the binary glTF states {} bytes, but only {} are left", chunk,
                                  size, length - offset));
    }
    if ((chunk == 0) != (type == kJsonChunk)) {
      throw GltfError("the binary glTF must have one JSON chunk, and have it first");
    }
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
    const auto last = first + static_cast<std::ptrdiff_t>(size);
    if (chunk == 0) container.json.assign(first, last);
    if (chunk == 1 && type == kBinaryChunk) container.binary.assign(first, last);
    offset += (size + 3) / 4 * 4;
  }
  if (container.json.empty()) throw GltfError("the binary glTF has an empty JSON chunk; it needs an object");
  return container;
}

// Decodes %xx. Throws GltfError for a % without two hexadecimal digits.
std::string percent_decoded(std::string_view text, const std::string& what) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    std::uint8_t code = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    if (digits.size() != 2 || read.ptr != digits.data() + 2)
      throw GltfError(what + " has a URI with '%' that is not followed by two hexadecimal digits");
    decoded.push_back(static_cast<char>(code));
    i += 2;
  }
  return decoded;
}

// Decodes the standard alphabet, padding optional. Throws GltfError for any other character or a bad length.
std::vector<std::uint8_t> base64_decoded(std::string_view text, const std::string& what) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> digits;
  digits.fill(0xff);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    digits[static_cast<std::uint8_t>(kDigits[i])] = static_cast<std::uint8_t>(i);
  while (!text.empty() && text.back() == '=')
    text.remove_suffix(1);
  if (text.size() % 4 == 1)
    throw GltfError(what + " has a base64 data URI of an impossible length; it is truncated");
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::uint8_t digit = digits[static_cast<std::uint8_t>(c)];
    if (digit == 0xff) {
      throw GltfError(fmt::format("{} has a data URI with the byte {:#04x}, which is not base64", what,
                                  static_cast<unsigned>(static_cast<std::uint8_t>(c))));
    }
    bits = bits << 6 | digit;
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count & 0xff));
  }
  return bytes;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::vector<std::uint8_t> read_data_uri(std::string_view uri, const std::string& what) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    throw GltfError(what + " has a data URI without a comma; expected data:<type>;base64,<data>");
  }
  std::string text = percent_decoded(uri.substr(comma + 1), what);
  if (!lower_case(uri.substr(0, comma)).ends_with(";base64")) return {text.begin(), text.end()};
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });  // some break their lines
  return base64_decoded(text, what);
}

// Reads the whole of a regular file. `what` begins the sentence of the GltfError: "image 2".
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, const std::string& what) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw GltfError(fmt::format("{} is missing: there is no file '{}'", what, path.string()));
  if (!std::filesystem::is_regular_file(status)) {
    throw GltfError(fmt::format(
        "{} cannot be read: '{}' is {}", what, path.string(),
        std::filesystem::is_directory(status) ? "a directory, not a file" : "not a regular file"));
  }
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error || size > kMaxGltfBytes) {
    throw GltfError(fmt::format("{} cannot be read: '{}' must be smaller than {} bytes", what, path.string(),
                                kMaxGltfBytes));
  }
  std::ifstream stream(path, std::ios::binary);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) {
    throw GltfError(fmt::format("{} cannot be read: opening or reading '{}' failed; check its permissions",
                                what, path.string()));
  }
  return bytes;
}

// Reads a .gltf or .glb, told apart by their first bytes. Throws GltfError.
GltfContainer read_gltf_container(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path, "the file");
  if (bytes.empty()) throw GltfError("the file is empty; a glTF 2.0 file (.gltf or .glb) is needed");
  if (bytes.size() >= 4 && word_at(bytes, 0) == kGlbMagic) return split_glb(bytes);

  std::size_t start = 0;
  if (bytes.size() >= 3 && std::memcmp(bytes.data(), "\xef\xbb\xbf", 3) == 0) start = 3;  // byte order mark
  std::size_t first = start;
  while (first < bytes.size() && std::isspace(bytes[first]) != 0)
    ++first;
  if (first == bytes.size() || bytes[first] != '{') {
    throw GltfError("the file is not glTF: it begins neither with '{' (.gltf) nor with 'glTF' (.glb)");
  }
  return {{bytes.begin() + static_cast<std::ptrdiff_t>(start), bytes.end()}, {}};
}

// Returns the bytes behind a URI: data (base64 or percent encoded) or a file relative to `folder`. Throws GltfError.
std::vector<std::uint8_t> read_uri(const std::filesystem::path& folder, const std::string& uri,
                                   const std::string& what) {
  if (holds_data(uri)) return read_data_uri(uri, what);
  std::string relative = uri;
  std::replace(relative.begin(), relative.end(), '\\', '/');  // never part of a URI, but of paths on Windows
  std::error_code unreadable;
  if (!std::filesystem::exists(folder / relative, unreadable)) relative = percent_decoded(relative, what);
  if (relative.empty()) throw GltfError(what + " has an empty URI; it must name a file or hold data");
  if (relative.find('\0') != std::string::npos) {
    throw GltfError(what + " has a URI with a zero byte; it must name a file");
  }
  const std::filesystem::path file(relative);
  if (relative.find("://") != std::string::npos || file.is_absolute() ||
      std::find(file.begin(), file.end(), "..") != file.end()) {
    throw GltfError(fmt::format(
        "{} refers to '{}'; only files beside the glTF and in folders there can be read", what, relative));
  }
  return read_file(folder / file, what);
}

using nlohmann::json;

json take(json& root, const char* name) {
  json result = root.contains(name) ? std::move(root[name]) : json::array();
  root.erase(name);
  return result;
}

tinygltf::Buffer load_buffer(const json& buffer, int index, const std::filesystem::path& folder,
                             std::vector<std::uint8_t>& binary) {
  tinygltf::Buffer result;
  result.name = buffer.value("name", "");
  const std::string what = described("buffer", index, result.name);
  if (buffer.contains("uri")) {
    result.data = read_uri(folder, buffer["uri"].get<std::string>(), what);
  } else if (index == 0 && !binary.empty()) {
    result.data = std::move(binary);
  } else {
    throw GltfError(what + " has no 'uri'; only buffer 0 of a .glb may do without, and then has a BIN chunk");
  }
  const std::uint64_t stated = buffer["byteLength"].get<std::uint64_t>();
  if (result.data.size() < stated) {
    throw GltfError(fmt::format("{} is truncated: it has {} bytes of the {} that 'byteLength' states", what,
                                result.data.size(), stated));
  }
  result.data.resize(static_cast<std::size_t>(stated));
  return result;
}

tinygltf::Image described_image(const json& image, int index) {
  tinygltf::Image result;
  result.name = image.value("name", "");
  result.uri = image.value("uri", "");
  result.mimeType = image.value("mimeType", "");
  result.bufferView = image.contains("bufferView") ? image["bufferView"].get<int>() : -1;
  if (result.uri.empty() == (result.bufferView < 0)) {
    throw GltfError(described("image", index, result.name) + " must have either a 'uri' or a 'bufferView'");
  }
  return result;
}

void check_buffer_views(const tinygltf::Model& model) {
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = model.bufferViews[i];
    const std::size_t size = model.buffers[static_cast<std::size_t>(view.buffer)].data.size();
    if (view.byteOffset > size || view.byteLength > size - view.byteOffset) {
      throw GltfError(fmt::format("{} covers bytes {} to {}, but buffer {} has only {}",
                                  described("bufferView", static_cast<int>(i), view.name), view.byteOffset,
                                  view.byteOffset + view.byteLength, view.buffer, size));
    }
  }
}

void check_graph(const tinygltf::Model& model) {
  const std::vector<int> parents = parents_of(model);
  const auto name = [&](int node) {
    return described("node", node, model.nodes[static_cast<std::size_t>(node)].name);
  };
  // Every node with one parent at most: whatever is not reached from a root lies on a cycle or below one.
  std::vector<int> pending;
  for (int i = 0; i < static_cast<int>(parents.size()); ++i) {
    if (parents[static_cast<std::size_t>(i)] < 0) pending.push_back(i);
  }
  std::vector<bool> reached(parents.size(), false);
  while (!pending.empty()) {
    const auto node = static_cast<std::size_t>(pending.back());
    pending.pop_back();
    reached[node] = true;
    pending.insert(pending.end(), model.nodes[node].children.begin(), model.nodes[node].children.end());
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i]) {
      throw GltfError(name(static_cast<int>(i)) + " lies on a cycle of 'children'; nodes must form trees");
    }
  }
  for (std::size_t s = 0; s < model.scenes.size(); ++s) {
    std::set<int> listed;
    for (const int node : model.scenes[s].nodes) {
      const std::string scene = described("scene", static_cast<int>(s), model.scenes[s].name);
      if (parents[static_cast<std::size_t>(node)] >= 0) {
        throw GltfError(fmt::format("{} lists {}, which is a child of another; only roots may be listed",
                                    scene, name(node)));
      }
      if (!listed.insert(node).second) throw GltfError(scene + " lists " + name(node) + " twice");
    }
  }
}

}  // namespace

void GltfDocument::warn(const std::string& sentence) {
  if (warned_.insert(sentence).second) spdlog::warn("{}: {}", path.string(), sentence);
}

bool holds_data(std::string_view uri) {
  return lower_case(uri.substr(0, 5)) == "data:";
}

std::string described(const char* kind, int index, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} '{}'", kind, index, name);
}

std::vector<int> parents_of(const tinygltf::Model& model) {
  std::vector<int> parents(model.nodes.size(), -1);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    for (const int child : model.nodes[i].children) {
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0) {
        throw GltfError(fmt::format(
            "{} is a child of node {} and of node {}; it may have one parent only",
            described("node", child, model.nodes[static_cast<std::size_t>(child)].name), parent, i));
      }
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

GltfDocument open_gltf_document(const std::filesystem::path& path) {
  GltfContainer container = read_gltf_container(path);
  CheckedJson checked = checked_gltf_json(container.json);
  const json buffers = take(checked.root, "buffers");
  const json images = take(checked.root, "images");

  GltfDocument document;
  document.path = path;
  for (const std::string& name : checked.unknown_extensions)
    document.warn(fmt::format("the extension {} is not read; the picture may lack what it describes", name));
  tinygltf::TinyGLTF reader;
  std::string errors;
  std::string warnings;
  const std::string text = checked.root.dump();
  if (!reader.LoadASCIIFromString(&document.model, &errors, &warnings, text.c_str(),
                                  static_cast<unsigned int>(text.size()), "", tinygltf::NO_REQUIRE)) {
    while (!errors.empty() && errors.back() == '\n')
      errors.pop_back();
    throw GltfError("tinygltf refuses it: " + errors);
  }
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    document.model.buffers.push_back(
        load_buffer(buffers[i], static_cast<int>(i), path.parent_path(), container.binary));
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    document.model.images.push_back(described_image(images[i], static_cast<int>(i)));
  }
  check_buffer_views(document.model);
  check_graph(document.model);
  return document;
}

std::vector<std::uint8_t> image_bytes(const GltfDocument& document, int image) {
  const tinygltf::Image& source = document.model.images[static_cast<std::size_t>(image)];
  if (source.bufferView < 0) {
    return read_uri(document.path.parent_path(), source.uri, described("image", image, source.name));
  }
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(source.bufferView)];
  const auto& data = document.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const auto first = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  return {first, first + static_cast<std::ptrdiff_t>(view.byteLength)};
}

}  // namespace quincunx::scenes
