// SPDX-License-Identifier: MIT
// Reads glTF 2.0 (.gltf, .glb) into a Scene: the one place that knows tinygltf.
//
// Read: meshes (triangles, strips, fans), node hierarchy with TRS or matrices, node animation (step, linear,
// cubic spline), cameras, metallic-roughness materials with textures, KHR_texture_transform,
// KHR_materials_unlit, KHR_materials_emissive_strength, KHR_lights_punctual, alpha modes. Not read: skins and
// morph targets (a skinned mesh stands in its bind pose). tinygltf trusts files, so every index, size and
// offset is checked here first.
#pragma once

#include <string>

#include "quincunx/status.h"
#include "scene.h"

namespace quincunx::scenes {

// A file without camera gets one that orbits its bounds; a file without lights gets a sun and a sky. Errors:
// kIoFailure with one sentence that names the file, the offending object ("accessor 3 of mesh 'Suzanne'"),
// what it holds and what would be right.
Result<Scene> load_gltf(const std::string& path);

}  // namespace quincunx::scenes
