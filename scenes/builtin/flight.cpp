// SPDX-License-Identifier: MIT
// The courtyard, flown through: a load that changes, for resolution control.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "builtin/courtyard.h"
#include "builtin/scenes.h"
#include "random.h"

namespace quincunx::scenes {
namespace {

constexpr double kDuration = 2 * kCourtyardDuration;  // a whole number of the courtyard's own rounds
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
  return phase_at(seconds, kDuration) / glm::two_pi<float>();
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

Scene make_flight(std::uint64_t seed) {
  Scene scene = make_courtyard(seed);
  scene.duration = kDuration;
  scene.camera = [](double seconds) {
    const Waypoint place = place_at(seconds);
    Camera camera;
    camera.vertical_fov = 0.95f;
    camera.world_from_camera = looking_from(place.eye, place.target);
    return camera;
  };
  scene.particles = [spray = scene.particles, puffs = make_puffs(seed)](double seconds,
                                                                        std::vector<Particle>& particles) {
    spray(seconds, particles);
    add_smoke(puffs, seconds, particles);
  };
  return scene;
}

}  // namespace quincunx::scenes
