// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "gltf/contents.h"

namespace quincunx::scenes {
namespace {

// Elements that no bytes of the file back (zeros, to be filled by a sparse part): bounds what a few bytes of
// JSON can make us allocate.
constexpr std::size_t kMaxUnbackedElements = 1u << 24;

// An accessor, and how messages call it.
struct Source {
  const tinygltf::Accessor& accessor;
  std::string who;

  Source(const GltfDocument& document, int index, const std::string& use)
      : accessor(document.model.accessors[static_cast<std::size_t>(index)]),
        who(described("accessor", index, accessor.name) + " (" + use + ")") {}
};

std::size_t component_size(int type) {
  return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
}

// Copies `count` elements out of a bufferView; 64-bit sums of 31-bit parts cannot overflow, and
// stride * count stays below 2^39.
void gather(const GltfDocument& document, int view_index, std::uint64_t offset, std::size_t element,
            std::size_t count, std::uint8_t* out, const std::string& who) {
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(view_index)];
  const std::uint64_t stride = view.byteStride != 0 ? view.byteStride : element;
  if (stride < element) {
    throw GltfError(fmt::format("{} has elements of {} bytes, but bufferView {} has them {} bytes apart", who,
                                element, view_index, stride));
  }
  const std::uint64_t end = offset + stride * (count - 1) + element;
  if (end > view.byteLength) {
    throw GltfError(fmt::format("{} needs {} bytes of bufferView {}, which has only {}", who, end, view_index,
                                view.byteLength));
  }
  const auto& data = document.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const std::uint8_t* source = data.data() + view.byteOffset + offset;
  if (stride == element) {
    std::memcpy(out, source, count * element);
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(out + i * element, source + i * stride, element);
}

std::uint32_t unsigned_at(const std::uint8_t* bytes, int type) {
  std::uint32_t value = 0;  // little endian, as the file
  std::memcpy(&value, bytes, component_size(type));
  return value;
}

void apply_sparse(const GltfDocument& document, const tinygltf::Accessor& accessor, std::size_t element,
                  std::vector<std::uint8_t>& bytes, const std::string& who) {
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<std::size_t>(sparse.count);
  if (count > accessor.count) {
    throw GltfError(fmt::format("{} replaces {} elements in its sparse part, but has only {}", who, count,
                                accessor.count));
  }
  const std::size_t index_size = component_size(sparse.indices.componentType);
  std::vector<std::uint8_t> indices(count * index_size);
  gather(document, sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
         index_size, count, indices.data(), "the sparse index part of " + who);
  std::vector<std::uint8_t> values(count * element);
  gather(document, sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset), element,
         count, values.data(), "the sparse value part of " + who);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = unsigned_at(indices.data() + i * index_size, sparse.indices.componentType);
    if (index >= accessor.count) {
      throw GltfError(fmt::format("{} replaces element {} in its sparse part, but has only {} elements", who,
                                  index, accessor.count));
    }
    std::memcpy(bytes.data() + index * element, values.data() + i * element, element);
  }
}

std::vector<std::uint8_t> read_elements(const GltfDocument& document, const Source& source,
                                        std::size_t element) {
  const auto& [accessor, who] = source;
  const std::uint64_t needed = element * static_cast<std::uint64_t>(accessor.count);
  if (accessor.bufferView < 0 && accessor.count > kMaxUnbackedElements) {
    throw GltfError(fmt::format("{} has {} elements without a bufferView; at most {} can be read", who,
                                accessor.count, kMaxUnbackedElements));
  }
  if (accessor.bufferView >= 0) {  // before allocating for it
    const auto& view = document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    if (needed > view.byteLength) {
      throw GltfError(fmt::format("{} needs at least {} bytes of bufferView {}, which has only {}", who,
                                  needed, accessor.bufferView, view.byteLength));
    }
  }
  std::vector<std::uint8_t> bytes(needed);
  if (accessor.bufferView >= 0)
    gather(document, accessor.bufferView, accessor.byteOffset, element, accessor.count, bytes.data(), who);
  if (accessor.sparse.isSparse) apply_sparse(document, accessor, element, bytes, who);
  return bytes;
}

template <typename T>
float integer_value(const std::uint8_t* bytes, bool normalised) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  if (!normalised) return static_cast<float>(value);
  return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float value_at(const std::uint8_t* bytes, int type, bool normalised) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return integer_value<std::int8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return integer_value<std::uint8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return integer_value<std::int16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return integer_value<std::uint16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return integer_value<std::uint32_t>(bytes, normalised);
    default: {
      float value;
      std::memcpy(&value, bytes, sizeof value);
      return value;
    }
  }
}

// Reads unsigned integers below `limit`: vertex indices. Throws GltfError as read_floats(), and for one out of range.
std::vector<std::uint32_t> read_indices(const GltfDocument& document, int accessor_index, std::size_t limit,
                                        const std::string& use) {
  const Source source(document, accessor_index, use);
  const auto& [accessor, who] = source;
  const int type = accessor.componentType;
  const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned || accessor.normalized) {
    throw GltfError(who + " cannot hold indices; plain unsigned integers of type SCALAR are needed");
  }
  const std::size_t size = component_size(type);
  const std::vector<std::uint8_t> bytes = read_elements(document, source, size);
  std::vector<std::uint32_t> result(bytes.size() / size);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = unsigned_at(bytes.data() + i * size, type);
    if (result[i] >= limit) {
      throw GltfError(fmt::format("{} holds index {} in element {}, but there are only {} vertices", who,
                                  result[i], i, limit));
    }
  }
  return result;
}

class PrimitiveReader {
 public:
  PrimitiveReader(GltfDocument& document, int mesh, int primitive)
      : document_(document),
        source_(document.model.meshes[static_cast<std::size_t>(mesh)]
                    .primitives[static_cast<std::size_t>(primitive)]),
        name_(fmt::format(
            "primitive {} of {}", primitive,
            described("mesh", mesh, document.model.meshes[static_cast<std::size_t>(mesh)].name))) {}

  std::optional<Mesh> read(const GltfMaterials& materials) {
    if (source_.mode < TINYGLTF_MODE_TRIANGLES) {
      document_.warn(name_ + " consists of points or lines, which are not drawn");
      return std::nullopt;
    }
    if (source_.attributes.count("POSITION") == 0) {
      document_.warn(name_ + " has no POSITION and is not drawn");
      return std::nullopt;
    }
    Mesh mesh;
    mesh.material = source_.material >= 0 ? source_.material : materials.default_material();
    read_vertices(mesh.vertices, materials.uv_sets[static_cast<std::size_t>(mesh.material)]);
    mesh.indices = triangles(corners(mesh.vertices.size()));
    if (mesh.indices.empty()) {
      document_.warn(name_ + " has no whole triangle and is not drawn");
      return std::nullopt;
    }
    if (!has_normals_) mesh = with_flat_normals(mesh);
    return mesh;
  }

 private:
  // Nothing where the primitive lacks the attribute.
  FloatArray attribute(const char* name, std::initializer_list<int> components) const {
    const auto found = source_.attributes.find(name);
    if (found == source_.attributes.end()) return {components.begin()[0], {}};
    return read_floats(document_, found->second, components, std::string(name) + " of " + name_);
  }

  void check_size(const char* name, const FloatArray& values, std::size_t vertices) const {
    if (values.values.empty() || values.size() == vertices) return;
    throw GltfError(fmt::format("{} has {} of {} in {} but {} positions; all attributes need the same number",
                                name_, values.size(), name,
                                described("accessor", source_.attributes.at(name), ""), vertices));
  }

  void read_vertices(std::vector<Vertex>& vertices, int uv_set) {
    const char* uv_name = uv_set == 1 ? "TEXCOORD_1" : "TEXCOORD_0";
    const FloatArray positions = attribute("POSITION", {3});
    const FloatArray normals = attribute("NORMAL", {3});
    const FloatArray uvs = attribute(uv_name, {2});
    const auto colour = source_.attributes.find("COLOR_0");  // integers of it are always normalised
    if (colour != source_.attributes.end())
      document_.model.accessors[static_cast<std::size_t>(colour->second)].normalized = true;
    const FloatArray colours = attribute("COLOR_0", {3, 4});
    const std::size_t count = positions.size();
    check_size("NORMAL", normals, count);
    check_size(uv_name, uvs, count);
    check_size("COLOR_0", colours, count);
    has_normals_ = !normals.values.empty();
    vertices.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      Vertex& vertex = vertices[i];
      vertex.position = {positions.values[3 * i], positions.values[3 * i + 1], positions.values[3 * i + 2]};
      if (has_normals_) {
        const glm::dvec3 normal(normals.values[3 * i], normals.values[3 * i + 1], normals.values[3 * i + 2]);
        const double length = glm::length(normal);
        if (length > 0) vertex.normal = glm::vec3(normal / length);
      }
      if (!uvs.values.empty()) vertex.uv = {uvs.values[2 * i], uvs.values[2 * i + 1]};
      for (int c = 0; !colours.values.empty() && c < colours.components; ++c) {
        vertex.colour[c] =
            colours.values[i * static_cast<std::size_t>(colours.components) + static_cast<std::size_t>(c)];
      }
    }
  }

  std::vector<std::uint32_t> corners(std::size_t vertices) const {
    if (source_.indices >= 0) {
      return read_indices(document_, source_.indices, vertices, "indices of " + name_);
    }
    std::vector<std::uint32_t> result(vertices);
    std::iota(result.begin(), result.end(), 0u);
    return result;
  }

  // Corners left over, short of a triangle, are dropped.
  std::vector<std::uint32_t> triangles(std::vector<std::uint32_t> corners) const {
    const std::size_t count = corners.size();
    if (source_.mode == TINYGLTF_MODE_TRIANGLES) {
      corners.resize(count / 3 * 3);
      return corners;
    }
    std::vector<std::uint32_t> result;
    if (count < 3) return result;
    result.reserve((count - 2) * 3);
    for (std::size_t i = 0; i + 2 < count; ++i) {
      if (source_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        const std::size_t odd = i % 2;  // every other triangle of a strip runs backwards
        result.insert(result.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
      } else {
        result.insert(result.end(), {corners[i + 1], corners[i + 2], corners[0]});
      }
    }
    return result;
  }

  static Mesh with_flat_normals(const Mesh& mesh) {
    Mesh result;
    result.material = mesh.material;
    result.vertices.reserve(mesh.indices.size());
    result.indices.resize(mesh.indices.size());
    std::iota(result.indices.begin(), result.indices.end(), 0u);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const Vertex* corner[3];
      for (std::size_t c = 0; c < 3; ++c)
        corner[c] = &mesh.vertices[mesh.indices[i + c]];
      // In double precision: the product of two edges overflows or vanishes in single for large or small
      // ones.
      const glm::dvec3 origin = corner[0]->position;
      const glm::dvec3 normal =
          glm::cross(glm::dvec3(corner[1]->position) - origin, glm::dvec3(corner[2]->position) - origin);
      const double length = glm::length(normal);
      for (const Vertex* vertex : corner) {
        result.vertices.push_back(*vertex);
        if (length > 0) result.vertices.back().normal = glm::vec3(normal / length);
      }
    }
    return result;
  }

  GltfDocument& document_;
  const tinygltf::Primitive& source_;
  std::string name_;
  bool has_normals_ = false;
};

}  // namespace

FloatArray read_floats(const GltfDocument& document, int accessor_index,
                       std::initializer_list<int> components, const std::string& use) {
  const Source source(document, accessor_index, use);
  const auto& [accessor, who] = source;
  FloatArray result;
  if (accessor.type != TINYGLTF_TYPE_MAT2 && accessor.type != TINYGLTF_TYPE_MAT3)  // are never read
    result.components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (std::find(components.begin(), components.end(), result.components) == components.end()) {
    throw GltfError(fmt::format("{} has the wrong 'type'; elements of {} components are needed", who,
                                fmt::join(components, " or ")));
  }
  const std::size_t size = component_size(accessor.componentType);
  const std::vector<std::uint8_t> bytes =
      read_elements(document, source, size * static_cast<std::size_t>(result.components));
  result.values.resize(bytes.size() / size);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const float value = value_at(bytes.data() + i * size, accessor.componentType, accessor.normalized);
    if (!std::isfinite(value)) {
      throw GltfError(fmt::format("{} holds a value that is not finite in element {}", who,
                                  i / static_cast<std::size_t>(result.components)));
    }
    result.values[i] = value;
  }
  return result;
}

std::optional<Mesh> read_primitive(GltfDocument& document, int mesh, int primitive,
                                   const GltfMaterials& materials) {
  return PrimitiveReader(document, mesh, primitive).read(materials);
}

}  // namespace quincunx::scenes
