// SPDX-License-Identifier: MIT
// velocity_from_depth: the velocity target of a frame in which only the camera moves.
#include "camera_params.h"
#include "motion/velocity_params.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class VelocityFromDepthPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
    const ImageView& depth = frame[Resource::kDepth];
    const ImageView& velocity = frame[Resource::kVelocity];
    const VelocityParams params{.width = render.width,
                                .height = render.height,
                                .depth = layout_of(depth),
                                .velocity = layout_of(velocity),
                                .columns_per_item = columns_per_item(shape(), render.width),
                                .camera = camera_params(frame.current)};
    bind(params, depth, velocity);
    launch(frame, render, params.columns_per_item, event);
  }
};

}  // namespace

void plan_velocity_from_depth(const PlanFacts& facts, PassList& list) {
  if (facts.velocity != VelocitySource::kCamera || !facts.reads_velocity()) return;
  list.passes.push_back(
      {.kernel = "velocity_from_depth",
       .options = velocity_options(facts.settings),
       .reason = "nothing but the camera moves",
       .uses = {{Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                {Resource::kVelocity, Access::kWrite, Area::kViewport, facts.settings.velocity}},
       .make = make_pass<VelocityFromDepthPass>});
}

}  // namespace quincunx
