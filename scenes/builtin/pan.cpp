// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "builtin/architecture.h"
#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;

void add_crates(SceneAssembly& assembly, int wood) {
  MeshBuilder& crates = assembly.still(wood);
  struct Crate {
    glm::vec3 foot;
    float size;
    float turn;
  };
  constexpr std::array kCrates = std::to_array<Crate>({{{-2.6f, 0, -4.4f}, 1.0f, 0.3f},
                                                       {{-2.5f, 1.0f, -4.5f}, 0.7f, 0.7f},
                                                       {{1.5f, 0, -2.2f}, 0.8f, -0.4f},
                                                       {{4.2f, 0, -5.6f}, 1.2f, 0.15f}});
  for (const Crate& crate : kCrates) {
    crates.pen.placement = moved_to(crate.foot) * turned(crate.turn, {0, 1, 0});
    const float half = crate.size / 2;
    crates.box({-half, 0, -half}, {half, crate.size, half});
    for (const float x : {-half, half}) {  // battens
      crates.box({x - 0.04f, 0, half}, {x + 0.04f, crate.size, half + 0.025f});
    }
    for (const float y : {0.0f, crate.size - 0.08f})
      crates.box({-half, y, half}, {half, y + 0.08f, half + 0.03f});
  }
  crates.pen.placement = glm::mat4(1);
}

}  // namespace

Scene make_pan(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 44, 4.6f, -9, seed);
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-22, 0, 8}, {44, 0, 0}, {0, 0, -17});
  MeshBuilder& columns = assembly.still(
      assembly.add_surface("limestone", stone_surface(256, seed + 3), SceneAssembly::Detail::kColour));
  for (int i = 0; i < 8; ++i) {
    columns.pen.placement = moved_to({-10.5f + 3.0f * static_cast<float>(i), 0, -6.2f});
    add_column(columns, 0.2f, 3.2f);
  }
  columns.pen.placement = moved_to({-0.9f, 0, 0.6f});
  add_column(columns, 0.16f, 3.2f);
  columns.pen.placement = glm::mat4(1);
  columns.box({-11.2f, 3.2f, -6.5f}, {11.2f, 3.55f, -5.9f});
  add_crates(assembly,
             assembly.add_surface("planks", plank_surface(256, seed + 4), SceneAssembly::Detail::kColour));
  MeshBuilder& iron =
      assembly.still(assembly.add(plain_material("iron", glm::vec3(0.05f, 0.055f, 0.06f), 0.5f)));
  iron.pen.placement = moved_to({0.6f, 0, -1.0f});
  add_railing(iron, {6.0f, 1.1f, 0.12f, 0.009f});

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.duration = kDuration;
  scene.camera_moves = true;
  scene.camera = [](double seconds) {
    const float angle = phase_at(seconds, kDuration);
    const float swing = std::sin(angle);
    Camera camera;
    camera.vertical_fov = 0.85f;
    camera.world_from_camera = moved_to({1.3f * swing, 1.6f, 5.0f}) * turned(-0.16f * swing, {0, 1, 0});
    return camera;
  };
  return assembly.finish();
}

}  // namespace quincunx::scenes
