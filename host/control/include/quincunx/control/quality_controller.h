// SPDX-License-Identifier: MIT
// QualityController: chooses each frame's render extent and method, so that the expected error is the least that fits.
//
// It knows each method's cost and error at each scale (ErrorFront), the picture's content (ContentStatistics), and, as
// the predictive controller does, the cost of drawing by resolution and the device's backlog. For each method it finds
// the largest resolution that fits the target beside the method's own passes. It moves to the pair with the least
// expected FLIP. From frame to frame the method stays and the resolution follows the load within the predictive
// controller's dead bands.
//
// A change of method has to be worth it (hysteresis), comes once a second at most, and is faded in over a few frames,
// in which both methods run. Right after a cut, where no history is worth anything, or in a fast pan it needs no fade.
// docs/control.md has the rules, the figures and a recipe.
//
//   auto made = make_quality_controller({.pacing = {.ladder = {.output_extent = {1920, 1080}}, .target_ms = 16.7}});
//   each frame:  QualityChoice choice = controller.choice();  draw at choice.render_extent;
//                resolve with choice.method, and with choice.fading_from where there is one;
//                for every timer that has come back, oldest first: controller.observe(frame)
//
// As every controller it is pure: the same calls give the same choices everywhere. Not thread safe.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/advanced/content_statistics.h"
#include "quincunx/advanced/export.h"
#include "quincunx/control/error_front.h"
#include "quincunx/control/predictive_controller.h"

namespace quincunx {

struct QualitySettings {
  PredictiveSettings pacing = {};  // ladder, target, buffers and all else of the predictive controller
  ErrorFront front = ErrorFront::built_in();
  std::vector<MethodVariant> methods =
      {};                    // to choose from, each with points in `front`; empty: all of the front
  double hysteresis = 0.03;  // part of the expected error that a change has to save, in [0, 1)
  double rest_seconds = 1;   // between two changes of method, in [0, 60]
  int fade_frames = 6;       // over which a change is faded in, in [0, 60]; 0: at once
};

// One past frame, as far as it is known.
struct QualityFrame {
  FrameTiming timing;                             // gpu_ms: with the resolve
  double resolve_ms = 0;                          // the method's passes' part of gpu_ms; 0: not known
  std::optional<ContentStatistics> content = {};  // nothing: as the frame before
};

// The extent and method of the next frame.
struct QualityChoice {
  Extent render_extent;  // as ResolutionController::next()
  MethodVariant method;
  // Resolve with this, too, and show `weight` of `method` and the rest of this.
  std::optional<MethodVariant> fading_from = {};
  double weight = 1;  // in (0, 1]; 1 unless fading
};

// A method at a scale, and its expected error and cost.
struct QualityPair {
  MethodVariant method;
  double scale = 1;  // per axis, the root of the area fraction
  double flip = 0;
  double ms = 0;  // the whole frame's
};

// The reasons of the last choice.
struct QualityReasons {
  SceneMix mix;                          // the picture's content, smoothed
  double budget_ms = 0;                  // for a frame while the display's queue is at rest
  QualityPair chosen;                    // the present method at the resolution that the budget allows
  std::vector<QualityPair> others = {};  // every other method at its own resolution, by rising error
  std::optional<QualityPair> next_better =
      {};  // the cheapest pair that errs 2 % less at least; its ms exceed the budget
           // unless hysteresis or rest keep the present method
};

class QUINCUNX_API QualityController : public ResolutionController {
 public:
  using ResolutionController::observe;  // takes a frame of unknown resolve_ms and content

  // Learns from one frame, as the base's. Further errors: kInvalidArgument for a resolve_ms that is negative or not
  // below gpu_ms, or content outside its ranges, which leave the controller as it was.
  virtual Status observe(const QualityFrame& frame) = 0;

  virtual QualityChoice choice() const = 0;
  virtual QualityReasons reasons() const = 0;

 protected:
  using ResolutionController::ResolutionController;
};

// Makes the controller. Before the first frame it chooses the highest resolution with the method that errs least there.
// Errors: kInvalidArgument for a field outside its range, and for a method that the front does not have.
QUINCUNX_API Result<std::unique_ptr<QualityController>> make_quality_controller(
    const QualitySettings& settings);

// Returns the reasons in three or four lines of plain text.
QUINCUNX_API std::string explain(const QualityReasons& reasons);

}  // namespace quincunx
