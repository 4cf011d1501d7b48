// SPDX-License-Identifier: MIT
#include "gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace quincunx::scenes {
namespace {

// Elements that no bytes of the file back (zeros, to be filled by a sparse part): bounds what a few bytes of
// JSON can make us allocate.
constexpr std::size_t kMaxUnbackedElements = 1u << 24;

std::string name_of(const GltfDocument& document, int accessor, const std::string& use) {
  const std::string& name = document.model.accessors[static_cast<std::size_t>(accessor)].name;
  return described("accessor", accessor, name) + " (" + use + ")";
}

const tinygltf::Accessor& at(const GltfDocument& document, int accessor) {
  return document.model.accessors[static_cast<std::size_t>(accessor)];
}

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    default:
      return 4;
  }
}

int component_count(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;  // matrices: nothing that is read here has that shape
  }
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

std::vector<std::uint8_t> read_elements(const GltfDocument& document, const tinygltf::Accessor& accessor,
                                        std::size_t element, const std::string& who) {
  const std::size_t count = accessor.count;
  if (accessor.bufferView < 0 && count > kMaxUnbackedElements) {
    throw GltfError(fmt::format("{} has {} elements without a bufferView; at most {} can be read", who, count,
                                kMaxUnbackedElements));
  }
  std::vector<std::uint8_t> bytes;
  if (accessor.bufferView >= 0) {
    const tinygltf::BufferView& view =
        document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    if (element * static_cast<std::uint64_t>(count) > view.byteLength) {  // before allocating for it
      throw GltfError(fmt::format("{} needs at least {} bytes of bufferView {}, which has only {}", who,
                                  element * static_cast<std::uint64_t>(count), accessor.bufferView,
                                  view.byteLength));
    }
    bytes.resize(count * element);
    gather(document, accessor.bufferView, accessor.byteOffset, element, count, bytes.data(), who);
  } else {
    bytes.resize(count * element);
  }
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

}  // namespace

FloatArray read_floats(const GltfDocument& document, int accessor_index,
                       std::initializer_list<int> components, const std::string& use) {
  const tinygltf::Accessor& accessor = at(document, accessor_index);
  const std::string who = name_of(document, accessor_index, use);
  FloatArray result;
  result.components = component_count(accessor.type);
  if (std::find(components.begin(), components.end(), result.components) == components.end()) {
    throw GltfError(fmt::format("{} has the wrong 'type'; elements of {} components are needed", who,
                                fmt::join(components, " or ")));
  }
  const std::size_t size = component_size(accessor.componentType);
  const std::vector<std::uint8_t> bytes =
      read_elements(document, accessor, size * static_cast<std::size_t>(result.components), who);
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

std::vector<std::uint32_t> read_indices(const GltfDocument& document, int accessor_index, std::size_t limit,
                                        const std::string& use) {
  const tinygltf::Accessor& accessor = at(document, accessor_index);
  const std::string who = name_of(document, accessor_index, use);
  const int type = accessor.componentType;
  const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned || accessor.normalized) {
    throw GltfError(who + " cannot hold indices; plain unsigned integers of type SCALAR are needed");
  }
  const std::size_t size = component_size(type);
  const std::vector<std::uint8_t> bytes = read_elements(document, accessor, size, who);
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

}  // namespace quincunx::scenes
