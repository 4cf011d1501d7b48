// SPDX-License-Identifier: MIT
// A place with much detail, and cameras that move in it: `pan`, `zoom` and `cut`.
#include <array>
#include <cmath>

#include "builtin/architecture.h"
#include "builtin/props.h"
#include "builtin/scene_assembly.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {
namespace {

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
  add_paving(assembly, 44, 8, 17, seed + 2);
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
  swing_camera(scene, kDuration, 0.85f, [](float swing) {
    return moved_to({1.3f * swing, 1.6f, 5.0f}) * turned(-0.16f * swing, {0, 1, 0});
  });
  return assembly.finish();
}

namespace {

// The camera's way in `zoom`.
constexpr int kCycles = 2;       // there and back, in kDuration
constexpr float kMiddle = 4.2f;  // metres from the wall's plane
constexpr float kSwing = 3.0f;   // as far to and fro: from 7.2 m to 1.2 m
constexpr float kPosterWall = -3;

}  // namespace

Scene make_zoom(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 20, 5.2f, kPosterWall, seed);
  add_paving(assembly, 24, 8, 11, seed + 2);
  MeshBuilder& columns = assembly.still(
      assembly.add_surface("limestone", stone_surface(256, seed + 3), SceneAssembly::Detail::kColour));
  for (int i = 0; i < 4; ++i) {
    for (const float x : {-1.9f, 1.9f}) {
      columns.pen.placement = moved_to({x, 0, kPosterWall + 0.7f + 1.5f * static_cast<float>(i)});
      add_column(columns, 0.16f, 3.4f);
    }
  }
  columns.pen.placement = glm::mat4(1);
  MeshBuilder& iron =
      assembly.still(assembly.add(plain_material("iron", glm::vec3(0.05f, 0.055f, 0.06f), 0.5f)));
  iron.pen.placement = moved_to({-1.9f, 0, kPosterWall + 0.7f});
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
    camera.world_from_camera = moved_to({0.08f, 1.75f, kPosterWall + distance});
    return camera;
  };
  return assembly.finish();
}

namespace {

constexpr double kSecondShot = 4;
constexpr int kSwings = 2;  // swings of the camera in kDuration: one in each shot, fastest at its cut

}  // namespace

// Two shots of the place that `pan` shows, each with a moving camera.
Scene make_cut(std::uint64_t seed) {
  Scene scene = make_pan(seed);
  scene.duration = kDuration;
  scene.cuts = {0, kSecondShot};
  scene.camera = [](double seconds) {
    const float swing = std::sin(phase_at(seconds, kDuration, kSwings));
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
