// SPDX-License-Identifier: MIT
#include "render/draw_list.h"

#include <algorithm>
#include <tuple>

namespace quincunx::scenes {
namespace {

constexpr int kGroupFrom = 12;  // visible instances of a part from which they are drawn in one go

float squared_distance(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = a - b;
  return glm::dot(d, d);
}

// Whether the winding of its triangles is reversed: it may change from frame to frame.
bool is_mirrored(const InstanceData& data) {
  return glm::dot(glm::vec3(data.world[0]), glm::cross(glm::vec3(data.world[1]), glm::vec3(data.world[2]))) <
         0;
}

}  // namespace

void DrawList::append(std::vector<Batch>& batches, const Item& item, const InstanceData& data) {
  const bool joins = !batches.empty() && !batches.back().particles && batches.back().range == item.range &&
                     batches.back().light_set == item.light_set && batches.back().program == item.program &&
                     batches.back().mirrored == item.mirrored;
  if (!joins) {
    batches.push_back({item.range, item.program, item.light_set, item.mirrored,
                       static_cast<std::uint32_t>(instances_.size()), 0, false});
  }
  ++batches.back().count;
  instances_.push_back(data);
}

void DrawList::build_casters(const SceneLayout& layout, const std::vector<InstanceData>& placed,
                             bool moving) {
  items_.clear();
  instances_.clear();
  opaque_.clear();
  blended_.clear();
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const PlacedInstance& instance = layout.instances[i];
    if (!instance.casts_shadow || instance.moves != moving) continue;
    Item item;
    item.range = instance.mesh;
    item.instance = static_cast<std::uint32_t>(i);
    items_.push_back(item);
  }
  std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
    return std::tie(a.range, a.instance) < std::tie(b.range, b.instance);
  });
  for (const Item& item : items_)
    append(opaque_, item, placed[item.instance]);
}

void DrawList::collect(const SceneLayout& layout, const std::vector<InstanceData>& placed,
                       const std::vector<Bounds>& boxes, const Frustum& frustum, const glm::vec3& eye,
                       float least_span) {
  items_.clear();
  blended_items_.clear();
  for (const Piece& piece : layout.pieces) {
    const PlacedInstance& instance = layout.instances[static_cast<std::size_t>(piece.instance)];
    const Bounds& box = instance.moves ? boxes[static_cast<std::size_t>(piece.instance)] : piece.box;
    if (!frustum.may_see(box)) continue;
    const glm::vec3 centre = 0.5f * (box.low + box.high);
    const float to_centre = glm::distance(centre, eye);
    const float diagonal = glm::distance(box.low, box.high);
    if (diagonal < least_span * to_centre) continue;
    const SurfaceFeatures& features = layout.programs[static_cast<std::size_t>(piece.program)];
    Item item;
    item.stage = features.mask ? 1 : 0;
    item.range = piece.part;
    item.program = piece.program;
    item.light_set = piece.light_set;
    item.mirrored = is_mirrored(placed[static_cast<std::size_t>(piece.instance)]);
    item.instance = static_cast<std::uint32_t>(piece.instance);
    item.distance = to_centre;
    if (features.blend) {
      blended_items_.push_back(item);
      continue;
    }
    // Large things (floors, walls) tend to lie behind what stands before them.
    item.distance += 0.5f * diagonal;
    items_.push_back(item);
  }
}

void DrawList::group_repeated_parts(std::size_t parts) {
  part_groups_.assign(parts, {0.0f, 0});
  for (const Item& item : items_) {
    auto& [sum, count] = part_groups_[static_cast<std::size_t>(item.range)];
    sum += item.distance;
    ++count;
  }
  for (Item& item : items_) {
    const auto& [sum, count] = part_groups_[static_cast<std::size_t>(item.range)];
    item.group_distance = count >= kGroupFrom ? sum / static_cast<float>(count) : item.distance;
  }
}

void DrawList::build_view(const SceneLayout& layout, const std::vector<InstanceData>& placed,
                          const std::vector<Bounds>& boxes, const Frustum& frustum, const glm::vec3& eye,
                          float least_span, std::vector<Particle>& particles) {
  instances_.clear();
  opaque_.clear();
  blended_.clear();
  collect(layout, placed, boxes, frustum, eye, least_span);
  group_repeated_parts(layout.parts.size());
  std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
    return std::tie(a.stage, a.group_distance, a.range, a.program, a.light_set, a.mirrored, a.distance,
                    a.instance) < std::tie(b.stage, b.group_distance, b.range, b.program, b.light_set,
                                           b.mirrored, b.distance, b.instance);
  });
  for (const Item& item : items_)
    append(opaque_, item, placed[item.instance]);

  std::sort(blended_items_.begin(), blended_items_.end(), [](const Item& a, const Item& b) {
    return std::tie(b.distance, a.instance) < std::tie(a.distance, b.instance);
  });
  std::stable_sort(particles.begin(), particles.end(), [&](const Particle& a, const Particle& b) {
    return squared_distance(a.position, eye) > squared_distance(b.position, eye);
  });
  merge_blended(placed, eye, particles);
}

void DrawList::merge_blended(const std::vector<InstanceData>& placed, const glm::vec3& eye,
                             const std::vector<Particle>& particles) {
  std::size_t p = 0;
  const auto draw_particles_beyond = [&](float squared) {
    const std::size_t first = p;
    while (p < particles.size() && squared_distance(particles[p].position, eye) > squared)
      ++p;
    if (p == first) return;
    Batch batch;
    batch.particles = true;
    batch.first = static_cast<std::uint32_t>(first);
    batch.count = static_cast<std::uint32_t>(p - first);
    blended_.push_back(batch);
  };
  for (const Item& item : blended_items_) {
    draw_particles_beyond(item.distance * item.distance);
    append(blended_, item, placed[item.instance]);
  }
  draw_particles_beyond(-1);
}

}  // namespace quincunx::scenes
