// SPDX-License-Identifier: MIT
// The GLSL peers: each filter as one would write it for a GPU, with its texture units doing what they can.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <memory>
#include <random>
#include <stdexcept>

#include "peers.h"
#include "quincunx_gl/handle.h"
#include "stage.h"

namespace quincunx::bench {
namespace {

inline constexpr const char* kVersion = "#version 450 core\n";

inline constexpr const char* kFullScreenTriangle = R"(
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
})";

inline constexpr const char* kInputs = R"(
layout(binding = 0) uniform sampler2D colour0;
layout(binding = 1) uniform sampler2D colour1;
layout(binding = 2) uniform sampler2D velocity0;
layout(binding = 3) uniform sampler2D velocity1;
in vec2 uv;
out vec4 result;
const float kJitter = 0.25;  // texels
)";

inline constexpr const char* kBilinear = R"(
void main() {
  result = texture(colour0, uv - kJitter / vec2(textureSize(colour0, 0)));
})";

// Sigg & Hadwiger, "Fast Third-Order Texture Filtering", 2005: four bilinear reads.
inline constexpr const char* kBSpline = R"(
void main() {
  vec2 size = vec2(textureSize(colour0, 0));
  vec2 p = uv * size - 0.5 - kJitter;
  vec2 base = floor(p), t = p - base, s = 1.0 - t;
  vec2 w0 = s * s * s / 6.0, w3 = t * t * t / 6.0;
  vec2 w1 = 2.0 / 3.0 - 0.5 * t * t * (2.0 - t);
  vec2 g0 = w0 + w1, g1 = 1.0 - g0, w2 = g1 - w3;
  vec2 lower = (base - 0.5 + w1 / g0) / size, upper = (base + 1.5 + w3 / (w2 + w3)) / size;
  result = g0.y * (g0.x * texture(colour0, lower) + g1.x * texture(colour0, vec2(upper.x, lower.y))) +
           g1.y * (g0.x * texture(colour0, vec2(lower.x, upper.y)) + g1.x * texture(colour0, upper));
})";

// Nine bilinear reads: the two inner weights of each axis share one.
inline constexpr const char* kCatmullRom = R"(
void main() {
  vec2 size = vec2(textureSize(colour0, 0));
  vec2 p = uv * size - kJitter;
  vec2 base = floor(p - 0.5) + 0.5, t = p - base;
  vec2 w0 = t * (-0.5 + t * (1.0 - 0.5 * t)), w1 = 1.0 + t * t * (-2.5 + 1.5 * t);
  vec2 w3 = t * t * (-0.5 + 0.5 * t), w2 = 1.0 - w0 - w1 - w3;
  vec2 inner = w1 + w2;
  vec2 c[3] = vec2[]((base - 1.0) / size, (base + w2 / inner) / size, (base + 2.0) / size);
  vec2 w[3] = vec2[](w0, inner, w3);
  result = vec4(0.0);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      result += w[i].x * w[j].y * texture(colour0, vec2(c[i].x, c[j].y));
})";

inline constexpr const char* kSeedResolve = R"(
void main() {
  vec2 size = vec2(textureSize(colour0, 0));
  vec2 shift = kJitter / size;
  vec2 v0 = texture(velocity0, uv).xy * size, v1 = texture(velocity1, uv).xy * size;
  float weight = 1.0 / (1.0 + dot(v0, v0) + dot(v1, v1));
  result = (texture(colour0, uv - shift) + weight * texture(colour1, uv + shift)) / (1.0 + weight);
})";

inline constexpr const char* kBlur = R"(
void main() {
  vec2 velocity = texture(velocity0, uv).xy;
  result = vec4(0.0);
  for (int i = 0; i < 8; ++i)
    result += texture(colour0, uv + velocity * ((float(i) + 0.5) / 8.0 - 0.5));
  result *= 1.0 / 8.0;
})";

GLuint compiled(GLenum stage, std::initializer_list<const char*> sources) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, static_cast<GLsizei>(sources.size()), sources.begin(), nullptr);
  glCompileShader(shader);
  return shader;
}

gl::Program linked(const char* fragment) {
  gl::Program program = gl::Program::create();
  const GLuint shaders[] = {compiled(GL_VERTEX_SHADER, {kVersion, kFullScreenTriangle}),
                            compiled(GL_FRAGMENT_SHADER, {kVersion, kInputs, fragment})};
  for (const GLuint shader : shaders) {
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.get());
  GLint done = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &done);
  if (done == GL_TRUE) return program;
  char log[2048] = {};
  glGetProgramInfoLog(program.get(), sizeof(log), nullptr, log);
  throw std::runtime_error(fmt::format("a GLSL peer does not link: {}", log));
}

gl::Texture texture(Extent extent, GLenum format, GLenum filter) {
  gl::Texture made = gl::Texture::create();
  glTextureStorage2D(made.get(), 1, format, extent.width, extent.height);
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(made.get(), name, static_cast<GLint>(filter));
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTextureParameteri(made.get(), name, GL_CLAMP_TO_EDGE);
  return made;
}

void fill(const gl::Texture& target, Extent extent, float low, float high) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(low, high);
  std::vector<float> values(static_cast<std::size_t>(extent.area()) * 4);
  for (float& value : values)
    value = uniform(random);
  glTextureSubImage2D(target.get(), 0, 0, 0, extent.width, extent.height, GL_RGBA, GL_FLOAT, values.data());
}

// Two frames at the render extent and the picture that the passes write.
struct Surface {
  Surface(Extent picture, Extent frame) : output(picture), render(frame) {
    for (gl::Texture& colour : colours) {
      colour = texture(render, GL_RGBA16F, GL_LINEAR);
      fill(colour, render, 0.1f, 1);
    }
    for (gl::Texture& velocity : velocities) {
      velocity = texture(render, GL_RG16F, GL_NEAREST);
      fill(velocity, render, -0.01f, 0.01f);
    }
    glNamedFramebufferTexture(framebuffer.get(), GL_COLOR_ATTACHMENT0, result.get(), 0);
    if (glCheckNamedFramebufferStatus(framebuffer.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("the GLSL peers need a renderable RGBA32F texture");
  }

  void draw(GLuint program) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
    glViewport(0, 0, output.width, output.height);
    glBindVertexArray(vertices.get());
    const GLuint inputs[] = {colours[0].get(), colours[1].get(), velocities[0].get(), velocities[1].get()};
    glBindTextures(0, 4, inputs);
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, ~GLuint64{0});
    glDeleteSync(fence);
  }

  Extent output, render;
  gl::Texture colours[2], velocities[2];
  gl::Texture result = texture(output, GL_RGBA32F, GL_NEAREST);
  gl::Framebuffer framebuffer = gl::Framebuffer::create();
  gl::VertexArray vertices = gl::VertexArray::create();
};

}  // namespace

void add_gl_peers(std::vector<Case>& cases, Extent output, double scale) {
  const Extent render = scaled(output, scale);
  const auto surface = std::make_shared<Surface>(output, render);
  const std::uint64_t colour = bytes_of(render, PixelFormat::kRGBA16F);
  const std::uint64_t velocity = bytes_of(render, PixelFormat::kRG16F);
  const auto add = [&](const char* name, const char* fragment, std::uint64_t read) {
    const auto program = std::make_shared<gl::Program>(linked(fragment));
    cases.push_back({.name = fmt::format("GLSL {} {:.2f}", name, scale),
                     .scale = scale,
                     .bytes = read + bytes_of(output, PixelFormat::kRGBA32F),
                     .run = [=] { return wall_ms([&] { surface->draw(program->get()); }); }});
  };
  add("bilinear", kBilinear, colour);
  add("b-spline", kBSpline, colour);
  add("catmull-rom", kCatmullRom, colour);
  add("seed resolve", kSeedResolve, 2 * (colour + velocity));
  add("8-tap blur", kBlur, colour + velocity);
}

}  // namespace quincunx::bench
