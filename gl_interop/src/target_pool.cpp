// SPDX-License-Identifier: MIT
#include "target_pool.h"

#include <algorithm>
#include <numeric>

namespace quincunx::gl {

TargetPool::TargetPool(const TargetNeeds& largest)
    : needs_(largest), most_texels_(2 * largest.target.area()) {}

void TargetPool::make_room(Extent extent) {
  std::int64_t texels = extent.area();
  for (const auto& targets : kept_)
    texels += targets->extent().area();
  auto oldest = kept_.begin();
  for (; oldest != kept_.end() && texels > most_texels_; ++oldest)
    texels -= (*oldest)->extent().area();
  kept_.erase(kept_.begin(), oldest);
}

const RenderTargets& TargetPool::at(Extent extent) {
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept->extent() == extent; });
  if (found != kept_.end()) {
    std::rotate(found, found + 1, kept_.end());
  } else {
    make_room(extent);
    TargetNeeds needs = needs_;
    needs.target = extent;
    kept_.push_back(std::make_unique<RenderTargets>(needs));
  }
  return *kept_.back();
}

std::uint64_t TargetPool::bytes() const {
  return std::accumulate(kept_.begin(), kept_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const auto& targets) { return sum + targets->bytes(); });
}

}  // namespace quincunx::gl
