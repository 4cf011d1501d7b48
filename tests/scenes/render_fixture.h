// SPDX-License-Identifier: MIT
// Small scenes, one GL context for all tests, and pictures as plain floats.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "quincunx_gl/render_targets.h"
#include "render/renderer.h"

namespace quincunx::scenes::testing {

// All targets of a frame, whole (the target extent), as float, top row first.
struct Picture {
  Extent extent;
  std::vector<float> colour;    // RGBA
  std::vector<float> depth;     // 1 a pixel
  std::vector<float> velocity;  // RG; empty without target
  std::vector<float> reactive;  // empty without target

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * extent.width + x; }
  glm::vec3 rgb(int x, int y) const {
    const float* c = &colour[index(x, y) * 4];
    return {c[0], c[1], c[2]};
  }
  glm::vec2 v(int x, int y) const { return {velocity[index(x, y) * 2], velocity[index(x, y) * 2 + 1]}; }
};

Picture read_back(const gl::RenderTargets& targets);
void fill_with(const gl::RenderTargets& targets, float value);  // every texel of every target

// Makes the context current and fails the test on GL errors left behind.
class RenderTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
};

// Both throw with the message on failure, which fails the test.
Renderer renderer_of(const Scene& scene);
Picture draw(Renderer& renderer, const FrameView& view, Extent target, bool velocity = true,
             bool reactive = true);

FrameView view_of_size(Extent render, Vec2 jitter = {}, double seconds = 0, double previous_seconds = 0);

// A rectangle in the plane z = 0 facing +z, of half size (x, y), cut into n x n squares; uv from 0 to 1, v
// down.
Mesh plate(glm::vec2 half_size, int material, int n = 1);
Material unlit(glm::vec4 colour);
CameraPath fixed_camera(glm::vec3 eye, glm::vec3 target, float vertical_fov = 1.0f);
glm::mat4 look_from(glm::vec3 eye, glm::vec3 target);  // world from camera

// Red and green vary smoothly with uv, `waves` periods along it; blue tells one surface from another.
Texture smooth_texture(int waves, std::uint8_t blue);

double rms(const std::vector<double>& differences);

}  // namespace quincunx::scenes::testing
