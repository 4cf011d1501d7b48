// SPDX-License-Identifier: MIT
#include "orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quincunx::scenes {
namespace {

constexpr double kElevation = 18 * std::numbers::pi / 180;
constexpr double kStart = 30 * std::numbers::pi / 180;
constexpr double kVerticalFov = 40 * std::numbers::pi / 180;
constexpr double kAspect = 4.0 / 3.0;
constexpr double kMargin = 1.08;  // a little air round the box

// The smallest distance from which the cylinder that the box's corners turn on is all in view.
double fitting_distance(double radius, double half_height) {
  constexpr int kSteps = 128;
  const double tan_y = std::tan(kVerticalFov / 2);
  const double tan_x = tan_y * kAspect;
  double distance = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double angle = step * 2 * std::numbers::pi / kSteps;
    const double towards = radius * std::cos(angle);  // horizontally, to the camera's side
    const double across = radius * std::sin(angle);
    for (const double height : {-half_height, half_height}) {
      const double nearer = towards * std::cos(kElevation) + height * std::sin(kElevation);
      const double up = height * std::cos(kElevation) - towards * std::sin(kElevation);
      distance = std::max(distance, nearer + std::max(std::abs(up) / tan_y, std::abs(across) / tan_x));
    }
  }
  return distance * kMargin;
}

// Rigid, at `eye`, with `back` the unit vector away from what it looks at, never straight up or down. From
// the direction, not from two points: far from the origin their difference is lost.
glm::mat4 camera_at(const glm::vec3& eye, const glm::vec3& back) {
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  return {glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(eye, 1)};
}

}  // namespace

CameraPath orbit_camera(const Bounds& bounds, double seconds) {
  const glm::vec3 centre = 0.5f * bounds.low + 0.5f * bounds.high;
  const glm::dvec3 half = 0.5 * (glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
  double radius = std::hypot(half.x, half.z);
  double half_height = half.y;
  if (!(std::max(radius, half_height) > 0)) radius = half_height = 0.5;
  const double distance = fitting_distance(radius, half_height);
  // Half way to the nearest point of the box, or close to the eye where the box surrounds it.
  const double nearest = distance - std::hypot(radius, half_height);
  const auto near_plane = static_cast<float>(std::max(0.5 * nearest, 0.01 * distance));

  return [=](double time) {
    const double angle = kStart + 2 * std::numbers::pi * std::fmod(time / seconds, 1.0);
    const glm::dvec3 towards(std::sin(angle) * std::cos(kElevation), std::sin(kElevation),
                             std::cos(angle) * std::cos(kElevation));
    Camera camera;
    camera.world_from_camera = camera_at(centre + glm::vec3(distance * towards), glm::vec3(towards));
    camera.vertical_fov = static_cast<float>(kVerticalFov);
    camera.near_plane = near_plane;
    return camera;
  };
}

}  // namespace quincunx::scenes
