// SPDX-License-Identifier: MIT
#include "programs/part_controller.h"

#include "quincunx/predictive_controller.h"
#include "render/frame_parts.h"

namespace quincunx::scenes {

Result<PartController> PartController::create(Extent whole, int step, double budget_ms) {
  auto controller = make_predictive_controller({.ladder = {.output = whole,
                                                           .min_scale = kLeastPartScale,
                                                           .max_scale = 1,
                                                           .order = AxisOrder::kBoth,
                                                           .step = step},
                                                .target_ms = budget_ms});
  if (!controller.ok()) return controller.status();
  return PartController(std::move(controller).value());
}

void PartController::learn(std::uint64_t frame, Extent extent, double ms) {
  static_cast<void>(controller_->observe({.frame = frame, .render = extent, .gpu_ms = ms}));
}

}  // namespace quincunx::scenes
