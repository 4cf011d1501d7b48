// SPDX-License-Identifier: MIT
// scale_filter: one rendered frame to the output through a separable filter of any width.
#include <fmt/format.h>

#include <algorithm>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

// Output pixels, in whole blocks, whose columns fit into the kernel's array: the first and the last pixel of
// a run of n are (n - 1) * render / output texels apart, and both may round.
int run_length(int render, int output, int taps, int columns) {
  const double step = static_cast<double>(render) / output;
  const int fitting = static_cast<int>((kFilterColumns - taps - 1) / step) + 1;
  return std::min(fitting / kBlock * kBlock, columns);
}

class ScaleFilterPass : public Pass {
 public:
  ScaleFilterPass(const PassSetup& setup, const PassSpec& spec)
      : Pass(setup, spec), filter_(filter_of(setup.facts.settings.method)) {
    setup.tables.filter(filter_);
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent render = frame.current.render;
    const int taps_x = filter_taps(filter_, render.width, extent.width);
    const int taps_y = filter_taps(filter_, render.height, extent.height);
    const int columns = columns_per_item(device(), extent.width);
    const bool narrow = render.width < std::max<int>(taps_x, kBlock) || render.height < taps_y;
    const FilterParams params{
        .output_width = extent.width,
        .output_height = extent.height,
        .source_width = render.width,
        .source_height = render.height,
        .source = layout_of(frame[Resource::kColour]),
        .output = layout_of(frame[picture()]),
        .row_axis = padded_columns(extent),
        .taps_x = taps_x,
        .taps_y = taps_y,
        .inner_x = filter_inner(render.width, extent.width),
        .inner_y = filter_inner(render.height, extent.height),
        .run = narrow ? 0 : std::max(run_length(render.width, extent.width, taps_x, columns), 0),
        .counter = frame.counter.index,
        .columns_per_item = columns};
    bind(params, frame.tables.filter(filter_).get(frame.queue, render, frame.current.jitter),
         frame[Resource::kColour], frame[picture()], frame.counter);
    launch(frame, extent, columns, event);
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
  if (!widens(settings.target, settings.output)) return;
  if (!facts.accumulates()) {
    add(kAnyTaps, "in its place where a viewport is larger than the output: the filter widens",
        Viewports::kWider);
  } else if (is_dense(settings.target, settings.output)) {
    add(kAnyTaps, "in place of the history where samples are denser than pixels", Viewports::kWider);
  }
}

}  // namespace quincunx
