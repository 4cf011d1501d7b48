// SPDX-License-Identifier: MIT
// Wheels that turn before a wall of text: `wheel` and `spokes`.
#include <array>
#include <cmath>
#include <string_view>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {
namespace {

constexpr float kGapAtSeam = 0.6f;  // cap heights between the last letter and the first

struct WheelMaterials {
  int steel;
  int tyre;
  int band;  // the flat ring that carries the lettering
  int ink;
};

struct Wheel {
  glm::vec3 centre;
  float radius;
  int spokes;
  int cycles;  // turns in kDuration
  const char* lettering;
};

// Lettering bent round the band, feet towards the hub, spread so that it goes round once.
void add_lettering(MeshBuilder& ink, const char* text, float radius, float cap_height) {
  const float around = kTau * (radius + cap_height / 2);
  TextStyle style{cap_height, 0, Align::kLeft};
  const float letters = static_cast<float>(std::string_view(text).size());
  style.tracking = (around - text_width(text, style)) / (letters * cap_height) - kGapAtSeam / letters;
  for (Polyline path : text_strokes(text, {0, 0}, style)) {
    for (glm::vec2& point : path) {
      const float angle = kTau * point.x / around;  // clockwise from the top
      point = (radius + point.y) * glm::vec2(std::sin(angle), std::cos(angle));
    }
    ink.stroke(path, 0.15f * cap_height, 0.031f);
  }
}

void add_wheel(SceneAssembly& assembly, const WheelMaterials& materials, const Wheel& wheel) {
  const float r = wheel.radius;
  const glm::vec3 axle(0, 0, 1);
  MeshBuilder steel(materials.steel);
  steel.ring({0, 0, 0}, axle, 0.93f * r, 0.025f * r, 96, 8);
  steel.ring({0, 0, 0}, axle, 0.60f * r, 0.012f * r, 96, 6);
  steel.rod({0, 0, -0.12f}, {0, 0, 0.12f}, 0.075f * r, 24);
  for (const float z : {-0.1f, 0.1f})
    steel.rod({0, 0, z - 0.012f}, {0, 0, z + 0.012f}, 0.13f * r, 24);
  for (int i = 0; i < wheel.spokes; ++i) {
    // Crossed spokes leave the hub at a tangent, alternately from its two flanges.
    const float angle = kTau * static_cast<float>(i) / static_cast<float>(wheel.spokes);
    const float lead = (i % 4 < 2 ? 0.9f : -0.9f);
    const float z = i % 2 == 0 ? 0.1f : -0.1f;
    const glm::vec3 hub(0.12f * r * std::cos(angle + lead), 0.12f * r * std::sin(angle + lead), z);
    const glm::vec3 rim(0.92f * r * std::cos(angle), 0.92f * r * std::sin(angle), 0);
    steel.rod(hub, rim, 0.0045f * r, 5);
  }
  MeshBuilder tyre(materials.tyre);
  tyre.ring({0, 0, 0}, axle, r, 0.05f * r, 96, 10);
  MeshBuilder band(materials.band);
  for (const float side : {1.0f, -1.0f})
    band.annulus({0, 0, 0.03f * side}, {0, 0, side}, 0.68f * r, 0.86f * r, 96);
  MeshBuilder ink(materials.ink);
  add_lettering(ink, wheel.lettering, 0.715f * r, 0.10f * r);
  for (MeshBuilder* part : {&steel, &tyre, &band, &ink}) {
    assembly.move(assembly.add(part->take()),
                  spinning(moved_to(wheel.centre), -axle, kDuration, wheel.cycles));
  }
}

}  // namespace

Scene make_wheel(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 16, 4.4f, -2.6f, seed);
  add_paving(assembly, 18, 7, 10, seed + 2);
  const WheelMaterials materials{
      assembly.add(plain_material("steel", glm::vec3(0.34f, 0.35f, 0.37f), 0.35f, 0.3f)),
      assembly.add(plain_material("tyre", glm::vec3(0.035f), 0.8f)),
      assembly.add(plain_material("band", glm::vec3(0.78f, 0.62f, 0.22f), 0.6f)),
      assembly.add(plain_material("ink", glm::vec3(0.02f), 0.9f))};
  constexpr std::array kWheels = std::to_array<Wheel>(
      {{{-0.9f, 1.75f, 0}, 1.35f, 36, 2, "QUINCUNX * FIVE OF A DIE * QUINCUNX * 12345 * "},
       {{1.75f, 2.25f, 0.1f}, 0.85f, 28, -5, "ABCDEFGHIJKLMNOPQRSTUVWXYZ 0123456789 "},
       {{1.95f, 0.72f, 0.2f}, 0.6f, 20, 13, "QUINCUNX * QUINCUNX * QUINCUNX * "}});
  MeshBuilder& stand = assembly.still(materials.steel);
  for (const Wheel& wheel : kWheels) {
    add_wheel(assembly, materials, wheel);
    for (const float x : {-0.28f, 0.28f}) {
      stand.rod(wheel.centre + glm::vec3(0, 0, -0.16f), {wheel.centre.x + x, 0, wheel.centre.z - 0.5f},
                0.022f, 8);
    }
    stand.rod(wheel.centre + glm::vec3(0, 0, -0.18f), wheel.centre + glm::vec3(0, 0, 0.13f), 0.03f, 12);
  }

  Scene& scene = assembly.scene;
  set_daylight(scene);
  hold_camera(scene, kDuration, 0.7f, {0.35f, 1.75f, 5.0f}, {0.25f, 1.6f, 0});
  return assembly.finish();
}

namespace {

constexpr float kFarWall = -1.6f;

struct Spokes {
  glm::vec3 centre;
  float radius;
  int count;
  float spoke;  // its radius
  int cycles;   // turns in kDuration
};

void add_spokes(SceneAssembly& assembly, int steel, const Spokes& wheel) {
  const float r = wheel.radius;
  MeshBuilder metal(steel);
  metal.ring({0, 0, 0}, {0, 0, 1}, r, 0.014f, 96, 8);
  metal.rod({0, 0, -0.05f}, {0, 0, 0.05f}, 0.05f * r, 20);
  for (int i = 0; i < wheel.count; ++i) {
    const float angle = kTau * static_cast<float>(i) / static_cast<float>(wheel.count);
    const glm::vec3 out(std::cos(angle), std::sin(angle), 0);
    metal.rod(0.04f * r * out, r * out, wheel.spoke, 6);
  }
  assembly.move(assembly.add(metal.take()),
                spinning(moved_to(wheel.centre), {0, 0, -1}, kDuration, wheel.cycles));
}

// A limewashed wall that is full of words, as geometry, so that they are sharp at every size.
void add_lettered_wall(SceneAssembly& assembly, std::uint64_t seed) {
  MeshBuilder& wall = assembly.still(
      assembly.add_surface("limewash", plaster_surface(512, seed), SceneAssembly::Detail::kColour));
  wall.pen.uv_per_metre = 1 / 4.0f;
  wall.patch({-8, -2, kFarWall}, {16, 0, 0}, {0, 8, 0});
  MeshBuilder& ink = assembly.still(assembly.add(plain_material("ink", glm::vec3(0.03f), 0.9f)));
  struct Line {
    float y;
    float cap_height;
    const char* text;
  };
  constexpr std::array kLines = std::to_array<Line>(
      {{3.30f, 0.34f, "WHAT STANDS BEHIND A WHEEL"},
       {2.83f, 0.22f, "ABCDEFGHIJKLM 0123456789 NOPQRSTUVWXYZ"},
       {2.52f, 0.12f, "It is seen between two spokes, hidden by one, and seen again a moment later."},
       {2.20f, 0.17f, "the quick brown fox jumps over the lazy dog, 1 2 3 4 5"},
       {1.80f, 0.25f, "* QUINCUNX * FIVE OF A DIE *"},
       {1.52f, 0.10f, "abcdefghijklmnopqrstuvwxyz ABCDEFGHIJKLMNOPQRSTUVWXYZ 0123456789 ( + - = / % )"},
       {1.18f, 0.20f, "LETTERS STAND STILL, SPOKES DO NOT"},
       {0.86f, 0.15f, "Whoever trusts the past too much writes spokes upon the wall,"},
       {0.60f, 0.15f, "and whoever trusts it too little cannot read what stands there."},
       {0.15f, 0.28f, "AEIOU BCDFG HJKLM NPQRS TVWXYZ"}});
  for (const Line& line : kLines) {
    const TextStyle style{line.cap_height, 0, Align::kCentre};
    for (const Polyline& path : text_strokes(line.text, {0, line.y}, style))
      ink.stroke(path, 0.14f * line.cap_height, kFarWall + 0.004f);
  }
}

}  // namespace

Scene make_spokes(std::uint64_t seed) {
  SceneAssembly assembly;
  add_lettered_wall(assembly, seed);
  const int steel = assembly.add(plain_material("steel", glm::vec3(0.34f, 0.35f, 0.37f), 0.35f, 0.3f));
  constexpr std::array kWheels = std::to_array<Spokes>({{{-1.05f, 1.85f, 0}, 1.45f, 26, 0.0065f, 3},
                                                        {{1.55f, 2.55f, 0.1f}, 0.95f, 18, 0.0045f, -7},
                                                        {{1.65f, 0.80f, 0.2f}, 0.70f, 14, 0.0090f, 11}});
  MeshBuilder& axle = assembly.still(steel);
  for (const Spokes& wheel : kWheels) {
    add_spokes(assembly, steel, wheel);
    axle.rod({wheel.centre.x, wheel.centre.y, kFarWall}, wheel.centre + glm::vec3(0, 0, 0.09f), 0.02f, 12);
  }

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.casts_shadows = false;  // they would move over what must come to rest
  hold_camera(scene, kDuration, 0.7f, {0.3f, 1.75f, 5.0f}, {0.2f, 1.7f, 0});
  return assembly.finish();
}

}  // namespace quincunx::scenes
