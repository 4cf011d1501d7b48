// SPDX-License-Identifier: MIT
#include "render/scene_layout.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>

namespace quincunx::scenes {

namespace {

// The distinct sets of lights that reach something, each made once.
class LightSets {
 public:
  explicit LightSets(const Scene& scene) : scene_(scene) {}

  // The lights that reach a world box, as a bit mask.
  std::uint32_t reaching(const Bounds& box) const;
  int index_of(std::uint32_t mask);  // -1 for none
  // The lights in a mask, rounded up to a count that has a shader variant.
  static int loop_count(std::uint32_t mask);
  std::vector<LightsBlock> take() { return std::move(blocks_); }

 private:
  const Scene& scene_;
  std::map<std::uint32_t, int> indices_;
  std::vector<LightsBlock> blocks_;
};

std::uint32_t LightSets::reaching(const Bounds& box) const {
  std::uint32_t mask = 0;
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    const PointLight& light = scene_.lights[i];
    const glm::vec3 offset = light.position - glm::clamp(light.position, box.low, box.high);
    if (glm::dot(offset, offset) < light.range * light.range) mask |= 1u << i;
  }
  return mask;
}

int LightSets::index_of(std::uint32_t mask) {
  if (mask == 0) return -1;
  const auto [entry, added] = indices_.emplace(mask, static_cast<int>(blocks_.size()));
  if (!added) return entry->second;
  LightsBlock block;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    if ((mask >> i & 1u) == 0) continue;
    const PointLight& light = scene_.lights[i];
    block.position[count] = glm::vec4(light.position, 1 / (light.range * light.range));
    block.intensity[count++] = glm::vec4(light.intensity, 0);
  }
  blocks_.push_back(block);
  return entry->second;
}

int LightSets::loop_count(std::uint32_t mask) {
  const int lights = std::popcount(mask);
  for (const int count : {0, 2, 4, 8}) {
    if (lights <= count) return count;
  }
  return Scene::kMaxPointLights;
}

struct Triangles {
  std::vector<glm::vec3> centres;
  std::vector<std::uint32_t> order;
};

Triangles triangles_of(const Mesh& mesh) {
  Triangles triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    glm::vec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k)
      sum += mesh.vertices[mesh.indices[i + k]].position;
    triangles.centres.push_back(sum / 3.0f);
  }
  triangles.order.resize(triangles.centres.size());
  std::iota(triangles.order.begin(), triangles.order.end(), 0u);
  return triangles;
}

// Cuts [begin, end) of the order at the median along its longest axis until the limits hold.
void split(Triangles& triangles, std::size_t begin, std::size_t end, const PartLimits& limits,
           std::vector<std::uint32_t>& counts) {
  glm::vec3 low = triangles.centres[triangles.order[begin]];
  glm::vec3 high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = glm::min(low, triangles.centres[triangles.order[i]]);
    high = glm::max(high, triangles.centres[triangles.order[i]]);
  }
  const glm::vec3 size = high - low;
  const std::size_t count = end - begin;
  if (count <= limits.few || (count <= limits.many && glm::length(size) <= limits.metres)) {
    std::sort(triangles.order.begin() + static_cast<std::ptrdiff_t>(begin),
              triangles.order.begin() + static_cast<std::ptrdiff_t>(end));
    counts.push_back(static_cast<std::uint32_t>(3 * count));
    return;
  }
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = begin + count / 2;
  const auto at = [&](std::size_t i) { return triangles.order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const float ca = triangles.centres[a][axis], cb = triangles.centres[b][axis];
    return ca != cb ? ca < cb : a < b;
  });
  split(triangles, begin, middle, limits, counts);
  split(triangles, middle, end, limits, counts);
}

constexpr int kMotionSamples = 32;       // places over the duration at which a moving instance is looked up
constexpr float kFloorFlatness = 0.02f;  // height over width of what is a floor rather than a caster
constexpr float kPartPerLightRange = 1;  // diagonal of a part of a mesh, in ranges of the shortest light

void include(Bounds& bounds, const Bounds& more) {
  bounds.low = glm::min(bounds.low, more.low);
  bounds.high = glm::max(bounds.high, more.high);
}

SurfaceFeatures features_of(const Mesh& mesh, const Material& material) {
  SurfaceFeatures f;
  f.unlit = material.unlit;
  f.base_texture = material.base_colour_texture.texture >= 0;
  f.surface_texture = !f.unlit && material.metallic_roughness_texture.texture >= 0;
  f.emissive_texture = material.emissive_texture.texture >= 0;
  f.normal_texture = !f.unlit && material.normal_texture.texture >= 0;
  f.textured = f.base_texture || f.surface_texture || f.emissive_texture || f.normal_texture;
  f.vertex_colour = std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                                [](const Vertex& vertex) { return vertex.colour != glm::vec4(1); });
  f.mask = material.alpha_mode == AlphaMode::kMask;
  f.blend = material.alpha_mode == AlphaMode::kBlend;
  f.double_sided = material.double_sided;
  return f;
}

// A floor under everything only receives: leaving it out keeps the map's texels for what casts.
bool is_floor(const Bounds& box, const Bounds& all) {
  const glm::vec3 size = box.high - box.low;
  const float width = std::max(size.x, size.z);
  return size.y <= kFloorFlatness * width && box.high.y <= all.low.y + kFloorFlatness * width;
}

class Layouter {
 public:
  explicit Layouter(const Scene& scene) : scene_(scene), lights_(scene) {}

  SceneLayout run() {
    add_meshes();
    place_instances();
    find_casters();
    add_pieces();
    layout_.light_sets = lights_.take();
    return std::move(layout_);
  }

 private:
  struct PartsOfMesh {
    int first = 0;
    int count = 0;
  };

  // Only what stands alone is cut: instanced and moving meshes stay one draw each.
  PartLimits limits_for(int mesh) const {
    const auto uses = std::count_if(scene_.instances.begin(), scene_.instances.end(),
                                    [&](const Instance& instance) { return instance.mesh == mesh; });
    const bool moves =
        std::any_of(scene_.instances.begin(), scene_.instances.end(),
                    [&](const Instance& instance) { return instance.mesh == mesh && instance.motion; });
    PartLimits limits;
    const Mesh& source = scene_.meshes[static_cast<std::size_t>(mesh)];
    const bool blends =
        scene_.materials[static_cast<std::size_t>(source.material)].alpha_mode == AlphaMode::kBlend;
    if (uses != 1 || moves || blends)
      limits.many = source.indices.size();
    else
      for (const PointLight& light : scene_.lights) {
        limits.metres = std::min(limits.metres, kPartPerLightRange * light.range);
      }
    return limits;
  }

  MeshRange range_of(const Mesh& mesh, std::size_t first, std::size_t count) const {
    MeshRange range;
    range.first_index = static_cast<std::uint32_t>(first);
    range.index_count = static_cast<std::uint32_t>(count);
    range.material = mesh.material;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3& position = mesh.vertices[layout_.indices[first + i]].position;
      if (i == 0) range.box = {position, position};
      include(range.box, {position, position});
    }
    return range;
  }

  void add_meshes() {
    for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
      const Mesh& mesh = scene_.meshes[m];
      const PartLimits limits = limits_for(static_cast<int>(m));
      const MeshParts parts = split_mesh(mesh, limits);
      const std::size_t begin = layout_.indices.size();
      std::size_t first = begin;
      layout_.indices.insert(layout_.indices.end(), parts.indices.begin(), parts.indices.end());
      layout_.meshes.push_back(range_of(mesh, first, parts.indices.size()));
      parts_of_mesh_.push_back(
          {static_cast<int>(layout_.parts.size()), static_cast<int>(parts.counts.size())});
      for (const std::uint32_t count : parts.counts) {
        add_part(range_of(mesh, first, count), static_cast<int>(m), limits.many);
        first += count;
      }
      parts_of_mesh_.back().count = static_cast<int>(layout_.parts.size()) - parts_of_mesh_.back().first;
      features_.push_back(features_of(mesh, scene_.materials[static_cast<std::size_t>(mesh.material)]));
      // All meshes lie in one buffer.
      for (std::size_t i = begin; i < layout_.indices.size(); ++i)
        layout_.indices[i] += base_vertex_;
      base_vertex_ += static_cast<std::uint32_t>(mesh.vertices.size());
    }
  }

  // Neighbours that the same lights reach become one part again, up to `many` triangles: fewer draws.
  void add_part(const MeshRange& part, int mesh, std::size_t many) {
    const int first = parts_of_mesh_.back().first;
    if (static_cast<int>(layout_.parts.size()) > first) {
      MeshRange& last = layout_.parts.back();
      const bool small = last.index_count + part.index_count <= 3 * many;
      if (small && lights_on_mesh(last.box, mesh) == lights_on_mesh(part.box, mesh)) {
        last.index_count += part.index_count;
        include(last.box, part.box);
        return;
      }
    }
    layout_.parts.push_back(part);
  }

  // Returns the lights that reach a mesh that is cut, and so stands once and still.
  std::uint32_t lights_on_mesh(const Bounds& box, int mesh) const {
    const auto instance = std::find_if(scene_.instances.begin(), scene_.instances.end(),
                                       [&](const Instance& candidate) { return candidate.mesh == mesh; });
    return instance == scene_.instances.end() ? 0 : lights_.reaching(transformed(box, instance->transform));
  }

  const Bounds& mesh_box(const PlacedInstance& instance) const {
    return layout_.meshes[static_cast<std::size_t>(instance.mesh)].box;
  }

  void place_instances() {
    for (const Instance& instance : scene_.instances) {
      PlacedInstance placed;
      placed.mesh = instance.mesh;
      placed.moves = static_cast<bool>(instance.motion);
      placed.transform = placed.moves ? instance.motion(0) : instance.transform;
      placed.reach = transformed(mesh_box(placed), placed.transform);
      layout_.instances.push_back(placed);
    }
    widen_reaches();
  }

  // Adds the bounds over time, widened by half the largest step between two looks. Look by look, because motions that
  // share work do so for one time.
  void widen_reaches() {
    std::vector<glm::vec3> last, step(layout_.instances.size(), glm::vec3(0));
    for (const PlacedInstance& placed : layout_.instances)
      last.push_back(placed.reach.low);
    for (int look = 1; look <= kMotionSamples; ++look) {
      for (std::size_t i = 0; i < layout_.instances.size(); ++i) {
        PlacedInstance& placed = layout_.instances[i];
        if (!placed.moves) continue;
        const double seconds = scene_.duration * look / kMotionSamples;
        const Bounds here = transformed(mesh_box(placed), scene_.instances[i].motion(seconds));
        step[i] = glm::max(step[i], glm::abs(here.low - last[i]));
        last[i] = here.low;
        include(placed.reach, here);
      }
    }
    for (std::size_t i = 0; i < layout_.instances.size(); ++i) {
      Bounds& reach = layout_.instances[i].reach;
      if (layout_.instances[i].moves) reach = {reach.low - 0.5f * step[i], reach.high + 0.5f * step[i]};
    }
  }

  void find_casters() {
    if (layout_.instances.empty()) return;
    Bounds all = layout_.instances[0].reach;
    for (const PlacedInstance& instance : layout_.instances)
      include(all, instance.reach);
    std::vector<ShadowCaster> casters;
    bool moves = false;
    for (PlacedInstance& instance : layout_.instances) {
      const MeshRange& mesh = layout_.meshes[static_cast<std::size_t>(instance.mesh)];
      instance.casts_shadow = !features_[static_cast<std::size_t>(instance.mesh)].blend &&
                              mesh.index_count > 0 && (instance.moves || !is_floor(instance.reach, all));
      if (!instance.casts_shadow) continue;
      moves = moves || instance.moves;
      add_caster(instance, casters);
    }
    layout_.shadow = fit_shadow(scene_, casters);
    layout_.shadow.moves = moves;
  }

  void add_caster(const PlacedInstance& instance, std::vector<ShadowCaster>& casters) const {
    const PartsOfMesh& parts = parts_of_mesh_[static_cast<std::size_t>(instance.mesh)];
    for (int p = parts.first; p < parts.first + parts.count; ++p) {
      const MeshRange& part = layout_.parts[static_cast<std::size_t>(p)];
      casters.push_back({instance.moves ? instance.reach : transformed(part.box, instance.transform),
                         static_cast<double>(part.index_count) / 3});
    }
  }

  void add_pieces() {
    for (std::size_t i = 0; i < layout_.instances.size(); ++i) {
      const PlacedInstance& instance = layout_.instances[i];
      const PartsOfMesh& parts = parts_of_mesh_[static_cast<std::size_t>(instance.mesh)];
      for (int p = parts.first; p < parts.first + parts.count; ++p) {
        Piece piece;
        piece.instance = static_cast<int>(i);
        piece.part = p;
        piece.box = instance.moves
                        ? instance.reach
                        : transformed(layout_.parts[static_cast<std::size_t>(p)].box, instance.transform);
        choose_program(features_[static_cast<std::size_t>(instance.mesh)], piece);
        layout_.pieces.push_back(piece);
      }
    }
  }

  void choose_program(SurfaceFeatures features, Piece& piece) {
    const std::uint32_t mask = features.unlit ? 0 : lights_.reaching(piece.box);
    features.shadows = layout_.shadow.enabled && !features.unlit;
    features.point_lights = LightSets::loop_count(mask);
    piece.light_set = lights_.index_of(mask);
    const auto [program, added] = programs_.emplace(features, static_cast<int>(layout_.programs.size()));
    if (added) layout_.programs.push_back(features);
    piece.program = program->second;
  }

  const Scene& scene_;
  SceneLayout layout_;
  LightSets lights_;
  std::vector<PartsOfMesh> parts_of_mesh_;
  std::vector<SurfaceFeatures> features_;
  std::map<SurfaceFeatures, int> programs_;
  std::uint32_t base_vertex_ = 0;
};

}  // namespace

MeshParts split_mesh(const Mesh& mesh, const PartLimits& limits) {
  MeshParts parts;
  if (mesh.indices.empty()) return parts;
  Triangles triangles = triangles_of(mesh);
  split(triangles, 0, triangles.order.size(), limits, parts.counts);
  for (const std::uint32_t triangle : triangles.order) {
    for (std::size_t k = 0; k < 3; ++k)
      parts.indices.push_back(mesh.indices[3 * triangle + k]);
  }
  return parts;
}

std::vector<std::string> SurfaceFeatures::defines() const {
  std::vector<std::string> list;
  const auto add = [&](bool on, const char* name) {
    if (on) list.emplace_back(name);
  };
  add(textured, "TEXTURED");
  add(base_texture, "BASE_TEXTURE");
  add(surface_texture, "SURFACE_TEXTURE");
  add(emissive_texture, "EMISSIVE_TEXTURE");
  add(normal_texture, "NORMAL_TEXTURE");
  add(vertex_colour, "VERTEX_COLOUR");
  add(unlit, "UNLIT");
  add(mask, "MASK");
  add(blend, "BLEND");
  add(double_sided, "DOUBLE_SIDED");
  if (shadows) list.push_back("SHADOWS " + std::to_string(kShadowTexels));
  list.push_back("POINT_LIGHTS " + std::to_string(point_lights));
  return list;
}

SceneLayout lay_out(const Scene& scene) {
  return Layouter(scene).run();
}

}  // namespace quincunx::scenes
