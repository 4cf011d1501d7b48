// SPDX-License-Identifier: MIT
#include <array>

#include "builtin/props.h"
#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;

glm::vec3 somewhere(Random& random) {
  const float x = random.signed_unit();
  const float y = random.signed_unit();
  return {x, y, random.signed_unit()};
}

struct Shoot {
  glm::vec3 from;
  glm::vec3 direction;
  float length;
  float radius;
  int generations;  // of shoots that it bears
};

// Bends upwards, and bears three shoots about half as thick.
void add_shoot(MeshBuilder& bark, const Shoot& shoot, Random& random) {
  constexpr std::size_t kPieces = 4;
  std::array<glm::vec3, kPieces + 1> path{};
  std::array<float, kPieces + 1> radii{};
  glm::vec3 direction = shoot.direction;
  path[0] = shoot.from;
  for (std::size_t i = 0; i <= kPieces; ++i) {
    radii[i] = shoot.radius * (1 - 0.45f * static_cast<float>(i) / kPieces);
    if (i == 0) continue;
    direction = glm::normalize(direction + glm::vec3(0, 0.10f, 0) + 0.16f * somewhere(random));
    path[i] = path[i - 1] + direction * (shoot.length / kPieces);
  }
  bark.tube(path, radii, 5);
  for (std::size_t i = kPieces - 2; shoot.generations > 0 && i <= kPieces; ++i) {
    add_shoot(bark,
              {.from = path[i],
               .direction = glm::normalize(direction + 0.75f * somewhere(random)),
               .length = shoot.length * random.range(0.58f, 0.74f),
               .radius = 0.52f * shoot.radius,
               .generations = shoot.generations - 1},
              random);
  }
}

void add_shrubs(MeshBuilder& bark, float z, int count, float radius, Random& random) {
  for (int i = 0; i < count; ++i) {
    const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(count - 1)) * 0.9f;
    add_shoot(bark,
              {.from = {x + 0.2f * random.signed_unit(), 0, z + 0.3f * random.signed_unit()},
               .direction = glm::normalize(glm::vec3(0, 1, 0) + 0.2f * somewhere(random)),
               .length = 0.95f,
               .radius = radius,
               .generations = 4},
              random);
  }
}

}  // namespace

Scene make_twigs(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 20, 4.4f, -4.5f, seed);
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-10, 0, 6}, {20, 0, 0}, {0, 0, -11});
  Random random(seed, 73);
  MeshBuilder& bark =
      assembly.still(assembly.add(plain_material("bark", glm::vec3(0.11f, 0.075f, 0.05f), 0.85f)));
  add_shrubs(bark, 0.2f, 7, 0.020f, random);
  add_shrubs(bark, -2.2f, 8, 0.026f, random);

  Scene& scene = assembly.scene;
  set_daylight(scene);
  swing_camera(scene, kDuration, 0.75f, [](float swing) {
    return moved_to({1.1f * swing, 1.6f, 4.0f}) * turned(-0.10f * swing, {0, 1, 0});
  });
  return assembly.finish();
}

}  // namespace quincunx::scenes
