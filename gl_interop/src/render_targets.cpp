// SPDX-License-Identifier: MIT
#include "quincunx_gl/render_targets.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <exception>
#include <utility>
#include <vector>

#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"
#include "state_scope.h"
#include "texel_copy.h"

namespace quincunx::gl {
namespace {

Texture make_texture(GLenum format, Extent extent) {
  Texture texture = Texture::create();
  texture_storage(texture.get(), 1, format, extent);
  // Read texel by texel: a filter would mix in what lies outside the viewport.
  texture_parameter(texture.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST});
  texture_parameter(texture.get(), GL_TEXTURE_MAG_FILTER, GLint{GL_NEAREST});
  texture_parameter(texture.get(), GL_TEXTURE_WRAP_S, GLint{GL_CLAMP_TO_EDGE});
  texture_parameter(texture.get(), GL_TEXTURE_WRAP_T, GLint{GL_CLAMP_TO_EDGE});
  return texture;
}

Status check_extent(Extent extent) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (extent.width >= 1 && extent.height >= 1 && extent.width <= limit && extent.height <= limit) return {};
  return Status::invalid(fmt::format("the target extent is {}x{}; it must lie within 1x1 and {}x{}",
                                     extent.width, extent.height, limit, limit));
}

// Depth of infinity, and the pattern as stencil.
void write_checkerboard(const Texture& texture, Extent extent) {
  struct Texel {
    float depth;
    std::uint32_t stencil;
  };
  std::vector<Texel> texels;
  texels.reserve(static_cast<std::size_t>(extent.area()));
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x)
      texels.push_back({0, static_cast<std::uint32_t>((x + y) % 2)});
  }
  texture_write(texture.get(), 0, extent, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, texels.data());
}

template <typename T>
std::vector<T> read_plane(const RenderTargets& targets, GLenum attachment, Extent render, GLenum format,
                          GLenum type, int channels) {
  std::vector<T> pixels(static_cast<std::size_t>(render.area()) * channels);
  read_attachment(targets.framebuffer(), attachment, render, format, type, pixels.data());
  return pixels;
}

std::vector<float> read_depth(const RenderTargets& targets, Extent render) {
  std::vector<float> pixels(static_cast<std::size_t>(render.area()));
  if (capabilities().reads_depth) {
    read_attachment(targets.framebuffer(), GL_COLOR_ATTACHMENT0, render, GL_DEPTH_COMPONENT, GL_FLOAT,
                    pixels.data());
  } else {
    DepthReader(targets.extent()).read(targets.depth(), render, pixels.data(), Before::kAsked);
  }
  return pixels;
}

}  // namespace

RenderTargets::RenderTargets(const TargetNeeds& needs)
    : extent_(needs.target_extent), colour_format_(needs.colour), has_checkerboard_(needs.checkerboard) {
  framebuffer_ = Framebuffer::create();
  const bool encoded = colour_format_ == PixelFormat::kRGBA8;
  colour_ = make_texture(encoded ? GL_SRGB8_ALPHA8 : GL_RGBA16F, extent_);
  depth_ = make_texture(has_checkerboard_ ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F, extent_);
  if (has_checkerboard_) {
    const UnpackScope restore;
    write_checkerboard(depth_, extent_);
  }
  if (needs.velocity) velocity_ = make_texture(GL_RG16F, extent_);
  if (needs.reactive) reactive_ = make_texture(GL_R8, extent_);

  const GLuint name = framebuffer_.get();
  attach(name, GL_COLOR_ATTACHMENT0, colour_.get());
  attach(name, has_checkerboard_ ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth_.get());
  if (velocity_) attach(name, GL_COLOR_ATTACHMENT1, velocity_.get());
  if (reactive_) attach(name, GL_COLOR_ATTACHMENT2, reactive_.get());
  const GLenum second = velocity_ ? GL_COLOR_ATTACHMENT1 : GL_NONE;
  const GLenum third = reactive_ ? GL_COLOR_ATTACHMENT2 : GL_NONE;
  draw_buffers(name, {GL_COLOR_ATTACHMENT0, second, third});
}

Result<RenderTargets> RenderTargets::create(const TargetNeeds& needs) try {
  if (Status status = check_extent(needs.target_extent); !status.ok()) return status;
  RenderTargets made(needs);
  const GLenum complete = framebuffer_status(made.framebuffer());
  if (complete == GL_FRAMEBUFFER_COMPLETE) return made;
  return Status::unsupported(
      fmt::format("a {}x{} framebuffer of {}, depth 32F{}{}{} is not complete (0x{:04x})", made.extent_.width,
                  made.extent_.height, name_of(needs.colour), needs.checkerboard ? " with stencil" : "",
                  needs.velocity ? ", RG16F" : "", needs.reactive ? ", R8" : "", complete));
} catch (const std::exception& error) {
  return Status::device(error.what());
}

std::uint64_t RenderTargets::bytes() const {
  const std::size_t depth = (has_checkerboard_ ? 2 : 1) * bytes_per_pixel(PixelFormat::kR32F);
  const std::size_t texel = bytes_per_pixel(colour_format_) + depth +
                            (velocity_ ? bytes_per_pixel(PixelFormat::kRG16F) : 0) +
                            (reactive_ ? bytes_per_pixel(PixelFormat::kR8) : 0);
  return static_cast<std::uint64_t>(extent_.area()) * texel;
}

void RenderTargets::clear(Extent render) const {
  constexpr std::array<GLfloat, 4> kZero = {0, 0, 0, 0};
  const ClearScope scope;
  gl::clear(framebuffer_.get(), GL_DEPTH, 0, kZero.data());
  scope.scissor(render.width, render.height);
  gl::clear(framebuffer_.get(), GL_COLOR, 0, kZero.data());
  if (velocity_) gl::clear(framebuffer_.get(), GL_COLOR, 1, kZero.data());
  if (reactive_) gl::clear(framebuffer_.get(), GL_COLOR, 2, kZero.data());
}

Result<TargetPixels> read_targets(const RenderTargets& targets, Extent render) try {
  const Extent whole = targets.extent();
  if (render.width < 1 || render.height < 1 || render.width > whole.width || render.height > whole.height) {
    return Status::invalid(fmt::format("read_targets: render is {}x{}; it must lie within 1x1 and {}x{}",
                                       render.width, render.height, whole.width, whole.height));
  }
  const PackScope restore;
  TargetPixels pixels;
  pixels.render_extent = render;
  if (targets.colour_format() == PixelFormat::kRGBA8) {
    pixels.codes =
        read_plane<std::uint8_t>(targets, GL_COLOR_ATTACHMENT0, render, GL_RGBA, GL_UNSIGNED_BYTE, 4);
  } else {
    pixels.colour =
        read_plane<std::uint16_t>(targets, GL_COLOR_ATTACHMENT0, render, GL_RGBA, GL_HALF_FLOAT, 4);
  }
  pixels.depth = read_depth(targets, render);
  if (targets.velocity() != 0) {
    pixels.velocity =
        read_plane<std::uint16_t>(targets, GL_COLOR_ATTACHMENT1, render, GL_RG, GL_HALF_FLOAT, 2);
  }
  if (targets.reactive() != 0) {
    pixels.reactive =
        read_plane<std::uint8_t>(targets, GL_COLOR_ATTACHMENT2, render, GL_RED, GL_UNSIGNED_BYTE, 1);
  }
  return pixels;
} catch (const std::exception& error) {
  return Status::unsupported(error.what());
}

}  // namespace quincunx::gl
