// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "scene.h"

namespace quincunx::scenes {

// A GL texture with all mip levels and its sampling state. Where `cutoff` is given, the texture is
// alpha-tested with it: each level then keeps the part of level 0 that passes the test, so that foliage does
// not thin out with distance (Castano, "Computing Alpha Mipmaps", 2010), and colours are averaged by their
// alpha. Errors: kInvalidArgument for a texture larger than the driver takes.
Result<gl::Texture> upload_texture(const Texture& texture, std::optional<float> cutoff);

}  // namespace quincunx::scenes
