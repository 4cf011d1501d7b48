// SPDX-License-Identifier: MIT
#include "builtin/architecture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace quincunx::scenes {

namespace {

constexpr int kArchPieces = 20;

// One upright quad of the front face and its twin on the back.
void both_faces(MeshBuilder& wall, float x0, float x1, float y0, float y1, float thickness) {
  wall.patch({x0, y0, 0}, {x1 - x0, 0, 0}, {0, y1 - y0, 0});
  wall.patch({x1, y0, -thickness}, {x0 - x1, 0, 0}, {0, y1 - y0, 0});
}

void spandrel(MeshBuilder& wall, glm::vec2 from, glm::vec2 to, float top, float thickness) {
  constexpr int kRows = 3;
  const auto point = [&](glm::vec2 foot, int row) {
    return glm::vec2(foot.x, glm::mix(foot.y, top, static_cast<float>(row) / kRows));
  };
  for (const bool is_front : {true, false}) {
    const glm::vec3 normal(0, 0, is_front ? 1 : -1);
    const auto corner = [&](glm::vec2 at) {
      const float u = is_front ? at.x : -at.x;
      return wall.vertex(glm::vec3(at, is_front ? 0 : -thickness), normal,
                         glm::vec2(u, -at.y) * wall.pen.uv_per_metre);
    };
    for (int row = 0; row < kRows; ++row) {
      const std::uint32_t a = corner(point(is_front ? from : to, row));
      const std::uint32_t b = corner(point(is_front ? to : from, row));
      const std::uint32_t c = corner(point(is_front ? to : from, row + 1));
      const std::uint32_t d = corner(point(is_front ? from : to, row + 1));
      wall.triangle(a, b, c);
      wall.triangle(a, c, d);
    }
  }
}

// The moulded ring round an arch, on the front face.
void archivolt(MeshBuilder& trim, glm::vec2 centre, float radius) {
  constexpr float kWidth = 0.17f;
  constexpr float kDepth = 0.045f;
  const auto at = [&](int i, float r) {
    const float angle = glm::pi<float>() * (1 - static_cast<float>(i) / kArchPieces);
    return centre + r * glm::vec2(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < kArchPieces; ++i) {
    const glm::vec3 a(at(i, radius), kDepth);
    const glm::vec3 b(at(i + 1, radius), kDepth);
    const glm::vec3 c(at(i + 1, radius + kWidth), kDepth);
    const glm::vec3 d(at(i, radius + kWidth), kDepth);
    const glm::vec3 back(0, 0, -kDepth);
    const glm::vec3 front(0, 0, 1);
    const std::uint32_t first = trim.vertex(a, front, glm::vec2(a.x, -a.y) * trim.pen.uv_per_metre);
    for (const glm::vec3 p : {b, c, d})
      trim.vertex(p, front, glm::vec2(p.x, -p.y) * trim.pen.uv_per_metre);
    trim.triangle(first, first + 1, first + 2);
    trim.triangle(first, first + 2, first + 3);
    trim.patch(d, c - d, back);  // outer rim
    trim.patch(b, a - b, back);  // inner rim
  }
}

}  // namespace

void add_arch_wall(MeshBuilder& wall, MeshBuilder& trim, const ArchWall& shape) {
  const float margin = shape.bay_width / 2 - shape.radius;
  const float depth = shape.thickness;
  for (int bay = 0; bay < shape.bays; ++bay) {
    const float left = static_cast<float>(bay) * shape.bay_width;
    const float right = left + shape.bay_width;
    const glm::vec2 centre(left + shape.bay_width / 2, shape.springing);
    both_faces(wall, left, left + margin, shape.base, shape.top, depth);
    both_faces(wall, right - margin, right, shape.base, shape.top, depth);
    // Jambs and undersides.
    const float jamb = shape.springing - shape.base;
    if (jamb > 0) {
      wall.patch({left + margin, shape.base, 0}, {0, 0, -depth}, {0, jamb, 0});
      wall.patch({right - margin, shape.base, -depth}, {0, 0, depth}, {0, jamb, 0});
    }
    wall.patch({left, shape.base, -depth}, {margin, 0, 0}, {0, 0, depth});
    wall.patch({right - margin, shape.base, -depth}, {margin, 0, 0}, {0, 0, depth});
    for (int i = 0; i < kArchPieces; ++i) {
      const auto point = [&](int k) {
        const float angle = glm::pi<float>() * (1 - static_cast<float>(k) / kArchPieces);
        return centre + shape.radius * glm::vec2(std::cos(angle), std::sin(angle));
      };
      const glm::vec2 from = point(i);
      const glm::vec2 to = point(i + 1);
      spandrel(wall, from, to, shape.top, depth);
      wall.patch(glm::vec3(from, -depth), glm::vec3(to - from, 0), {0, 0, depth});  // intrados
    }
    archivolt(trim, centre, shape.radius);
    trim.box({centre.x - 0.11f, centre.y + shape.radius - 0.03f, -0.05f},
             {centre.x + 0.11f, centre.y + shape.radius + 0.27f, 0.085f});
  }
}

void add_window_wall(MeshBuilder& wall, MeshBuilder& trim, const WindowWall& shape) {
  const float sill = shape.low + shape.sill;
  const float head = sill + shape.opening.y;
  for (int bay = 0; bay < shape.bays; ++bay) {
    const float left = static_cast<float>(bay) * shape.bay_width;
    const float right = left + shape.bay_width;
    const float x0 = (left + right - shape.opening.x) / 2;
    const float x1 = (left + right + shape.opening.x) / 2;
    wall.patch({left, shape.low, 0}, {x0 - left, 0, 0}, {0, shape.high - shape.low, 0});
    wall.patch({x1, shape.low, 0}, {right - x1, 0, 0}, {0, shape.high - shape.low, 0});
    wall.patch({x0, shape.low, 0}, {x1 - x0, 0, 0}, {0, shape.sill, 0});
    wall.patch({x0, head, 0}, {x1 - x0, 0, 0}, {0, shape.high - head, 0});
    const glm::vec3 in(0, 0, -shape.reveal);
    wall.patch({x0, sill, 0}, in, {0, shape.opening.y, 0});
    wall.patch(glm::vec3(x1, sill, 0) + in, -in, {0, shape.opening.y, 0});
    wall.patch({x0, sill, 0}, {x1 - x0, 0, 0}, in);
    wall.patch(glm::vec3(x0, head, 0) + in, {x1 - x0, 0, 0}, -in);
    constexpr float kBand = 0.14f;
    trim.box({x0 - kBand, sill, 0}, {x0, head, 0.05f});
    trim.box({x1, sill, 0}, {x1 + kBand, head, 0.05f});
    trim.box({x0 - kBand, head, 0}, {x1 + kBand, head + kBand, 0.06f});
    trim.box({x0 - kBand - 0.08f, head + kBand, 0}, {x1 + kBand + 0.08f, head + kBand + 0.07f, 0.14f});
    trim.box({x0 - kBand - 0.05f, sill - 0.09f, 0}, {x1 + kBand + 0.05f, sill, 0.13f});
  }
}

void add_windows(MeshBuilder& glass, MeshBuilder& frame, MeshBuilder& shutters, const WindowWall& shape) {
  const float sill = shape.low + shape.sill;
  const float head = sill + shape.opening.y;
  constexpr float kBar = 0.022f;
  for (int bay = 0; bay < shape.bays; ++bay) {
    const float middle = (static_cast<float>(bay) + 0.5f) * shape.bay_width;
    const float x0 = middle - shape.opening.x / 2;
    const float x1 = middle + shape.opening.x / 2;
    const float z = -shape.reveal;
    glass.patch({x0, sill, z + 0.01f}, {x1 - x0, 0, 0}, {0, head - sill, 0});
    frame.box({middle - 2 * kBar, sill, z}, {middle + 2 * kBar, head, z + 0.06f});
    for (const float x : {x0 + kBar, x1 - kBar})
      frame.box({x - kBar, sill, z}, {x + kBar, head, z + 0.05f});
    constexpr int kRows = 4;
    for (int row = 0; row <= kRows; ++row) {
      const float y = glm::mix(sill + kBar, head - kBar, static_cast<float>(row) / kRows);
      frame.box({x0, y - kBar, z}, {x1, y + kBar, z + 0.04f});
    }
    // Louvred shutters folded back against the wall.
    const float leaf = shape.opening.x / 2;
    for (const float x : {x0 - 0.16f - leaf, x1 + 0.16f}) {
      shutters.box({x, sill, 0.05f}, {x + 0.05f, head, 0.10f});
      shutters.box({x + leaf - 0.05f, sill, 0.05f}, {x + leaf, head, 0.10f});
      for (const float y : {sill, head - 0.07f}) {
        shutters.box({x + 0.05f, y, 0.05f}, {x + leaf - 0.05f, y + 0.07f, 0.10f});
      }
      const int slats = static_cast<int>((head - sill) / 0.085f);
      for (int i = 1; i < slats; ++i) {
        const float y = sill + static_cast<float>(i) * 0.085f;
        shutters.patch({x + 0.05f, y, 0.095f}, {leaf - 0.10f, 0, 0}, {0, 0.075f, -0.04f});
      }
    }
  }
}

void add_column(MeshBuilder& stone, float radius, float height) {
  constexpr int kSegments = 18;
  const float r = radius;
  const float plinth = 0.16f;
  const float abacus = 0.14f;
  const float top = height - abacus;
  stone.box({-1.45f * r, 0, -1.45f * r}, {1.45f * r, plinth, 1.45f * r});
  stone.box({-1.5f * r, top, -1.5f * r}, {1.5f * r, height, 1.5f * r});
  std::vector<glm::vec2> profile = {{1.4f * r, plinth},          {1.43f * r, plinth + 0.05f},
                                    {1.36f * r, plinth + 0.10f}, {1.12f * r, plinth + 0.12f},
                                    {1.10f * r, plinth + 0.15f}, {1.22f * r, plinth + 0.18f},
                                    {1.18f * r, plinth + 0.22f}, {1.0f * r, plinth + 0.24f}};
  constexpr int kShaftPieces = 5;
  const float foot = plinth + 0.24f;
  const float neck = top - 0.32f;
  for (int i = 1; i <= kShaftPieces; ++i) {
    const float t = static_cast<float>(i) / kShaftPieces;
    profile.emplace_back(r * (1.0f - 0.16f * t * t), glm::mix(foot, neck, t));  // entasis
  }
  const std::array<glm::vec2, 6> capital{{{0.96f * r, neck},
                                          {0.96f * r, neck + 0.05f},
                                          {0.85f * r, neck + 0.06f},
                                          {0.92f * r, neck + 0.16f},
                                          {1.16f * r, neck + 0.27f},
                                          {1.42f * r, top}}};
  profile.insert(profile.end(), capital.begin(), capital.end());
  stone.lathe(profile, kSegments);
}

void add_cornice(MeshBuilder& stone, float length, float height, float depth) {
  // Profile from the wall at the bottom to the lip at the top, in (z, y) downwards from the top.
  const std::array<glm::vec2, 7> profile{{{0.0f, -height},
                                          {0.22f * depth, -height},
                                          {0.26f * depth, -0.62f * height},
                                          {0.62f * depth, -0.38f * height},
                                          {0.66f * depth, -0.30f * height},
                                          {depth, -0.26f * height},
                                          {depth, 0.0f}}};
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const glm::vec3 low(0, profile[i].y, profile[i].x);
    const glm::vec3 high(0, profile[i + 1].y, profile[i + 1].x);
    stone.patch(low, {length, 0, 0}, high - low);
  }
  stone.patch({0, 0, depth}, {length, 0, 0}, {0, 0, -depth - 0.3f});
  for (const float x : {0.0f, length}) {  // ends
    const float outwards = x > 0 ? 1.0f : -1.0f;
    const glm::vec3 corner(x, -height, x > 0 ? depth : 0.0f);
    stone.patch(corner, {0, 0, -outwards * depth}, {0, height, 0});
  }
}

void add_balustrade(MeshBuilder& stone, float length, float height) {
  constexpr float kSpacing = 0.26f;
  const float low = 0.12f;
  const float high = height - 0.12f;
  stone.box({0, 0, -0.11f}, {length, low, 0.11f});
  stone.box({0, high, -0.12f}, {length, height, 0.12f});
  const float span = high - low;
  const std::array<glm::vec2, 9> profile{{{0.075f, low},
                                          {0.075f, low + 0.06f * span},
                                          {0.040f, low + 0.12f * span},
                                          {0.080f, low + 0.30f * span},
                                          {0.072f, low + 0.42f * span},
                                          {0.036f, low + 0.72f * span},
                                          {0.036f, low + 0.84f * span},
                                          {0.065f, low + 0.92f * span},
                                          {0.065f, high}}};
  const int count = static_cast<int>(length / kSpacing);
  for (int i = 0; i < count; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) * length / static_cast<float>(count);
    const PenScope offset(stone, glm::translate(stone.pen.placement, glm::vec3(x, 0, 0)));
    stone.lathe(profile, 8);
  }
}

void add_railing(MeshBuilder& iron, const Railing& shape) {
  const float top = shape.height - 0.12f;
  for (const float y : {0.10f, top}) {
    iron.box({0, y - 0.006f, -0.018f}, {shape.length, y + 0.006f, 0.018f});
  }
  const int count = static_cast<int>(std::round(shape.length / shape.spacing));
  for (int i = 0; i <= count; ++i) {
    const float x = shape.length * static_cast<float>(i) / static_cast<float>(count);
    const std::array<glm::vec3, 2> bar{{{x, 0, 0}, {x, shape.height - 0.05f, 0}}};
    iron.tube(bar, shape.bar_radius, 6);
    const PenScope offset(iron, glm::translate(iron.pen.placement, glm::vec3(x, shape.height - 0.09f, 0)));
    const std::array<glm::vec2, 4> spear{
        {{shape.bar_radius, 0}, {2.4f * shape.bar_radius, 0.03f}, {0.004f, 0.1f}, {0, 0.11f}}};
    iron.lathe(spear, 6);
  }
}

void add_wire_fence(MeshBuilder& wire, float length, float height) {
  constexpr float kMesh = 0.11f;
  constexpr float kWire = 0.0022f;
  const int count = static_cast<int>((length + height) / kMesh);
  for (int i = 0; i < count; ++i) {
    const float start = static_cast<float>(i) * kMesh - height;
    for (const bool rising : {true, false}) {
      const auto x_at = [&](float y) { return rising ? start + y : start + height - y; };
      const float low = rising ? std::max(0.0f, -start) : std::max(0.0f, start + height - length);
      const float high = rising ? std::min(height, length - start) : std::min(height, start + height);
      if (high - low < 0.01f) continue;
      const float z = rising ? kWire : -kWire;
      const std::array<glm::vec3, 2> path{{{x_at(low), low + 0.05f, z}, {x_at(high), high + 0.05f, z}}};
      wire.tube(path, kWire, 4);
    }
  }
  for (float x = 0; x <= length + 0.01f; x += 2.4f)
    wire.rod({x, 0, -0.03f}, {x, height + 0.15f, -0.03f}, 0.025f, 10);
  for (const float y : {0.05f, height + 0.05f})
    wire.rod({0, y, -0.03f}, {length, y, -0.03f}, 0.014f, 8);
}

void add_steps(MeshBuilder& stone, float length, int count, float rise, float tread) {
  for (int i = 0; i < count; ++i) {
    const float top = static_cast<float>(i + 1) * rise;
    const float front = static_cast<float>(count - 1 - i) * tread;
    stone.patch({0, top - rise, front}, {length, 0, 0}, {0, rise, 0});
    stone.patch({0, top, front}, {length, 0, 0}, {0, 0, i + 1 < count ? -tread : -0.01f});
    stone.patch({0, 0, front - tread}, {0, 0, tread}, {0, top, 0});
    stone.patch({length, 0, front}, {0, 0, -tread}, {0, top, 0});
  }
}

void add_tile_roof(MeshBuilder& tiles, float length, float depth, float rise) {
  constexpr float kPitch = 0.24f;
  constexpr float kCourse = 0.46f;
  const float slope_length = std::sqrt(depth * depth + rise * rise);
  const glm::vec3 up_slope(0, rise / slope_length, -depth / slope_length);
  const glm::vec3 out(0, depth / slope_length, rise / slope_length);
  const int rows = static_cast<int>(length / kPitch);
  const int courses = static_cast<int>(std::ceil(slope_length / kCourse));
  const float pitch = length / static_cast<float>(rows);
  const glm::vec4 paint = tiles.pen.colour;
  std::uint32_t shade = 12345;
  for (int row = 0; row < rows; ++row) {
    for (int course = 0; course < courses; ++course) {
      shade = shade * 1664525u + 1013904223u;
      const float tone = 0.72f + 0.4f * static_cast<float>(shade >> 24) / 255.0f;
      tiles.pen.colour = paint * glm::vec4(tone, tone * 0.97f, tone * 0.94f, 1);
      const float x = (static_cast<float>(row) + 0.5f) * pitch;
      const glm::vec3 foot = glm::vec3(x, 0, 0) + up_slope * (static_cast<float>(course) * kCourse);
      constexpr int kSides = 6;
      // A half barrel that is wider at its lower end, so that each course overlaps the next.
      std::uint32_t first = 0;
      for (int i = 0; i <= kSides; ++i) {
        const float angle = glm::pi<float>() * (1 - static_cast<float>(i) / kSides);
        const glm::vec3 spread = glm::vec3(1, 0, 0) * std::cos(angle) + out * std::sin(angle);
        const glm::vec3 low = foot + spread * pitch * 0.52f + out * 0.03f;
        const glm::vec3 high = foot + up_slope * (kCourse * 1.02f) + spread * pitch * 0.42f;
        const std::uint32_t index = tiles.vertex(low, spread, {0, 0});
        tiles.vertex(high, spread, {0, 0});
        if (i == 0) first = index;
      }
      for (std::uint32_t i = 0; i < kSides; ++i) {
        const std::uint32_t a = first + 2 * i;
        tiles.triangle(a, a + 2, a + 3);
        tiles.triangle(a, a + 3, a + 1);
      }
    }
  }
  tiles.pen.colour = paint;
  tiles.patch({0, -0.02f, 0}, {length, 0, 0}, up_slope * slope_length);
}

}  // namespace quincunx::scenes
