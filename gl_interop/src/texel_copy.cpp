// SPDX-License-Identifier: MIT
#include "texel_copy.h"

#include <fmt/format.h>

#include <string>

#include "cl_handle.h"
#include "quincunx_gl/capabilities.h"

namespace quincunx::gl {
namespace {

constexpr int kGroupWidth = 32;
constexpr int kGroupHeight = 4;

// Texels of a size are read and written as whole numbers, so that every bit stays.
struct KindFacts {
  TexelCopy::Kind kind;
  GLenum image;        // format of the image unit
  const char* layout;  // the same in a shader
  const char* word;    // what the buffer holds
  std::size_t bytes;   // of that
  int texels;          // in that
  const char* load;
  const char* store;
};

const KindFacts& facts_of(TexelCopy::Kind kind) {
  using enum TexelCopy::Kind;
  static constexpr KindFacts kFacts[] = {
      {k1, GL_R8UI, "r8ui", "uint", 4, 4,
       "uint word = 0u; for (int i = 3; i >= 0; --i) word = word << 8 | imageLoad(texels, ivec2(4 * at.x + "
       "i, at.y)).r;",
       ""},
      {k4, GL_R32UI, "r32ui", "uint", 4, 1, "uint word = imageLoad(texels, at).r;", "uvec4(word)"},
      {k8, GL_RG32UI, "rg32ui", "uvec2", 8, 1, "uvec2 word = imageLoad(texels, at).rg;",
       "uvec4(word, 0u, 0u)"},
      {k16, GL_RGBA32UI, "rgba32ui", "uvec4", 16, 1, "uvec4 word = imageLoad(texels, at);", "word"},
      {kDepth, GL_NONE, "", "uint", 4, 1, "uint word = floatBitsToUint(texelFetch(texels, at, 0).r);", ""}};
  return kFacts[static_cast<std::size_t>(kind)];
}

std::string source_of(const KindFacts& facts, bool to_texture) {
  const std::string texels = facts.image == GL_NONE
                                 ? "layout(binding = 0) uniform sampler2D texels;"
                                 : fmt::format("layout(binding = 0, {}) {} uniform uimage2D texels;",
                                               facts.layout, to_texture ? "writeonly" : "readonly");
  const std::string copy =
      to_texture ? fmt::format("{} word = words[index]; imageStore(texels, at, {});", facts.word, facts.store)
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

}  // namespace

std::optional<TexelCopy::Kind> TexelCopy::of(const Plane& plane) {
  if (capabilities().api != Api::kGl45) return std::nullopt;
  if (plane.kind == PlaneKind::kDepth) return Kind::kDepth;
  if (plane.format == PixelFormat::kR8) return Kind::k1;
  return plane.format == PixelFormat::kRGBA8 ? std::nullopt : of_picture(plane.format);
}

std::optional<TexelCopy::Kind> TexelCopy::of_picture(PixelFormat picture) {
  if (capabilities().api != Api::kGl45) return std::nullopt;
  switch (bytes_per_pixel(picture)) {
    case 4:
      return Kind::k4;
    case 8:
      return Kind::k8;
    case 16:
      return Kind::k16;
    default:
      return std::nullopt;
  }
}

void TexelCopy::prepare(Kind kind, bool to_texture) {
  const std::string text = source_of(facts_of(kind), to_texture);
  const char* const source = text.c_str();
  Program program = Program::adopt(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
  GLint linked = GL_FALSE;
  if (program) glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::string log(1024, '\0');
    GLsizei length = 0;
    if (program) glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw InteropError(fmt::format("the compute shader that copies texels was refused: {}", log));
  }
  programs_[{kind, to_texture}] = std::move(program);
  if (!sampler_) sampler_ = Handle<SamplerTraits>::create();
}

void TexelCopy::run(Kind kind, bool to_texture, GLuint texture, Extent extent, GLuint buffer,
                    std::size_t offset, std::size_t pitch, Before before) const {
  const KindFacts& facts = facts_of(kind);
  const ComputeScope restore(before);
  const StorageScope storage(before);
  const int width = (extent.width + facts.texels - 1) / facts.texels;
  glUseProgram(programs_.at({kind, to_texture}).get());
  glUniform2i(0, width, extent.height);
  glUniform2ui(1, static_cast<GLuint>(offset / facts.bytes), static_cast<GLuint>(pitch / facts.bytes));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
  if (facts.image == GL_NONE) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glBindSampler(0, sampler_.get());
  } else {
    glBindImageTexture(0, texture, 0, GL_FALSE, 0, to_texture ? GL_WRITE_ONLY : GL_READ_ONLY, facts.image);
  }
  glDispatchCompute(groups(width, kGroupWidth), groups(extent.height, kGroupHeight), 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void TexelCopy::to_buffer(Kind kind, GLuint texture, Extent extent, GLuint buffer, std::size_t offset,
                          std::size_t pitch, Before before) const {
  run(kind, false, texture, extent, buffer, offset, pitch, before);
}

void TexelCopy::to_texture(Kind kind, GLuint texture, Extent extent, GLuint buffer, std::size_t offset,
                           std::size_t pitch, Before before) const {
  run(kind, true, texture, extent, buffer, offset, pitch, before);
}

}  // namespace quincunx::gl
