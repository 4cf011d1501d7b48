// SPDX-License-Identifier: MIT
// The node tree of a glTF file and its animation, as pure functions of time. Private to the glTF loader.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace quincunx::scenes {

enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// Values of one property over time; clamped to the first and the last key.
struct Track {
  Interpolation interpolation = Interpolation::kLinear;
  bool rotation = false;  // x y z w, unit: linear means slerp, a spline is normalised
  int components = 3;
  std::vector<float> times;   // ascending, seconds
  std::vector<float> values;  // values of each key; for a spline in-tangent, value, out-tangent

  glm::vec4 at(double seconds) const;
};

// Immutable once built, so that any number of motions may share it and any thread may ask.
class NodeTree {
 public:
  // Takes the first animation of the file; others are named in a warning. Throws GltfError.
  explicit NodeTree(GltfDocument& document);

  double duration() const { return duration_; }  // seconds; 0: nothing moves
  bool is_animated(int node) const { return nodes_[static_cast<std::size_t>(node)].animated; }

  // World from node. Time runs round: `duration()` seconds are 0 seconds again.
  glm::mat4 world(int node, double seconds) const;

 private:
  enum Path : std::uint8_t { kTranslation, kRotation, kScale };
  struct Node {
    int parent = -1;
    glm::mat4 matrix{1};  // parent from node, where nothing animates the node itself
    glm::vec3 translation{0};
    glm::vec4 rotation{0, 0, 0, 1};
    glm::vec3 scale{1};
    std::array<int, 3> tracks = {-1, -1, -1};  // per Path
    bool animated = false;                     // itself or a node above
    bool has_matrix = false;
  };

  void read_pose(const tinygltf::Node& source, int index);
  void read_animation(GltfDocument& document, int index);
  int read_track(const GltfDocument& document, const tinygltf::Animation& animation, int sampler, Path path,
                 const std::string& who);
  glm::mat4 local(const Node& node, double seconds) const;

  std::vector<Node> nodes_;
  std::vector<Track> tracks_;
  double duration_ = 0;
};

}  // namespace quincunx::scenes
