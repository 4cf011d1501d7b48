// SPDX-License-Identifier: MIT
// Reads glTF 2.0 (.gltf, .glb) into a Scene: the one place that knows tinygltf.
//
// Read: meshes (triangles, strips, fans), node hierarchy with TRS or matrices, node animation (step, linear,
// cubic spline), cameras, metallic-roughness materials with textures, KHR_texture_transform,
// KHR_materials_unlit, KHR_materials_emissive_strength, KHR_lights_punctual, alpha modes. Not read: morph
// targets, and skins but for their first joint, which the mesh follows in its bind pose. tinygltf trusts files, so
// every index, size and offset is checked here first.
#pragma once

#include <string>

#include "quincunx/status.h"
#include "scene.h"

namespace quincunx::scenes {

// A file without camera gets one that orbits its bounds; a file without lights gets a sun and a sky. Errors:
// kIoFailure with one sentence that names the file, the offending object ("accessor 3 of mesh 'Suzanne'"),
// what it holds and what would be right.
Result<Scene> load_gltf(const std::string& path);

constexpr double kOrbitSeconds = 8;

// Circles the bounds on a level path, counter-clockwise seen from above, once in `seconds` (> 0), looking at
// their middle from 18 degrees above; at time 0 it stands 30 degrees to the right of their +z side. The box
// fits into a picture of 4:3 or wider at every moment, and lies behind the near plane. Empty bounds are seen
// as a unit box. A pure function of time.
CameraPath orbit_camera(const Bounds& bounds, double seconds = kOrbitSeconds);

}  // namespace quincunx::scenes
