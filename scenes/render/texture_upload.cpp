// SPDX-License-Identifier: MIT
#include "render/texture_upload.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>
#include <vector>

#include "quincunx_gl/gl_calls.h"

namespace quincunx::scenes {
namespace {

constexpr float kAnisotropy = 8;
constexpr int kBisections = 12;  // of the alpha scale: 1 / 4096

struct Level {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> texels;  // linear
};

float linear_of(std::uint8_t code, bool srgb) {
  const float c = static_cast<float>(code) / 255;
  if (!srgb) return c;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t code_of(float value, bool srgb) {
  const float c = std::clamp(value, 0.0f, 1.0f);
  const float coded = !srgb ? c : c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(coded * 255));
}

Level first_level(const Texture& texture) {
  Level level{texture.width, texture.height, {}};
  level.texels.reserve(texture.rgba.size() / 4);
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
    const std::uint8_t* t = &texture.rgba[i];
    level.texels.emplace_back(linear_of(t[0], texture.srgb), linear_of(t[1], texture.srgb),
                              linear_of(t[2], texture.srgb), static_cast<float>(t[3]) / 255);
  }
  return level;
}

// 2x2 box (clamped at odd edges), colours weighted by alpha.
Level half_of(const Level& from) {
  Level to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
  to.texels.reserve(static_cast<std::size_t>(to.width) * to.height);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      glm::vec3 colour(0), plain(0);
      float alpha = 0;
      for (int k = 0; k < 4; ++k) {
        const int sx = std::min(2 * x + (k & 1), from.width - 1);
        const int sy = std::min(2 * y + (k >> 1), from.height - 1);
        const glm::vec4& t = from.texels[static_cast<std::size_t>(sy) * from.width + sx];
        colour += glm::vec3(t) * t.a;
        plain += glm::vec3(t);
        alpha += t.a;
      }
      to.texels.emplace_back(alpha > 0 ? colour / alpha : plain * 0.25f, alpha * 0.25f);
    }
  }
  return to;
}

float coverage(const Level& level, float cutoff, float scale) {
  const auto passing = std::count_if(level.texels.begin(), level.texels.end(),
                                     [&](const glm::vec4& t) { return t.a * scale >= cutoff; });
  return static_cast<float>(passing) / static_cast<float>(level.texels.size());
}

// The scale of alpha with which a level covers as much as level 0 does, as nearly as its texels allow.
float alpha_scale(const Level& level, float cutoff, float wanted) {
  float low = 0, high = 8;
  for (int i = 0; i < kBisections; ++i) {
    const float middle = 0.5f * (low + high);
    (coverage(level, cutoff, middle) < wanted ? low : high) = middle;
  }
  const float above = coverage(level, cutoff, high) - wanted;
  return above <= wanted - coverage(level, cutoff, low) ? high : low;
}

void upload_level(GLuint name, int index, const Level& level, float scale, bool srgb) {
  std::vector<std::uint8_t> codes;
  codes.reserve(level.texels.size() * 4);
  for (const glm::vec4& t : level.texels) {
    for (int c = 0; c < 3; ++c)
      codes.push_back(code_of(t[c], srgb));
    codes.push_back(code_of(t.a * scale, false));
  }
  gl::texture_write(name, index, {level.width, level.height}, GL_RGBA, GL_UNSIGNED_BYTE, codes.data());
}

void upload_tested_levels(GLuint name, int levels, const Texture& texture, float cutoff) {
  Level level = first_level(texture);
  const float wanted = coverage(level, cutoff, 1);
  for (int i = 1; i < levels; ++i) {
    level = half_of(level);
    // Nothing or everything passes: no scale is needed, and none would be found.
    const float scale = wanted > 0 && wanted < 1 ? alpha_scale(level, cutoff, wanted) : 1;
    upload_level(name, i, level, scale, texture.srgb);
  }
}

GLint wrap_mode(Wrap wrap) {
  switch (wrap) {
    case Wrap::kClamp:
      return GL_CLAMP_TO_EDGE;
    case Wrap::kMirror:
      return GL_MIRRORED_REPEAT;
    case Wrap::kRepeat:
      break;
  }
  return GL_REPEAT;
}

// Software rasterisers pay for it out of all proportion: twice the time of a whole frame with 4 on llvmpipe.
float affordable_anisotropy() {
  const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool software = renderer.find("llvmpipe") != renderer.npos ||
                        renderer.find("softpipe") != renderer.npos ||
                        renderer.find("SwiftShader") != renderer.npos;
  return software ? 1 : kAnisotropy;
}

void set_sampling(GLuint name, const Texture& texture) {
  const float anisotropy = affordable_anisotropy();
  gl::texture_parameter(name, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap_mode(texture.wrap_u)));
  gl::texture_parameter(name, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap_mode(texture.wrap_v)));
  gl::texture_parameter(name, GL_TEXTURE_MAG_FILTER,
                        static_cast<GLint>(texture.nearest ? GL_NEAREST : GL_LINEAR));
  gl::texture_parameter(name, GL_TEXTURE_MIN_FILTER,
                        static_cast<GLint>(texture.nearest ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR));
  if (texture.nearest || anisotropy <= 1 || !epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
    return;
  float most = 1;
  glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
  gl::texture_parameter(name, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(most, anisotropy));
}

}  // namespace

Result<gl::Texture> upload_texture(const Texture& texture, std::optional<float> cutoff) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (texture.width > largest || texture.height > largest) {
    return Status::invalid(fmt::format("a texture is {} x {}; this driver takes at most {} x {}",
                                       texture.width, texture.height, largest, largest));
  }
  const int levels = std::bit_width(static_cast<unsigned>(std::max(texture.width, texture.height)));
  gl::Texture handle = gl::Texture::create();
  const GLuint name = handle.get();
  const Extent extent = {texture.width, texture.height};
  gl::texture_storage(name, levels, texture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, extent);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl::texture_write(name, 0, extent, GL_RGBA, GL_UNSIGNED_BYTE, texture.rgba.data());
  set_sampling(name, texture);
  if (cutoff) {
    upload_tested_levels(name, levels, texture, *cutoff);
  } else {
    gl::texture_mipmaps(name);
  }
  return handle;
}

}  // namespace quincunx::scenes
