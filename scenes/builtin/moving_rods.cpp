// SPDX-License-Identifier: MIT
// Rods that cross each other while they move: `crossings` at a steady speed, `jolts` at a speed that jumps.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {
namespace {

constexpr float kHalf = 6;  // metres: rods end outside the picture, wherever they slide

// Parallel rods in the plane z = 0 about the origin, of two thicknesses by turns.
int make_rack(SceneAssembly& assembly, int material, float angle, float spacing, float radius) {
  MeshBuilder rack(material);
  const glm::vec3 along(std::cos(angle), std::sin(angle), 0);
  const glm::vec3 across(-along.y, along.x, 0);
  const int count = static_cast<int>(kHalf / spacing);
  for (int i = -count; i <= count; ++i) {
    const glm::vec3 middle = across * (static_cast<float>(i) * spacing);
    rack.rod(middle - kHalf * along, middle + kHalf * along, i % 2 == 0 ? radius : 0.6f * radius, 5);
  }
  return assembly.add(rack.take());
}

// Needles through one axle, one behind the other.
int make_needles(SceneAssembly& assembly, int material, int count) {
  MeshBuilder needles(material);
  for (int i = 0; i < count; ++i) {
    const float angle = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(count);
    const glm::vec3 out(std::cos(angle), std::sin(angle), 0);
    const glm::vec3 behind(0, 0, -0.02f * static_cast<float>(i));
    needles.rod(behind - 0.95f * out, behind + 0.95f * out, 0.006f, 6);
  }
  return assembly.add(needles.take());
}

}  // namespace

Scene make_crossings(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 14, 4.6f, -2.2f, seed);
  add_paving(assembly, 14, 6, 9, seed + 2);
  const int dark = assembly.add(plain_material("dark cord", glm::vec3(0.03f), 0.7f));
  const int pale = assembly.add(plain_material("pale cord", glm::vec3(0.80f, 0.78f, 0.72f), 0.7f));
  const int red = assembly.add(plain_material("red enamel", glm::vec3(0.60f, 0.06f, 0.04f), 0.3f));
  constexpr float kUpright = glm::half_pi<float>();
  const auto slide = [&](int mesh, float z, glm::vec3 way, int cycles) {
    assembly.move(mesh, sliding(moved_to({0, 1.8f, z}), way, kDuration, cycles, 0));
  };
  slide(make_rack(assembly, dark, kUpright, 0.31f, 0.0075f), 0.0f, {0.95f, 0, 0}, 2);
  slide(make_rack(assembly, pale, 0.30f, 0.37f, 0.0075f), -0.3f, {0, 0.55f, 0}, 3);
  slide(make_rack(assembly, red, -0.75f, 0.83f, 0.0060f), -0.6f, {-0.80f, 0, 0}, 1);
  const int needles = make_needles(assembly, dark, 5);
  assembly.move(needles, spinning(moved_to({-0.9f, 2.0f, -1.0f}), {0, 0, 1}, kDuration, 2));
  assembly.move(needles, spinning(moved_to({1.3f, 1.5f, 0.3f}), {0, 0, 1}, kDuration, -5));

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.casts_shadows = false;  // they would move over what must come to rest
  hold_camera(scene, kDuration, 0.7f, {0.2f, 1.8f, 4.6f}, {0, 1.75f, 0});
  return assembly.finish();
}

namespace {

// From -1 to 1 and back at one speed, from one frame to the next. It moves for `moving` of the time, and rests at both
// ends alike. The counts are frames of 1/60 s; a period must fit into the scene's duration a whole number of times.
struct Shuttle {
  int period = 0;
  float moving = 1;
  int start = 0;

  float at(double seconds) const {
    const double cycles = (seconds * 60 - start) / period;
    const double half = 2 * (cycles - std::floor(cycles));
    const double way = std::min((half - std::floor(half)) / static_cast<double>(moving), 1.0);
    return static_cast<float>(half < 1 ? 2 * way - 1 : 1 - 2 * way);
  }
};

// As the hand of a clock: `ticks` in a turn, each in a quarter of its time.
float ticking(double seconds, int ticks) {
  const double tick = seconds / kDuration * ticks;
  const double angle = std::floor(tick) + std::min(4 * (tick - std::floor(tick)), 1.0);
  return glm::two_pi<float>() * static_cast<float>(std::fmod(angle / ticks, 1.0));
}

int make_hand(SceneAssembly& assembly, int material) {
  MeshBuilder hand(material);
  for (int i = 0; i < 3; ++i) {
    const float angle = glm::pi<float>() * static_cast<float>(i) / 3;
    const glm::vec3 out(std::cos(angle), std::sin(angle), 0);
    hand.rod(-0.8f * out, 0.8f * out, 0.007f, 6);
  }
  return assembly.add(hand.take());
}

}  // namespace

Scene make_jolts(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 14, 4.6f, -2.2f, seed);
  add_paving(assembly, 14, 6, 9, seed + 2);
  const int dark = assembly.add(plain_material("dark rod", glm::vec3(0.03f), 0.7f));
  const int pale = assembly.add(plain_material("pale rod", glm::vec3(0.80f, 0.78f, 0.72f), 0.7f));
  const int red = assembly.add(plain_material("red enamel", glm::vec3(0.60f, 0.06f, 0.04f), 0.3f));
  const auto move = [&](int mesh, glm::vec3 place, glm::vec3 way, Shuttle shuttle) {
    assembly.move(mesh, [=](double seconds) { return moved_to(place + way * shuttle.at(seconds)); });
  };
  move(make_rack(assembly, dark, glm::half_pi<float>(), 0.53f, 0.0085f), {0, 1.8f, 0.2f}, {0.14f, 0, 0},
       {48, 0.5f, 4});
  move(make_rack(assembly, pale, 0.22f, 0.71f, 0.0085f), {0, 1.8f, -0.6f}, {0, 0.13f, 0}, {24, 1, 10});
  const int hand = make_hand(assembly, red);
  for (const float x : {-1.1f, 1.2f})
    assembly.move(hand, [=](double seconds) {
      return moved_to({x, 1.8f, 0.6f}) * turned(ticking(seconds, x < 0 ? 20 : -10), {0, 0, 1});
    });

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.casts_shadows = false;  // they would move over what stands still
  scene.duration = kDuration;
  scene.camera_moves = true;
  scene.camera = [](double seconds) {
    Camera camera;
    camera.vertical_fov = 0.7f;
    camera.world_from_camera = moved_to({0.18f * Shuttle{96, 0.5f, 20}.at(seconds), 1.8f, 4.6f});
    return camera;
  };
  return assembly.finish();
}

}  // namespace quincunx::scenes
