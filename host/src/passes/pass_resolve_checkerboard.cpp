// SPDX-License-Identifier: MIT
// resolve_checkerboard: the other half of a frame in which every other pixel is shaded.
#include <fmt/format.h>

#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "resolve_params.h"

namespace quincunx {
namespace {

// The two resources that the pass reads and writes in place of a target that is shaded in full.
struct Target {
  Resource shaded;
  Resource filled;
};

Target velocity_target(const PlanFacts& facts) {
  return {Resource::kShadedVelocity, filled_velocity_of(facts)};
}

class ResolveCheckerboardPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render_extent;
    const PreviousPlaces places = previous_places(frame.current, frame.previous);
    const Resource velocity = velocity_target(facts()).filled;
    const CheckerboardParams params{
        .width = render.width,
        .height = render.height,
        .previous_width = frame.previous.render_extent.width,
        .previous_height = frame.previous.render_extent.height,
        .parity = frame.current.parity,
        .has_history = frame.has_history ? 1 : 0,
        .columns_per_item = columns_per_item(shape(), render.width, kCheckerboardBlock),
        .shaded = {layout_of(frame[Resource::kShadedColour]),
                   layout_if_used(frame, Resource::kShadedVelocity), layout_of(frame[Resource::kShadedDepth]),
                   layout_if_used(frame, Resource::kShadedReactive)},
        .filled = {layout_of(frame[Resource::kColour]), layout_if_used(frame, velocity),
                   layout_of(frame[Resource::kDepth]), layout_if_used(frame, Resource::kReactive)},
        .previous_colour = layout_of(frame[Resource::kPreviousColour]),
        .previous_depth = layout_of(frame[Resource::kPreviousDepth]),
        .step_x = places.step_x,
        .step_y = places.step_y,
        .start_x = places.start_x,
        .start_y = places.start_y,
        .motion_x = places.motion_x,
        .motion_y = places.motion_y,
        .edge_x = places.edge_x,
        .edge_y = places.edge_y,
        .camera = camera_params(frame.current)};
    bind(params, frame[Resource::kShadedColour],
         view_or(frame, Resource::kShadedVelocity, Resource::kShadedDepth), frame[Resource::kShadedDepth],
         view_or(frame, Resource::kShadedReactive, Resource::kShadedDepth), frame[Resource::kPreviousColour],
         frame[Resource::kPreviousDepth], frame[Resource::kColour],
         view_or(frame, velocity, Resource::kDepth), frame[Resource::kDepth],
         view_or(frame, Resource::kReactive, Resource::kDepth));
    launch(frame, render, params.columns_per_item, event);
  }
};

const char* motion_option(VelocitySource velocity) {
  if (velocity == VelocitySource::kNone) return "NONE";
  return velocity == VelocitySource::kCamera ? "CAMERA" : "TARGET";
}

std::string options_for(const PlanFacts& facts) {
  const ResolveSettings& settings = facts.settings;
  const bool target = facts.velocity == VelocitySource::kTarget;
  std::string options = fmt::format("-D MOTION={} -D VELOCITY={} -D REACTIVE={} {}",
                                    motion_option(facts.velocity), target && facts.reads_velocity() ? 1 : 0,
                                    facts.needs.transparents ? 1 : 0, colour_options(settings));
  if (target && settings.targets.storage == Storage::kBuffer)
    options += fmt::format(" -D VELOCITY_FORMAT={}", precision_of(settings.velocity));
  return options;
}

}  // namespace

void plan_resolve_checkerboard(const PlanFacts& facts, PassList& list) {
  if (!facts.fills()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "resolve_checkerboard",
      .options = options_for(facts),
      .reason = "half of the pixels are shaded: the others are filled",
      .uses = {{Resource::kPreviousColour, Access::kRead, Area::kPreviousViewport, settings.colour},
               {Resource::kPreviousDepth, Access::kRead, Area::kPreviousViewport, PixelFormat::kR32F}},
      .make = make_pass<ResolveCheckerboardPass>};
  const auto fill = [&spec](Target target, PixelFormat format) {
    spec.uses.push_back({target.shaded, Access::kRead, Area::kViewport, format});
    spec.uses.push_back({target.filled, Access::kWrite, Area::kViewport, format});
  };
  fill({Resource::kShadedColour, Resource::kColour}, settings.colour);
  fill({Resource::kShadedDepth, Resource::kDepth}, PixelFormat::kR32F);
  if (facts.needs.transparents) fill({Resource::kShadedReactive, Resource::kReactive}, PixelFormat::kR8);
  if (facts.velocity == VelocitySource::kTarget) {
    if (facts.reads_velocity())
      fill(velocity_target(facts), settings.velocity);
    else
      spec.uses.push_back({Resource::kShadedVelocity, Access::kRead, Area::kViewport, settings.velocity});
  }
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
