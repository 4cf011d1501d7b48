// SPDX-License-Identifier: MIT
// Cameras that move before much detail, and before lines thinner than a pixel: `pan`, `zoom`, `cut`, `wires`, `cables`
// and `fence`.
#include <array>
#include <cmath>

#include "builtin/architecture.h"
#include "builtin/scene_assembly.h"
#include "builtin/scenes.h"
#include "random.h"

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
  // At second 0 it passes the middle inwards, at its fastest: what lies there grows by 2 % a frame at 60 Hz.
  move_camera(scene, kDuration, 0.8f, [](double seconds) {
    const float distance = kMiddle - kSwing * std::sin(phase_at(seconds, kDuration, kCycles));
    return moved_to({0.08f, 1.75f, kPosterWall + distance});
  });
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

namespace {

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
  move_camera(scene, kDuration, 0.85f, [](double seconds) {
    const float angle = phase_at(seconds, kDuration);
    return looking_from({0.35f * std::sin(angle), 1.7f + 0.12f * std::cos(angle), 5.2f},
                        {0.1f * std::sin(angle), 2.35f, -6.0f});
  });
  return assembly.finish();
}

namespace {

constexpr float kReach = 16;  // half the span of a cable: both ends lie outside the picture

// Some hang still, some sway about the line between their ends.
void add_cables(SceneAssembly& assembly, int copper) {
  struct Cable {
    float height;
    float slope;  // slope of the line between the ends
    float z;
    float sag;
    float radius;
    int cycles;  // cycles of its sway in kDuration; 0: it hangs still
  };
  constexpr std::array kCables = std::to_array<Cable>({{4.1f, 0.16f, -5.5f, 0.9f, 0.0030f, 5},
                                                       {4.7f, -0.11f, -6.5f, 1.0f, 0.0045f, 0},
                                                       {5.6f, 0.24f, -7.5f, 1.3f, 0.0065f, 3},
                                                       {5.9f, -0.27f, -9.0f, 1.0f, 0.0090f, 0},
                                                       {7.4f, 0.07f, -10.0f, 1.5f, 0.0060f, -4},
                                                       {7.7f, 0.33f, -12.0f, 1.2f, 0.0130f, 0},
                                                       {9.6f, -0.20f, -14.0f, 1.8f, 0.0090f, 2},
                                                       {9.9f, 0.03f, -16.0f, 1.3f, 0.0180f, 0}});
  for (const Cable& cable : kCables) {
    const glm::vec3 end(kReach, cable.slope * kReach, 0);
    const auto path = hanging_wire(-end, end, cable.sag, 48);
    const glm::mat4 rest = moved_to({0, cable.height, cable.z});
    MeshBuilder wire(copper);
    wire.tube(path, cable.radius, 5);
    const int mesh = assembly.add(wire.take());
    if (cable.cycles == 0) {
      assembly.place(mesh, rest);
    } else {
      assembly.move(mesh, swinging(rest, {1, 0, 0}, 0.22f, kDuration, cable.cycles, cable.height));
    }
  }
}

// Upright whips and slanting stays, so that the camera's way crosses something thin as well.
void add_stays(MeshBuilder& iron, Random& random) {
  for (int i = 0; i < 13; ++i) {
    const float x = -9 + 1.5f * (static_cast<float>(i) + 0.5f * random.signed_unit());
    const float z = random.range(-12, -5);
    const glm::vec3 foot(x, 0, z);
    iron.rod(foot, foot + glm::vec3(random.range(-2.2f, 2.2f), 11, 0), random.range(0.004f, 0.016f), 6);
  }
}

// A row of houses a long way off: it moves as the sky does.
void add_skyline(MeshBuilder& brick, Random& random) {
  brick.pen.uv_per_metre = 1 / 6.0f;
  float x = -90;
  while (x < 90) {
    const float width = random.range(5, 12);
    brick.box({x, 0, -98 + random.unit()}, {x + width, random.range(9, 19), -96});
    x += width;
  }
}

}  // namespace

Scene make_cables(std::uint64_t seed) {
  SceneAssembly assembly;
  Random random(seed, 71);
  add_cables(assembly, assembly.add(plain_material("cable", glm::vec3(0.03f, 0.03f, 0.035f), 0.5f)));
  add_stays(assembly.still(assembly.add(plain_material("iron", glm::vec3(0.10f, 0.11f, 0.12f), 0.55f))),
            random);
  add_skyline(
      assembly.still(assembly.add_surface("brick", brick_surface(256, seed), SceneAssembly::Detail::kColour)),
      random);

  Scene& scene = assembly.scene;
  set_daylight(scene);
  swing_camera(scene, kDuration, 0.75f, [](float swing) {
    return moved_to({2.2f * swing, 1.7f, 0}) * turned(0.12f * swing, {0, 1, 0}) * turned(0.36f, {1, 0, 0});
  });
  return assembly.finish();
}

namespace {

constexpr float kFence = 1.4f;  // z
constexpr float kPanel = 2.4f;  // metres
constexpr float kTop = 2.3f;    // beyond the upper edge of the picture

// Panels of bars, thinner from one to the next, and panels of wire, by turns.
void add_fence(MeshBuilder& iron, MeshBuilder& wire) {
  float bar_radius = 0.012f;
  for (int panel = -3; panel < 3; ++panel) {
    const glm::mat4 at = moved_to({kPanel * static_cast<float>(panel), 0, kFence});
    if (panel % 2 == 0) {
      wire.pen.placement = at;
      add_wire_fence(wire, kPanel, kTop);
    } else {
      iron.pen.placement = at;
      add_railing(iron, {kPanel, kTop, 0.11f, bar_radius});
      bar_radius *= 0.6f;
    }
  }
}

}  // namespace

Scene make_fence(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 26, 4.4f, -4.0f, seed);
  add_paving(assembly, 26, 6, 11, seed + 2);
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
