// SPDX-License-Identifier: MIT
// Two shots of the place that `pan` shows, each with a moving camera.
#include <cmath>

#include "builtin/scene_assembly.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr double kSecondShot = 4;
constexpr int kCycles = 2;  // of the camera's swing, in kDuration: one in each shot, fastest at its cut

}  // namespace

Scene make_cut(std::uint64_t seed) {
  Scene scene = make_pan(seed);
  scene.duration = kDuration;
  scene.cuts = {0, kSecondShot};
  scene.camera = [](double seconds) {
    const float swing = std::sin(phase_at(seconds, kDuration, kCycles));
    const bool second = seconds - kDuration * std::floor(seconds / kDuration) >= kSecondShot;
    Camera camera;
    camera.vertical_fov = second ? 0.62f : 0.85f;
    camera.world_from_camera = second ? looking_from({5.2f + 0.4f * swing, 1.75f, 1.2f}, {-1.5f, 1.5f, -6.5f})
                                      : looking_from({0.9f * swing, 1.6f, 5.0f}, {0.3f, 1.6f, -4.0f});
    return camera;
  };
  return scene;
}

}  // namespace quincunx::scenes
