// SPDX-License-Identifier: MIT
#include "caller_texture.h"

#include <fmt/format.h>

#include <array>

#include "quincunx_gl/capabilities.h"

namespace quincunx::gl {
namespace {

// Level 0 of a texture: its size, and for each of its channels the bits and the type. Not the name of its format, for
// those without a size (GL_RGBA) keep theirs.
struct Level {
  Extent extent = {};
  std::array<GLint, 4> bits = {};  // red, green, blue, alpha
  GLint type = GL_NONE;            // of red
  GLint depth_bits = 0;
};

// Binds a texture to one of the targets on the active unit, and puts back what was bound.
class BoundTo {
 public:
  BoundTo(GLenum target, GLenum query, GLuint texture) : target_(target) {
    glGetIntegerv(query, &before_);
    glBindTexture(target_, texture);
  }
  ~BoundTo() { glBindTexture(target_, static_cast<GLuint>(before_)); }
  BoundTo(const BoundTo&) = delete;
  BoundTo& operator=(const BoundTo&) = delete;

 private:
  GLenum target_;
  GLint before_ = 0;
};

// Returns the target that a texture was made for. OpenGL ES has no call for that, and Mesa's refuses in compatibility
// profiles: a wrong target is then an error, which is taken back.
GLenum target_of(GLuint texture) {
  if (capabilities().api == Api::kGl45) {
    GLint target = GL_NONE;
    glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &target);
    if (target != GL_NONE) return static_cast<GLenum>(target);
  }
  while (glGetError() != GL_NO_ERROR) {
  }
  for (const auto& [target, query] : {std::pair{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                                      {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE}}) {
    const BoundTo bound(static_cast<GLenum>(target), static_cast<GLenum>(query), texture);
    if (glGetError() == GL_NO_ERROR) return static_cast<GLenum>(target);
  }
  return GL_NONE;
}

Level level_of(GLuint texture) {
  const BoundTo bound(GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D, texture);
  const auto get = [](GLenum name, GLint* value) { glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, name, value); };
  Level level;
  get(GL_TEXTURE_WIDTH, &level.extent.width);
  get(GL_TEXTURE_HEIGHT, &level.extent.height);
  get(GL_TEXTURE_RED_SIZE, &level.bits[0]);
  get(GL_TEXTURE_GREEN_SIZE, &level.bits[1]);
  get(GL_TEXTURE_BLUE_SIZE, &level.bits[2]);
  get(GL_TEXTURE_ALPHA_SIZE, &level.bits[3]);
  get(GL_TEXTURE_RED_TYPE, &level.type);
  get(GL_TEXTURE_DEPTH_SIZE, &level.depth_bits);
  return level;
}

Level level_for(PixelFormat format) {
  switch (format) {
    case PixelFormat::kR8:
      return {.bits = {8, 0, 0, 0}, .type = GL_UNSIGNED_NORMALIZED};
    case PixelFormat::kR32F:
      return {.bits = {32, 0, 0, 0}, .type = GL_FLOAT};
    case PixelFormat::kRG16F:
      return {.bits = {16, 16, 0, 0}, .type = GL_FLOAT};
    case PixelFormat::kRG32F:
      return {.bits = {32, 32, 0, 0}, .type = GL_FLOAT};
    case PixelFormat::kRGBA8:
      return {.bits = {8, 8, 8, 8}, .type = GL_UNSIGNED_NORMALIZED};
    case PixelFormat::kRGBA16F:
      return {.bits = {16, 16, 16, 16}, .type = GL_FLOAT};
    case PixelFormat::kRGBA32F:
      return {.bits = {32, 32, 32, 32}, .type = GL_FLOAT};
    case PixelFormat::kNone:
      break;
  }
  return {};
}

std::string describe(const Level& level) {
  std::string text;
  for (std::size_t i = 0; i < level.bits.size(); ++i) {
    if (level.bits[i] > 0) text += fmt::format("{}{}", "RGBA"[i], level.bits[i]);
  }
  if (level.depth_bits > 0) return text + fmt::format("{}-bit depth", level.depth_bits);
  if (level.type == GL_FLOAT) return text + "F";
  if (level.type == GL_INT || level.type == GL_UNSIGNED_INT) return text + " of whole numbers";
  return text.empty() ? "nothing yet" : text;
}

// Returns what is wrong with a texture, "" where nothing is. `depth`: a depth format will do as well.
std::string fault_of(const std::string& field, GLuint texture, PixelFormat format, bool depth, Extent least,
                     const char* whose) {
  const std::string wanted = fmt::format("{}{}", name_of(format), depth ? " or a depth format" : "");
  if (texture == 0) return fmt::format("{} is 0 and must be a texture of {}", field, wanted);
  if (glIsTexture(texture) == GL_FALSE)
    return fmt::format("{} is {}, which is no texture of this context", field, texture);
  const GLenum target = target_of(texture);
  if (target == GL_TEXTURE_2D_MULTISAMPLE) {
    return fmt::format("{} is multisampled; blit it into a plain GL_TEXTURE_2D first", field);
  }
  if (target != GL_TEXTURE_2D) return fmt::format("{} is no GL_TEXTURE_2D", field);
  const Level level = level_of(texture);
  const Level right = level_for(format);
  const bool fits = level.depth_bits == 0 && level.bits == right.bits && level.type == right.type;
  if (!fits && !(depth && level.depth_bits > 0))
    return fmt::format("{} holds {} and must hold {}", field, describe(level), wanted);
  if (level.extent.width < least.width || level.extent.height < least.height) {
    return fmt::format("{} has {}x{} texels, fewer than {} {}x{}", field, level.extent.width,
                       level.extent.height, whose, least.width, least.height);
  }
  return {};
}

const char* name_of(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kDepth:
      return "depth";
    case PlaneKind::kVelocity:
      return "velocity";
    case PlaneKind::kReactive:
      return "reactive";
    case PlaneKind::kColour:
      break;
  }
  return "colour";
}

}  // namespace

FrameTextures textures_of(const RenderTargets& targets) {
  return {.colour = targets.colour(),
          .depth = targets.depth(),
          .velocity = targets.velocity(),
          .reactive = targets.reactive()};
}

GLuint texture_of(const FrameTextures& textures, PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kDepth:
      return textures.depth;
    case PlaneKind::kVelocity:
      return textures.velocity;
    case PlaneKind::kReactive:
      return textures.reactive;
    case PlaneKind::kColour:
      break;
  }
  return textures.colour;
}

bool has_depth_format(GLuint texture) {
  return level_of(texture).depth_bits > 0;
}

Status check_textures(const std::vector<Plane>& planes, const FrameTextures& textures, Extent render) {
  std::string faults;
  for (const Plane& plane : planes) {
    const std::string fault = fault_of(name_of(plane.kind), texture_of(textures, plane.kind), plane.format,
                                       plane.kind == PlaneKind::kDepth, render, "the viewport's");
    if (!fault.empty()) faults += (faults.empty() ? "FrameTextures: " : "; ") + fault;
  }
  return faults.empty() ? Status() : Status::invalid(faults);
}

Status check_picture_texture(GLuint texture, PixelFormat format, Extent output) {
  const std::string fault = fault_of("the texture", texture, format, false, output, "the picture's");
  return fault.empty() ? Status() : Status::invalid("present: " + fault);
}

}  // namespace quincunx::gl
