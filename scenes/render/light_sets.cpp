// SPDX-License-Identifier: MIT
#include "render/light_sets.h"

#include <bit>

namespace quincunx::scenes {

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

}  // namespace quincunx::scenes
