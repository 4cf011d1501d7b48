// SPDX-License-Identifier: MIT
// What moves before a camera that stands or nearly does: `wheel`, `occluders`, `shadows` and `particles`.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string_view>

#include "builtin/scene_assembly.h"
#include "builtin/scenes.h"
#include "random.h"

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
    assembly.move(*part, spinning(moved_to(wheel.centre), -axle, kDuration, wheel.cycles));
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
  assembly.move(rotor, spinning(rest, {0, 0, 1}, kDuration, cycles));
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
  assembly.move(slats, swinging(rest, {0, 0, 1}, 0.5f, kDuration, 4, 0));
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
    assembly.move(
        vase, spinning(moved_to({x, 0.3f, 0.7f}), {0, 1, 0}, kDuration, kTurns[static_cast<std::size_t>(i)]));
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

struct Seedling {  // what one particle was given at birth
  glm::vec3 from;
  glm::vec3 velocity;
  float start;  // part of its life gone at second 0
  float radius;
  float tone;
  int lives;  // in kDuration
};

std::vector<Seedling> sow(std::uint64_t seed, std::uint64_t stream, int count, glm::vec3 spread,
                          glm::vec3 rise, int most_lives) {
  Random random(seed, stream);
  std::vector<Seedling> seedlings(static_cast<std::size_t>(count));
  for (Seedling& one : seedlings) {
    one.from = {spread.x * random.signed_unit(), spread.y * random.unit(), spread.z * random.signed_unit()};
    one.velocity = rise * glm::vec3(random.signed_unit(), random.range(0.6f, 1.2f), random.signed_unit());
    one.start = random.unit();
    one.radius = random.range(0.5f, 1.0f);
    one.tone = random.unit();
    one.lives = 1 + random.below(most_lives);
  }
  return seedlings;
}

float age_of(const Seedling& one, double seconds) {
  const double life = seconds / kDuration * one.lives + static_cast<double>(one.start);
  return static_cast<float>(life - std::floor(life));
}

void add_smoke(const std::vector<Seedling>& smoke, double seconds, std::vector<Particle>& particles) {
  for (const Seedling& one : smoke) {
    const float age = age_of(one, seconds);
    const float curl = 0.35f * std::sin(kTau * (age + one.tone));
    const glm::vec3 at =
        glm::vec3(-1.5f, 0.5f, -1.2f) + one.from + one.velocity * age + glm::vec3(curl * age, 0, 0);
    const float alpha = 0.34f * std::sin(glm::pi<float>() * age);
    const glm::vec3 grey = glm::vec3(0.42f, 0.41f, 0.42f) * (0.5f + 0.5f * one.tone);
    particles.push_back({at, 0.10f + 0.45f * age * one.radius, glm::vec4(grey * alpha, alpha)});
  }
}

void add_sparks(const std::vector<Seedling>& sparks, double seconds, std::vector<Particle>& particles) {
  for (const Seedling& one : sparks) {
    const float age = age_of(one, seconds);
    const glm::vec3 at =
        glm::vec3(1.5f, 0.6f, -0.6f) + one.from + one.velocity * age - glm::vec3(0, 2.2f * age * age, 0);
    const float fade = (1 - age) * (1 - age);
    particles.push_back({at, 0.012f + 0.014f * one.radius, glm::vec4(glm::vec3(14, 6, 1.6f) * fade, 0)});
  }
}

int add_glass(SceneAssembly& assembly, const char* name, glm::vec3 tint, float alpha) {
  Material material = plain_material(name, tint, 0.05f);
  material.base_colour.a = alpha;
  material.alpha_mode = AlphaMode::kBlend;
  material.double_sided = true;
  material.reactive = 0.6f;
  return assembly.add(material);
}

}  // namespace

Scene make_particles(std::uint64_t seed) {
  SceneAssembly assembly;
  add_poster_wall(assembly, 18, 4.4f, -3.4f, seed);
  add_paving(assembly, 20, 8, 12, seed + 2);
  MeshBuilder& iron = assembly.still(assembly.add(plain_material("iron", glm::vec3(0.04f), 0.5f)));
  const std::array<glm::vec2, 6> bowl{
      {{0, 0.28f}, {0.22f, 0.30f}, {0.36f, 0.44f}, {0.40f, 0.6f}, {0.37f, 0.6f}, {0.30f, 0.42f}}};
  for (const glm::vec3 foot : {glm::vec3(-1.5f, 0, -1.2f), glm::vec3(1.5f, 0, -0.6f)}) {
    iron.pen.placement = moved_to(foot);
    iron.lathe(bowl, 28);
    for (int leg = 0; leg < 3; ++leg) {
      const float angle = kTau * static_cast<float>(leg) / 3;
      iron.rod({0.15f * std::cos(angle), 0.32f, 0.15f * std::sin(angle)},
               {0.34f * std::cos(angle), 0, 0.34f * std::sin(angle)}, 0.02f, 8);
    }
  }
  const std::array<int, 3> tints{add_glass(assembly, "green glass", {0.25f, 0.55f, 0.40f}, 0.35f),
                                 add_glass(assembly, "amber glass", {0.85f, 0.50f, 0.12f}, 0.40f),
                                 add_glass(assembly, "blue glass", {0.15f, 0.30f, 0.65f}, 0.35f)};
  for (int i = 0; i < 3; ++i) {
    MeshBuilder pane(tints[static_cast<std::size_t>(i)]);
    pane.box({-0.55f, -0.75f, -0.012f}, {0.55f, 0.75f, 0.012f});
    const glm::mat4 rest =
        moved_to({-1.0f + 1.0f * static_cast<float>(i), 1.8f, 0.2f * static_cast<float>(i)});
    assembly.move(pane, spinning(rest, {0, 1, 0}, kDuration, i % 2 == 0 ? 1 : -1));
  }

  Scene& scene = assembly.scene;
  set_daylight(scene);
  scene.lights.push_back({{1.5f, 1.0f, -0.6f}, {9, 4, 1.2f}, 6});
  const auto smoke = sow(seed, 1, 260, {0.15f, 0.1f, 0.15f}, {0.5f, 2.6f, 0.3f}, 2);
  const auto sparks = sow(seed, 2, 700, {0.12f, 0.05f, 0.12f}, {1.3f, 3.2f, 1.0f}, 6);
  scene.particles = [smoke, sparks](double seconds, std::vector<Particle>& particles) {
    particles.clear();
    add_smoke(smoke, seconds, particles);
    add_sparks(sparks, seconds, particles);
  };
  swing_camera(scene, kDuration, 0.8f, [](float swing) {
    return looking_from({0.8f * swing, 1.7f, 4.6f}, {0.15f * swing, 1.6f, -2});
  });
  return assembly.finish();
}

}  // namespace quincunx::scenes
