// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "builtin/architecture.h"
#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;

// A mast of four legs with crossed stays, its foot at the pen.
void add_mast(MeshBuilder& iron, float height, float foot) {
  constexpr int kStages = 9;
  const auto corner = [&](int stage, int leg) {
    const float t = static_cast<float>(stage) / kStages;
    const float half = glm::mix(foot, 0.16f, t) / 2;
    return glm::vec3((leg == 0 || leg == 3) ? -half : half, t * height, leg < 2 ? -half : half);
  };
  for (int leg = 0; leg < 4; ++leg) {
    iron.rod(corner(0, leg), corner(kStages, leg), 0.03f, 6);
    for (int stage = 0; stage < kStages; ++stage) {
      const int next = (leg + 1) % 4;
      iron.rod(corner(stage, leg), corner(stage + 1, next), 0.011f, 5);
      iron.rod(corner(stage, next), corner(stage + 1, leg), 0.011f, 5);
      iron.rod(corner(stage + 1, leg), corner(stage + 1, next), 0.009f, 5);
    }
  }
  for (const float y : {0.72f, 0.86f, 0.98f}) {
    iron.rod({-1.5f, y * height, 0}, {1.5f, y * height, 0}, 0.03f, 6);
    iron.rod({-1.5f, y * height, 0}, {0, (y + 0.07f) * height, 0}, 0.010f, 5);
    iron.rod({1.5f, y * height, 0}, {0, (y + 0.07f) * height, 0}, 0.010f, 5);
  }
}

void add_power_lines(SceneAssembly& assembly, int iron, int copper, int glass) {
  constexpr std::array<glm::vec3, 4> kMasts{{{-15, 0, -4}, {-4.5f, 0, -13}, {8.0f, 0, -20}, {24, 0, -27}}};
  constexpr float kHeight = 9.5f;
  MeshBuilder& lattice = assembly.still(iron);
  for (const glm::vec3 mast : kMasts) {
    lattice.pen.placement = moved_to(mast) * turned(-0.72f, {0, 1, 0});
    add_mast(lattice, kHeight, 1.3f);
  }
  lattice.pen.placement = glm::mat4(1);
  const glm::mat3 turn(turned(-0.72f, {0, 1, 0}));
  for (std::size_t i = 0; i + 1 < kMasts.size(); ++i) {
    for (const float level : {0.72f, 0.86f, 0.98f}) {
      for (const float side : {-1.45f, 1.45f}) {
        const glm::vec3 hang = turn * glm::vec3(side, 0, 0) + glm::vec3(0, level * kHeight - 0.25f, 0);
        const float sag = 0.7f + 0.2f * level;
        assembly.still(copper).tube(hanging_wire(kMasts[i] + hang, kMasts[i + 1] + hang, sag, 32), 0.006f, 5);
        assembly.still(glass).sphere(kMasts[i] + hang + glm::vec3(0, 0.12f, 0), 0.07f, 10);
      }
    }
  }
}

// Thin whips with a ball on top, each half as thick as the one before: where does each method lose them?
void add_whips(SceneAssembly& assembly, int iron, int red) {
  float radius = 0.016f;
  for (int i = 0; i < 7; ++i) {
    const float x = -2.4f + 0.55f * static_cast<float>(i);
    assembly.still(iron).rod({x, 0, -1.6f}, {x + 0.25f, 2.9f, -1.6f}, radius, 8);
    assembly.still(red).sphere({x + 0.25f, 2.9f, -1.6f}, 0.03f, 10);
    radius *= 0.62f;
  }
}

}  // namespace

Scene make_wires(std::uint64_t seed) {
  SceneAssembly assembly;
  const int iron = assembly.add(plain_material("iron", glm::vec3(0.10f, 0.11f, 0.12f), 0.55f));
  const int galvanised =
      assembly.add(plain_material("galvanised wire", glm::vec3(0.55f, 0.57f, 0.58f), 0.4f));
  const int copper = assembly.add(plain_material("cable", glm::vec3(0.03f, 0.03f, 0.035f), 0.5f));
  const int porcelain = assembly.add(plain_material("porcelain", glm::vec3(0.42f, 0.18f, 0.10f), 0.25f));
  const int red = assembly.add(plain_material("red paint", glm::vec3(0.6f, 0.05f, 0.03f), 0.4f));
  add_poster_wall(assembly, 16, 3.2f, -8, seed);
  const int grass =
      assembly.add_surface("meadow", grass_surface(512, seed + 3), SceneAssembly::Detail::kColour);
  MeshBuilder& ground = assembly.still(grass);
  ground.pen.uv_per_metre = 1 / 3.0f;
  ground.patch({-120, -0.02f, 12}, {240, 0, 0}, {0, 0, -200});
  MeshBuilder& fence = assembly.still(galvanised);
  fence.pen.placement = moved_to({0.9f, 0, 0.4f}) * turned(0.35f, {0, 1, 0});
  add_wire_fence(fence, 4.8f, 1.7f);
  add_power_lines(assembly, iron, copper, porcelain);
  add_whips(assembly, iron, red);

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.duration = kDuration;
  scene.camera_moves = true;
  scene.camera = [](double seconds) {
    const float angle = phase_at(seconds, kDuration);
    Camera camera;
    camera.vertical_fov = 0.85f;
    camera.world_from_camera = looking_from({0.35f * std::sin(angle), 1.7f + 0.12f * std::cos(angle), 5.2f},
                                            {0.1f * std::sin(angle), 2.35f, -6.0f});
    return camera;
  };
  return assembly.finish();
}

}  // namespace quincunx::scenes
