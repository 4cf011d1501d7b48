// SPDX-License-Identifier: MIT
#include "render_fixture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <stdexcept>

#include "quincunx_gl/context.h"
#include "skip.h"

namespace quincunx::scenes::testing {
namespace {

// Lives until the program ends: GL objects of static lifetime do not exist in these tests.
Result<gl::Context>& shared_context() {
  static Result<gl::Context> context = gl::Context::create();
  return context;
}

std::vector<float> read_texture(GLuint texture, GLenum format, int channels, Extent extent) {
  if (texture == 0) return {};
  std::vector<float> values(static_cast<std::size_t>(extent.area()) * channels);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture, 0, format, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)),
                    values.data());
  return values;
}

}  // namespace

Picture read_back(const gl::RenderTargets& targets) {
  const Extent extent = targets.extent();
  return {extent, read_texture(targets.colour(), GL_RGBA, 4, extent),
          read_texture(targets.depth(), GL_DEPTH_COMPONENT, 1, extent),
          read_texture(targets.velocity(), GL_RG, 2, extent),
          read_texture(targets.reactive(), GL_RED, 1, extent)};
}

void fill_with(const gl::RenderTargets& targets, float value) {
  const float values[] = {value, value, value, value};
  glDisable(GL_SCISSOR_TEST);
  for (GLint buffer = 0; buffer < 3; ++buffer) {
    glClearNamedFramebufferfv(targets.framebuffer(), GL_COLOR, buffer, values);
  }
  glClearNamedFramebufferfv(targets.framebuffer(), GL_DEPTH, 0, values);
}

void RenderTest::SetUp() {
  Result<gl::Context>& context = shared_context();
  if (!context.ok()) QUINCUNX_SKIP(context.status().message());
  const Status status = context->make_current();
  ASSERT_TRUE(status.ok()) << status.message();
}

void RenderTest::TearDown() {
  if (!shared_context().ok()) return;
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

Renderer renderer_of(const Scene& scene) {
  Result<Renderer> renderer = Renderer::create(scene);
  if (!renderer.ok()) throw std::runtime_error(renderer.status().message());
  return std::move(renderer).value();
}

Picture draw(Renderer& renderer, const FrameView& view, Extent target, bool velocity, bool reactive) {
  const gl::RenderTargets targets = gl::RenderTargets::create({target, velocity, reactive}).value();
  const Status status = renderer.draw(targets, view);
  if (!status.ok()) throw std::runtime_error(status.message());
  return read_back(targets);
}

FrameView view_of_size(Extent render, Vec2 jitter, double seconds, double previous_seconds) {
  FrameView view;
  view.render = render;
  view.jitter = jitter;
  view.seconds = seconds;
  view.previous_seconds = previous_seconds;
  return view;
}

Mesh plate(glm::vec2 half_size, int material, int n) {
  Mesh mesh;
  mesh.material = material;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const glm::vec2 uv = glm::vec2(i, j) / static_cast<float>(n);
      Vertex vertex;
      vertex.position = glm::vec3((2 * uv.x - 1) * half_size.x, (1 - 2 * uv.y) * half_size.y, 0);
      vertex.normal = {0, 0, 1};
      vertex.uv = uv;
      mesh.vertices.push_back(vertex);
    }
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      for (const std::uint32_t index :
           {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)}) {
        mesh.indices.push_back(index);
      }
    }
  }
  return mesh;
}

Material unlit(glm::vec4 colour) {
  Material material;
  material.unlit = true;
  material.base_colour = colour;
  return material;
}

glm::mat4 look_from(glm::vec3 eye, glm::vec3 target) {
  return glm::inverse(glm::lookAt(eye, target, glm::vec3(0, 1, 0)));
}

CameraPath fixed_camera(glm::vec3 eye, glm::vec3 target, float vertical_fov) {
  return [=](double) {
    Camera camera;
    camera.world_from_camera = look_from(eye, target);
    camera.vertical_fov = vertical_fov;
    return camera;
  };
}

Texture smooth_texture(int waves, std::uint8_t blue) {
  constexpr int kSide = 256;
  Texture texture;
  texture.width = texture.height = kSide;
  texture.srgb = false;
  const auto wave = [&](int i) {
    const double phase = 2 * std::numbers::pi * waves * (i + 0.5) / kSide;
    return static_cast<std::uint8_t>(std::lround(127.5 + 100 * std::sin(phase)));
  };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (const std::uint8_t code : {wave(x), wave(y), blue, std::uint8_t{255}})
        texture.rgba.push_back(code);
    }
  }
  return texture;
}

double rms(const std::vector<double>& differences) {
  double sum = 0;
  for (const double d : differences)
    sum += d * d;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(differences.size(), 1)));
}

}  // namespace quincunx::scenes::testing
