// SPDX-License-Identifier: MIT
#include "gltf/mesh.h"

#include <fmt/format.h>

#include <numeric>

#include "gltf/accessor.h"

namespace quincunx::scenes {
namespace {

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

std::optional<Mesh> read_primitive(GltfDocument& document, int mesh, int primitive,
                                   const GltfMaterials& materials) {
  return PrimitiveReader(document, mesh, primitive).read(materials);
}

}  // namespace quincunx::scenes
