// SPDX-License-Identifier: MIT
// MeshBuilder: meshes from simple solids, for the procedural scenes; and how open the sky is to them.
//
// Everything comes out with unit normals, triangles counter-clockwise seen from outside, and texture
// coordinates that read like a picture seen from outside: u to the right, v downwards, in metres times
// Pen::uv_per_metre unless a function says otherwise. Angles in radians, lengths in metres. Not thread-safe;
// cheap to create.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <span>
#include <vector>

#include "scene.h"

namespace quincunx::scenes {

inline constexpr float kTau = glm::two_pi<float>();

// The place and the paint of what is added next.
struct Pen {
  glm::mat4 placement{1};  // mesh from local; no mirroring
  glm::vec4 colour{1};     // vertex colour
  float uv_per_metre = 1;
  float cell = 1e9f;  // longest edge of the pieces of a plane, so that colour can vary over it
};

struct UvRect {
  glm::vec2 top_left{0, 0};
  glm::vec2 bottom_right{1, 1};
};

class MeshBuilder {
 public:
  Pen pen;

  explicit MeshBuilder(int material) { mesh_.material = material; }

  std::uint32_t vertex(glm::vec3 position, glm::vec3 normal, glm::vec2 uv);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // Parallelogram origin + s * right + t * up; its front is where `right` points right and `up` up.
  void patch(glm::vec3 origin, glm::vec3 right, glm::vec3 up);
  void picture(glm::vec3 origin, glm::vec3 right, glm::vec3 up, UvRect uv = {});

  // A leaf: a quad seen from both sides, with one normal for both; uv is the whole texture.
  void card(glm::vec3 centre, glm::vec3 half_right, glm::vec3 half_up, glm::vec3 normal);

  void box(glm::vec3 low, glm::vec3 high);

  // Turned on the y axis. The profile (radius, height) runs from bottom to top; corners sharper than 35
  // degrees stay sharp. No caps: start and end at radius 0 to close it.
  void lathe(std::span<const glm::vec2> profile, int segments);

  // Sweep of a circle; no caps. A closed path must not repeat its first point.
  void tube(std::span<const glm::vec3> path, float radius, int sides, bool closed = false);
  void tube(std::span<const glm::vec3> path, std::span<const float> radii, int sides, bool closed = false);

  void rod(glm::vec3 from, glm::vec3 to, float radius, int sides);  // with caps
  void ring(glm::vec3 centre, glm::vec3 axis, float radius, float thickness, int segments, int sides);
  void annulus(glm::vec3 centre, glm::vec3 normal, float inner, float outer, int segments);
  void sphere(glm::vec3 centre, float radius, int segments);

  // Convex outline in the xy plane, counter-clockwise seen from +z, from z = back to z = front.
  void prism(std::span<const glm::vec2> outline, float back, float front);

  // Flat strip of the given width along a path in the xy plane, facing +z, with round joints and ends.
  void stroke(std::span<const glm::vec2> path, float width, float z);

  bool empty() const { return mesh_.indices.empty(); }
  Mesh take();  // leaves the builder empty, pen and material unchanged

 private:
  Mesh mesh_;
};

// Two unit vectors that make a right-handed frame with the unit vector `axis`: cross(x, y) = axis.
std::array<glm::vec3, 2> frame_around(glm::vec3 axis);

// Points of a wire that hangs between two points; `sag` is how far its middle lies below the chord.
std::vector<glm::vec3> hanging_wire(glm::vec3 from, glm::vec3 to, float sag, int pieces);

// Sets a builder's pen and puts it back: what is added while it lives stands at a place.
class PenScope {
 public:
  PenScope(MeshBuilder& builder, const Pen& pen) : builder_(builder), before_(builder.pen) {
    builder.pen = pen;
  }
  PenScope(MeshBuilder& builder, const glm::mat4& placement) : builder_(builder), before_(builder.pen) {
    builder.pen.placement = placement;
  }
  ~PenScope() { builder_.pen = before_; }
  PenScope(const PenScope&) = delete;
  PenScope& operator=(const PenScope&) = delete;
  MeshBuilder* operator->() const { return &builder_; }
  MeshBuilder& operator*() const { return builder_; }

 private:
  MeshBuilder& builder_;
  Pen before_;
};

struct OcclusionSettings {
  float cell = 0.16f;     // metres: size of the cubes that the scene is measured in
  float reach = 2.6f;     // metres: what is further away does not darken
  int directions = 32;    // over the hemisphere, cosine weighted
  float strength = 0.9f;  // 0: nothing happens, 1: a closed corner turns black
};

// Multiplies the vertex colours of the meshes that stand still once, untransformed, by how open the sky is to
// them. Only opaque materials hide and are darkened, and only where `takes_part(material)` holds. Small, slow
// and simple: a bit per cube, marched through; meant for 1e5 vertices and some seconds at most.
void bake_ambient_occlusion(Scene& scene, const OcclusionSettings& settings,
                            const std::function<bool(const Material&)>& takes_part);

}  // namespace quincunx::scenes
