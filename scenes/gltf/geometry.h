// SPDX-License-Identifier: MIT
// The contents of a glTF file's buffers: typed reading of accessors, sparse ones included, and of primitives as meshes
// of a Scene. Private to the glTF loader.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/materials.h"
#include "scene.h"

namespace quincunx::scenes {

// Elements of `components` values each, tightly packed. Integers are normalised to [0, 1] or [-1, 1] where
// the accessor says so, else converted as they are. All values are finite.
struct FloatArray {
  int components = 0;
  std::vector<float> values;

  std::size_t size() const { return values.size() / static_cast<std::size_t>(components); }
};

// Reads an accessor. `use` says what for, in messages: "POSITION of primitive 0 of mesh 1 'Suzanne'". Throws GltfError
// for an accessor that leaves its bufferView, for one whose number of components is not among those allowed, and for
// values that are not finite.
FloatArray read_floats(const GltfDocument& document, int accessor, std::initializer_list<int> components,
                       const std::string& use);

// Reads triangles, strips and fans, indexed or not. Without NORMAL the triangles get flat normals of their
// own, as glTF demands. Nothing for points and lines, with a warning. Throws GltfError.
std::optional<Mesh> read_primitive(GltfDocument& document, int mesh, int primitive,
                                   const GltfMaterials& materials);

}  // namespace quincunx::scenes
