// SPDX-License-Identifier: MIT
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
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
