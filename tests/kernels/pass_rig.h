// SPDX-License-Identifier: MIT
// PassRig: one pass of a plan, run alone on what a test binds to its resources.
#pragma once

#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>

#include "kernel_fixture.h"
#include "passes/pass_chain.h"
#include "picture_params.h"

namespace quincunx::testing {

// A scene in which nothing moves.
inline constexpr SceneNeeds kStill = {.moving_objects = false, .camera_motion = false, .transparents = false};

class PassRig {
 public:
  using Bound = std::initializer_list<std::pair<Resource, ImageView>>;

  // Ends the program where the plan has no pass of this kernel.
  PassRig(const SceneNeeds& needs, const ResolveSettings& settings, std::string_view kernel)
      : PassRig(PlanFacts(needs, settings), kernel) {}
  PassRig(const PlanFacts& facts, std::string_view kernel);

  const PlanFacts& facts() const { return facts_; }

  // Sets the focus for the next run(), until which it stays; null: none.
  void set_focus(const FocusInputs* focus) { focus_ = focus; }

  // Sets the exposure of another history, which the runs to come merge; 0: they merge none.
  void set_other_exposure(float exposure) { other_exposure_ = exposure; }

  // Sets that of the frames to come; 1 at first.
  void set_exposure(const Exposure& exposure) { exposure_ = exposure; }

  // Sets the albedo of the pictures to come; none at first.
  void set_albedo(const ImageView& albedo) { albedo_ = albedo; }

  // On viewports and an output of any size; the inputs of both frames are bound, `bound` adds what else the pass uses.
  // `previous_output`: of the history; {0, 0}: the output.
  void run(const FrameInputs& current, const FrameInputs& previous, Extent output, Counter counter,
           Bound bound, Extent previous_output = {});

 private:
  PlanFacts facts_;
  const FocusInputs* focus_ = nullptr;
  float other_exposure_ = 0;
  Exposure exposure_ = {1, 1, 1, 1};
  ImageView albedo_;
  std::unique_ptr<Pass> pass_;
};

// The spec of a kernel in the plan for these facts. Ends the program where there is none.
PassSpec spec_of(const PlanFacts& facts, std::string_view kernel);

}  // namespace quincunx::testing
