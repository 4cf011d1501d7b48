// SPDX-License-Identifier: MIT
// Every controller that the library makes, for tests of what they share.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "quincunx/control/predictive_controller.h"
#include "quincunx/control/quality_controller.h"
#include "quincunx/control/resolution_controller.h"

namespace quincunx::testing {

using Controller = std::unique_ptr<ResolutionController>;

struct ControllerKind {
  std::string name;
  std::function<Result<Controller>(const LadderSettings&, double target_ms)> make;
};

// Those that choose nothing but the resolution.
inline std::vector<ControllerKind> resolution_controllers() {
  return {
      {"proportional",
       [](const LadderSettings& ladder, double target_ms) {
         return make_proportional_controller({.ladder = ladder, .target_ms = target_ms});
       }},
      {"minimum_of_n",
       [](const LadderSettings& ladder, double target_ms) {
         return make_minimum_of_n_controller({.ladder = ladder, .target_ms = target_ms});
       }},
      {"predictive",
       [](const LadderSettings& ladder, double target_ms) {
         return make_predictive_controller({.ladder = ladder, .target_ms = target_ms});
       }},
      {"predictive_two_buffers",
       [](const LadderSettings& ladder, double target_ms) {
         return make_predictive_controller({.ladder = ladder,
                                            .target_ms = target_ms,
                                            .buffers = 2,
                                            .cpu_bound = CpuBound::kFollow,
                                            .blur_aware = {.enabled = true}});
       }},
  };
}

inline std::vector<ControllerKind> all_controllers() {
  std::vector<ControllerKind> kinds = resolution_controllers();
  kinds.push_back({"quality", [](const LadderSettings& ladder, double target_ms) -> Result<Controller> {
                     QualitySettings settings;
                     settings.pacing.ladder = ladder;
                     settings.pacing.target_ms = target_ms;
                     auto made = make_quality_controller(settings);
                     if (!made.ok()) return made.status();
                     return Controller(std::move(made).value());
                   }});
  return kinds;
}

}  // namespace quincunx::testing
