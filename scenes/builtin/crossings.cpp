// SPDX-License-Identifier: MIT
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr float kHalf = 6;  // metres: strings end outside the picture, wherever they slide

// Parallel strings in the plane z = 0 about the origin, of two thicknesses by turns.
int make_harp(SceneAssembly& assembly, int material, float angle, float spacing, float radius) {
  MeshBuilder harp(material);
  const glm::vec3 along(std::cos(angle), std::sin(angle), 0);
  const glm::vec3 across(-along.y, along.x, 0);
  const int count = static_cast<int>(kHalf / spacing);
  for (int i = -count; i <= count; ++i) {
    const glm::vec3 middle = across * (static_cast<float>(i) * spacing);
    harp.rod(middle - kHalf * along, middle + kHalf * along, i % 2 == 0 ? radius : 0.6f * radius, 5);
  }
  return assembly.add(harp.take());
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
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-7, 0, 6}, {14, 0, 0}, {0, 0, -9});
  const int dark = assembly.add(plain_material("dark cord", glm::vec3(0.03f), 0.7f));
  const int pale = assembly.add(plain_material("pale cord", glm::vec3(0.80f, 0.78f, 0.72f), 0.7f));
  const int red = assembly.add(plain_material("red enamel", glm::vec3(0.60f, 0.06f, 0.04f), 0.3f));
  constexpr float kUpright = glm::half_pi<float>();
  const auto slide = [&](int mesh, float z, glm::vec3 way, int cycles) {
    assembly.move(mesh, sliding(moved_to({0, 1.8f, z}), way, kDuration, cycles, 0));
  };
  slide(make_harp(assembly, dark, kUpright, 0.31f, 0.0075f), 0.0f, {0.95f, 0, 0}, 2);
  slide(make_harp(assembly, pale, 0.30f, 0.37f, 0.0075f), -0.3f, {0, 0.55f, 0}, 3);
  slide(make_harp(assembly, red, -0.75f, 0.83f, 0.0060f), -0.6f, {-0.80f, 0, 0}, 1);
  const int needles = make_needles(assembly, dark, 5);
  assembly.move(needles, spinning(moved_to({-0.9f, 2.0f, -1.0f}), {0, 0, 1}, kDuration, 2));
  assembly.move(needles, spinning(moved_to({1.3f, 1.5f, 0.3f}), {0, 0, 1}, kDuration, -5));

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.casts_shadows = false;  // they would move over what must come to rest
  scene.duration = kDuration;
  Camera camera;
  camera.vertical_fov = 0.7f;
  camera.world_from_camera = looking_from({0.2f, 1.8f, 4.6f}, {0, 1.75f, 0});
  scene.camera = [camera](double) { return camera; };
  return assembly.finish();
}

}  // namespace quincunx::scenes
