// SPDX-License-Identifier: MIT
// Edges against what has no depth: the sky of `backdrop`, nothing at all behind `cutout`.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/architecture.h"
#include "builtin/props.h"
#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {
namespace {

constexpr float kHub = 3.4f;  // height of the wind wheel's hub

void add_colonnade(MeshBuilder& stone, Random& random) {
  for (int i = 0; i < 9; ++i) {
    stone.pen.placement = moved_to({-7.2f + 1.8f * static_cast<float>(i), 0, -4.5f - 0.6f * random.unit()});
    add_column(stone, 0.17f, i % 3 == 2 ? 2.2f : 3.3f);
  }
}

// A mast with stays on both sides.
void add_mast(MeshBuilder& iron, float x) {
  const glm::vec3 foot(x, 0, -3);
  const glm::vec3 top = foot + glm::vec3(0, 5, 0);
  iron.rod(foot, top, 0.035f, 8);
  for (const float reach : {-2.4f, -1.5f, 1.5f, 2.4f}) {
    iron.rod(foot + glm::vec3(reach, 0, 0), glm::mix(foot, top, std::abs(reach) / 2.5f), 0.007f, 5);
  }
}

void add_wind_wheel(SceneAssembly& assembly, int iron) {
  constexpr int kBlades = 12;
  MeshBuilder wheel(iron);
  wheel.ring({0, 0, 0}, {0, 0, 1}, 0.95f, 0.012f, 64, 6);
  for (int i = 0; i < kBlades; ++i) {
    const float turn = glm::two_pi<float>() * static_cast<float>(i) / kBlades;
    wheel.pen.placement = turned(turn, {0, 0, 1});
    wheel.box({0.15f, -0.05f, -0.006f}, {0.90f, 0.05f, 0.006f});
  }
  assembly.move(assembly.add(wheel.take()), spinning(moved_to({1.1f, kHub, -1.9f}), {0, 0, 1}, kDuration, 2));
}

}  // namespace

Scene make_backdrop(std::uint64_t seed) {
  SceneAssembly assembly;
  Random random(seed, 79);
  add_colonnade(assembly.still(assembly.add_surface("limestone", stone_surface(256, seed),
                                                    SceneAssembly::Detail::kColour)),
                random);
  const int iron = assembly.add(plain_material("iron", glm::vec3(0.05f, 0.055f, 0.06f), 0.5f));
  MeshBuilder& still_iron = assembly.still(iron);
  add_mast(still_iron, -1.9f);
  still_iron.rod({1.1f, 0, -2.0f}, {1.1f, kHub, -2.0f}, 0.03f, 8);
  add_wind_wheel(assembly, iron);
  MeshBuilder& meadow = assembly.still(
      assembly.add_surface("meadow", grass_surface(512, seed + 1), SceneAssembly::Detail::kColour));
  meadow.pen.uv_per_metre = 1 / 3.0f;
  meadow.patch({-120, 0, 12}, {240, 0, 0}, {0, 0, -200});

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.direction = glm::normalize(glm::vec3(-0.10f, -0.30f, 0.95f));
  scene.sun.irradiance = {3.0f, 2.2f, 1.4f};
  scene.sky.zenith = {0.05f, 0.11f, 0.34f};
  scene.sky.horizon = {0.95f, 0.62f, 0.36f};
  scene.sky.sun_radiance = {140, 100, 60};
  scene.sky.sun_radius = 0.03f;
  scene.sky.has_velocity = false;
  scene.duration = kDuration;
  scene.camera_moves = true;
  scene.camera = [](double seconds) {
    const float angle = phase_at(seconds, kDuration);
    Camera camera;
    camera.vertical_fov = 0.8f;
    camera.world_from_camera = moved_to({0.3f * std::sin(angle), 1.6f, 3.2f}) *
                               turned(0.30f * std::sin(angle), {0, 1, 0}) *
                               turned(0.22f + 0.05f * std::sin(2 * angle), {1, 0, 0});
    return camera;
  };
  return assembly.finish();
}

namespace {

constexpr int kSpokes = 16;

void add_wheel(SceneAssembly& assembly, glm::vec3 centre) {
  MeshBuilder wheel(assembly.add(plain_material("steel", glm::vec3(0.34f, 0.35f, 0.37f), 0.35f, 0.3f)));
  wheel.ring({0, 0, 0}, {0, 0, 1}, 1.0f, 0.05f, 72, 10);
  for (int i = 0; i < kSpokes; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / kSpokes;
    wheel.rod({0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, 0.008f, 6);
  }
  assembly.move(assembly.add(wheel.take()), spinning(moved_to(centre), {0, 0, -1}, kDuration, 3));
}

// A poster on a board that hangs by its upper edge.
void add_sign(SceneAssembly& assembly, glm::vec3 hinge, std::uint64_t seed) {
  const Motion swing = swinging(moved_to(hinge), {0, 0, 1}, 0.30f, kDuration, 2, 0);
  MeshBuilder board(assembly.add(plain_material("board", glm::vec3(0.20f, 0.13f, 0.08f), 0.8f)));
  board.box({-0.62f, -1.65f, -0.03f}, {0.62f, 0, 0});
  board.rod({0, 0, 0}, {0, 1.5f, 0}, 0.008f, 6);
  assembly.move(assembly.add(board.take()), swing);
  MeshBuilder sheet(add_picture_material(assembly, "sheet", poster_texture(quincunx_poster(seed))));
  sheet.picture({-0.58f, -1.6f, 0.004f}, {1.16f, 0, 0}, {0, 1.55f, 0});
  assembly.move(assembly.add(sheet.take()), swing);
}

}  // namespace

Scene make_cutout(std::uint64_t seed) {
  SceneAssembly assembly;
  add_wheel(assembly, {-1.15f, 1.75f, 0});
  add_sign(assembly, {1.25f, 2.75f, 0.1f}, seed);
  MeshBuilder& cord =
      assembly.still(assembly.add(plain_material("cord", glm::vec3(0.75f, 0.70f, 0.6f), 0.8f)));
  MeshBuilder& ball =
      assembly.still(assembly.add(plain_material("blue enamel", glm::vec3(0.05f, 0.16f, 0.42f), 0.3f)));
  for (int i = 0; i < 9; ++i) {
    const float x = -3.0f + 0.75f * static_cast<float>(i);
    const float low = 0.5f + 0.25f * static_cast<float>(i * 7 % 5);
    cord.rod({x, low, -0.8f}, {x, 4.2f, -0.8f}, 0.003f + 0.0012f * static_cast<float>(i), 6);
    ball.sphere({x, low, -0.8f}, 0.12f, 20);
  }

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sky.background = Background::kNone;
  swing_camera(scene, kDuration, 0.7f, [](float swing) {
    return moved_to({0.9f * swing, 1.75f, 4.6f}) * turned(0.10f * swing, {0, 1, 0});
  });
  return assembly.finish();
}

}  // namespace quincunx::scenes
