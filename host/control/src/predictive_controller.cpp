// SPDX-License-Identifier: MIT
#include "quincunx/control/predictive_controller.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "predictive_model.h"

namespace quincunx {

Status check(const PredictiveSettings& settings) {
  if (settings.buffers < 2 || settings.buffers > 8) {
    return Status::invalid(fmt::format("buffers is {}; it must lie in [2, 8]", settings.buffers));
  }
  if (!(settings.fixed_part >= 0 && settings.fixed_part <= 0.9)) {
    return Status::invalid(fmt::format("fixed_part is {}; it must lie in [0, 0.9]", settings.fixed_part));
  }
  const BlurAware& blur = settings.blur_aware;
  if (!(blur.start_px >= 0 && blur.full_px > blur.start_px && std::isfinite(blur.full_px))) {
    return Status::invalid(fmt::format(
        "blur_aware.start_px is {} and full_px {}; the first must be at least 0 and below the second",
        blur.start_px, blur.full_px));
  }
  if (!(blur.min_scale > 0 && blur.min_scale <= 1)) {
    return Status::invalid(fmt::format("blur_aware.min_scale is {}; it must lie in (0, 1]", blur.min_scale));
  }
  return {};
}

namespace {

class PredictiveController final : public ResolutionController {
 public:
  static Result<std::unique_ptr<ResolutionController>> create(const PredictiveSettings& settings) {
    if (Status status = check_target(settings.target_ms); !status.ok()) return status;
    if (Status status = quincunx::check(settings); !status.ok()) return status;
    Result<ResolutionLadder> ladder = ResolutionLadder::create(settings.ladder);
    if (!ladder.ok()) return ladder.status();
    return std::unique_ptr<ResolutionController>(
        new PredictiveController(std::move(ladder).value(), settings));
  }

  const char* name() const override { return "predictive"; }

 private:
  PredictiveController(ResolutionLadder steps, const PredictiveSettings& settings)
      : ResolutionController(std::move(steps), settings.target_ms), model_(ladder(), settings) {}

  int choose(const FrameTiming& timing) override {
    model_.observe(timing, 0, target_ms());
    const int result = model_.wanted_rung(rung(), 0);
    model_.choose(rung(), result, 0);
    return result;
  }

  PredictiveModel model_;
};

}  // namespace

Result<std::unique_ptr<ResolutionController>> make_predictive_controller(const PredictiveSettings& settings) {
  return PredictiveController::create(settings);
}

}  // namespace quincunx
