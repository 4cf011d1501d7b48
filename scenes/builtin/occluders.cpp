// SPDX-License-Identifier: MIT
// Objects and shadows that pass over what stands still: `occluders`, `shadows` and `runners`.
#include <array>
#include <cmath>

#include "builtin/props.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {
namespace {

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
  add_paving(assembly, 24, 12, 15, seed + 2);
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
  hold_camera(scene, kDuration, 0.75f, kEye, {0, 1.75f, -3});
  return assembly.finish();
}

namespace {

// The casters of the shadows stand above the picture, on the sun's way to these places.
constexpr float kWall = -3.0f;
constexpr glm::vec3 kOnTheLeft(-1.9f, 2.3f, kWall);
constexpr glm::vec3 kOnTheRight(1.7f, 2.3f, kWall);
constexpr glm::vec3 kOnTheFloor(1.2f, 0, -0.6f);
constexpr float kWayOff = 5.5f;  // metres

// Blades in a hoop, turning in a plane across the sun's rays: edges of shadow that sweep the wall.
void add_rotor(SceneAssembly& assembly, int wood, glm::vec3 shadow, glm::vec3 to_sun, int cycles) {
  constexpr int kBlades = 5;
  MeshBuilder rotor(wood);
  rotor.ring({0, 0, 0}, {0, 0, 1}, 1.6f, 0.03f, 64, 6);
  for (int i = 0; i < kBlades; ++i) {
    rotor.pen.placement = turned(kTau * static_cast<float>(i) / kBlades, {0, 0, 1});
    rotor.box({-0.19f, 0.15f, -0.01f}, {0.19f, 1.6f, 0.01f});
  }
  const glm::mat4 rest = moved_to(shadow + kWayOff * to_sun) * looking_from({0, 0, 0}, -to_sun);
  assembly.move(assembly.add(rotor.take()), spinning(rest, {0, 0, 1}, kDuration, cycles));
}

// A trellis that swings: thin shadows, and what they uncover, on the floor.
void add_trellis(SceneAssembly& assembly, int wood, glm::vec3 to_sun) {
  constexpr int kSlats = 9;
  MeshBuilder slats(wood);
  for (int i = 0; i < kSlats; ++i) {
    const float at = 0.24f * (static_cast<float>(i) - (kSlats - 1) / 2.0f);
    slats.box({at - 0.03f, -1.2f, -0.01f}, {at + 0.03f, 1.2f, 0.01f});
    slats.box({-1.2f, at - 0.03f, 0.012f}, {1.2f, at + 0.03f, 0.03f});
  }
  const glm::mat4 rest = moved_to(kOnTheFloor + kWayOff * to_sun) * looking_from({0, 0, 0}, -to_sun);
  assembly.move(assembly.add(slats.take()), swinging(rest, {0, 0, 1}, 0.5f, kDuration, 4, 0));
}

// A highlight stands still while the surface under it turns away.
void add_vases(SceneAssembly& assembly, std::uint64_t seed) {
  constexpr std::array<glm::vec2, 9> kProfile{{{0, 0},
                                               {0.20f, 0},
                                               {0.26f, 0.08f},
                                               {0.38f, 0.38f},
                                               {0.34f, 0.66f},
                                               {0.17f, 0.90f},
                                               {0.15f, 1.02f},
                                               {0.22f, 1.12f},
                                               {0, 1.08f}}};
  Material glaze = plain_material("glaze", glm::vec3(1), 0.22f, 0.35f);
  glaze.base_colour_texture.texture = assembly.add(colour_texture(plank_surface(256, seed + 4)));
  const int material = assembly.add(glaze);
  const int stone =
      assembly.add_surface("plinth", stone_surface(256, seed + 3), SceneAssembly::Detail::kColour);
  constexpr std::array<int, 3> kTurns{2, -4, 7};
  for (int i = 0; i < 3; ++i) {
    const float x = -2.3f + 2.2f * static_cast<float>(i);
    MeshBuilder vase(material);
    vase.pen.uv_per_metre = 2;
    vase.lathe(kProfile, 48);
    assembly.move(assembly.add(vase.take()), spinning(moved_to({x, 0.3f, 0.7f}), {0, 1, 0}, kDuration,
                                                      kTurns[static_cast<std::size_t>(i)]));
    assembly.still(stone).box({x - 0.3f, 0, 0.4f}, {x + 0.3f, 0.3f, 1.0f});
  }
}

}  // namespace

Scene make_shadows(std::uint64_t seed) {
  SceneAssembly assembly;
  set_daylight(assembly.scene);
  const glm::vec3 to_sun = -assembly.scene.sun.direction;
  add_poster_wall(assembly, 16, 4.6f, kWall, seed);
  add_paving(assembly, 18, 7, 10, seed + 2);
  const int wood =
      assembly.add_surface("planks", plank_surface(256, seed + 5), SceneAssembly::Detail::kColour);
  add_rotor(assembly, wood, kOnTheLeft, to_sun, 3);
  add_rotor(assembly, wood, kOnTheRight, to_sun, -2);
  add_trellis(assembly, wood, to_sun);
  add_vases(assembly, seed);

  Scene& scene = assembly.scene;
  hold_camera(scene, kDuration, 0.75f, {0.2f, 1.9f, 5.2f}, {0, 1.65f, -1});
  return assembly.finish();
}

namespace {

constexpr double kStride = kDuration / 12;

// Runs round in a circle on the paving; each leg and arm swings about its joint.
void add_runner(SceneAssembly& assembly, int cloth, float start) {
  const auto at = [=](double seconds) {
    const float step = kTau * static_cast<float>(seconds / kStride) + start;
    return moved_to({0, 0.03f * std::abs(std::sin(step)), 0.4f}) *
           turned(start + phase_at(seconds, kDuration, 1), {0, 1, 0}) * moved_to({0, 0, -2.6f});
  };
  MeshBuilder body(cloth);
  body.pen.uv_per_metre = 2;
  body.rod({0.02f, 0.92f, 0}, {-0.08f, 1.45f, 0}, 0.15f, 16);
  body.sphere({-0.12f, 1.66f, 0}, 0.12f, 24);
  assembly.move(assembly.add(body.take()), at);

  // From its joint down, and from the knee or elbow on to one side.
  const auto limb = [&](float upper, float lower, float bend, float thickness) {
    MeshBuilder mesh(cloth);
    mesh.rod({0, 0, 0}, {0, -upper, 0}, thickness, 12);
    mesh.rod({0, -upper, 0}, {lower * std::sin(bend), -upper - lower * std::cos(bend), 0}, 0.75f * thickness,
             12);
    return assembly.add(mesh.take());
  };
  const int leg = limb(0.45f, 0.45f, 0.5f, 0.075f);
  const int arm = limb(0.28f, 0.26f, -1.3f, 0.05f);
  for (const float side : {-1.0f, 1.0f}) {
    const auto swung = [=](glm::vec3 joint, float most) {
      return [=](double seconds) {
        const float angle = most * side * std::sin(kTau * static_cast<float>(seconds / kStride) + start);
        return at(seconds) * moved_to(joint) * turned(angle, {0, 0, 1});
      };
    };
    assembly.move(leg, swung({0.02f, 0.92f, 0.1f * side}, 0.8f));
    assembly.move(arm, swung({-0.07f, 1.4f, 0.22f * side}, -0.9f));
  }
}

}  // namespace

Scene make_runners(std::uint64_t seed) {
  constexpr int kRunners = 7;
  SceneAssembly assembly;
  add_poster_wall(assembly, 20, 5.2f, kWall, seed);
  add_paving(assembly, 24, 12, 15, seed + 2);
  for (int i = 0; i < kRunners; ++i) {
    const int cloth = assembly.add(plain_material(
        "cloth", i % 2 == 0 ? glm::vec3(0.5f, 0.1f, 0.06f) : glm::vec3(0.08f, 0.2f, 0.4f), 0.8f));
    add_runner(assembly, cloth, kTau * static_cast<float>(i) / kRunners);
  }
  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.sun.direction = glm::normalize(glm::vec3(0.5f, -0.6f, -0.62f));  // shadows reach the wall
  hold_camera(scene, kDuration, 0.75f, {0.2f, 1.9f, 6.2f}, {0, 1.05f, -1});
  return assembly.finish();
}

}  // namespace quincunx::scenes
