// SPDX-License-Identifier: MIT
// The built-in scenes, and the way from a name or a file to a Scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quincunx/status.h"
#include "scene.h"

namespace quincunx::scenes {

struct SceneEntry {
  std::string name;
  std::string summary;
  std::string reason;
};

std::vector<SceneEntry> list_scenes();  // the first is the default

// `name`: one of list_scenes(), the path of a .gltf or .glb file, or empty for the default scene. `seed`
// varies what is random in a procedural scene; the same seed gives the same scene. Errors: kInvalidArgument
// for an unknown name (the message lists them), kIoFailure for a bad file.
Result<Scene> open_scene(const std::string& name, std::uint64_t seed = 0);

}  // namespace quincunx::scenes
