// SPDX-License-Identifier: MIT
#include "gltf/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx::scenes {
namespace {

constexpr glm::vec3 kSunIrradiance{3.3f, 3.1f, 2.8f};
constexpr glm::vec3 kSunDirection{-0.45f, -0.75f, -0.5f};  // from the upper right of who looks along -z

// White paper under this irradiance has radiance 3.2, about what tone mapping still shows as bright.
constexpr float kBrightIrradiance = 10;

// Without a range a light reaches this many diagonals of the scene.
constexpr float kReachInDiagonals = 4;

// How much of the day's sky is left where the file lights the scene with lamps alone.
constexpr float kNightSky = 0.1f;

void default_light(Scene& scene) {
  scene.sun.direction = glm::normalize(kSunDirection);
  scene.sun.irradiance = kSunIrradiance;
  scene.sky.sun_radiance = 20.0f * kSunIrradiance;
}

glm::vec3 power_of(const tinygltf::Light& light) {
  glm::vec3 colour(1);
  for (std::size_t c = 0; c < light.color.size() && c < 3; ++c) {
    colour[static_cast<int>(c)] = static_cast<float>(light.color[c]);
  }
  return colour * static_cast<float>(light.intensity);
}

float brightness(const glm::vec3& colour) {
  return std::max({colour.r, colour.g, colour.b});
}

void scale_to_photometric(Scene& scene, const Bounds& bounds) {
  const glm::vec3 centre = 0.5f * bounds.low + 0.5f * bounds.high;
  const float radius = 0.5f * glm::length(bounds.high - bounds.low);
  float irradiance = brightness(scene.sun.irradiance);
  for (const PointLight& light : scene.lights) {
    const float distance = std::max(glm::length(light.position - centre), radius);
    if (distance > 0) irradiance += brightness(light.intensity) / (distance * distance);
  }
  const float gain =
      irradiance > kBrightIrradiance && std::isfinite(irradiance) ? irradiance / kBrightIrradiance : 1.0f;
  scene.exposure = 1 / gain;
  const bool is_day = scene.sun.irradiance != glm::vec3(0);
  for (glm::vec3* colour : {&scene.sky.zenith, &scene.sky.horizon, &scene.sky.ground}) {
    *colour *= gain * (is_day ? 1.0f : kNightSky);
  }
}

}  // namespace

void read_lights(GltfDocument& document, const NodeTree& tree, const std::vector<int>& nodes,
                 const Bounds& bounds, Scene& scene) {
  const float diagonal = glm::length(bounds.high - bounds.low);
  bool has_sun = false;
  for (const int node : nodes) {
    const tinygltf::Node& source = document.model.nodes[static_cast<std::size_t>(node)];
    const auto extension = source.extensions.find("KHR_lights_punctual");
    if (extension == source.extensions.end()) continue;
    const int index = extension->second.Get("light").GetNumberAsInt();
    const tinygltf::Light& light = document.model.lights[static_cast<std::size_t>(index)];
    const std::string who = described("light", index, light.name);
    const glm::mat4 world = tree.world(node, 0);
    if (tree.is_animated(node)) document.warn(who + " is animated; it stays where it is at time 0");
    if (light.type == "spot") {
      document.warn(who + " is a spot light, which is left out; point and directional lights are read");
    } else if (light.type == "directional") {
      const glm::vec3 direction = -glm::vec3(world[2]);
      if (has_sun || !(glm::length(direction) > 0)) {
        document.warn(who + " is left out; one directional light can shine, and needs a direction");
        continue;
      }
      has_sun = true;
      scene.sun.direction = glm::normalize(direction);
      scene.sun.irradiance = power_of(light);
    } else if (scene.lights.size() < static_cast<std::size_t>(Scene::kMaxPointLights)) {
      const float range = light.range > 0 ? static_cast<float>(light.range) : kReachInDiagonals * diagonal;
      scene.lights.push_back({glm::vec3(world[3]), power_of(light), range});
    } else {
      document.warn(fmt::format("only the first {} point lights can shine", Scene::kMaxPointLights));
    }
  }
  if (!has_sun && scene.lights.empty()) {
    default_light(scene);
  } else {
    scale_to_photometric(scene, bounds);
  }
}

}  // namespace quincunx::scenes
