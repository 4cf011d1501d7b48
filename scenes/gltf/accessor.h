// SPDX-License-Identifier: MIT
// Typed reading of glTF accessors, sparse ones included. Private to the glTF loader.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace quincunx::scenes {

// Elements of `components` values each, tightly packed. Integers are normalised to [0, 1] or [-1, 1] where
// the accessor says so, else converted as they are. All values are finite.
struct FloatArray {
  int components = 0;
  std::vector<float> values;

  std::size_t size() const { return values.size() / static_cast<std::size_t>(components); }
};

// `use` says what for, in messages: "POSITION of primitive 0 of mesh 1 'Suzanne'". Throws GltfError for an
// accessor that leaves its bufferView, for one whose number of components is not among those allowed, and for
// values that are not finite.
FloatArray read_floats(const GltfDocument& document, int accessor, std::initializer_list<int> components,
                       const std::string& use);

// Unsigned integers below `limit`: vertex indices. Throws GltfError as above and for a value out of range.
std::vector<std::uint32_t> read_indices(const GltfDocument& document, int accessor, std::size_t limit,
                                        const std::string& use);

}  // namespace quincunx::scenes
