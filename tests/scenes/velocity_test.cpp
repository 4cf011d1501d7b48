// SPDX-License-Identifier: MIT
// Velocity: by warping the previous frame, by geometry computed here, and by depth and the camera's motion.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "render_fixture.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{256, 144};
constexpr double kNow = 0.5, kBefore = 0.45;
constexpr Vec2 kJitterNow{0.25f, -0.25f}, kJitterBefore{-0.25f, 0.25f};

glm::mat4 wall_place() {
  return glm::translate(glm::mat4(1), glm::vec3(0, 0, -4));
}

glm::mat4 plate_place(double t) {
  const auto s = static_cast<float>(t);
  glm::mat4 m = glm::translate(glm::mat4(1), glm::vec3(2 * s - 1, 0.8f * s - 0.4f, 0));
  m = glm::rotate(m, 0.9f * s, glm::vec3(0, 0, 1));
  return glm::rotate(m, 0.7f * s - 0.5f, glm::vec3(0, 1, 0));
}

Camera moving_camera(double t) {
  const auto s = static_cast<float>(t);
  Camera camera;
  camera.world_from_camera = look_from({0.8f * s, 0.3f, 5 - 1.5f * s}, {0.2f * s, 0.4f * s, 0});
  camera.vertical_fov = 0.9f;
  return camera;
}

// A wall that stands and a plate before it that moves, both smooth.
Scene smooth_scene(bool moving_plate) {
  Scene scene;
  scene.textures = {smooth_texture(12, 0), smooth_texture(4, 255)};
  for (int i = 0; i < 2; ++i) {
    Material material = unlit(glm::vec4(1));
    material.base_colour_texture.texture = i;
    scene.materials.push_back(material);
  }
  scene.meshes = {plate({12, 12}, 0, 4), plate({1.2f, 1.2f}, 1)};
  scene.instances.push_back({0, wall_place(), {}});
  if (moving_plate) scene.instances.push_back({1, glm::mat4(1), plate_place});
  scene.camera = moving_camera;
  scene.camera_moves = true;
  return scene;
}

// Bilinear, at a position in texels of which texel i has its centre at i + .5; nothing where the four texels
// are not all of the surface marked by `blue`.
std::optional<glm::vec3> sample(const Picture& picture, glm::vec2 at, float blue) {
  const glm::vec2 p = at - 0.5f;
  const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
  if (x < 0 || y < 0 || x + 1 >= picture.extent.width || y + 1 >= picture.extent.height) return std::nullopt;
  const glm::vec2 f = p - glm::vec2(x, y);
  glm::vec3 sum(0);
  for (int k = 0; k < 4; ++k) {
    const glm::vec3 c = picture.rgb(x + (k & 1), y + (k >> 1));
    if (std::abs(c.b - blue) > 0.01f) return std::nullopt;
    sum += c * (((k & 1) != 0 ? f.x : 1 - f.x) * ((k >> 1) != 0 ? f.y : 1 - f.y));
  }
  return sum;
}

struct WarpError {
  double rms = 0;
  std::size_t pixels = 0;
};

// `sign` multiplies velocity; `jitter_left_in` takes the samples for pixel centres.
WarpError warp_error(const Picture& now, const Picture& before, float sign, bool jitter_left_in) {
  const glm::vec2 size(kSize.width, kSize.height);
  const glm::vec2 jitter_now = jitter_left_in ? glm::vec2(0) : glm::vec2(kJitterNow.x, kJitterNow.y);
  const glm::vec2 jitter_before = jitter_left_in ? glm::vec2(0) : glm::vec2(kJitterBefore.x, kJitterBefore.y);
  std::vector<double> differences;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const glm::vec3 here = now.rgb(x, y);
      const glm::vec2 at = glm::vec2(x, y) + 0.5f + jitter_now - sign * now.v(x, y) * size - jitter_before;
      const std::optional<glm::vec3> there = sample(before, at, here.b);
      if (!there) continue;
      differences.push_back(here.r - there->r);
      differences.push_back(here.g - there->g);
    }
  }
  return {rms(differences), differences.size() / 2};
}

TEST_F(RenderTest, VelocityWarpsThePreviousFrameOntoThisOne) {
  // Waves of some 40 pixels and amplitude .4. Bilinear interpolation errs by up to .4 (2 pi / 40)^2 / 8 = .0012, 8-bit
  // texels by .002 and the filter's weights by as much again. Half a pixel of jitter moves the value by .02 rms.
  constexpr double kBound = 0.004;
  Renderer renderer = renderer_of(smooth_scene(true));
  const Picture before = draw(renderer, view_of_size(kSize, kJitterBefore, kBefore, kBefore - 0.05), kSize);
  const Picture now = draw(renderer, view_of_size(kSize, kJitterNow, kNow, kBefore), kSize);
  const WarpError right = warp_error(now, before, 1, false);
  EXPECT_LT(right.rms, kBound);
  EXPECT_GT(right.pixels, static_cast<std::size_t>(kSize.area()) * 8 / 10);
  // The check has teeth: each of the classic mistakes fails it clearly.
  EXPECT_GT(warp_error(now, before, -1, false).rms, 4 * kBound) << "a flipped sign must not pass";
  EXPECT_GT(warp_error(now, before, 0, false).rms, 4 * kBound) << "no velocity at all must not pass";
  EXPECT_GT(warp_error(now, before, 1, true).rms, 2 * kBound) << "jitter left in must not pass";
}

// The uv at which a camera sees a world point; written independently of the renderer.
glm::dvec2 uv_of(const Camera& camera, double aspect, const glm::dvec3& world) {
  const glm::dvec3 p = glm::dvec3(glm::inverse(glm::dmat4(camera.world_from_camera)) * glm::dvec4(world, 1));
  const double focal = 1 / std::tan(0.5 * static_cast<double>(camera.vertical_fov));
  return {0.5 + 0.5 * focal / aspect * p.x / -p.z, 0.5 - 0.5 * focal * p.y / -p.z};
}

// Where the ray of a uv meets the plane z = 0 of a mesh, in mesh space.
glm::dvec3 meet_plate(const Camera& camera, double aspect, const glm::dvec2& uv, const glm::dmat4& place) {
  const double tangent = std::tan(0.5 * static_cast<double>(camera.vertical_fov));
  const glm::dvec4 along((2 * uv.x - 1) * tangent * aspect, (1 - 2 * uv.y) * tangent, -1, 0);
  const glm::dmat4 mesh_from_camera = glm::inverse(place) * glm::dmat4(camera.world_from_camera);
  const glm::dvec3 origin(mesh_from_camera[3]);
  const glm::dvec3 direction(mesh_from_camera * along);
  return origin - direction * (origin.z / direction.z);
}

TEST_F(RenderTest, VelocityIsThatOfTheGeometry) {
  // RG16F keeps 11 bits, and llvmpipe truncates; 2e-6 of the viewport is what 32-bit interpolation over large
  // triangles leaves.
  constexpr double kHalfPrecision = 1.0 / 1024, kInterpolation = 2e-6;
  Renderer renderer = renderer_of(smooth_scene(true));
  const Picture now = draw(renderer, view_of_size(kSize, kJitterNow, kNow, kBefore), kSize);
  const double aspect = static_cast<double>(kSize.width) / kSize.height;
  const Camera camera = moving_camera(kNow), camera_before = moving_camera(kBefore);
  int on_plate = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool plate = now.rgb(x, y).b > 0.5f;
      on_plate += plate;
      const glm::dmat4 place = plate ? plate_place(kNow) : wall_place();
      const glm::dmat4 place_before = plate ? plate_place(kBefore) : wall_place();
      const glm::dvec2 uv((x + 0.5 + kJitterNow.x) / kSize.width, (y + 0.5 + kJitterNow.y) / kSize.height);
      const glm::dvec3 local = meet_plate(camera, aspect, uv, place);
      const glm::dvec2 expected =
          uv - uv_of(camera_before, aspect, glm::dvec3(place_before * glm::dvec4(local, 1)));
      const glm::dvec2 error = glm::abs(glm::dvec2(now.v(x, y)) - expected);
      ASSERT_LE(error.x, std::abs(expected.x) * kHalfPrecision + kInterpolation) << x << ", " << y;
      ASSERT_LE(error.y, std::abs(expected.y) * kHalfPrecision + kInterpolation) << x << ", " << y;
    }
  }
  EXPECT_GT(on_plate, 1000);
}

TEST_F(RenderTest, DepthAndCameraMotionGiveTheSameVelocity) {
  // Half precision as above; depth is a 32-bit float, and the quotient of two products leaves about 1e-6.
  constexpr double kHalfPrecision = 1.0 / 1024, kArithmetic = 3e-6;
  Scene scene = smooth_scene(false);
  scene.meshes[0] = plate({5, 1.5f}, 0, 4);  // sky above and below: points at infinity
  Renderer renderer = renderer_of(scene);
  const FrameView view = view_of_size(kSize, kJitterNow, kNow, kBefore);
  const Picture now = draw(renderer, view, kSize);
  const std::array<float, 16> m = renderer.camera_motion(view).clip_to_previous_clip;
  int sky = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const double u = (x + 0.5 + kJitterNow.x) / kSize.width, v = (y + 0.5 + kJitterNow.y) / kSize.height;
      const double depth = now.depth[now.index(x, y)];
      const double in[4] = {2 * u - 1, 1 - 2 * v, depth, 1};
      double out[4] = {};
      for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
          out[row] += static_cast<double>(m[4 * column + row]) * in[column];
        }
      }
      const double expected_x = u - (0.5 + 0.5 * out[0] / out[3]);
      const double expected_y = v - (0.5 - 0.5 * out[1] / out[3]);
      sky += depth == 0;
      ASSERT_NEAR(now.v(x, y).x, expected_x, std::abs(expected_x) * kHalfPrecision + kArithmetic)
          << x << ", " << y;
      ASSERT_NEAR(now.v(x, y).y, expected_y, std::abs(expected_y) * kHalfPrecision + kArithmetic)
          << x << ", " << y;
    }
  }
  EXPECT_GT(sky, 1000) << "the sky must be part of this check";
  EXPECT_LT(sky, kSize.area() - 1000);
}

TEST_F(RenderTest, WhatStandsStillHasExactlyNoVelocity) {
  Scene scene = smooth_scene(false);
  scene.meshes[0] = plate({5, 1.5f}, 0, 4);
  scene.camera = [](double) { return moving_camera(0.3); };
  Renderer renderer = renderer_of(scene);
  const Picture now = draw(renderer, view_of_size(kSize, kJitterNow, kNow, kBefore), kSize);
  for (const float v : now.velocity)
    ASSERT_EQ(v, 0.0f);
}

TEST_F(RenderTest, VelocityStaysFiniteBehindThePreviousCamera) {
  Scene scene = smooth_scene(true);
  // The camera jumps backwards through the plate and over much of the floor.
  scene.instances.push_back(
      {0, glm::rotate(glm::translate(glm::mat4(1), glm::vec3(0, -1, 0)), -1.5708f, glm::vec3(1, 0, 0)), {}});
  scene.camera = [](double t) {
    Camera camera = moving_camera(0);
    camera.world_from_camera = look_from({0, 0, t < kNow ? -2.0f : 5.0f}, {0, 0, -4});
    return camera;
  };
  Renderer renderer = renderer_of(scene);
  const Picture now = draw(renderer, view_of_size(kSize, kJitterNow, kNow, kBefore), kSize);
  float largest = 0;
  for (const float v : now.velocity) {
    ASSERT_TRUE(std::isfinite(v));
    largest = std::max(largest, std::abs(v));
  }
  EXPECT_GT(largest, 1) << "the case must reach points near or behind the previous camera";
}

}  // namespace
}  // namespace quincunx::scenes::testing
