// SPDX-License-Identifier: MIT
#include <cmath>

#include "builtin/architecture.h"
#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr int kCycles = 2;       // there and back, in kDuration
constexpr float kMiddle = 4.2f;  // metres from the wall's plane
constexpr float kSwing = 3.0f;   // as far to and fro: from 7.2 m to 1.2 m
constexpr float kWall = -3;

}  // namespace

Scene make_zoom(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 20, 5.2f, kWall, seed);
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-12, 0, 8}, {24, 0, 0}, {0, 0, -11});
  MeshBuilder& columns = assembly.still(
      assembly.add_surface("limestone", stone_surface(256, seed + 3), SceneAssembly::Detail::kColour));
  for (int i = 0; i < 4; ++i) {
    for (const float x : {-1.9f, 1.9f}) {
      columns.pen.placement = moved_to({x, 0, kWall + 0.7f + 1.5f * static_cast<float>(i)});
      add_column(columns, 0.16f, 3.4f);
    }
  }
  columns.pen.placement = glm::mat4(1);
  MeshBuilder& iron =
      assembly.still(assembly.add(plain_material("iron", glm::vec3(0.05f, 0.055f, 0.06f), 0.5f)));
  iron.pen.placement = moved_to({-1.9f, 0, kWall + 0.7f});
  add_railing(iron, {3.8f, 1.0f, 0.12f, 0.008f});

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.duration = kDuration;
  scene.camera_moves = true;
  // At second 0 it passes the middle inwards, at its fastest: what lies there grows by 2 % a frame at 60 Hz.
  scene.camera = [](double seconds) {
    const float distance = kMiddle - kSwing * std::sin(phase_at(seconds, kDuration, kCycles));
    Camera camera;
    camera.vertical_fov = 0.8f;
    camera.world_from_camera = moved_to({0.08f, 1.75f, kWall + distance});
    return camera;
  };
  return assembly.finish();
}

}  // namespace quincunx::scenes
