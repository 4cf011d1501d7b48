// SPDX-License-Identifier: MIT
// The node tree of a glTF file and its animation, as pure functions of time. Private to the glTF loader.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace quincunx::scenes {

enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// The values of one property over time; clamped to the first and the last key.
struct Track {
  Interpolation interpolation = Interpolation::kLinear;
  bool rotation = false;  // x y z w, unit: linear means slerp, a spline is normalised
  int components = 3;
  std::vector<float> times;   // ascending, seconds
  std::vector<float> values;  // values of each key; for a spline in-tangent, value, out-tangent

  glm::vec4 at(double seconds) const;
};

// Any number of motions may share it, and any thread may ask.
class NodeTree {
 public:
  // Takes the first animation of the file; others are named in a warning. Throws GltfError.
  explicit NodeTree(GltfDocument& document);

  double duration() const { return duration_; }  // seconds; 0: nothing moves
  bool is_animated(int node) const { return nodes_[static_cast<std::size_t>(node)].animated; }

  // Returns world from node. Time runs round: `duration()` seconds are 0 seconds again. The last two times of all nodes
  // are kept, so that a frame and the one before cost as much as there are nodes, however deep these are.
  glm::mat4 world(int node, double seconds) const;

 private:
  enum Path : std::uint8_t { kTranslation, kRotation, kScale };
  struct Node {
    int parent = -1;
    glm::mat4 matrix{1};  // parent from node, where nothing animates the node itself
    glm::mat4 still{1};   // world from node at time 0
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

  struct Moment {
    double seconds = std::numeric_limits<double>::quiet_NaN();
    std::vector<glm::mat4> worlds;  // of all animated nodes
  };

  std::vector<Node> nodes_;
  std::vector<int> order_;    // of all nodes, each after its parent
  mutable std::mutex mutex_;  // of the next two
  mutable std::array<Moment, 2> moments_;
  mutable std::size_t oldest_ = 0;
  std::vector<Track> tracks_;
  double duration_ = 0;
};

}  // namespace quincunx::scenes
