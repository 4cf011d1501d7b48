// SPDX-License-Identifier: MIT
#include <array>

#include "builtin/props.h"
#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr float kReach = 16;  // half the span of a cable: both ends lie outside the picture

// Some hang still, some sway about the line between their ends.
void add_cables(SceneAssembly& assembly, int copper) {
  struct Cable {
    float height;
    float slope;  // of the line between the ends
    float z;
    float sag;
    float radius;
    int cycles;  // of its sway in kDuration; 0: it hangs still
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

}  // namespace quincunx::scenes
