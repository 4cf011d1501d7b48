// SPDX-License-Identifier: MIT
// Decodes the images of a glTF file. Private to the glTF loader.
#pragma once

#include <cstdint>
#include <vector>

#include "gltf/document.h"

namespace quincunx::scenes {

struct DecodedImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, top row first, alpha 255 where the file has none
};

// PNG or JPEG, as glTF allows. Throws GltfError that names the image.
DecodedImage decode_image(const GltfDocument& document, int image);

}  // namespace quincunx::scenes
