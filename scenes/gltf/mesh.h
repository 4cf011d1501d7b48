// SPDX-License-Identifier: MIT
// glTF primitives as meshes of a Scene. Private to the glTF loader.
#pragma once

#include <optional>

#include "gltf/document.h"
#include "gltf/materials.h"
#include "scene.h"

namespace quincunx::scenes {

// Reads triangles, strips and fans, indexed or not. Without NORMAL the triangles get flat normals of their
// own, as glTF demands. Nothing for points and lines, with a warning. Throws GltfError.
std::optional<Mesh> read_primitive(GltfDocument& document, int mesh, int primitive,
                                   const GltfMaterials& materials);

}  // namespace quincunx::scenes
