// SPDX-License-Identifier: MIT
// scale_point, scale_bilinear, scale_noise, scale_noise_offset: one rendered frame to the output through an axis
// table of two taps.
#include <algorithm>
#include <cmath>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "scale_params.h"

namespace quincunx {
namespace {

bool is_noise(Method method) {
  return method == Method::kNoise || method == Method::kNoiseOffset;
}

// Grain stands in for the detail that is missing: none at scale 1, all of it at scale 0.
float grain_amplitude(float grain, Extent render, Extent output) {
  const double scale = std::sqrt(static_cast<double>(render.area()) / static_cast<double>(output.area()));
  return static_cast<float>(grain * std::max(0.0, 1 - scale));
}

// Of an output pixel, in 1/256 texels; a texel at least, and what the kernel's integers hold.
int random_reach(int render, int output) {
  const double ratio = static_cast<double>(render) / output;
  return static_cast<int>(std::nearbyint(std::clamp(ratio, 1.0, 250.0) * 256));
}

class ScalePass : public Pass {
 public:
  ScalePass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) { setup.tables.axis(); }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent render = frame.current.render;
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
      const auto seed = static_cast<unsigned>(settings().noise_moves ? frame.current.frame_index : 0);
      const NoiseParams noise{params, seed, grain_amplitude(settings().grain, render, extent),
                              random_reach(render.width, extent.width),
                              random_reach(render.height, extent.height)};
      bind(noise, taps, colour, output, frame.counter);
    } else {
      bind(params, taps, colour, output, frame.counter);
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
       .uses = {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
                {picture_of(facts), Access::kWrite, Area::kOutput, settings.resolved}},
       .make = make_pass<ScalePass>,
       .frames = choice.frames,
       // Bilinear widens above scale 1, which is scale_filter's work.
       .viewports = skips_samples(settings.method) ? Viewports::kAll : Viewports::kNotWider});
}

}  // namespace quincunx
