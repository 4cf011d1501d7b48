// SPDX-License-Identifier: MIT
#include "caller_texture.h"

#include <fmt/format.h>

#include <array>

#include "quincunx_gl/capabilities.h"
#include "state_scope.h"

namespace quincunx::gl {
namespace {

// Returns the target that a texture was made for. OpenGL ES has no call for that, and Mesa's refuses in compatibility
// profiles: a wrong target is then an error.
GLenum target_of(GLuint texture) {
  const ErrorScope callers;
  if (capabilities().api == Api::kGl45) {
    GLint target = GL_NONE;
    glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &target);
    if (target != GL_NONE) return static_cast<GLenum>(target);
  }
  ErrorScope::take();
  for (const auto& [target, query] : {std::pair{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                                      {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE}}) {
    const BindingScope bound(BindingScope::bind_texture, static_cast<GLenum>(target),
                             static_cast<GLenum>(query), texture);
    if (ErrorScope::take() == GL_NO_ERROR) return static_cast<GLenum>(target);
  }
  return GL_NONE;
}

// The channels, not the name of the format: those without a size (GL_RGBA) keep theirs.
TextureFacts facts_of(GLuint texture) {
  TextureFacts facts;
  facts.exists = glIsTexture(texture) != GL_FALSE;
  if (facts.exists) facts.target = target_of(texture);
  if (facts.target != GL_TEXTURE_2D) return facts;
  const BindingScope bound = BindingScope::texture(texture);
  const auto of_level = [](GLenum name, GLint* to) { glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, name, to); };
  of_level(GL_TEXTURE_WIDTH, &facts.extent.width);
  of_level(GL_TEXTURE_HEIGHT, &facts.extent.height);
  of_level(GL_TEXTURE_RED_SIZE, &facts.bits[0]);
  of_level(GL_TEXTURE_GREEN_SIZE, &facts.bits[1]);
  of_level(GL_TEXTURE_BLUE_SIZE, &facts.bits[2]);
  of_level(GL_TEXTURE_ALPHA_SIZE, &facts.bits[3]);
  of_level(GL_TEXTURE_RED_TYPE, &facts.type);
  of_level(GL_TEXTURE_DEPTH_SIZE, &facts.depth_bits);
  GLint immutable = GL_FALSE;
  glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_FORMAT, &immutable);
  facts.immutable = immutable != GL_FALSE;
  if (!facts.immutable) glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, &facts.largest_level);
  return facts;
}

std::string describe(const TextureFacts& level) {
  std::string text;
  for (std::size_t i = 0; i < level.bits.size(); ++i) {
    if (level.bits[i] > 0) text += fmt::format("{}{}", "RGBA"[i], level.bits[i]);
  }
  if (level.depth_bits > 0) return text + fmt::format("{}-bit depth", level.depth_bits);
  if (level.type == GL_FLOAT) return text + "F";
  if (level.type == GL_INT || level.type == GL_UNSIGNED_INT) return text + " of whole numbers";
  return text.empty() ? "nothing yet" : text;
}

// What a texture must be.
struct Wanted {
  PixelFormat format;
  bool or_depth;  // a depth format will do as well
  Extent least;
  const char* whose;
};

// Returns what is wrong with a texture, "" where nothing is.
std::string fault_in(const TextureFacts& facts, const std::string& field, GLuint texture,
                     const Wanted& wanted) {
  if (!facts.exists) return fmt::format("{} is {}, which is no texture of this context", field, texture);
  if (facts.target == GL_TEXTURE_2D_MULTISAMPLE)
    return fmt::format("{} is multisampled; blit it into a plain GL_TEXTURE_2D first", field);
  if (facts.target != GL_TEXTURE_2D) return fmt::format("{} is no GL_TEXTURE_2D", field);
  const FormatNames& right = names_of(wanted.format);
  const bool fits = facts.depth_bits == 0 && facts.bits == right.bits && facts.type == right.type;
  if (!fits && !(wanted.or_depth && facts.depth_bits > 0)) {
    return fmt::format("{} holds {} and must hold {}{}", field, describe(facts), name_of(wanted.format),
                       wanted.or_depth ? " or a depth format" : "");
  }
  if (facts.extent.width < wanted.least.width || facts.extent.height < wanted.least.height) {
    return fmt::format("{} has {}x{} texels, fewer than {} {}x{}", field, facts.extent.width,
                       facts.extent.height, wanted.whose, wanted.least.width, wanted.least.height);
  }
  return {};
}

// The same of facts that may be old.
std::string fault_of(TextureFacts& facts, const std::string& field, GLuint texture, const Wanted& wanted) {
  if (texture == 0) {
    return fmt::format("{} is 0 and must be a texture of {}{}", field, name_of(wanted.format),
                       wanted.or_depth ? " or a depth format" : "");
  }
  if (fault_in(facts, field, texture, wanted).empty()) return {};
  facts = facts_of(texture);
  return fault_in(facts, field, texture, wanted);
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

Status CallerTextures::check(const std::vector<Plane>& planes, const FrameTextures& textures, Extent render) {
  std::string faults;
  for (const Plane& plane : planes) {
    const GLuint texture = texture_of(textures, plane.kind);
    const std::string fault =
        fault_of(known_[{plane.kind, texture}], name_of(plane.kind), texture,
                 {plane.format, plane.kind == PlaneKind::kDepth, render, "the viewport's"});
    if (!fault.empty()) faults += (faults.empty() ? "FrameTextures: " : "; ") + fault;
  }
  return faults.empty() ? Status() : Status::invalid(faults);
}

Status CallerTextures::check_picture(GLuint texture, PixelFormat format, Extent output) {
  const std::string fault =
      fault_of(pictures_[texture], "the texture", texture, {format, false, output, "the picture's"});
  return fault.empty() ? Status() : Status::invalid("present: " + fault);
}

void CallerTextures::forget() {
  known_.clear();
  pictures_.clear();
}

}  // namespace quincunx::gl
