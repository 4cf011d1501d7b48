// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr double kDuration = 8;
constexpr float kTau = glm::two_pi<float>();
constexpr glm::vec3 kEye(0, 1.7f, 5.5f);

// Objects on a circle about the camera: they cross the picture at a steady speed, leave it and come back,
// without ever jumping.
struct Carousel {
  float radius;
  int count;
  int cycles;  // turns in kDuration; two turns are about 35 pixels a frame at 60 Hz and 1280 x 720
};

void add_carousel(SceneAssembly& assembly, int mesh, const Carousel& carousel, float height) {
  for (int i = 0; i < carousel.count; ++i) {
    const float start = kTau * static_cast<float>(i) / static_cast<float>(carousel.count);
    const float radius = carousel.radius;
    const int cycles = carousel.cycles;
    assembly.move(mesh, [=](double seconds) {
      return moved_to(glm::vec3(kEye.x, height, kEye.z)) *
             turned(start + phase_at(seconds, kDuration, cycles), {0, 1, 0}) * moved_to({0, 0, -radius});
    });
  }
}

int make_slat(SceneAssembly& assembly, int wood) {
  MeshBuilder slat(wood);
  slat.pen.uv_per_metre = 0.8f;
  slat.box({-0.11f, -1.9f, -0.02f}, {0.11f, 1.9f, 0.02f});
  return assembly.add(slat.take());
}

int make_hoop(SceneAssembly& assembly, int paint) {
  MeshBuilder hoop(paint);
  hoop.ring({0, 0, 0}, glm::normalize(glm::vec3(0.3f, 0, 1)), 0.42f, 0.03f, 48, 10);
  for (int i = 0; i < 6; ++i) {
    const float angle = kTau * static_cast<float>(i) / 6;
    hoop.rod({0, 0, 0}, {0.42f * std::cos(angle), 0.42f * std::sin(angle), -0.126f * std::cos(angle)}, 0.008f,
             6);
  }
  return assembly.add(hoop.take());
}

int make_ball(SceneAssembly& assembly, int paint) {
  MeshBuilder ball(paint);
  ball.sphere({0, 0, 0}, 0.3f, 32);
  return assembly.add(ball.take());
}

}  // namespace

Scene make_occluders(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 20, 4.4f, -3.0f, seed);
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed + 2)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-12, 0, 12}, {24, 0, 0}, {0, 0, -15});
  const int wood =
      assembly.add_surface("planks", plank_surface(256, seed + 4), SceneAssembly::Detail::kColour);
  const int blue = assembly.add(plain_material("blue enamel", glm::vec3(0.05f, 0.16f, 0.42f), 0.3f));
  const int red = assembly.add(plain_material("red enamel", glm::vec3(0.60f, 0.06f, 0.04f), 0.3f));
  add_carousel(assembly, make_slat(assembly, wood), {3.4f, 11, 2}, 1.9f);
  add_carousel(assembly, make_hoop(assembly, blue), {4.6f, 13, -2}, 2.35f);
  add_carousel(assembly, make_ball(assembly, red), {6.0f, 11, 1}, 0.9f);
  add_carousel(assembly, make_ball(assembly, blue), {2.6f, 5, 3}, 1.15f);

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.duration = kDuration;
  Camera camera;
  camera.vertical_fov = 0.75f;
  camera.world_from_camera = looking_from(kEye, {0, 1.75f, -3});
  scene.camera = [camera](double) { return camera; };
  return assembly.finish();
}

}  // namespace quincunx::scenes
