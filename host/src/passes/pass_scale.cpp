// SPDX-License-Identifier: MIT
// The passes that scale one picture: scale_point, scale_bilinear, scale_noise, scale_noise_offset, scale_filter.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "resolve_params.h"

namespace quincunx {
namespace {

// A picture that a filter reads or makes: the top left `extent` of `view`.
struct FilterPicture {
  Extent extent;
  const ImageView& view;
};

// Returns the output pixels, in whole blocks, whose columns fit into the kernel's array: the first and the last pixel
// of a run of n are (n - 1) * render / output texels apart, and both may round.
int run_length(int render, int output, int taps, int columns) {
  const double step = static_cast<double>(render) / output;
  const int fitting = static_cast<int>((kFilterColumns - taps - 1) / step) + 1;
  return std::min(fitting / kBlock * kBlock, columns);
}

// Returns the parameters for the tables of `filter` from the one extent to the other.
FilterParams filter_params(const Filter& filter, const WorkShape& shape, const FilterPicture& from,
                           const FilterPicture& to, const Counter& counter) {
  const Extent render = from.extent;
  const Extent extent = to.extent;
  const int taps_x = filter_taps(filter, render.width, extent.width);
  const int taps_y = filter_taps(filter, render.height, extent.height);
  const int columns = columns_per_item(shape, extent.width);
  const bool narrow = render.width < std::max<int>(taps_x, kBlock) || render.height < taps_y;
  return {.output_width = extent.width,
          .output_height = extent.height,
          .source_width = render.width,
          .source_height = render.height,
          .source = layout_of(from.view),
          .output = layout_of(to.view),
          .row_axis = padded_columns(extent),
          .taps_x = taps_x,
          .taps_y = taps_y,
          .inner_x = filter_inner(render.width, extent.width),
          .inner_y = filter_inner(render.height, extent.height),
          .run = narrow ? 0 : std::max(run_length(render.width, extent.width, taps_x, columns), 0),
          .counter = counter.index,
          .columns_per_item = columns};
}

}  // namespace

// scale_point, scale_bilinear, scale_noise, scale_noise_offset: one rendered frame to the output through an axis
// table of two taps.

namespace {

bool is_noise(Method method) {
  return method == Method::kNoise || method == Method::kNoiseOffset;
}

// Grain stands in for the detail that is missing: none at scale 1, all of it at scale 0.
float grain_amplitude(float grain, Extent render, Extent output) {
  const double scale = std::sqrt(static_cast<double>(render.area()) / static_cast<double>(output.area()));
  return static_cast<float>(grain * std::max(0.0, 1 - scale));
}

// Returns the reach of an output pixel in 1/256 texels: at least a texel, at most as the kernel's integers hold.
int random_reach(int render, int output) {
  const double ratio = static_cast<double>(render) / output;
  return static_cast<int>(std::nearbyint(std::clamp(ratio, 1.0, 250.0) * 256));
}

class ScalePass : public Pass {
 public:
  ScalePass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) { setup.tables.axis(); }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent render = frame.inputs.render_extent;
    const ImageView& colour = frame[Resource::kColour];
    const ImageView& output = frame[picture()];
    const ScaleParams params{.output_width = extent.width,
                             .output_height = extent.height,
                             .source_width = render.width,
                             .source_height = render.height,
                             .source = layout_of(colour),
                             .output = layout_of(output),
                             .row_axis = padded_columns(extent),
                             .counter = frame.counter.index,
                             .columns_per_item = columns_per_item(shape(), extent.width)};
    const cl::Buffer& taps = frame.tables.axis().get(frame.queue, frame.key());
    if (is_noise(settings().method)) {
      const auto seed = static_cast<unsigned>(settings().filter.noise_moves ? frame.inputs.frame_index : 0);
      const NoiseParams noise{params, seed, grain_amplitude(settings().filter.grain, render, extent),
                              random_reach(render.width, extent.width),
                              random_reach(render.height, extent.height)};
      bind(frame, noise, taps, colour, output, frame.counter);
    } else {
      bind(frame, params, taps, colour, output, frame.counter);
    }
    launch(frame, extent, params.columns_per_item, event);
  }
};

// The kernel, and why: several methods take bilinear's in place of their own.
struct Choice {
  const char* kernel;
  const char* reason;
  Frames frames = Frames::kAll;
};

Choice choice_of(Method method) {
  switch (method) {
    case Method::kPoint:
      return {"scale_point", "the method: the nearest sample"};
    case Method::kNoise:
      return {"scale_noise", "the method: the nearest sample, with grain"};
    case Method::kNoiseOffset:
      return {"scale_noise_offset", "the method: one of four samples, at random"};
    case Method::kBilinear:
      return {"scale_bilinear", "the method: four samples"};
    case Method::kQuincunx:
      // Bit for bit what the quincunx resolve gives where the previous frame has no weight.
      return {"scale_bilinear", "in place of both frames on the first one and after a reset",
              Frames::kWithoutHistory};
    default:
      return {nullptr, nullptr};
  }
}

}  // namespace

void plan_scale(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  const Choice choice = choice_of(settings.method);
  if (choice.kernel == nullptr) return;
  list.passes.push_back(
      {.kernel = choice.kernel,
       .options = scale_options(settings),
       .reason = choice.reason,
       .uses = uses_of(settings, {.reads = {Resource::kColour}, .writes = {picture_of(facts)}}),
       .make = make_pass<ScalePass>,
       .frames = choice.frames,
       // Bilinear widens above scale 1, which is scale_filter's work.
       .viewports = skips_samples(settings.method) ? Viewports::kAll : Viewports::kNotWider});
}

// scale_filter: one rendered frame to the output through a separable filter of any width.

namespace {

class ScaleFilterPass : public Pass {
 public:
  ScaleFilterPass(const PassSetup& setup, const PassSpec& spec)
      : Pass(setup, spec), filter_(filter_of(setup.facts.settings.method)) {
    setup.tables.filter(filter_);
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent render = frame.inputs.render_extent;
    const FilterParams params = filter_params(filter_, shape(), {render, frame[Resource::kColour]},
                                              {extent, frame[picture()]}, frame.counter);
    bind(frame, params, frame.tables.filter(filter_).get(frame.queue, frame.key()), Resource::kColour,
         picture(), frame.counter);
    launch(frame, extent, params.columns_per_item, event);
  }

 private:
  const Filter& filter_;
};

constexpr int kFourTaps = 4;  // number of taps with a variant of its own
constexpr int kAnyTaps = 0;

}  // namespace

void plan_scale_filter(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  const Filter* own = own_filter(settings.method);
  if (skips_samples(settings.method)) return;
  const bool clamps = own != nullptr && own->rings && settings.filter.clamp_ringing;
  const auto add = [&](int taps, const std::string& reason, Viewports viewports) {
    list.passes.push_back(
        {.kernel = "scale_filter",
         .options = fmt::format("-D TAPS={} -D CLAMP={} {}", taps, clamps ? 1 : 0, scale_options(settings)),
         .reason = reason,
         .uses = uses_of(settings, {.reads = {Resource::kColour}, .writes = {picture_of(facts)}}),
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

// scale_filter: the finished picture, where its size is dynamic, to the size in which it is shown.

namespace {

const Filter& display_filter() {
  return filter_of(Method::kCatmullRom);
}

class ScaleToDisplayPass : public Pass {
 public:
  ScaleToDisplayPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.filter(display_filter());
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ImageView& finished = frame[finished_of(facts())];
    const ImageView& displayed = frame[Resource::kDisplayed];
    const FilterParams params = filter_params(display_filter(), shape(), {frame.output, finished},
                                              {frame.display, displayed}, frame.counter);
    bind(frame, params,
         frame.tables.filter(display_filter()).get(frame.queue, {frame.display, frame.output, {}}), finished,
         displayed, frame.counter);
    launch(frame, frame.display, params.columns_per_item, event);
  }
};

}  // namespace

void plan_scale_to_display(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!facts.is_dual()) return;
  list.passes.push_back(
      {.kernel = "scale_filter",
       .options = fmt::format(
           "-D TAPS=4 -D CLAMP=1 -D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}",
           precision_of(settings.output.linear)),
       .reason = "the output is dynamic: its picture in the size in which it is shown",
       .uses = uses_of(settings, {.reads = {finished_of(facts)}, .writes = {Resource::kDisplayed}}),
       .make = make_pass<ScaleToDisplayPass>,
       .frames = Frames::kScaledOutput});
}

}  // namespace quincunx
