// SPDX-License-Identifier: MIT
// TargetPool: render targets of the sizes that were asked for most recently.
//
// OpenGL has no memory in which textures could be placed (but what Vulkan allocates), so that targets of exactly a
// viewport's size have to be made. Those of sizes that come back are kept, as long as all of them together have no
// more texels than two of the largest size: as many as a double-buffered allocation would have.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "quincunx_gl/render_targets.h"

namespace quincunx::gl {

class TargetPool {
 public:
  // `largest.target` is the largest size that at() will be asked for. Makes nothing yet.
  explicit TargetPool(const TargetNeeds& largest);

  // Targets of this size, valid until the next call. Throws std::runtime_error where they cannot be made.
  const RenderTargets& at(Extent extent);

  std::uint64_t bytes() const;  // of all that are kept

 private:
  void make_room(Extent extent);

  TargetNeeds needs_;
  std::int64_t most_texels_;
  std::vector<std::unique_ptr<RenderTargets>> kept_;  // the most recently used last
};

}  // namespace quincunx::gl
