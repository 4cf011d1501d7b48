// SPDX-License-Identifier: MIT
#include "builtin/architecture.h"
#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr float kFence = 1.4f;   // z
constexpr float kPanel = 2.4f;   // metres
constexpr float kHeight = 2.3f;  // beyond the upper edge of the picture

// Panels of bars, thinner from one to the next, and panels of wire, by turns.
void add_fence(MeshBuilder& iron, MeshBuilder& wire) {
  float bar_radius = 0.012f;
  for (int panel = -3; panel < 3; ++panel) {
    const glm::mat4 at = moved_to({kPanel * static_cast<float>(panel), 0, kFence});
    if (panel % 2 == 0) {
      wire.pen.placement = at;
      add_wire_fence(wire, kPanel, kHeight);
    } else {
      iron.pen.placement = at;
      add_railing(iron, {kPanel, kHeight, 0.11f, bar_radius});
      bar_radius *= 0.6f;
    }
  }
}

}  // namespace

Scene make_fence(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 26, 4.4f, -4.0f, seed);
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-13, 0, 6}, {26, 0, 0}, {0, 0, -11});
  const int iron = assembly.add(plain_material("iron", glm::vec3(0.05f, 0.055f, 0.06f), 0.5f));
  const int galvanised =
      assembly.add(plain_material("galvanised wire", glm::vec3(0.55f, 0.57f, 0.58f), 0.4f));
  add_fence(assembly.still(iron), assembly.still(galvanised));

  Scene& scene = assembly.scene;
  set_daylight(scene);
  swing_camera(scene, kDuration, 0.75f, [](float swing) { return moved_to({1.9f * swing, 1.45f, 4.0f}); });
  return assembly.finish();
}

}  // namespace quincunx::scenes
