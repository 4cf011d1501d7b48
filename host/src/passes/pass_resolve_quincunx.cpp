// SPDX-License-Identifier: MIT
// resolve_quincunx: this frame and the previous one on the five-of-a-die pattern, in the mean and velocity forms.
#include <fmt/format.h>

#include <cmath>

#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "resolve_params.h"

namespace quincunx {
namespace {

// From the velocity of one frame to sqrt(K) of its render pixels.
Vec2 speed_scale(const FrameInputs& frame, float weight) {
  const VelocityScale pixels = velocity_scale_to(frame, frame.render_extent);
  const double root = std::sqrt(static_cast<double>(weight));
  return {static_cast<float>(root * pixels.x), static_cast<float>(root * pixels.y)};
}

class ResolveQuincunxPass : public Pass {
 public:
  ResolveQuincunxPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.axis();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& current = frame.current;
    const FrameInputs& previous = frame.previous;
    AxisTables& tables = frame.tables.axis();
    const Vec2 scale0 = speed_scale(current, settings().quincunx.velocity_weight);
    const Vec2 scale1 = speed_scale(previous, settings().quincunx.velocity_weight);
    ResolveParams params{};
    params.output_width = frame.output.width;
    params.output_height = frame.output.height;
    params.frame0 = {current.render_extent.width, current.render_extent.height,
                     layout_of(frame[Resource::kColour]), layout_if_used(frame, Resource::kVelocity),
                     layout_if_used(frame, Resource::kReactive)};
    params.frame1 = {previous.render_extent.width, previous.render_extent.height,
                     layout_of(frame[Resource::kPreviousColour]),
                     layout_if_used(frame, Resource::kPreviousVelocity),
                     layout_if_used(frame, Resource::kPreviousReactive)};
    params.output = layout_of(frame[picture()]);
    params.row_axis = padded_columns(frame.output);
    params.counter = frame.counter.index;
    params.columns_per_item = columns_per_item(shape(), frame.output.width);
    params.velocity0_scale_x = scale0.x;
    params.velocity0_scale_y = scale0.y;
    params.velocity1_scale_x = scale1.x;
    params.velocity1_scale_y = scale1.y;
    bind(params, tables.get(frame.queue, frame.key()), tables.get(frame.queue, frame.previous_key()),
         frame[Resource::kColour], frame[Resource::kPreviousColour],
         view_or(frame, Resource::kVelocity, Resource::kColour),
         view_or(frame, Resource::kPreviousVelocity, Resource::kPreviousColour),
         view_or(frame, Resource::kReactive, Resource::kColour),
         view_or(frame, Resource::kPreviousReactive, Resource::kPreviousColour), frame[picture()],
         frame.counter);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

std::string options_of(const PlanFacts& facts) {
  const ResolveSettings& settings = facts.settings;
  std::string format;
  if (facts.weighs_velocity() && settings.targets.storage == Storage::kBuffer)
    format = fmt::format(" -D VELOCITY_FORMAT={}", precision_of(settings.velocity));
  return fmt::format("-D SAMPLING={} -D WEIGHT={} -D REACTIVE={} {}{} -D OUTPUT_FORMAT={}",
                     settings.quincunx.sampling == Sampling::kPoint ? "POINT" : "BILINEAR",
                     facts.weighs_velocity() ? 1 : 0, facts.reads_reactive() ? 1 : 0,
                     colour_options(settings), format, precision_of(settings.output.linear));
}

}  // namespace

void plan_resolve_quincunx(const PlanFacts& facts, PassList& list) {
  if (!facts.resolves_two_frames() || facts.has_form(TwoFrameForm::kReprojected)) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{.kernel = "resolve_quincunx",
                .options = options_of(facts),
                .reason = "the method: this frame and the previous one",
                .uses = {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
                         {Resource::kPreviousColour, Access::kRead, Area::kPreviousViewport, settings.colour},
                         {picture_of(facts), Access::kWrite, Area::kOutput, settings.output.linear}},
                .make = make_pass<ResolveQuincunxPass>,
                .frames = Frames::kWithHistory};
  if (facts.weighs_velocity()) read_both_frames(spec.uses, Resource::kVelocity, settings.velocity);
  if (facts.reads_reactive()) read_both_frames(spec.uses, Resource::kReactive, PixelFormat::kR8);
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
