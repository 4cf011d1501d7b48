// SPDX-License-Identifier: MIT
// glTF materials and textures as those of a Scene. Private to the glTF loader.
#pragma once

#include <vector>

#include "gltf/document.h"
#include "scene.h"

namespace quincunx::scenes {

struct GltfMaterials {
  std::vector<Texture> textures;
  std::vector<Material> materials;  // as in the file, then one for primitives that name none
  std::vector<int> uv_sets;         // of each material: which TEXCOORD_n its textures are drawn with

  int default_material() const { return static_cast<int>(materials.size()) - 1; }
};

// A vertex has one pair of texture coordinates: the set of the base colour serves all slots of a material,
// with a warning where another slot asks for a different one. Throws GltfError.
GltfMaterials read_materials(GltfDocument& document);

}  // namespace quincunx::scenes
