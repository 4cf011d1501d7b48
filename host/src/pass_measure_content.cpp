// SPDX-License-Identifier: MIT
// measure_content: what a frame shows, for a controller that chooses the method.
#include <algorithm>
#include <cmath>

#include "content_params.h"
#include "content_sums.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

constexpr double kThinReach = 3;  // output pixels to either side of what is thin

int reach(int render, int output) {
  return std::max(1, static_cast<int>(std::lround(kThinReach * render / output)));
}

float step(int output, int tiles) {
  return static_cast<float>(static_cast<double>(output) / (tiles * kContentSamples));
}

class MeasureContentPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
    const Extent tiles = content_tiles(frame.output);
    const VelocityScale pixels = velocity_scale_to(frame.current, frame.output);
    const ContentParams params{.width = render.width,
                               .height = render.height,
                               .tiles_x = tiles.width,
                               .tiles_y = tiles.height,
                               .velocity = layout_of(frame[Resource::kVelocity]),
                               .depth = layout_of(frame[Resource::kDepth]),
                               .reactive = layout_if_used(frame, Resource::kReactive),
                               .reach_x = reach(render.width, frame.output.width),
                               .reach_y = reach(render.height, frame.output.height),
                               .pixels_x = static_cast<float>(pixels.x),
                               .pixels_y = static_cast<float>(pixels.y),
                               .step_x = step(frame.output.width, tiles.width),
                               .step_y = step(frame.output.height, tiles.height)};
    bind(params, frame[Resource::kVelocity], frame[Resource::kDepth],
         view_or(frame, Resource::kReactive, Resource::kDepth), frame[Resource::kContentSums]);
    launch(frame, tiles, 1, event);
  }
};

}  // namespace

void plan_measure_content(const PlanFacts& facts, PassList& list) {
  if (!facts.measures_content()) return;
  const bool reactive = facts.needs.transparents;
  PassSpec spec{
      .kernel = "measure_content",
      .options =
          std::string(reactive ? "-D REACTIVE=1 " : "-D REACTIVE=0 ") + velocity_options(facts.settings),
      .reason = "what the picture shows is wanted: a sample of it",
      .uses = {{Resource::kVelocity, Access::kRead, Area::kViewport, facts.settings.velocity},
               {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
               {Resource::kContentSums, Access::kAccumulate, Area::kWhole, {}, sizeof(ContentSums)}},
      .make = make_pass<MeasureContentPass>};
  if (reactive) spec.uses.push_back({Resource::kReactive, Access::kRead, Area::kViewport, PixelFormat::kR8});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
