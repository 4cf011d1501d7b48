// SPDX-License-Identifier: MIT
#include "quincunx/predictive_controller.h"

#include <utility>

#include "predictive_model.h"
#include "predictive_settings.h"

namespace quincunx {
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
