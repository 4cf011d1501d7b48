// SPDX-License-Identifier: MIT
// TexelCopy: texels between textures and a buffer of the device's, by compute shaders. glReadPixels and
// glTextureSubImage2D do the same, but on NVIDIA's H100 they take 45 GB/s of 3 TB/s.
#pragma once

#include <epoxy/gl.h>

#include <map>
#include <optional>

#include "depth_copy.h"
#include "frame_layout.h"
#include "quincunx_gl/handle.h"
#include "state_scope.h"

namespace quincunx::gl {

class TexelCopy {
 public:
  // What a shader copies: texels of so many bytes as they are, or depth of any format as floats.
  enum class Kind { k1, k4, k8, k16, kDepth };

  // Returns the kind of a plane of targets, or of a picture; nothing where pixel transfers do it: in OpenGL ES, and for
  // encoded targets, which no image unit takes.
  static std::optional<Kind> of(const Plane& plane);
  static std::optional<Kind> of_picture(PixelFormat picture);

  // Compiles what copies this kind. Throws InteropError where the driver refuses.
  void prepare(Kind kind, bool to_texture);

  // Copies the top left `extent`. The texture is immutable; `offset` and `pitch` are bytes. Of one-byte texels a row
  // ends with up to three more, and `pitch` is a multiple of 4.
  void to_buffer(Kind kind, GLuint texture, Extent extent, GLuint buffer, std::size_t offset,
                 std::size_t pitch, Before before) const;
  void to_texture(Kind kind, GLuint texture, Extent extent, GLuint buffer, std::size_t offset,
                  std::size_t pitch, Before before) const;

 private:
  void run(Kind kind, bool to_texture, GLuint texture, Extent extent, GLuint buffer, std::size_t offset,
           std::size_t pitch, Before before) const;

  std::map<std::pair<Kind, bool>, Program> programs_;
  Handle<SamplerTraits> sampler_;
};

}  // namespace quincunx::gl
