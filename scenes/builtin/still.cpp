// SPDX-License-Identifier: MIT
// The courtyard, stopped at one moment.
#include "builtin/scenes.h"

namespace quincunx::scenes {

Scene make_still(std::uint64_t seed) {
  Scene scene = make_courtyard(seed);
  for (Instance& instance : scene.instances) {
    if (!instance.motion) continue;
    instance.transform = instance.motion(0);
    instance.motion = {};
  }
  scene.particles = {};
  const Camera camera = scene.camera(0);
  scene.camera = [camera](double) { return camera; };
  scene.camera_moves = false;
  return scene;
}

}  // namespace quincunx::scenes
