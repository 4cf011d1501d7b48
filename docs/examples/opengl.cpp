// SPDX-License-Identifier: MIT
// Quincunx in a renderer of your own: a GLFW window, your render targets, a frame time that is held.
//
//   opengl [FRAMES]                          turning cubes, until the window is closed
//   opengl FRAMES PICTURE.ppm SCALE METHOD   at a fixed scale, by temporal or bilinear; the last frame as a file
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <quincunx/control/predictive_controller.h>
#include <quincunx/resolve_service.h>
#include <quincunx_gl/bridge.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using namespace quincunx;

constexpr Extent kOutput = {960, 540};
constexpr Extent kTarget = {2 * kOutput.width, 2 * kOutput.height};  // for scales up to 2
constexpr float kStep = 1.0f / 60;  // seconds of the scene from frame to frame

const char* const kVertex = R"(#version 450 core
layout(location = 0) uniform vec2 times;   // of this frame and of the one before
layout(location = 1) uniform vec2 jitter;  // as a part of the viewport, +y down
out vec3 now, before;
out vec2 uv;
vec4 project(vec3 corner, float time) {  // without jitter
  float a = 0.5 * time + gl_InstanceID, b = 0.3 * time;
  corner.xz *= mat2(cos(a), sin(a), -sin(a), cos(a));
  corner.xy *= mat2(cos(b), sin(b), -sin(b), cos(b));
  vec3 p = corner + 2.2 * vec3(gl_InstanceID % 7 - 3, gl_InstanceID / 7 - 2, 0) - vec3(0, 0, 9 + gl_InstanceID % 3);
  return vec4(p.x, 16.0 / 9.0 * p.y, 0.1, -p.z);  // reversed infinite depth: near / distance
}
void main() {
  int face = gl_VertexID / 6, k = gl_VertexID % 6;
  uv = vec2(k == 1 || k == 2 || k == 4, k == 2 || k == 4 || k == 5);
  vec3 corner = 0.7 * vec3(2.0 * uv - 1.0, face % 2 == 0 ? 1.0 : -1.0);
  corner = face / 2 == 0 ? corner : face / 2 == 1 ? corner.zxy : corner.yzx;
  gl_Position = project(corner, times.x);
  now = gl_Position.xyw;
  before = project(corner, times.y).xyw;
  gl_Position.xy -= 2.0 * vec2(jitter.x, -jitter.y) * gl_Position.w;  // moves the samples by +jitter
})";
const char* const kFragment = R"(#version 450 core
layout(binding = 0) uniform sampler2D pattern;
in vec3 now, before;
in vec2 uv;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec2 velocity;
void main() {
  colour = vec4(texture(pattern, uv).r * vec3(0.9, 0.2 + 0.6 * uv), 1.0);      // linear light
  velocity = (now.xy / now.z - before.xy / before.z) * vec2(0.5, -0.5);  // in uv, +y down, without jitter
})";

struct Glfw {
  ~Glfw() { glfwTerminate(); }
};

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

template <typename T>
T get(Result<T> result) {
  if (!result.ok()) fail(result.status().message());
  return std::move(result).value();
}

GLuint make_program() {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, source] :
       {std::pair{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  return program;
}

GLuint make_texture(GLenum format, Extent extent, GLsizei levels = 1) {
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, levels, format, extent.width, extent.height);
  return texture;
}

GLuint make_pattern() {
  constexpr int kSide = 256;
  std::vector<unsigned char> texels;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int x = i % kSide, y = i / kSide;
    texels.push_back(x % 32 < 4 || y % 32 < 4 ? 10 : (x / 32 + y / 32) % 2 == 0 ? 230 : 90);
  }
  const GLuint texture = make_texture(GL_R8, {kSide, kSide}, 9);
  glTextureSubImage2D(texture, 0, 0, 0, kSide, kSide, GL_RED, GL_UNSIGNED_BYTE, texels.data());
  glGenerateTextureMipmap(texture);
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  return texture;
}

void write_picture(const char* path, GLuint picture) {
  std::vector<char> texels(static_cast<std::size_t>(kOutput.area()) * 3);
  const auto bytes = static_cast<GLsizei>(texels.size());
  glGetTextureImage(picture, 0, GL_RGB, GL_UNSIGNED_BYTE, bytes, texels.data());
  std::ofstream file(path, std::ios::binary);
  file << "P6 " << kOutput.width << ' ' << kOutput.height << " 255\n";
  file.write(texels.data(), bytes);
}

int main(int argc, char** argv) {
  const long frames = argc > 1 ? std::atol(argv[1]) : 0;
  const bool fixed = argc == 5;
  const Glfw glfw;  // ends after the bridge, which needs the context
  if (glfwInit() == GLFW_FALSE) fail("GLFW finds no display");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
  GLFWwindow* const window = glfwCreateWindow(kOutput.width, kOutput.height, "Quincunx", nullptr, nullptr);
  if (window == nullptr) fail("GLFW makes no window with OpenGL 4.5");
  glfwMakeContextCurrent(window);

  // What makes the picture. The bridge says how OpenCL sees your textures.
  const auto context = get(gl::Context::create(gl::Platform::kCurrent));
  const auto device = get(gl::open_device(context, "", gl::Interop::kAuto));
  ResolveSettings settings;
  settings.output_extent = kOutput;
  settings.target_extent = kTarget;
  if (fixed && argv[4] == std::string("bilinear")) settings.method = Method::kBilinear;
  const SceneNeeds needs = {.transparents = false};
  gl::BridgeSettings bridging = gl::bridge_settings(get(plan_for(needs, settings)));
  bridging.imports = true;
  const auto bridge = get(gl::Bridge::create(context, device, bridging));
  settings.targets.storage = bridge->storage();
  auto service = get(ResolveService::create(device, get(plan_for(needs, settings))));
  const double scale = fixed ? std::atof(argv[3]) : 0.5;  // at least
  const auto controller = get(make_predictive_controller(
      {.ladder = {.output_extent = kOutput, .min_scale = scale, .max_scale = fixed ? scale : 1}}));

  // The renderer's own: targets of the largest viewport, a texture for the picture, a program.
  const gl::FrameTextures textures = {.colour = make_texture(GL_RGBA16F, kTarget),
                                      .depth = make_texture(GL_DEPTH_COMPONENT32F, kTarget),
                                      .velocity = make_texture(GL_RG16F, kTarget)};
  const GLuint picture = make_texture(GL_RGBA8, kOutput);
  const GLuint pattern = make_pattern();
  GLuint framebuffers[2], vertices = 0;
  glCreateFramebuffers(2, framebuffers);
  glNamedFramebufferTexture(framebuffers[0], GL_COLOR_ATTACHMENT0, textures.colour, 0);
  glNamedFramebufferTexture(framebuffers[0], GL_COLOR_ATTACHMENT1, textures.velocity, 0);
  glNamedFramebufferTexture(framebuffers[0], GL_DEPTH_ATTACHMENT, textures.depth, 0);
  const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(framebuffers[0], 2, buffers);
  glNamedFramebufferTexture(framebuffers[1], GL_COLOR_ATTACHMENT0, picture, 0);
  glCreateVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glBindTextureUnit(0, pattern);
  glUseProgram(make_program());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);  // row 0 on top, depth from 1 at the near plane to 0

  for (long n = 0; n != frames || frames == 0; ++n) {
    if (glfwWindowShouldClose(window) == GLFW_TRUE) break;
    const double begun = glfwGetTime();
    const Extent render = controller->next();
    // Filters of one frame need no jitter.
    const Vec2 jitter = uses_earlier_frames(settings.method)
                            ? quincunx::jitter(static_cast<std::uint64_t>(n), render, kOutput)
                            : Vec2();
    const float time = kStep * static_cast<float>(n);
    const float sky[] = {0.02f, 0.03f, 0.06f, 1}, zero[] = {0, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[0]);
    glViewport(0, 0, render.width, render.height);
    glClearBufferfv(GL_COLOR, 0, sky);
    glClearBufferfv(GL_COLOR, 1, zero);
    glClearBufferfv(GL_DEPTH, 0, zero);
    glUniform2f(0, time, time - kStep);
    glUniform2f(1, jitter.x / static_cast<float>(render.width), jitter.y / static_cast<float>(render.height));
    glTextureParameterf(pattern, GL_TEXTURE_LOD_BIAS, texture_lod_bias(render, kOutput));
    glDrawArraysInstanced(GL_TRIANGLES, 0, 36, 35);

    const gl::SharedFrame inputs = get(bridge->import(textures, render));  // the targets are free again
    const FrameReport report = service.dispatch({.colour = inputs.colour,
                                                 .depth = inputs.depth,
                                                 .velocity = inputs.velocity,
                                                 .render_extent = render,
                                                 .jitter = jitter},
                                                {.presented = get(bridge->begin_present())});
    if (!report.ok()) fail(report.status.message());
    if (const Status status = bridge->present(picture); !status.ok()) fail(status.message());

    // import() has waited for OpenGL and present() for OpenCL, so the host's clock has seen all of the frame.
    const double ms = 1000 * (glfwGetTime() - begun);
    (void)controller->observe(
        {.frame = static_cast<std::uint64_t>(n + 1), .render_extent = render, .gpu_ms = ms});
    const std::string title = std::to_string(render.width) + " x " + std::to_string(render.height);
    glfwSetWindowTitle(window, title.c_str());
    glBlitNamedFramebuffer(framebuffers[1], 0, 0, 0, kOutput.width, kOutput.height, 0, kOutput.height,
                           kOutput.width, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);  // row 0 on top
    glfwSwapBuffers(window);
    glfwPollEvents();
  }
  if (fixed) write_picture(argv[2], picture);
  return 0;
}
