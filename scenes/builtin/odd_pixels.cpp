// SPDX-License-Identifier: MIT
// Pixels that are no surface, or far brighter than their neighbours: the sky of `backdrop`, nothing at all behind
// `cutout`, the glints of `sparkles`, the broken pixels of `faults`.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "builtin/architecture.h"
#include "builtin/scene_assembly.h"
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
  assembly.move(wheel, spinning(moved_to({1.1f, kHub, -1.9f}), {0, 0, 1}, kDuration, 2));
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
  move_camera(scene, kDuration, 0.8f, [](double seconds) {
    const float angle = phase_at(seconds, kDuration);
    return moved_to({0.3f * std::sin(angle), 1.6f, 3.2f}) * turned(0.30f * std::sin(angle), {0, 1, 0}) *
           turned(0.22f + 0.05f * std::sin(2 * angle), {1, 0, 0});
  });
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
  assembly.move(wheel, spinning(moved_to(centre), {0, 0, -1}, kDuration, 3));
}

// A poster on a board that hangs by its upper edge.
void add_sign(SceneAssembly& assembly, glm::vec3 hinge, std::uint64_t seed) {
  const Motion swing = swinging(moved_to(hinge), {0, 0, 1}, 0.30f, kDuration, 2, 0);
  MeshBuilder board(assembly.add(plain_material("board", glm::vec3(0.20f, 0.13f, 0.08f), 0.8f)));
  board.box({-0.62f, -1.65f, -0.03f}, {0.62f, 0, 0});
  board.rod({0, 0, 0}, {0, 1.5f, 0}, 0.008f, 6);
  assembly.move(board, swing);
  MeshBuilder sheet(add_picture_material(assembly, "sheet", poster_texture(quincunx_poster(seed))));
  sheet.picture({-0.58f, -1.6f, 0.004f}, {1.16f, 0, 0}, {0, 1.55f, 0});
  assembly.move(sheet, swing);
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

namespace {

// Square mirrors in rings on a dark ball, no two quite alike: each flashes where it throws a lamp's light at
// the eye.
void add_mirror_ball(SceneAssembly& assembly, glm::vec3 centre, float radius, int cycles, Random& random) {
  constexpr float kTile = 0.05f;
  constexpr float kGap = 0.006f;
  constexpr float kTilt = 0.035f;  // radians
  MeshBuilder mirrors(assembly.add(plain_material("mirror", glm::vec3(0.92f, 0.93f, 0.95f), 0.16f, 1)));
  const int rings = static_cast<int>(glm::pi<float>() * radius / (kTile + kGap));
  for (int ring = 1; ring < rings; ++ring) {
    const float height = glm::pi<float>() * (static_cast<float>(ring) / static_cast<float>(rings) - 0.5f);
    const int tiles = static_cast<int>(kTau * radius * std::cos(height) / (kTile + kGap));
    for (int i = 0; i < tiles; ++i) {
      const float around = kTau * static_cast<float>(i) / static_cast<float>(tiles);
      const glm::vec3 tilt = kTilt * glm::vec3(random.signed_unit(), random.signed_unit(), 0);
      mirrors.pen.placement = turned(around, {0, 1, 0}) * turned(-height, {1, 0, 0}) *
                              moved_to({0, 0, radius}) * turned(tilt.x, {1, 0, 0}) *
                              turned(tilt.y, {0, 1, 0});
      mirrors.patch({-kTile / 2, -kTile / 2, 0}, {kTile, 0, 0}, {0, kTile, 0});
    }
  }
  MeshBuilder core(assembly.add(plain_material("core", glm::vec3(0.02f), 0.8f)));
  core.sphere({0, 0, 0}, 0.985f * radius, 32);
  for (MeshBuilder* part : {&mirrors, &core})
    assembly.move(*part, spinning(moved_to(centre), {0, 1, 0}, kDuration, cycles));
  MeshBuilder& rope = assembly.still(assembly.add(plain_material("rope", glm::vec3(0.05f), 0.9f)));
  rope.rod(centre + glm::vec3(0, radius, 0), centre + glm::vec3(0, 3, 0), 0.012f, 6);
}

// Points of light on strings that swing, a pixel wide at 480 x 270.
void add_garlands(SceneAssembly& assembly, Random& random) {
  constexpr int kStrings = 9;
  constexpr int kBeads = 16;
  const std::array<int, 3> lamps{assembly.add(lamp_material("warm bead", {420, 260, 110})),
                                 assembly.add(lamp_material("white bead", {240, 250, 260})),
                                 assembly.add(lamp_material("dim bead", {30, 22, 46}))};
  const int cord = assembly.add(plain_material("cord", glm::vec3(0.03f), 0.9f));
  for (int string = 0; string < kStrings; ++string) {
    const glm::vec3 top(-2.6f + 0.65f * static_cast<float>(string), 3.3f, -0.9f - 0.5f * random.unit());
    std::array<MeshBuilder, 3> beads{MeshBuilder(lamps[0]), MeshBuilder(lamps[1]), MeshBuilder(lamps[2])};
    for (int i = 0; i < kBeads; ++i) {
      const float drop = 0.25f + 0.14f * static_cast<float>(i) + 0.04f * random.unit();
      const glm::vec3 at(0.03f * random.signed_unit(), -drop, 0.03f * random.signed_unit());
      beads[static_cast<std::size_t>(random.below(3))].sphere(at, 0.008f, 6);
    }
    MeshBuilder line(cord);
    line.rod({0, 0, 0}, {0, -0.25f - 0.14f * kBeads, 0}, 0.002f, 4);
    const Motion swing = swinging(moved_to(top), {0, 0, 1}, 0.10f, kDuration, 3, kTau * random.unit());
    assembly.move(line, swing);
    for (MeshBuilder& part : beads) {
      if (!part.empty()) assembly.move(part, swing);
    }
  }
}

void set_evening(Scene& scene) {
  scene.sun.direction = glm::normalize(glm::vec3(-0.6f, -0.5f, -0.62f));
  scene.sun.irradiance = {0.5f, 0.34f, 0.24f};
  scene.sky.zenith = {0.02f, 0.03f, 0.08f};
  scene.sky.horizon = {0.10f, 0.08f, 0.11f};
  scene.sky.ground = {0.03f, 0.025f, 0.02f};
  scene.exposure = 1;
  for (const glm::vec3 at : {glm::vec3(-3.4f, 2.8f, 2.0f),
                             {3.6f, 3.0f, 1.4f},
                             {0.4f, 0.4f, 2.6f},
                             {-1.6f, 3.9f, 1.2f},
                             {2.2f, 1.2f, 3.2f}}) {
    scene.lights.push_back({at, {4.4f, 3.6f, 2.8f}, 9});
  }
}

}  // namespace

Scene make_sparkles(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 16, 4.6f, -3, seed);
  add_paving(assembly, 18, 7, 10, seed + 2);
  Random random(seed, 61);
  add_mirror_ball(assembly, {-0.7f, 2.0f, 0.2f}, 0.62f, 1, random);
  add_mirror_ball(assembly, {1.55f, 1.35f, 0.6f}, 0.34f, -3, random);
  add_garlands(assembly, random);

  Scene& scene = assembly.scene;
  set_evening(scene);
  swing_camera(scene, kDuration, 0.75f, [](float swing) {
    return looking_from({0.35f * swing, 1.7f, 4.4f}, {0.1f * swing, 1.7f, -2});
  });
  return assembly.finish();
}

namespace {

constexpr double kBetweenFaults = 0.1;  // seconds: at 60 Hz five frames show what has become of one
constexpr double kFirstFault = 0.5 / 60;
constexpr float kSide = 0.03f;  // ten pixels at 640 x 360

void add_signs(SceneAssembly& assembly, std::uint64_t seed) {
  const int sheet = add_picture_material(assembly, "sheet", poster_texture(die_poster(seed)));
  for (int i = 0; i < 3; ++i) {
    MeshBuilder sign(sheet);
    sign.picture({-0.45f, -1.25f, 0}, {0.9f, 0, 0}, {0, 1.2f, 0});
    sign.rod({0, 0, -0.02f}, {0, 1.6f, -0.02f}, 0.01f, 6);
    const glm::vec3 hinge(-2.0f + 2.0f * static_cast<float>(i), 2.9f, -1.0f);
    assembly.move(sign, swinging(moved_to(hinge), {0, 0, 1}, 0.25f, kDuration, 2 + i, static_cast<float>(i)));
  }
}

void add_faults(Scene& scene, Random& random) {
  constexpr std::array kValues{50.0f, -5.0f, std::numeric_limits<float>::infinity()};
  for (double seconds = kFirstFault; seconds < kDuration; seconds += kBetweenFaults) {
    for (const float value : kValues) {
      const float x = random.range(0, 0.95f);
      scene.faults.push_back({seconds, {x, random.range(0, 0.95f)}, kSide, value});
    }
  }
}

}  // namespace

Scene make_faults(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 14, 4.6f, -2.6f, seed);
  add_paving(assembly, 14, 6, 9, seed + 2);
  add_signs(assembly, seed + 5);

  Scene& scene = assembly.scene;
  Random random(seed, 83);
  add_faults(scene, random);
  set_daylight(scene);
  hold_camera(scene, kDuration, 0.7f, {0.2f, 1.7f, 4.6f}, {0, 1.7f, 0});
  return assembly.finish();
}

}  // namespace quincunx::scenes
