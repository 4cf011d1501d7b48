// SPDX-License-Identifier: MIT
#include <array>
#include <limits>

#include "builtin/props.h"
#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
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
    assembly.move(assembly.add(sign.take()),
                  swinging(moved_to(hinge), {0, 0, 1}, 0.25f, kDuration, 2 + i, static_cast<float>(i)));
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
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-7, 0, 6}, {14, 0, 0}, {0, 0, -9});
  add_signs(assembly, seed + 5);

  Scene& scene = assembly.scene;
  Random random(seed, 83);
  add_faults(scene, random);
  set_daylight(scene);
  scene.duration = kDuration;
  Camera camera;
  camera.vertical_fov = 0.7f;
  camera.world_from_camera = looking_from({0.2f, 1.7f, 4.6f}, {0, 1.7f, 0});
  scene.camera = [camera](double) { return camera; };
  return assembly.finish();
}

}  // namespace quincunx::scenes
