// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "render/frame_block.h"
#include "scene.h"

namespace quincunx::scenes {

// The distinct sets of lights that reach something, each made once.
class LightSets {
 public:
  explicit LightSets(const Scene& scene) : scene_(scene) {}

  // The lights that reach a world box, as a bit mask.
  std::uint32_t reaching(const Bounds& box) const;
  int index_of(std::uint32_t mask);  // -1 for none
  static int loop_count(
      std::uint32_t mask);  // lights in a mask, rounded up to a count that has a shader variant
  std::vector<LightsBlock> take() { return std::move(blocks_); }

 private:
  const Scene& scene_;
  std::map<std::uint32_t, int> indices_;
  std::vector<LightsBlock> blocks_;
};

}  // namespace quincunx::scenes
