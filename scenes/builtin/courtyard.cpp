// SPDX-License-Identifier: MIT
// The courtyard as a whole: `courtyard`, `still` and `flight`.
#include "builtin/courtyard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {
namespace {

CourtyardMaterials add_masonry(SceneAssembly& assembly, std::uint64_t seed) {
  CourtyardMaterials m{};
  using Detail = SceneAssembly::Detail;
  m.brick = assembly.add_surface("brick", brick_surface(512, seed));
  m.ashlar = assembly.add_surface("ashlar", ashlar_surface(512, seed + 1));
  m.plaster = assembly.add_surface("limewash", plaster_surface(512, seed + 2), Detail::kColour);
  m.paving = assembly.add_surface("paving", paving_surface(1024, seed + 3), Detail::kReliefAndRoughness);
  m.planks = assembly.add_surface("planks", plank_surface(256, seed + 4), Detail::kColour);
  m.limestone = assembly.add_surface("limestone", stone_surface(256, seed + 5), Detail::kColour);
  m.tiles = assembly.add(plain_material("roof tiles", {0.46f, 0.19f, 0.11f}, 0.85f));
  m.terracotta = assembly.add(plain_material("terracotta", {0.50f, 0.22f, 0.12f}, 0.8f));
  m.soil = assembly.add(plain_material("soil", {0.06f, 0.045f, 0.03f}, 1));
  return m;
}

void add_metals(SceneAssembly& assembly, CourtyardMaterials& m) {
  m.iron = assembly.add(plain_material("wrought iron", {0.028f, 0.031f, 0.034f}, 0.5f));
  m.gilt = assembly.add(plain_material("gilt", {0.85f, 0.60f, 0.24f}, 0.35f, 0.75f));
  m.bronze = assembly.add(plain_material("bronze", {0.10f, 0.065f, 0.035f}, 0.45f, 0.2f));
  m.shutters = assembly.add(plain_material("shutters", {0.075f, 0.16f, 0.135f}, 0.6f));
  assembly.scene.materials[static_cast<std::size_t>(m.shutters)].double_sided = true;
  m.window = assembly.add(plain_material("window panes", {0.02f, 0.025f, 0.03f}, 0.1f));
  m.lamp = assembly.add(lamp_material("lamp", {34, 18, 6}));
  m.ember = assembly.add(lamp_material("ember", {3.2f, 0.42f, 0.04f}));
}

void add_clear_materials(SceneAssembly& assembly, CourtyardMaterials& m, std::uint64_t seed) {
  Material water = plain_material("water", {0.05f, 0.13f, 0.13f}, 0.1f);
  water.base_colour.a = 0.78f;
  water.alpha_mode = AlphaMode::kBlend;
  water.reactive = 0.5f;
  water.normal_texture.texture = assembly.add(water_normal_texture(512, seed + 6));
  m.water = assembly.add(water);
  Material glass = plain_material("glass", {0.85f, 0.87f, 0.85f}, 0.08f);
  glass.base_colour = {0.05f, 0.055f, 0.05f, 0.22f};
  glass.alpha_mode = AlphaMode::kBlend;
  glass.double_sided = true;
  glass.reactive = 0.4f;
  m.glass = assembly.add(glass);
}

CourtyardMaterials add_materials(SceneAssembly& assembly, std::uint64_t seed) {
  CourtyardMaterials m = add_masonry(assembly, seed);
  add_metals(assembly, m);
  add_clear_materials(assembly, m, seed);
  m.poster_title = add_picture_material(assembly, "notice: quincunx", poster_texture(quincunx_poster(seed)));
  m.poster_figures = add_picture_material(assembly, "notice: figures", poster_texture(figures_poster(seed)));
  m.plants.leaves = assembly.add(leaf_material(assembly.add(leaf_texture(512, seed))));
  m.plants.bark = assembly.add(plain_material("bark", {0.16f, 0.12f, 0.085f}, 0.95f));
  m.plants.fruit = assembly.add(plain_material("orange", {0.85f, 0.28f, 0.02f}, 0.5f));
  return m;
}

// Late afternoon: the sun stands low on the right, behind the camera.
void set_light(Scene& scene) {
  scene.sun.direction = glm::normalize(glm::vec3(-0.70f, -0.47f, -0.53f));
  scene.sun.irradiance = {9.6f, 6.4f, 3.5f};
  scene.sky.zenith = {0.065f, 0.175f, 0.50f};
  scene.sky.horizon = {0.56f, 0.51f, 0.48f};
  scene.sky.ground = {0.24f, 0.165f, 0.10f};
  scene.exposure = 0.8f;
}

// Clouds on a part of a cylinder far out, from the horizon up.
void add_clouds(SceneAssembly& assembly, std::uint64_t seed) {
  constexpr float kRadius = 450;
  constexpr int kPieces = 48;
  Material material = unlit_material("clouds", glm::vec3(0.95f, 0.86f, 0.80f));
  material.alpha_mode = AlphaMode::kBlend;
  material.reactive = 0;  // they stand still
  material.base_colour_texture.texture = assembly.add(cloud_texture(1024, 512, seed));
  MeshBuilder& clouds = assembly.still(assembly.add(material));
  for (std::uint32_t i = 0; i <= kPieces; ++i) {
    const float turn = static_cast<float>(i) / kPieces;
    const float angle = glm::two_pi<float>() * (turn - 0.5f);
    const glm::vec3 out(std::sin(angle), 0, -std::cos(angle));
    clouds.vertex(kRadius * out + glm::vec3(0, 10, 0), -out, {2 * turn, 1});
    const std::uint32_t high = clouds.vertex(kRadius * out + glm::vec3(0, 400, 0), -out, {2 * turn, 0});
    if (i > 0) {
      clouds.triangle(high - 3, high - 1, high);
      clouds.triangle(high - 3, high, high - 2);
    }
  }
}

constexpr float kFieldOfView = 0.95f;

glm::mat4 camera_at(double seconds) {
  const float angle = phase_at(seconds, kCourtyardDuration);
  const glm::vec3 eye(1.5f + 0.75f * std::sin(angle), 1.80f + 0.10f * std::cos(angle),
                      9.4f - 0.45f * std::cos(angle));
  const glm::vec3 target(-0.45f + 0.12f * std::sin(angle), 3.35f, -5.0f);
  return looking_from(eye, target);
}

}  // namespace

Scene make_courtyard(std::uint64_t seed) {
  SceneAssembly assembly;
  const CourtyardMaterials materials = add_materials(assembly, seed);
  add_courtyard_ground(assembly, materials);
  add_courtyard_arcade(assembly, materials);
  add_courtyard_facade(assembly, materials);
  add_courtyard_tower(assembly, materials);
  add_courtyard_garden(assembly, materials, seed);
  add_courtyard_props(assembly, materials);
  add_courtyard_motion(assembly, materials, seed);
  add_clouds(assembly, seed);
  Scene scene = assembly.finish();
  set_light(scene);
  add_courtyard_particles(scene, seed);
  bake_ambient_occlusion(scene, {}, [](const Material& material) {
    return !material.unlit && material.base_colour_texture.texture >= 0;  // masonry; the rest is thin or dark
  });
  move_camera(scene, kCourtyardDuration, kFieldOfView, camera_at);
  return scene;
}

// The courtyard, stopped at one moment.
Scene make_still(std::uint64_t seed) {
  Scene scene = make_courtyard(seed);
  for (Instance& instance : scene.instances) {
    if (!instance.motion) continue;
    instance.transform = instance.motion(0);
    instance.motion = {};
  }
  scene.particles = {};
  const Camera camera = scene.camera(0);
  scene.camera = [camera](double) { return camera; };
  scene.camera_moves = false;
  return scene;
}

namespace {

constexpr double kFlight = 2 * kCourtyardDuration;  // seconds: a whole number of the courtyard's own rounds
// The heavy moment, in parts of the flight: smoke drifts in, hangs before the camera, and is gone.
constexpr float kSmokeFrom = 0.40f;
constexpr float kSmokeTo = 0.70f;
constexpr float kSmokeFade = 0.02f;  // within which it thickens and thins
constexpr int kPuffs = 200;

struct Waypoint {
  glm::vec3 eye;
  glm::vec3 target;
};

// Up to the fountain, over it, back past the lamps, and round; the first follows on the last.
constexpr std::array<Waypoint, 6> kWaypoints{{{{1.5f, 1.8f, 9.4f}, {-0.4f, 3.3f, -5.0f}},
                                              {{0.2f, 2.0f, 6.2f}, {-0.2f, 2.6f, -5.0f}},
                                              {{-0.6f, 3.4f, 3.6f}, {0.4f, 2.2f, -6.0f}},
                                              {{-0.9f, 3.8f, 4.4f}, {0.8f, 3.0f, -6.0f}},
                                              {{-1.6f, 3.2f, 7.0f}, {0.2f, 3.2f, -5.0f}},
                                              {{0.2f, 2.4f, 9.2f}, {-0.3f, 3.3f, -5.0f}}}};

// Catmull and Rom: through all points, without a jump in speed.
glm::vec3 spline(const std::array<glm::vec3, 4>& p, float t) {
  const glm::vec3 a = 2.0f * p[1];
  const glm::vec3 b = p[2] - p[0];
  const glm::vec3 c = 2.0f * p[0] - 5.0f * p[1] + 4.0f * p[2] - p[3];
  const glm::vec3 d = -p[0] + 3.0f * p[1] - 3.0f * p[2] + p[3];
  return 0.5f * (a + t * (b + t * (c + t * d)));
}

float part_of_flight(double seconds) {
  return phase_at(seconds, kFlight) / glm::two_pi<float>();
}

Waypoint place_at(double seconds) {
  const std::size_t count = kWaypoints.size();
  const float along = part_of_flight(seconds) * static_cast<float>(count);
  const auto first = static_cast<std::size_t>(along);
  std::array<glm::vec3, 4> eyes{};
  std::array<glm::vec3, 4> targets{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Waypoint& point = kWaypoints[(first + i + count - 1) % count];
    eyes[i] = point.eye;
    targets[i] = point.target;
  }
  const float t = along - static_cast<float>(first);
  return {spline(eyes, t), spline(targets, t)};
}

struct Puff {
  glm::vec3 offset;  // right, up and ahead of the camera
  glm::vec3 drift;
  float radius, tone;
};

float smoke_at(double seconds) {
  const float part = part_of_flight(seconds);
  const float in = std::clamp((part - kSmokeFrom) / kSmokeFade, 0.0f, 1.0f);
  const float out = std::clamp((kSmokeTo - part) / kSmokeFade, 0.0f, 1.0f);
  return in * out;
}

std::vector<Puff> make_puffs(std::uint64_t seed) {
  Random random(seed, 41);
  std::vector<Puff> puffs;
  for (int i = 0; i < kPuffs; ++i) {
    Puff puff;
    puff.offset = {1.6f * random.signed_unit(), 0.9f * random.signed_unit(), random.range(2.0f, 3.2f)};
    puff.drift = {0.8f * random.signed_unit(), 0.3f * random.signed_unit(), 0.3f * random.signed_unit()};
    puff.radius = random.range(1.1f, 1.9f);
    puff.tone = random.unit();
    puffs.push_back(puff);
  }
  return puffs;
}

void add_smoke(const std::vector<Puff>& puffs, double seconds, std::vector<Particle>& particles) {
  const float thickness = smoke_at(seconds);
  if (thickness <= 0) return;
  const Waypoint place = place_at(seconds);
  const glm::mat4 camera = looking_from(place.eye, place.target);
  const float age = (part_of_flight(seconds) - kSmokeFrom) / (kSmokeTo - kSmokeFrom);
  for (const Puff& puff : puffs) {
    const glm::vec3 at = puff.offset + (2 * age - 1) * puff.drift;
    const float alpha = 0.012f * thickness * (0.5f + puff.tone);
    const glm::vec3 colour =
        glm::mix(glm::vec3(0.55f, 0.47f, 0.42f), glm::vec3(0.95f, 0.75f, 0.55f), puff.tone);
    particles.push_back(
        {glm::vec3(camera * glm::vec4(at.x, at.y, -at.z, 1)), puff.radius, glm::vec4(colour * alpha, alpha)});
  }
}

}  // namespace

// The courtyard, flown through: a load that changes, for resolution control.
Scene make_flight(std::uint64_t seed) {
  Scene scene = make_courtyard(seed);
  move_camera(scene, kFlight, kFieldOfView, [](double seconds) {
    const Waypoint place = place_at(seconds);
    return looking_from(place.eye, place.target);
  });
  scene.particles = [spray = scene.particles, puffs = make_puffs(seed)](double seconds,
                                                                        std::vector<Particle>& particles) {
    spray(seconds, particles);
    add_smoke(puffs, seconds, particles);
  };
  return scene;
}

}  // namespace quincunx::scenes
