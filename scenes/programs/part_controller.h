// SPDX-License-Identifier: MIT
// PartController: holds the time that one part of a frame takes, by the part's own resolution.
//
// The predictive controller on a ladder of the part's own: it learns from the times of that part what it would cost in
// full, how much of that does not scale, and how noisy it is. Pure; one thread.
#pragma once

#include <cstdint>
#include <memory>

#include "quincunx/resolution_controller.h"

namespace quincunx::scenes {

class PartController {
 public:
  // `whole`: the part's largest extent. `step`: by which a side grows or shrinks, texels. Errors: kInvalidArgument for
  // an empty extent, a step below 1 or a budget outside (0, ResolutionController::kLongestMs].
  static Result<PartController> create(Extent whole, int step, double budget_ms);

  Extent next() const { return controller_->next(); }

  // A part of frame `frame` at `extent` took so long. What is late, or no time, changes nothing.
  void learn(std::uint64_t frame, Extent extent, double ms);

 private:
  explicit PartController(std::unique_ptr<ResolutionController> controller)
      : controller_(std::move(controller)) {}

  std::unique_ptr<ResolutionController> controller_;
};

}  // namespace quincunx::scenes
