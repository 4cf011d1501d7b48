// SPDX-License-Identifier: MIT
// A front and a machine that are written down here, and a program that draws as a quality controller tells it to.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "quincunx/quality_controller.h"

namespace quincunx::testing {

constexpr FrontMethod kPlain = {.method = Method::kBilinear};
constexpr FrontMethod kTwo = {.method = Method::kQuincunx};
constexpr FrontMethod kDear = {.method = Method::kTemporal};
constexpr double kTargetMs = 20;
constexpr LadderSettings kLadder = {.output = {1000, 1000}, .order = AxisOrder::kBoth};  // one megapixel

// Milliseconds of a method's passes, of an output of one megapixel.
inline double passes_ms(const FrontMethod& method) {
  return method == kPlain ? 0.5 : method == kTwo ? 2 : 6;
}

// In a still picture the dear method errs least by far; in light the plain one does; between them, the second.
inline double flip(SceneClass scene_class, const FrontMethod& method, double scale) {
  const bool light = scene_class == SceneClass::kLight;
  const double at_one = method == kPlain ? (light ? 0.05 : 0.08)
                        : method == kTwo ? 0.06
                                         : (light ? 0.09 : 0.03);
  return at_one * (1 + 0.8 * (1 - scale));
}

inline ErrorFront front(double ms_factor = 1) {
  std::vector<FrontPoint> points;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    for (const FrontMethod& method : {kPlain, kTwo, kDear}) {
      for (const double scale : {0.5, 1.0}) {
        FrontPoint point = {.scene_class = static_cast<SceneClass>(i), .method = method, .scale = scale};
        point.flip = flip(point.scene_class, method, scale);
        point.psnr_db = 30;
        point.ms_per_megapixel = passes_ms(method) * ms_factor;
        points.push_back(point);
      }
    }
  }
  FrontSource source;
  source.device = "a machine written down";
  source.output = kLadder.output;
  return ErrorFront::create(source, points).value();
}

inline QualitySettings usual_settings() {
  QualitySettings settings;
  settings.pacing.ladder = kLadder;
  settings.pacing.target_ms = kTargetMs;
  settings.front = front();
  return settings;
}
using Change = std::function<void(QualitySettings&)>;

// A program that draws what it is told to.
class Program {
 public:
  explicit Program(const Change& change = {}) {
    QualitySettings settings = usual_settings();
    if (change) change(settings);
    auto made = make_quality_controller(settings);
    if (!made.ok()) throw std::invalid_argument(made.status().message());
    controller_ = std::move(made).value();
  }

  // Frames whose drawing takes so long at the output resolution.
  void run(int frames, double full_ms, std::optional<ContentStatistics> content, bool timed = true) {
    for (int i = 0; i < frames; ++i) {
      const QualityChoice choice = controller_->choice();
      const double area = controller_->ladder().area_fraction(choice.render);
      const double passes =
          passes_ms(choice.method) + (choice.fading_from ? passes_ms(*choice.fading_from) : 0);
      QualityFrame frame = {.timing = {.frame = frame_++, .render = choice.render}};
      frame.timing.gpu_ms = full_ms * (0.2 + 0.8 * area) + passes;
      frame.timing.cpu_ms = cpu_ms;
      frame.timing.interval_ms = std::max(kTargetMs, frame.timing.gpu_ms);
      frame.timing.queued = 1;
      frame.resolve_ms = timed ? passes : 0;
      frame.content = content;
      if (content) content->cut = false;
      last_ms = frame.timing.gpu_ms;
      const QualityChoice before = choice;
      ASSERT_TRUE(controller_->observe(frame).ok());
      if (!(controller_->choice().method == before.method)) ++changes;
      if (controller_->choice().fading_from) ++faded;
    }
  }
  QualityController& operator*() { return *controller_; }
  QualityController* operator->() { return controller_.get(); }

  double cpu_ms = 4;
  double last_ms = 0;
  int changes = 0;
  int faded = 0;

 private:
  std::unique_ptr<QualityController> controller_;
  std::uint64_t frame_ = 0;
};

}  // namespace quincunx::testing
