// SPDX-License-Identifier: MIT
#include "scene_layout.h"

#include <algorithm>
#include <map>

namespace quincunx::scenes {
namespace {

constexpr int kMotionSamples = 32;       // places over the duration at which a moving instance is looked up
constexpr float kFloorFlatness = 0.02f;  // height over width of what is a floor rather than a caster

void include(Bounds& bounds, const Bounds& more) {
  bounds.low = glm::min(bounds.low, more.low);
  bounds.high = glm::max(bounds.high, more.high);
}

// Mesh bounds over time, widened by half the largest step between two looks.
Bounds reach_of(const Instance& instance, const Bounds& box, double duration) {
  if (!instance.motion) return transformed(box, instance.transform);
  Bounds reach = transformed(box, instance.motion(0));
  glm::vec3 last = reach.low;
  glm::vec3 step(0);
  for (int i = 1; i <= kMotionSamples; ++i) {
    const Bounds here = transformed(box, instance.motion(duration * i / kMotionSamples));
    step = glm::max(step, glm::abs(here.low - last));
    last = here.low;
    include(reach, here);
  }
  return {reach.low - 0.5f * step, reach.high + 0.5f * step};
}

MeshRange range_of(const Mesh& mesh, const MeshRange* before, std::size_t vertices_before) {
  MeshRange range;
  range.first_index = before != nullptr ? before->first_index + before->index_count : 0;
  range.index_count = static_cast<std::uint32_t>(mesh.indices.size());
  range.base_vertex = static_cast<std::int32_t>(vertices_before);
  range.material = mesh.material;
  if (!mesh.vertices.empty()) range.box = {mesh.vertices[0].position, mesh.vertices[0].position};
  for (const Vertex& vertex : mesh.vertices)
    include(range.box, {vertex.position, vertex.position});
  return range;
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

bool reaches(const PointLight& light, const Bounds& box) {
  const glm::vec3 nearest = glm::clamp(light.position, box.low, box.high);
  const glm::vec3 offset = light.position - nearest;
  return glm::dot(offset, offset) < light.range * light.range;
}

// The lights that reach a box, as a bit mask.
std::uint32_t lights_on(const Scene& scene, const Bounds& box) {
  std::uint32_t mask = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (reaches(scene.lights[i], box)) mask |= 1u << i;
  }
  return mask;
}

LightsBlock light_set(const Scene& scene, std::uint32_t mask) {
  LightsBlock block;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if ((mask >> i & 1u) == 0) continue;
    const PointLight& light = scene.lights[i];
    block.position[count] = glm::vec4(light.position, 1 / (light.range * light.range));
    block.intensity[count++] = glm::vec4(light.intensity, 0);
  }
  return block;
}

int loop_count(std::uint32_t mask) {
  int lights = 0;
  for (; mask != 0; mask &= mask - 1)
    ++lights;
  for (const int count : {0, 2, 4, 8}) {
    if (lights <= count) return count;
  }
  return 16;
}

// A floor under everything only receives: leaving it out keeps the map's texels for what casts.
bool is_floor(const Bounds& box, const Bounds& all) {
  const glm::vec3 size = box.high - box.low;
  const float width = std::max(size.x, size.z);
  const bool flat = size.y <= kFloorFlatness * width;
  const bool at_bottom = box.high.y <= all.low.y + kFloorFlatness * width;
  return flat && at_bottom;
}

ShadowFit fit_shadow(const Scene& scene, std::vector<PlacedInstance>& instances) {
  ShadowFit fit;
  if (!scene.sun.casts_shadows || scene.sun.irradiance == glm::vec3(0) || instances.empty()) return fit;
  Bounds all = instances[0].reach;
  for (const PlacedInstance& instance : instances)
    include(all, instance.reach);

  const glm::vec3 along = glm::normalize(scene.sun.direction);
  const glm::vec3 helper = std::abs(along.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 right = glm::normalize(glm::cross(helper, along));
  const glm::mat4 light_from_world =
      glm::transpose(glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(along, right), 0),
                               glm::vec4(along, 0), glm::vec4(0, 0, 0, 1)));
  Bounds box;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    PlacedInstance& instance = instances[i];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    instance.casts_shadow = material.alpha_mode != AlphaMode::kBlend && !mesh.indices.empty() &&
                            (instance.moves || !is_floor(instance.reach, all));
    if (!instance.casts_shadow) continue;
    const Bounds seen = transformed(instance.reach, light_from_world);
    if (!fit.enabled) box = seen;
    include(box, seen);
    fit.enabled = true;
    fit.moves = fit.moves || instance.moves;
  }
  if (!fit.enabled) return fit;
  const glm::vec3 size = glm::max(box.high - box.low, glm::vec3(1e-3f)) * 1.01f;
  const glm::vec3 low = 0.5f * (box.low + box.high) - 0.5f * size;
  fit.texel_metres = std::max(size.x, size.y) / kShadowTexels;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      fit.shadow_from_world[column][row] = light_from_world[column][row] / size[row];
    }
    fit.shadow_from_world[3][row] -= low[row] / size[row];
  }
  return fit;
}

}  // namespace

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
  SceneLayout layout;
  std::vector<SurfaceFeatures> mesh_features;
  std::size_t vertices = 0;
  for (const Mesh& mesh : scene.meshes) {
    layout.meshes.push_back(
        range_of(mesh, layout.meshes.empty() ? nullptr : &layout.meshes.back(), vertices));
    vertices += mesh.vertices.size();
    mesh_features.push_back(features_of(mesh, scene.materials[static_cast<std::size_t>(mesh.material)]));
  }
  for (const Instance& instance : scene.instances) {
    PlacedInstance placed;
    placed.mesh = instance.mesh;
    placed.moves = static_cast<bool>(instance.motion);
    placed.transform = placed.moves ? instance.motion(0) : instance.transform;
    placed.mirrored = glm::determinant(glm::mat3(placed.transform)) < 0;
    placed.reach =
        reach_of(instance, layout.meshes[static_cast<std::size_t>(instance.mesh)].box, scene.duration);
    layout.instances.push_back(placed);
  }
  layout.shadow = fit_shadow(scene, layout.instances);

  std::map<std::uint32_t, int> sets;
  std::map<SurfaceFeatures, int> programs;
  for (PlacedInstance& placed : layout.instances) {
    SurfaceFeatures features = mesh_features[static_cast<std::size_t>(placed.mesh)];
    const std::uint32_t mask = features.unlit ? 0 : lights_on(scene, placed.reach);
    features.shadows = layout.shadow.enabled && !features.unlit;
    features.point_lights = loop_count(mask);
    if (mask != 0) {
      const auto [set, added] = sets.emplace(mask, static_cast<int>(layout.light_sets.size()));
      if (added) layout.light_sets.push_back(light_set(scene, mask));
      placed.light_set = set->second;
    }
    const auto [program, added] = programs.emplace(features, static_cast<int>(layout.programs.size()));
    if (added) layout.programs.push_back(features);
    placed.program = program->second;
  }
  return layout;
}

}  // namespace quincunx::scenes
