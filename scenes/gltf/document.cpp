// SPDX-License-Identifier: MIT
#include "gltf/document.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "gltf/file.h"
#include "gltf/validate.h"

namespace quincunx::scenes {
namespace {

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
  json root = checked_gltf_json(container.json);
  const json buffers = take(root, "buffers");
  const json images = take(root, "images");

  GltfDocument document;
  document.path = path;
  tinygltf::TinyGLTF reader;
  std::string errors;
  std::string warnings;
  const std::string text = root.dump();
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
