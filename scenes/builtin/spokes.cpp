// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr float kWall = -1.6f;

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
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(wheel.count);
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
  wall.patch({-8, -2, kWall}, {16, 0, 0}, {0, 8, 0});
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
      ink.stroke(path, 0.14f * line.cap_height, kWall + 0.004f);
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
    axle.rod({wheel.centre.x, wheel.centre.y, kWall}, wheel.centre + glm::vec3(0, 0, 0.09f), 0.02f, 12);
  }

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.casts_shadows = false;  // they would move over what must come to rest
  scene.duration = kDuration;
  Camera camera;
  camera.vertical_fov = 0.7f;
  camera.world_from_camera = looking_from({0.3f, 1.75f, 5.0f}, {0.2f, 1.7f, 0});
  scene.camera = [camera](double) { return camera; };
  return assembly.finish();
}

}  // namespace quincunx::scenes
