// SPDX-License-Identifier: MIT
// scale_filter: one rendered frame to the output through a separable filter of any width.
#include <fmt/format.h>

#include "filter_params.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "scale_params.h"

namespace quincunx {
namespace {

class ScaleFilterPass : public Pass {
 public:
  ScaleFilterPass(const PassSetup& setup, const PassSpec& spec)
      : Pass(setup, spec), filter_(filter_of(setup.facts.settings.method)) {
    setup.tables.filter(filter_);
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent render = frame.current.render;
    const FilterParams params = filter_params(filter_, shape(), {render, frame[Resource::kColour]},
                                              {extent, frame[picture()]}, frame.counter);
    bind(params, frame.tables.filter(filter_).get(frame.queue, frame.key()), frame[Resource::kColour],
         frame[picture()], frame.counter);
    launch(frame, extent, params.columns_per_item, event);
  }

 private:
  const Filter& filter_;
};

constexpr int kFourTaps = 4;  // of which the kernel has a variant of its own
constexpr int kAnyTaps = 0;

}  // namespace

void plan_scale_filter(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  const Filter* own = own_filter(settings.method);
  if (skips_samples(settings.method)) return;
  const bool clamps = own != nullptr && own->rings && settings.clamp_ringing;
  const auto add = [&](int taps, const std::string& reason, Viewports viewports) {
    list.passes.push_back(
        {.kernel = "scale_filter",
         .options = fmt::format("-D TAPS={} -D CLAMP={} {}", taps, clamps ? 1 : 0, scale_options(settings)),
         .reason = reason,
         .uses = {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
                  {picture_of(facts), Access::kWrite, Area::kOutput, settings.resolved}},
         .make = make_pass<ScaleFilterPass>,
         .frames = facts.accumulates()           ? Frames::kDense
                   : facts.resolves_two_frames() ? Frames::kWithoutHistory
                                                 : Frames::kAll,
         .viewports = viewports});
  };
  const bool has_four_taps = own != nullptr && 2 * own->radius == kFourTaps;
  const bool has_more = own != nullptr && 2 * own->radius > kFourTaps;
  if (has_more) {
    add(kAnyTaps, fmt::format("the method: {0} x {0} samples", 2 * own->radius), Viewports::kAll);
    return;
  }
  if (has_four_taps) add(kFourTaps, "the method: 16 samples", Viewports::kNotWider);
  if (!facts.may_widen()) return;
  if (!facts.accumulates()) {
    add(kAnyTaps, "in its place where a viewport is larger than the output: the filter widens",
        Viewports::kWider);
  } else if (facts.may_be_dense()) {
    add(kAnyTaps, "in place of the history where samples are denser than pixels", Viewports::kWider);
  }
}

}  // namespace quincunx
