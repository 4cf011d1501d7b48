// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/props.h"
#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {

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
    assembly.move(assembly.add(pane.take()), spinning(rest, {0, 1, 0}, kDuration, i % 2 == 0 ? 1 : -1));
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
