// SPDX-License-Identifier: MIT
// DrawList: what of a scene is seen in a frame, in which order, as few draws as possible. No GL.
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame_block.h"
#include "render/scene_layout.h"
#include "render/view_math.h"

namespace quincunx::scenes {

// One instanced draw.
struct Batch {
  int range = 0;  // index into SceneLayout::parts; of casters, into SceneLayout::meshes
  int program = 0;
  int light_set = -1;
  bool mirrored = false;
  std::uint32_t first = 0;  // into the list's instances (or particles)
  std::uint32_t count = 0;
  bool particles = false;  // then only first and count mean something
};

// Reused from frame to frame: the vectors keep their capacity.
class DrawList {
 public:
  // Casters of shadows, by mesh: either all that stands still or all that moves.
  void build_casters(const SceneLayout& layout, const std::vector<InstanceData>& placed, bool moving);

  // Surfaces within the frustum: opaque front to back (near things hide fill cost; a mesh with many instances stays
  // one draw), then alpha-tested, as `opaque`; blended instances and particles back to front as `blended`.
  // `boxes`: world bounds of this frame. What spans less than `least_span` (its diagonal over its distance)
  // is left out; 0 leaves nothing out. Sorts `particles`.
  void build_view(const SceneLayout& layout, const std::vector<InstanceData>& placed,
                  const std::vector<Bounds>& boxes, const Frustum& frustum, const glm::vec3& eye,
                  float least_span, std::vector<Particle>& particles);

  const std::vector<InstanceData>& instances() const { return instances_; }
  const std::vector<Batch>& opaque() const { return opaque_; }
  const std::vector<Batch>& blended() const { return blended_; }

 private:
  struct Item {
    int stage = 0;  // 0 opaque, 1 alpha-tested
    float group_distance = 0;
    int range = 0;
    int program = 0;
    int light_set = -1;
    bool mirrored = false;
    float distance = 0;
    std::uint32_t instance = 0;
  };

  void collect(const SceneLayout& layout, const std::vector<InstanceData>& placed,
               const std::vector<Bounds>& boxes, const Frustum& frustum, const glm::vec3& eye,
               float least_span);
  void group_repeated_parts(std::size_t parts);
  void append(std::vector<Batch>& batches, const Item& item, const InstanceData& data);
  void merge_blended(const std::vector<InstanceData>& placed, const glm::vec3& eye,
                     const std::vector<Particle>& particles);

  std::vector<Item> items_;
  std::vector<Item> blended_items_;
  std::vector<std::pair<float, int>> part_groups_;  // sum of distances, count
  std::vector<InstanceData> instances_;
  std::vector<Batch> opaque_;
  std::vector<Batch> blended_;
};

}  // namespace quincunx::scenes
