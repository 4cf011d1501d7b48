// SPDX-License-Identifier: MIT
#include "builtin/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

namespace quincunx::scenes {

namespace {

constexpr float kSharpCosine = 0.82f;  // cos 35 degrees

int pieces_of(float length, float cell) {
  constexpr float kMostPieces = 256;
  return static_cast<int>(std::clamp(std::ceil(length / cell - 1e-4f), 1.0f, kMostPieces));
}

glm::vec2 outward_of(glm::vec2 from, glm::vec2 to) {
  const glm::vec2 along = to - from;
  const float length = glm::length(along);
  return length > 0 ? glm::vec2(along.y, -along.x) / length : glm::vec2(1, 0);
}

}  // namespace

std::array<glm::vec3, 2> frame_around(glm::vec3 axis) {
  const glm::vec3 helper = std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 x = glm::normalize(glm::cross(helper, axis));
  return {x, glm::cross(axis, x)};
}

std::vector<glm::vec3> hanging_wire(glm::vec3 from, glm::vec3 to, float sag, int pieces) {
  std::vector<glm::vec3> points;
  points.reserve(static_cast<std::size_t>(pieces) + 1);
  for (int i = 0; i <= pieces; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(pieces);
    points.push_back(glm::mix(from, to, t) - glm::vec3(0, sag * 4 * t * (1 - t), 0));
  }
  return points;
}

std::uint32_t MeshBuilder::vertex(glm::vec3 position, glm::vec3 normal, glm::vec2 uv) {
  const glm::mat3 linear(pen.placement);
  const glm::mat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
  mesh_.vertices.push_back({glm::vec3(pen.placement * glm::vec4(position, 1)),
                            glm::normalize(cofactors * normal), uv, pen.colour});
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
}

void MeshBuilder::patch(glm::vec3 origin, glm::vec3 right, glm::vec3 up) {
  const glm::vec2 size = glm::vec2(glm::length(right), glm::length(up)) * pen.uv_per_metre;
  // Texture coordinates continue over neighbouring patches: they start at the origin's distance along each
  // edge.
  const glm::vec2 start =
      glm::vec2(glm::dot(origin, glm::normalize(right)), -glm::dot(origin, glm::normalize(up))) *
      pen.uv_per_metre;
  picture(origin, right, up, {start - glm::vec2(0, size.y), start + glm::vec2(size.x, 0)});
}

void MeshBuilder::picture(glm::vec3 origin, glm::vec3 right, glm::vec3 up, UvRect uv) {
  const glm::vec3 normal = glm::normalize(glm::cross(right, up));
  const int columns = pieces_of(glm::length(right), pen.cell);
  const int rows = pieces_of(glm::length(up), pen.cell);
  const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const glm::vec2 at(static_cast<float>(i) / static_cast<float>(columns),
                         static_cast<float>(j) / static_cast<float>(rows));
      vertex(origin + at.x * right + at.y * up, normal,
             {glm::mix(uv.top_left.x, uv.bottom_right.x, at.x),
              glm::mix(uv.bottom_right.y, uv.top_left.y, at.y)});
    }
  }
  const std::uint32_t stride = static_cast<std::uint32_t>(columns) + 1;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = first + static_cast<std::uint32_t>(j) * stride + static_cast<std::uint32_t>(i);
      triangle(a, a + 1, a + stride + 1);
      triangle(a, a + stride + 1, a + stride);
    }
  }
}

void MeshBuilder::card(glm::vec3 centre, glm::vec3 half_right, glm::vec3 half_up, glm::vec3 normal) {
  const std::uint32_t a = vertex(centre - half_right - half_up, normal, {0, 1});
  vertex(centre + half_right - half_up, normal, {1, 1});
  vertex(centre + half_right + half_up, normal, {1, 0});
  vertex(centre - half_right + half_up, normal, {0, 0});
  triangle(a, a + 1, a + 2);
  triangle(a, a + 2, a + 3);
  triangle(a, a + 2, a + 1);
  triangle(a, a + 3, a + 2);
}

void MeshBuilder::box(glm::vec3 low, glm::vec3 high) {
  const glm::vec3 size = high - low;
  const glm::vec3 x(size.x, 0, 0);
  const glm::vec3 y(0, size.y, 0);
  const glm::vec3 z(0, 0, size.z);
  patch(low + z, x, y);       // front, +z
  patch(low + x, -x, y);      // back
  patch(low + x + z, -z, y);  // right
  patch(low, z, y);           // left
  patch(low + y + z, x, -z);  // top
  patch(low, x, z);           // bottom
}

void MeshBuilder::lathe(std::span<const glm::vec2> profile, int segments) {
  const auto row = [&](glm::vec2 point, glm::vec2 normal, float along) {
    for (int i = 0; i <= segments; ++i) {
      const float turn = static_cast<float>(i) / static_cast<float>(segments);
      const float angle = kTau * static_cast<float>(i % segments) / static_cast<float>(segments);
      const glm::vec3 out(std::sin(angle), 0, std::cos(angle));
      // The same repeats all the way up: a whole number round the widest place would differ from part to
      // part.
      vertex(out * point.x + glm::vec3(0, point.y, 0), out * normal.x + glm::vec3(0, normal.y, 0),
             {std::round(4 * pen.uv_per_metre) * turn, -along * pen.uv_per_metre});
    }
  };
  float along = 0;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const glm::vec2 own = outward_of(profile[k], profile[k + 1]);
    const auto blend = [&](glm::vec2 other) {
      return glm::dot(own, other) > kSharpCosine ? glm::normalize(own + other) : own;
    };
    const glm::vec2 low = k > 0 ? blend(outward_of(profile[k - 1], profile[k])) : own;
    const glm::vec2 high = k + 2 < profile.size() ? blend(outward_of(profile[k + 1], profile[k + 2])) : own;
    const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
    row(profile[k], low, along);
    along += glm::length(profile[k + 1] - profile[k]);
    row(profile[k + 1], high, along);
    const std::uint32_t stride = static_cast<std::uint32_t>(segments) + 1;
    for (std::uint32_t i = first; i + 1 < first + stride; ++i) {
      if (profile[k].x > 0) triangle(i, i + 1, i + stride + 1);
      if (profile[k + 1].x > 0) triangle(i, i + stride + 1, i + stride);
    }
  }
}

void MeshBuilder::tube(std::span<const glm::vec3> path, float radius, int sides, bool closed) {
  const std::vector<float> radii(path.size(), radius);
  tube(path, radii, sides, closed);
}

void MeshBuilder::tube(std::span<const glm::vec3> path, std::span<const float> radii, int sides,
                       bool closed) {
  const std::size_t count = path.size();
  const std::size_t rows = closed ? count + 1 : count;
  const auto tangent_at = [&](std::size_t k) {
    const glm::vec3 before = closed ? path[(k + count - 1) % count] : path[k > 0 ? k - 1 : 0];
    const glm::vec3 after = closed ? path[(k + 1) % count] : path[std::min(k + 1, count - 1)];
    return glm::normalize(after - before);
  };
  glm::vec3 tangent = tangent_at(0);
  glm::vec3 side = frame_around(tangent)[0];
  const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
  float along = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t k = row % count;
    if (row > 0) along += glm::length(path[k] - path[row - 1]);
    tangent = tangent_at(k);
    side = glm::normalize(side - tangent * glm::dot(side, tangent));
    if (closed && row == count) side = frame_around(tangent)[0];
    const glm::vec3 up = glm::cross(tangent, side);
    for (int i = 0; i <= sides; ++i) {
      const float turn = static_cast<float>(i) / static_cast<float>(sides);
      const float angle = kTau * static_cast<float>(i % sides) / static_cast<float>(sides);
      const glm::vec3 out = side * std::cos(angle) + up * std::sin(angle);
      vertex(path[k] + out * radii[k], out, {turn, -along * pen.uv_per_metre});
    }
  }
  const std::uint32_t stride = static_cast<std::uint32_t>(sides) + 1;
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t i = 0; i + 1 < stride; ++i) {
      const std::uint32_t a = first + row * stride + i;
      triangle(a, a + 1, a + stride + 1);
      triangle(a, a + stride + 1, a + stride);
    }
  }
}

void MeshBuilder::rod(glm::vec3 from, glm::vec3 to, float radius, int sides) {
  const std::array<glm::vec3, 2> path{from, to};
  const glm::vec3 axis = glm::normalize(to - from);
  tube(path, radius, sides);
  annulus(from, -axis, 0, radius, sides);
  annulus(to, axis, 0, radius, sides);
}

void MeshBuilder::ring(glm::vec3 centre, glm::vec3 axis, float radius, float thickness, int segments,
                       int sides) {
  const auto [x, y] = frame_around(axis);
  std::vector<glm::vec3> path;
  path.reserve(static_cast<std::size_t>(segments));
  for (int i = 0; i < segments; ++i) {
    const float angle = kTau * static_cast<float>(i) / static_cast<float>(segments);
    path.push_back(centre + radius * (std::cos(angle) * x + std::sin(angle) * y));
  }
  tube(path, thickness, sides, true);
}

void MeshBuilder::annulus(glm::vec3 centre, glm::vec3 normal, float inner, float outer, int segments) {
  const auto [x, y] = frame_around(normal);
  const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (int i = 0; i <= segments; ++i) {
    const float angle = kTau * static_cast<float>(i % segments) / static_cast<float>(segments);
    const glm::vec2 at(std::cos(angle), std::sin(angle));
    for (const float radius : {inner, outer}) {
      vertex(centre + radius * (at.x * x + at.y * y), normal,
             glm::vec2(at.x, -at.y) * radius * pen.uv_per_metre);
    }
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
    const std::uint32_t a = first + 2 * i;
    triangle(a, a + 1, a + 3);
    if (inner > 0) triangle(a, a + 3, a + 2);
  }
}

void MeshBuilder::sphere(glm::vec3 centre, float radius, int segments) {
  const int rows = std::max(segments / 2, 2);
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= rows; ++i) {
    const float angle = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rows);
    const bool pole = i == 0 || i == rows;
    profile.emplace_back(pole ? 0.0f : radius * std::sin(angle), -radius * std::cos(angle));
  }
  const std::size_t first = mesh_.vertices.size();
  const glm::mat4 outer = pen.placement;
  pen.placement = outer * glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                                    glm::vec4(centre, 1));
  lathe(profile, segments);
  const glm::vec3 middle(pen.placement[3]);
  for (std::size_t i = first; i < mesh_.vertices.size(); ++i) {
    mesh_.vertices[i].normal = glm::normalize(mesh_.vertices[i].position - middle);
  }
  pen.placement = outer;
}

void MeshBuilder::prism(std::span<const glm::vec2> outline, float back, float front) {
  const std::size_t count = outline.size();
  for (const bool is_front : {true, false}) {
    const std::uint32_t first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const glm::vec2 point : outline) {
      vertex(glm::vec3(point, is_front ? front : back), {0, 0, is_front ? 1 : -1},
             glm::vec2(is_front ? point.x : -point.x, -point.y) * pen.uv_per_metre);
    }
    for (std::uint32_t i = 1; i + 1 < count; ++i) {
      if (is_front) {
        triangle(first, first + i, first + i + 1);
      } else {
        triangle(first, first + i + 1, first + i);
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 from = outline[i];
    const glm::vec2 along = outline[(i + 1) % count] - from;
    patch(glm::vec3(from, front), glm::vec3(0, 0, back - front), glm::vec3(along, 0));
  }
}

void MeshBuilder::stroke(std::span<const glm::vec2> path, float width, float z) {
  constexpr int kCapPieces = 12;
  constexpr float kBevelCosine = 0.7f;
  const glm::vec3 front(0, 0, 1);
  const auto corner = [&](glm::vec2 at) { return vertex(glm::vec3(at, z), front, {0, 0}); };
  glm::vec2 previous(0);
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const glm::vec2 along = path[k + 1] - path[k];
    const float length = glm::length(along);
    if (length <= 0) continue;
    const glm::vec2 side = glm::vec2(-along.y, along.x) / length * (width / 2);
    const std::uint32_t a = corner(path[k] - side);
    corner(path[k + 1] - side);
    corner(path[k + 1] + side);
    corner(path[k] + side);
    triangle(a, a + 1, a + 2);
    triangle(a, a + 2, a + 3);
    if (previous != glm::vec2(0)) {
      if (glm::dot(previous, side) < kBevelCosine * width * width / 4) {
        annulus(glm::vec3(path[k], z), front, 0, width / 2, kCapPieces);
      } else {  // a slight bend: one triangle fills the gap on its outer side
        const bool left_turn = previous.x * side.y - previous.y * side.x > 0;
        const std::uint32_t b = corner(path[k]);
        corner(left_turn ? path[k] - previous : path[k] + side);
        corner(left_turn ? path[k] - side : path[k] + previous);
        triangle(b, b + 1, b + 2);
      }
    }
    previous = side;
  }
  for (const glm::vec2 end : {path.front(), path.back()}) {
    annulus(glm::vec3(end, z), front, 0, width / 2, kCapPieces);
  }
}

Mesh MeshBuilder::take() {
  Mesh result = std::move(mesh_);
  mesh_ = Mesh();
  mesh_.material = result.material;
  return result;
}

namespace {

// One byte per cube: whether a surface crosses it.
class CubeGrid {
 public:
  CubeGrid(const Bounds& bounds, float cell) : low_(bounds.low - cell), cell_(cell) {
    size_ = glm::ivec3(glm::ceil((bounds.high - bounds.low) / cell)) + 3;
    filled_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                       static_cast<std::size_t>(size_.z),
                   0);
  }

  void fill(glm::vec3 point) {
    const std::ptrdiff_t at = index_of(point);
    if (at >= 0) filled_[static_cast<std::size_t>(at)] = 1;
  }
  bool is_filled(glm::vec3 point) const {
    const std::ptrdiff_t at = index_of(point);
    return at >= 0 && filled_[static_cast<std::size_t>(at)] != 0;
  }

 private:
  std::ptrdiff_t index_of(glm::vec3 point) const {
    const glm::ivec3 at(glm::floor((point - low_) / cell_));
    if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, size_))) return -1;
    return (static_cast<std::ptrdiff_t>(at.z) * size_.y + at.y) * size_.x + at.x;
  }

  glm::vec3 low_;
  float cell_;
  glm::ivec3 size_{0};
  std::vector<unsigned char> filled_;
};

void fill_triangle(CubeGrid& grid, glm::vec3 a, glm::vec3 b, glm::vec3 c, float cell) {
  const float longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
  const int steps = static_cast<int>(std::ceil(longest / (cell * 0.5f)));
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const float u = steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0;
      const float v = steps > 0 ? static_cast<float>(j) / static_cast<float>(steps) : 0;
      grid.fill(a + u * (b - a) + v * (c - a));
    }
  }
}

// Cosine-weighted directions about +z, on a golden spiral.
std::vector<glm::vec3> hemisphere(int count) {
  std::vector<glm::vec3> directions;
  constexpr float kGoldenAngle = 2.39996323f;
  for (int i = 0; i < count; ++i) {
    const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
    const float angle = kGoldenAngle * static_cast<float>(i);
    directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                            std::sqrt(1 - radius * radius));
  }
  return directions;
}

float openness(const CubeGrid& grid, const Vertex& vertex, const std::vector<glm::vec3>& directions,
               const OcclusionSettings& settings) {
  const auto [x, y] = frame_around(vertex.normal);
  // Off the surface's own layer of cubes, whichever way it slopes.
  const glm::vec3 start = vertex.position + vertex.normal * (1.8f * settings.cell);
  float hidden = 0;
  for (const glm::vec3 direction : directions) {
    const glm::vec3 ray = direction.x * x + direction.y * y + direction.z * vertex.normal;
    for (float distance = 0; distance < settings.reach; distance += settings.cell) {
      if (grid.is_filled(start + ray * distance)) {
        hidden += 1 - distance / settings.reach;
        break;
      }
    }
  }
  return 1 - settings.strength * hidden / static_cast<float>(directions.size());
}

}  // namespace

void bake_ambient_occlusion(Scene& scene, const OcclusionSettings& settings,
                            const std::function<bool(const Material&)>& takes_part) {
  std::vector<Mesh*> meshes;
  Bounds bounds{glm::vec3(1e9f), glm::vec3(-1e9f)};
  for (const Instance& instance : scene.instances) {
    Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    const bool still = !instance.motion && instance.transform == glm::mat4(1);
    if (!still || material.alpha_mode != AlphaMode::kOpaque || !takes_part(material)) continue;
    meshes.push_back(&mesh);
    for (const Vertex& vertex : mesh.vertices) {
      bounds.low = glm::min(bounds.low, vertex.position);
      bounds.high = glm::max(bounds.high, vertex.position);
    }
  }
  if (meshes.empty()) return;
  CubeGrid grid(bounds, settings.cell);
  for (const Mesh* mesh : meshes) {
    for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
      fill_triangle(grid, mesh->vertices[mesh->indices[i]].position,
                    mesh->vertices[mesh->indices[i + 1]].position,
                    mesh->vertices[mesh->indices[i + 2]].position, settings.cell);
    }
  }
  const std::vector<glm::vec3> directions = hemisphere(settings.directions);
  for (Mesh* mesh : meshes) {
    for (Vertex& vertex : mesh->vertices) {
      const float open = openness(grid, vertex, directions, settings);
      // Light that comes round corners has been reflected once more, and so is warmer.
      vertex.colour *= glm::vec4(std::pow(open, 0.92f), open, std::pow(open, 1.08f), 1);
    }
  }
}

}  // namespace quincunx::scenes
