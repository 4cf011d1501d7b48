// SPDX-License-Identifier: MIT
// The blocks that the shaders read, as they lay them out (std140). Mirrors shaders/frame.glsl, surface.frag.glsl,
// lighting.glsl.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene.h"

namespace quincunx::scenes {

struct FrameBlock {
  glm::mat4 clip_from_world{1};
  glm::mat4 previous_clip_from_world{1};
  glm::mat4 clip_to_previous_clip{1};
  glm::mat4 shadow_from_world{1};
  glm::vec4 jitter{0};
  glm::vec4 jitter_clip{0};
  glm::vec4 camera_position{0};
  glm::vec4 camera_right{0};
  glm::vec4 camera_up{0};
  glm::vec4 ray_centre{0};
  glm::vec4 ray_x{0};
  glm::vec4 ray_y{0};
  glm::vec4 to_sun{0};
  glm::vec4 sun_irradiance{0};
  glm::vec4 sun_radiance{0};
  glm::vec4 zenith{0};
  glm::vec4 horizon{0};
  glm::vec4 ground{0};
  glm::vec4 display{0};
  glm::vec4 shadow{0};
};
static_assert(sizeof(FrameBlock) == 4 * 64 + 16 * 16);

struct MaterialBlock {
  glm::vec4 base_colour{1};
  glm::vec4 emissive{0};
  glm::vec4 surface{0};
  std::array<glm::vec4, 8> uv{};
};
static_assert(sizeof(MaterialBlock) == 11 * 16);

struct LightsBlock {
  std::array<glm::vec4, Scene::kMaxPointLights> position{};
  std::array<glm::vec4, Scene::kMaxPointLights> intensity{};
};
static_assert(sizeof(LightsBlock) == 2 * 16 * Scene::kMaxPointLights);

// One instance of a draw, as vertex attributes: rows of affine matrices, world from mesh.
struct InstanceData {
  std::array<glm::vec4, 3> world;
  std::array<glm::vec4, 3> previous;
};
static_assert(sizeof(InstanceData) == 96);

// Binding points of the uniform blocks.
inline constexpr unsigned kFrameBinding = 0;
inline constexpr unsigned kMaterialBinding = 1;
inline constexpr unsigned kLightsBinding = 2;
inline constexpr unsigned kShadowUnit = 4;  // texture unit; 0 to 3 are the material's

}  // namespace quincunx::scenes
