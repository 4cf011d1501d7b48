// SPDX-License-Identifier: MIT
// glTF materials, textures and their images as those of a Scene. Private to the glTF loader.
#pragma once

#include <cstdint>
#include <vector>

#include "gltf/document.h"
#include "scene.h"

namespace quincunx::scenes {

struct DecodedImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, top row first, alpha 255 where the file has none
};

// Decodes PNG or JPEG, as glTF allows (image.cpp). Throws GltfError that names the image.
DecodedImage decode_image(const GltfDocument& document, int image);

struct GltfMaterials {
  std::vector<Texture> textures;
  std::vector<Material> materials;  // as in the file, then one for primitives that name none
  std::vector<int> uv_sets;         // for each material: which TEXCOORD_n its textures are drawn with

  int default_material() const { return static_cast<int>(materials.size()) - 1; }
};

// Reads all of them. A vertex has one pair of texture coordinates: the set of the base colour serves all slots of a
// material, with a warning where another slot asks for a different one. Throws GltfError.
GltfMaterials read_materials(GltfDocument& document);

}  // namespace quincunx::scenes
