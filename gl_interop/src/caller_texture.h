// SPDX-License-Identifier: MIT
// Textures of the caller's: whether they are what the bridge takes.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "frame_layout.h"
#include "quincunx_gl/bridge.h"
#include "texel_copy.h"

namespace quincunx::gl {

FrameTextures textures_of(const RenderTargets& targets);
GLuint texture_of(const FrameTextures& textures, PlaneKind kind);

// What OpenGL said of a texture.
struct TextureFacts {
  bool exists = false;
  GLenum target = GL_NONE;
  Extent extent = {};              // of level 0, as all below
  std::array<GLint, 4> bits = {};  // red, green, blue, alpha
  GLint type = GL_NONE;            // of red
  GLint depth_bits = 0;            // above 0: it has a depth format
  bool immutable = false;
  std::shared_ptr<const TexelCopy> copy;  // by a shader, once it was asked for
  GLint largest_level = -1;  // GL_TEXTURE_MAX_LEVEL where the texture lacks levels that its filter asks for
};

// Asks OpenGL once about each texture of each plane, and about one that seems wrong once more, so that a steady frame
// asks nothing. forget() where textures have changed.
class CallerTextures {
 public:
  // Checks the textures of these planes against a viewport. Errors: kInvalidArgument; the message names every fault.
  Status check(const std::vector<Plane>& planes, const FrameTextures& textures, Extent render);

  // Checks a texture that gets a picture.
  Status check_picture(GLuint texture, PixelFormat format, Extent output);

  // Returns the facts of a texture that was checked for this plane.
  TextureFacts& facts(PlaneKind kind, GLuint texture) { return known_[{kind, texture}]; }
  TextureFacts& picture_facts(GLuint texture) { return pictures_[texture]; }

  void forget();

 private:
  std::map<std::pair<PlaneKind, GLuint>, TextureFacts> known_;
  std::map<GLuint, TextureFacts> pictures_;
};

}  // namespace quincunx::gl
