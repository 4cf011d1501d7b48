// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "builtin/courtyard.h"
#include "random.h"

namespace quincunx::scenes {

namespace {

constexpr float kTrack = 2.35f;  // radius of the rails round the fountain
constexpr glm::vec3 kBrazier{-3.1f, 0, 4.9f};

constexpr glm::vec3 kLampIntensity(8.0f, 4.2f, 1.5f);
constexpr float kLampRange = 3.6f;

// --- Lanterns: a shade, four bars, glass and a bulb, hanging from their origin.

struct LanternMeshes {
  int frame, glass, bulb;
};

LanternMeshes make_lantern(SceneAssembly& assembly, const CourtyardMaterials& m, float drop) {
  MeshBuilder frame(m.iron);
  frame.rod({0, 0, 0}, {0, -drop, 0}, 0.008f, 6);
  constexpr float kHalf = 0.11f;
  constexpr float kBody = 0.34f;
  const float top = -drop - 0.12f;
  const std::array<glm::vec2, 4> cap{
      {{0.19f, top}, {0.15f, top + 0.02f}, {0.04f, top + 0.13f}, {0, top + 0.17f}}};
  frame.lathe(cap, 4);
  frame.box({-kHalf, top - kBody - 0.02f, -kHalf}, {kHalf, top - kBody, kHalf});
  frame.box({-kHalf - 0.02f, top - 0.02f, -kHalf - 0.02f}, {kHalf + 0.02f, top, kHalf + 0.02f});
  for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    frame.rod({corner.x * kHalf, top - kBody, corner.y * kHalf}, {corner.x * kHalf, top, corner.y * kHalf},
              0.01f, 5);
  }
  MeshBuilder glass(m.glass);
  glass.box({-kHalf, top - kBody, -kHalf}, {kHalf, top - 0.02f, kHalf});
  MeshBuilder bulb(m.lamp);
  bulb.sphere({0, top - 0.2f, 0}, 0.055f, 14);
  return {assembly.add(frame.take()), assembly.add(glass.take()), assembly.add(bulb.take())};
}

void hang_lantern(SceneAssembly& assembly, const LanternMeshes& meshes, glm::vec3 hook, glm::vec3 axis,
                  int index) {
  const Motion swing = swinging(moved_to(hook), axis, 0.085f, kCourtyardDuration, 3 + index % 2,
                                1.7f * static_cast<float>(index));
  for (const int mesh : {meshes.frame, meshes.bulb, meshes.glass})
    assembly.move(mesh, swing);
}

void add_lanterns(SceneAssembly& assembly, const CourtyardMaterials& m) {
  const LanternMeshes arcade = make_lantern(assembly, m, 0.75f);
  for (int i = 0; i < 7; ++i) {
    const float z = 10.4f - 2.6f * (static_cast<float>(i) + 0.5f);
    hang_lantern(assembly, arcade, {-7.9f, 4.05f, z}, {0, 0, 1}, i);
    // Every second one lights its surroundings: by day nobody misses the others, and each costs.
    if (i % 2 == 0) assembly.scene.lights.push_back({{-7.9f, 2.98f, z}, kLampIntensity, kLampRange});
  }
  const LanternMeshes portico = make_lantern(assembly, m, 0.65f);
  for (int i = 0; i < 5; ++i) {
    const float x = -5.2f + 2.6f * static_cast<float>(i);
    hang_lantern(assembly, portico, {x, 4.7f, -9.0f}, {1, 0, 0}, i + 3);
    if (i % 2 == 0) assembly.scene.lights.push_back({{x, 3.73f, -9.0f}, kLampIntensity, kLampRange});
  }
}

// --- Pennants on wires between the terrace and two poles.

void add_pennants(SceneAssembly& assembly, const CourtyardMaterials& m) {
  constexpr std::array<glm::vec3, 5> kColours{{{0.55f, 0.06f, 0.04f},
                                               {0.80f, 0.45f, 0.06f},
                                               {0.78f, 0.72f, 0.58f},
                                               {0.05f, 0.20f, 0.30f},
                                               {0.10f, 0.26f, 0.12f}}};
  std::array<int, 5> meshes{};
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    MeshBuilder cloth(assembly.add(plain_material("pennant", kColours[i], 0.9f)));
    for (const float side : {1.0f, -1.0f}) {
      const glm::vec3 normal(0, 0, side);
      const std::uint32_t a = cloth.vertex({-0.13f * side, 0, 0}, normal, {0, 0});
      cloth.vertex({0, -0.36f, 0}, normal, {0, 0});
      cloth.vertex({0.13f * side, 0, 0}, normal, {0, 0});
      cloth.triangle(a, a + 1, a + 2);
    }
    meshes[i] = assembly.add(cloth.take());
  }
  struct Line {
    glm::vec3 from, to;
    float sag;
  };
  constexpr std::array kLines = std::to_array<Line>({{{-6.45f, 5.3f, 4.0f}, {6.5f, 4.7f, 2.8f}, 0.75f},
                                                     {{-6.45f, 5.3f, -2.4f}, {6.5f, 5.0f, -4.0f}, 0.45f}});
  MeshBuilder& iron = assembly.still(m.iron, kGarden);
  int index = 0;
  for (const Line& line : kLines) {
    constexpr int kPieces = 44;
    const std::vector<glm::vec3> wire = hanging_wire(line.from, line.to, line.sag, kPieces);
    iron.tube(wire, 0.006f, 5);
    iron.rod({line.to.x, 2.29f, line.to.z}, line.to + glm::vec3(0, 0.25f, 0), 0.025f, 8);
    for (int i = 2; i + 1 < kPieces; i += 2, ++index) {
      const glm::vec3 along =
          glm::normalize(wire[static_cast<std::size_t>(i) + 1] - wire[static_cast<std::size_t>(i)]);
      const glm::vec3 front = glm::normalize(glm::cross(along, glm::vec3(0, 1, 0)));
      const glm::mat4 rest(glm::vec4(along, 0), glm::vec4(glm::cross(front, along), 0), glm::vec4(front, 0),
                           glm::vec4(wire[static_cast<std::size_t>(i)], 1));
      assembly.move(meshes[static_cast<std::size_t>(index) % meshes.size()],
                    swinging(rest, {1, 0, 0}, 0.32f, kCourtyardDuration, 4 + index % 3,
                             0.9f * static_cast<float>(index)));
    }
  }
}

// --- A clockwork cart on rails round the fountain.

void add_rails(SceneAssembly& assembly, const CourtyardMaterials& m) {
  MeshBuilder& iron = assembly.still(m.iron, kFountainPart);
  for (const float radius : {kTrack - 0.16f, kTrack + 0.16f}) {
    iron.ring(kFountain + glm::vec3(0, 0.03f, 0), {0, 1, 0}, radius, 0.016f, 96, 6);
  }
  MeshBuilder& wood = assembly.still(m.planks, kFountainPart);
  for (int i = 0; i < 48; ++i) {
    wood.pen.placement =
        moved_to(kFountain) * turned(kTau * static_cast<float>(i) / 48, {0, 1, 0}) * moved_to({kTrack, 0, 0});
    wood.box({-0.25f, 0, -0.035f}, {0.25f, 0.02f, 0.035f});
  }
  wood.pen.placement = glm::mat4(1);
}

void add_cart(SceneAssembly& assembly, const CourtyardMaterials& m) {
  const int red = assembly.add(plain_material("red lacquer", {0.52f, 0.035f, 0.025f}, 0.32f));
  // The cart drives towards its local -z at x = kTrack.
  const auto ride = [](double seconds) {
    return moved_to(kFountain) * turned(phase_at(seconds, kCourtyardDuration) - 1.15f, {0, 1, 0}) *
           moved_to({kTrack, 0.05f, 0});
  };
  MeshBuilder body(red);
  body.box({-0.17f, 0.13f, -0.42f}, {0.17f, 0.33f, 0.34f});
  body.box({-0.19f, 0.33f, -0.02f}, {0.19f, 0.62f, 0.36f});
  MeshBuilder brass(m.gilt);
  brass.rod({0, 0.36f, -0.44f}, {0, 0.36f, 0.0f}, 0.125f, 20);
  brass.rod({0, 0.36f, -0.30f}, {0, 0.66f, -0.30f}, 0.04f, 12);
  brass.sphere({0, 0.50f, -0.10f}, 0.06f, 12);
  brass.box({-0.22f, 0.62f, -0.06f}, {0.22f, 0.66f, 0.40f});
  for (const float y : {0.15f, 0.31f})
    brass.box({-0.176f, y - 0.008f, -0.43f}, {0.176f, y + 0.008f, 0.345f});
  MeshBuilder lamp(m.lamp);
  lamp.sphere({0, 0.36f, -0.46f}, 0.045f, 12);
  for (MeshBuilder* part : {&body, &brass, &lamp})
    assembly.move(*part, ride);
  MeshBuilder wheel(m.iron);
  constexpr float kRadius = 0.12f;
  wheel.ring({0, 0, 0}, {1, 0, 0}, kRadius - 0.012f, 0.014f, 28, 6);
  wheel.rod({-0.03f, 0, 0}, {0.03f, 0, 0}, 0.022f, 10);
  for (int spoke = 0; spoke < 8; ++spoke) {
    const float angle = kTau * static_cast<float>(spoke) / 8;
    wheel.rod({0, 0, 0}, {0, (kRadius - 0.015f) * std::cos(angle), (kRadius - 0.015f) * std::sin(angle)},
              0.006f, 5);
  }
  const int wheel_mesh = assembly.add(wheel.take());
  const int turns = static_cast<int>(std::round(kTrack / kRadius));
  for (const glm::vec2 axle : {glm::vec2(-0.16f, -0.27f), {0.16f, -0.27f}, {-0.16f, 0.2f}, {0.16f, 0.2f}}) {
    assembly.move(wheel_mesh, [ride, axle, turns](double seconds) {
      return ride(seconds) * moved_to({axle.x, 0.11f, axle.y}) *
             turned(-phase_at(seconds, kCourtyardDuration, turns), {1, 0, 0});
    });
  }
}

// --- A wind wheel on the roof, a vane on the tower, swifts round it.

void add_wind_wheel(SceneAssembly& assembly, const CourtyardMaterials& m) {
  const glm::vec3 hub(-4.0f, 10.6f, -9.0f);
  MeshBuilder& iron = assembly.still(m.iron, kTower);
  for (const glm::vec2 foot : {glm::vec2(-0.45f, -0.4f), {0.45f, -0.4f}, {0.45f, 0.4f}, {-0.45f, 0.4f}}) {
    iron.rod({hub.x + foot.x, 8.0f, hub.z - 0.4f + foot.y}, hub + glm::vec3(0.1f * foot.x, -0.05f, -0.3f),
             0.022f, 6);
  }
  iron.rod(hub + glm::vec3(0, 0, 0.05f), hub + glm::vec3(0, 0, -1.3f), 0.03f, 8);
  iron.box(hub + glm::vec3(-0.01f, -0.3f, -1.9f), hub + glm::vec3(0.01f, 0.3f, -1.25f));
  MeshBuilder wheel(m.iron);
  constexpr int kBlades = 16;
  for (const float radius : {0.42f, 1.02f})
    wheel.ring({0, 0, 0}, {0, 0, 1}, radius, 0.013f, 48, 5);
  MeshBuilder blades(m.shutters);
  for (int i = 0; i < kBlades; ++i) {
    const glm::mat4 spoke = turned(kTau * static_cast<float>(i) / kBlades, {0, 0, 1});
    wheel.pen.placement = spoke;
    wheel.rod({0, 0, 0}, {0, 1.02f, 0}, 0.009f, 5);
    blades.pen.placement = spoke * turned(0.6f, {0, 1, 0});
    const std::array<glm::vec2, 4> outline{
        {{-0.055f, 0.42f}, {0.055f, 0.42f}, {0.14f, 1.08f}, {-0.14f, 1.08f}}};
    blades.prism(outline, -0.004f, 0.004f);
  }
  const glm::mat4 rest = moved_to(hub) * turned(0.35f, {0, 1, 0});
  for (MeshBuilder* part : {&wheel, &blades})
    assembly.move(*part, spinning(rest, {0, 0, 1}, kCourtyardDuration, 3));
  MeshBuilder vane(m.gilt);
  vane.rod({0, 0, 0}, {0, 1.1f, 0}, 0.03f, 8);
  vane.sphere({0, 0.45f, 0}, 0.13f, 14);
  vane.rod({-0.7f, 0.85f, 0}, {0.7f, 0.85f, 0}, 0.022f, 6);
  const std::array<glm::vec2, 3> tail{{{-0.75f, 0.62f}, {-0.35f, 0.85f}, {-0.75f, 1.08f}}};
  vane.prism(tail, -0.01f, 0.01f);
  assembly.move(vane, swinging(moved_to({3.6f, 19.6f, -21}), {0, 1, 0}, 0.5f, kCourtyardDuration, 1, 0.4f));
}

void add_swifts(SceneAssembly& assembly, std::uint64_t seed) {
  Random random(seed, 17);
  const int dark = assembly.add(plain_material("swift", glm::vec3(0.025f, 0.022f, 0.022f), 0.9f));
  std::array<int, 2> wings{};
  for (int side = 0; side < 2; ++side) {
    MeshBuilder wing(dark);
    const float out = side == 0 ? 1.0f : -1.0f;
    // Half the body and one sickle wing, flying towards -z.
    const std::array<glm::vec3, 4> outline{
        {{0, 0, -0.13f}, {out * 0.14f, 0, -0.06f}, {out * 0.38f, 0, 0.10f}, {out * 0.03f, 0, 0.12f}}};
    for (const float up : {1.0f, -1.0f}) {
      std::array<std::uint32_t, 4> index{};
      for (std::size_t i = 0; i < 4; ++i)
        index[i] = wing.vertex(outline[i], {0, up, 0}, {0, 0});
      const bool keep = (up > 0) == (side == 1);
      for (std::uint32_t i = 1; i < 3; ++i)
        wing.triangle(index[0], index[keep ? i : i + 1], index[keep ? i + 1 : i]);
    }
    wings[static_cast<std::size_t>(side)] = assembly.add(wing.take());
  }
  for (int bird = 0; bird < 9; ++bird) {
    const float start = random.range(0, kTau);
    const float radius = random.range(4.0f, 8.5f);
    const float height = random.range(12.5f, 18.5f);
    const float flap_start = random.range(0, kTau);
    const int rounds = bird % 3 == 0 ? 2 : 1;
    for (int side = 0; side < 2; ++side) {
      assembly.move(wings[static_cast<std::size_t>(side)], [=](double seconds) {
        const float angle = start + phase_at(seconds, kCourtyardDuration, rounds);
        const float rise = 0.7f * std::sin(phase_at(seconds, kCourtyardDuration, 2) + start);
        const float flap = 0.35f + 0.45f * std::sin(phase_at(seconds, kCourtyardDuration, 36) + flap_start);
        return moved_to({1.0f, height + rise, -19}) * turned(angle, {0, 1, 0}) * moved_to({radius, 0, 0}) *
               turned(0.35f, {0, 0, 1}) * turned(side == 0 ? flap : -flap, {0, 0, 1});
      });
    }
  }
}

void add_brazier(SceneAssembly& assembly, const CourtyardMaterials& m) {
  MeshBuilder& iron = assembly.still(m.iron, kProps);
  iron.pen.placement = moved_to(kBrazier);
  const std::array<glm::vec2, 7> bowl{{{0, 0.42f},
                                       {0.18f, 0.44f},
                                       {0.31f, 0.56f},
                                       {0.36f, 0.72f},
                                       {0.38f, 0.72f},
                                       {0.33f, 0.66f},
                                       {0, 0.62f}}};
  iron.lathe(bowl, 28);
  for (int leg = 0; leg < 3; ++leg) {
    const float angle = kTau * static_cast<float>(leg) / 3 + 0.4f;
    iron.rod({0.24f * std::cos(angle), 0.52f, 0.24f * std::sin(angle)},
             {0.36f * std::cos(angle), 0, 0.36f * std::sin(angle)}, 0.018f, 8);
  }
  iron.ring({0, 0.2f, 0}, {0, 1, 0}, 0.31f, 0.012f, 32, 6);
  iron.pen.placement = glm::mat4(1);
  MeshBuilder& coals = assembly.still(m.ember, kProps);
  Random random(5, 23);  // the same coals whatever the seed
  for (int i = 0; i < 26; ++i) {
    const float angle = random.range(0, kTau);
    const float radius = 0.27f * std::sqrt(random.unit());
    coals.pen.placement =
        moved_to(kBrazier + glm::vec3(radius * std::cos(angle), 0.66f + 0.05f * random.unit(),
                                      radius * std::sin(angle))) *
        turned(random.range(0, kTau), glm::normalize(glm::vec3(1, random.unit(), 0.3f)));
    const float half = random.range(0.025f, 0.05f);
    coals.box(glm::vec3(-half), glm::vec3(half));
  }
  assembly.scene.lights.push_back({kBrazier + glm::vec3(0, 1.0f, 0), {7.0f, 2.8f, 0.8f}, 5});
}

struct Drop {
  glm::vec3 from, velocity;
  float start, radius;
  int lives;
};

float age_of(const Drop& drop, double seconds) {
  const double life = seconds / kCourtyardDuration * drop.lives + static_cast<double>(drop.start);
  return static_cast<float>(life - std::floor(life));
}

}  // namespace

void add_courtyard_motion(SceneAssembly& assembly, const CourtyardMaterials& m, std::uint64_t seed) {
  add_lanterns(assembly, m);
  add_pennants(assembly, m);
  add_rails(assembly, m);
  add_cart(assembly, m);
  add_wind_wheel(assembly, m);
  add_swifts(assembly, seed);
  add_brazier(assembly, m);
}

void add_courtyard_particles(Scene& scene, std::uint64_t seed) {
  constexpr float kGravity = 9.81f;
  constexpr int kSprayLives = 9;
  Random random(seed, 29);
  std::vector<Drop> spray;
  for (int i = 0; i < 620; ++i) {
    // Eight jets from the top, and a veil over the rim of the bowl.
    const bool jet = i % 3 != 0;
    const float angle = jet ? kTau * (static_cast<float>(random.below(8)) / 8 + 0.008f * random.signed_unit())
                            : random.range(0, kTau);
    const glm::vec3 out(std::cos(angle), 0, std::sin(angle));
    const float speed = random.range(0.92f, 1.08f);
    Drop drop;
    drop.from = kFountain + (jet ? glm::vec3(0, 1.98f, 0) : 0.8f * out + glm::vec3(0, 1.45f, 0));
    drop.velocity = jet ? speed * (1.05f * out + glm::vec3(0, 2.2f, 0)) : 0.22f * speed * out;
    drop.start = random.unit();
    drop.radius = random.range(0.008f, 0.02f);
    drop.lives = kSprayLives;
    spray.push_back(drop);
  }
  std::vector<Drop> embers;
  for (int i = 0; i < 110; ++i) {
    const float angle = random.range(0, kTau);
    Drop ember;
    ember.from = kBrazier + glm::vec3(0.2f * std::cos(angle), 0.7f, 0.2f * std::sin(angle));
    ember.velocity = {0.3f * random.signed_unit(), random.range(0.9f, 1.9f), 0.3f * random.signed_unit()};
    ember.start = random.unit();
    ember.radius = random.range(0.005f, 0.011f);
    ember.lives = 2 + random.below(3);
    embers.push_back(ember);
  }
  scene.particles = [spray, embers](double seconds, std::vector<Particle>& particles) {
    particles.clear();
    particles.reserve(spray.size() + embers.size());
    for (const Drop& drop : spray) {
      const float age = age_of(drop, seconds);
      const float time = age * static_cast<float>(kCourtyardDuration) / kSprayLives;
      glm::vec3 at = drop.from + drop.velocity * time - glm::vec3(0, 0.5f * kGravity * time * time, 0);
      constexpr float kPool = 0.48f;
      if (at.y < kPool) continue;
      const float alpha = 0.5f * std::min(1.0f, 8 * age);
      particles.push_back(
          {at, drop.radius * (1 + age), glm::vec4(glm::vec3(1.25f, 1.12f, 0.98f) * alpha, 0.6f * alpha)});
    }
    for (const Drop& ember : embers) {
      const float age = age_of(ember, seconds);
      const float wander = 0.16f * age * std::sin(kTau * (1.5f * age + ember.start * 7));
      const glm::vec3 at = ember.from + ember.velocity * age * 1.3f + glm::vec3(wander, 0, wander * 0.6f);
      const float glow = (1 - age) * (1 - age) * std::min(1.0f, 10 * age);
      particles.push_back({at, ember.radius, glm::vec4(glm::vec3(14, 4.0f, 0.7f) * glow, 0)});
    }
  };
}

}  // namespace quincunx::scenes
