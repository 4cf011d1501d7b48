// SPDX-License-Identifier: MIT
#include "texel_copy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "cl_handle.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl {
namespace {

constexpr int kGroupSide = 8;

constexpr const char* kDepthSource = R"(#version 310 es
precision highp float;
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform highp sampler2D depth;
layout(binding = 0, r32f) writeonly uniform highp image2D copy;
layout(location = 0) uniform ivec2 render;
void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, render))) return;
  imageStore(copy, texel, vec4(texelFetch(depth, texel, 0).r));
})";

constexpr int kGroupWidth = 32;
constexpr int kGroupHeight = 4;

// Texels of a size as whole numbers, so that every bit stays: the image, what the buffer holds, and how one comes to
// the other.
struct WordFacts {
  std::size_t texel_bytes;
  GLenum image;
  const char* layout;
  const char* word;
  std::size_t word_bytes;
  int word_texels;
  const char* load;
  const char* store;
};

constexpr std::array<WordFacts, 4> kWords = {{
    {1, GL_R8UI, "r8ui", "uint", 4, 4,
     "uint word = 0u; for (int i = 3; i >= 0; --i) word = word << 8 | imageLoad(texels, ivec2(4 * at.x + i, "
     "at.y)).r;",
     "for (int i = 0; i < 4; ++i) imageStore(texels, ivec2(4 * at.x + i, at.y), uvec4(word >> 8 * i & "
     "255u));"},
    {4, GL_R32UI, "r32ui", "uint", 4, 1, "uint word = imageLoad(texels, at).r;",
     "imageStore(texels, at, uvec4(word));"},
    {8, GL_RG32UI, "rg32ui", "uvec2", 8, 1, "uvec2 word = imageLoad(texels, at).rg;",
     "imageStore(texels, at, uvec4(word, 0u, 0u));"},
    {16, GL_RGBA32UI, "rgba32ui", "uvec4", 16, 1, "uvec4 word = imageLoad(texels, at);",
     "imageStore(texels, at, word);"},
}};
constexpr WordFacts kDepth = {
    4, GL_NONE, "", "uint", 4, 1, "uint word = floatBitsToUint(texelFetch(texels, at, 0).r);", ""};

const WordFacts& facts_of(PixelFormat format, bool is_depth) {
  if (is_depth) return kDepth;
  return *std::find_if(kWords.begin(), kWords.end() - 1,
                       [&](const WordFacts& facts) { return facts.texel_bytes == bytes_per_pixel(format); });
}

std::string source_of(const WordFacts& facts, bool to_texture) {
  const std::string texels = facts.image == GL_NONE
                                 ? "layout(binding = 0) uniform sampler2D texels;"
                                 : fmt::format("layout(binding = 0, {}) {} uniform uimage2D texels;",
                                               facts.layout, to_texture ? "writeonly" : "readonly");
  const std::string copy = to_texture ? fmt::format("{} word = words[index]; {}", facts.word, facts.store)
                                      : fmt::format("{} words[index] = word;", facts.load);
  return fmt::format(R"(#version 450 core
layout(local_size_x = {}, local_size_y = {}) in;
{}
layout(std430, binding = 0) {} buffer Words {{ {} words[]; }};
layout(location = 0) uniform ivec2 extent;
layout(location = 1) uniform uvec2 place;
void main() {{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, extent))) return;
  uint index = place.x + uint(at.y) * place.y + uint(at.x);
  {}
}})",
                     kGroupWidth, kGroupHeight, texels, to_texture ? "readonly" : "writeonly", facts.word,
                     copy);
}

GLuint groups(int count, int size) {
  return static_cast<GLuint>((count + size - 1) / size);
}

// Throws InteropError where the driver refuses the shader.
Program compute_program(const std::string& text) {
  const char* const source = text.c_str();
  Program program = Program::adopt(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
  GLint linked = GL_FALSE;
  if (program) glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::string log(1024, '\0');
  GLsizei length = 0;
  if (program) glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw InteropError(fmt::format("the compute shader that copies texels was refused: {}", log));
}

}  // namespace

GLuint SamplerTraits::create() {
  GLuint name = 0;
  glGenSamplers(1, &name);
  glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return name;
}

DepthCopy DepthCopy::create() {
  DepthCopy made;
  made.program_ = compute_program(kDepthSource);
  made.sampler_ = Handle<SamplerTraits>::create();
  return made;
}

void DepthCopy::copy(GLuint depth, GLuint to, Extent render, Before before) const {
  const ComputeScope restore(before);
  glUseProgram(program_.get());
  glUniform2i(0, render.width, render.height);
  glBindTexture(GL_TEXTURE_2D, depth);
  glBindSampler(0, sampler_.get());
  glBindImageTexture(0, to, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
  glDispatchCompute(groups(render.width, kGroupSide), groups(render.height, kGroupSide), 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

DepthReader::DepthReader(Extent target)
    : copy_(Texture::create()), framebuffer_(Framebuffer::create()), to_copy_(DepthCopy::create()) {
  texture_storage(copy_.get(), 1, GL_R32F, target);
  attach(framebuffer_.get(), GL_COLOR_ATTACHMENT0, copy_.get());
  if (framebuffer_status(framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the driver draws into no R32F texture, through which depth is read");
}

void DepthReader::read(GLuint depth, Extent render, void* pixels, Before before) const {
  to_copy_.copy(depth, copy_.get(), render, before);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glReadPixels(0, 0, render.width, render.height, GL_RED, GL_FLOAT, pixels);
}

TexelCopy::TexelCopy(GLuint texture, PixelFormat format, bool is_depth, Direction direction)
    : texture_(texture) {
  const WordFacts& facts = facts_of(format, is_depth);
  const bool to_texture = direction == Direction::kToTexture;
  word_bytes_ = facts.word_bytes;
  word_texels_ = facts.word_texels;
  access_ = to_texture ? GL_WRITE_ONLY : GL_READ_ONLY;
  image_format_ = facts.image;
  program_ = compute_program(source_of(facts, to_texture));
  if (is_depth) {
    sampler_ = Handle<SamplerTraits>::create();
    return;
  }
  // A view needs a name without a texture.
  GLuint name = 0;
  glGenTextures(1, &name);
  view_ = Texture::adopt(name);
  glTextureView(name, GL_TEXTURE_2D, texture, image_format_, 0, 1, 0, 1);
  check_gl("glTextureView");
}

void TexelCopy::run(Extent extent, GLuint buffer, std::size_t offset, std::size_t pitch,
                    Before before) const {
  const ComputeScope restore(before);
  const StorageScope storage(before);
  const int width = (extent.width + word_texels_ - 1) / word_texels_;
  glUseProgram(program_.get());
  glUniform2i(0, width, extent.height);
  glUniform2ui(1, static_cast<GLuint>(offset / word_bytes_), static_cast<GLuint>(pitch / word_bytes_));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
  if (view_) {
    glBindImageTexture(0, view_.get(), 0, GL_FALSE, 0, access_, image_format_);
  } else {
    glBindTexture(GL_TEXTURE_2D, texture_);
    glBindSampler(0, sampler_.get());
  }
  glDispatchCompute(groups(width, kGroupWidth), groups(extent.height, kGroupHeight), 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace quincunx::gl
