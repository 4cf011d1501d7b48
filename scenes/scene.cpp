// SPDX-License-Identifier: MIT
#include "scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx::scenes {
namespace {

// Cuts up to a time, as if the scene had always repeated.
std::int64_t cuts_until(const Scene& scene, double seconds) {
  const double round = std::floor(seconds / scene.duration);
  const double within = seconds - round * scene.duration;
  const auto passed = std::upper_bound(scene.cuts.begin(), scene.cuts.end(), within) - scene.cuts.begin();
  return static_cast<std::int64_t>(round) * static_cast<std::int64_t>(scene.cuts.size()) + passed;
}

bool within(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_textures(const Scene& scene) {
  for (std::size_t t = 0; t < scene.textures.size(); ++t) {
    const Texture& texture = scene.textures[t];
    const std::size_t wanted = texture.width > 0 && texture.height > 0
                                   ? static_cast<std::size_t>(texture.width) * texture.height * 4
                                   : 0;
    if (wanted == 0 || texture.rgba.size() != wanted) {
      return Status::invalid(
          fmt::format("texture {} is {} x {} with {} bytes; it needs a positive size and {} bytes", t,
                      texture.width, texture.height, texture.rgba.size(), wanted));
    }
  }
  return {};
}

Status check_materials(const Scene& scene) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const Material& material = scene.materials[m];
    for (const TextureSlot* slot : {&material.base_colour_texture, &material.metallic_roughness_texture,
                                    &material.emissive_texture, &material.normal_texture}) {
      if (slot->texture != -1 && !within(slot->texture, scene.textures.size())) {
        return Status::invalid(fmt::format("material {} ('{}') names texture {}, but the scene has {}", m,
                                           material.name, slot->texture, scene.textures.size()));
      }
    }
  }
  return {};
}

Status check_meshes(const Scene& scene) {
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    if (!within(mesh.material, scene.materials.size())) {
      return Status::invalid(fmt::format("mesh {} names material {}, but the scene has {}", m, mesh.material,
                                         scene.materials.size()));
    }
    if (mesh.indices.size() % 3 != 0) {
      return Status::invalid(
          fmt::format("mesh {} has {} indices; triangles need a multiple of 3", m, mesh.indices.size()));
    }
    for (const std::uint32_t index : mesh.indices) {
      if (index >= mesh.vertices.size()) {
        return Status::invalid(
            fmt::format("mesh {} has index {}, but only {} vertices", m, index, mesh.vertices.size()));
      }
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (!finite(mesh.vertices[v].position)) {
        return Status::invalid(fmt::format("vertex {} of mesh {} has a position that is not finite", v, m));
      }
    }
  }
  return {};
}

Status check_faults(const Scene& scene) {
  const auto is_part = [](float value) { return value >= 0 && value < 1; };
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    const Fault& fault = scene.faults[f];
    if (fault.seconds >= 0 && fault.seconds < scene.duration && is_part(fault.place.x) &&
        is_part(fault.place.y) && is_part(fault.side)) {
      continue;
    }
    return Status::invalid(fmt::format(
        "fault {} lies at {} s, ({}, {}), with side {}; its time must lie within the scene's {} s, the "
        "others in [0, 1)",
        f, fault.seconds, fault.place.x, fault.place.y, fault.side, scene.duration));
  }
  return {};
}

}  // namespace

SceneNeeds needs_of(const Scene& scene) {
  SceneNeeds needs;
  needs.moving_objects =
      std::any_of(scene.instances.begin(), scene.instances.end(),
                  [](const Instance& instance) { return static_cast<bool>(instance.motion); });
  needs.camera_motion = scene.camera_moves;
  const auto is_blended = [&](const Instance& instance) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    return scene.materials[static_cast<std::size_t>(mesh.material)].alpha_mode == AlphaMode::kBlend;
  };
  needs.transparents = static_cast<bool>(scene.particles) ||
                       std::any_of(scene.instances.begin(), scene.instances.end(), is_blended);
  needs.background = scene.sky.background != Background::kNone;
  return needs;
}

bool is_cut(const Scene& scene, double previous_seconds, double seconds) {
  return cuts_until(scene, previous_seconds) != cuts_until(scene, seconds);
}

bool shows(const Scene& scene, const Fault& fault, double previous_seconds, double seconds) {
  const auto rounds = [&](double now) { return std::floor((now - fault.seconds) / scene.duration); };
  return rounds(seconds) > rounds(previous_seconds);
}

std::optional<double> next_cut(const Scene& scene, double seconds) {
  if (scene.cuts.empty()) return std::nullopt;
  const double round = std::floor(seconds / scene.duration) * scene.duration;
  const auto next = std::lower_bound(scene.cuts.begin(), scene.cuts.end(), seconds - round);
  return next != scene.cuts.end() ? round + *next : round + scene.duration + scene.cuts.front();
}

Bounds bounds_of(const Mesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Bounds box{mesh.vertices[0].position, mesh.vertices[0].position};
  for (const Vertex& vertex : mesh.vertices) {
    box.low = glm::min(box.low, vertex.position);
    box.high = glm::max(box.high, vertex.position);
  }
  return box;
}

Bounds transformed(const Bounds& box, const glm::mat4& transform) {
  const glm::vec3 centre = 0.5f * (box.low + box.high);
  const glm::vec3 half = 0.5f * (box.high - box.low);
  const auto new_centre = glm::vec3(transform * glm::vec4(centre, 1));
  const glm::vec3 new_half = glm::abs(glm::vec3(transform[0])) * half.x +
                             glm::abs(glm::vec3(transform[1])) * half.y +
                             glm::abs(glm::vec3(transform[2])) * half.z;
  return {new_centre - new_half, new_centre + new_half};
}

Status check_scene(const Scene& scene) {
  for (const auto& check : {check_textures, check_materials, check_meshes, check_faults}) {
    if (Status status = check(scene); !status.ok()) return status;
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!within(scene.instances[i].mesh, scene.meshes.size())) {
      return Status::invalid(fmt::format("instance {} names mesh {}, but the scene has {}", i,
                                         scene.instances[i].mesh, scene.meshes.size()));
    }
  }
  if (scene.lights.size() > Scene::kMaxPointLights) {
    return Status::invalid(fmt::format("the scene has {} point lights; at most {} are possible",
                                       scene.lights.size(), Scene::kMaxPointLights));
  }
  if (!scene.camera) return Status::invalid("the scene has no camera; Scene::camera must be set");
  return {};
}

}  // namespace quincunx::scenes
