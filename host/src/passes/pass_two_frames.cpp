// SPDX-License-Identifier: MIT
// The passes of two frames: resolve_quincunx, resolve_reprojected.
#include <fmt/format.h>

#include <cmath>

#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "resolve_params.h"

namespace quincunx {

// resolve_quincunx: this frame and the previous one on the five-of-a-die pattern, in the mean and velocity forms.

namespace {

// From the velocity of one frame to sqrt(K) of its render pixels.
Vec2 speed_scale(const FrameInputs& inputs, float weight) {
  const VelocityScale pixels = velocity_scale_to(inputs, inputs.render_extent);
  const double root = std::sqrt(static_cast<double>(weight));
  return {static_cast<float>(root * pixels.x), static_cast<float>(root * pixels.y)};
}

class ResolveQuincunxPass : public Pass {
 public:
  ResolveQuincunxPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.axis();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& inputs = frame.inputs;
    const FrameInputs& previous = frame.previous;
    AxisTables& tables = frame.tables.axis();
    const Vec2 scale0 = speed_scale(inputs, settings().quincunx.velocity_weight);
    const Vec2 scale1 = speed_scale(previous, settings().quincunx.velocity_weight);
    ResolveParams params{};
    params.output_width = frame.output.width;
    params.output_height = frame.output.height;
    params.frame0 = {inputs.render_extent.width, inputs.render_extent.height,
                     layout_of(frame[Resource::kColour]), layout_of(frame[Resource::kVelocity]),
                     layout_of(frame[Resource::kReactive])};
    params.frame1 = {previous.render_extent.width, previous.render_extent.height,
                     layout_of(frame[Resource::kPreviousColour]),
                     layout_of(frame[Resource::kPreviousVelocity]),
                     layout_of(frame[Resource::kPreviousReactive])};
    params.output = layout_of(frame[picture()]);
    params.row_axis = padded_columns(frame.output);
    params.counter = frame.counter.index;
    params.columns_per_item = columns_per_item(shape(), frame.output.width);
    params.velocity0_scale_x = scale0.x;
    params.velocity0_scale_y = scale0.y;
    params.velocity1_scale_x = scale1.x;
    params.velocity1_scale_y = scale1.y;
    bind(frame, params, tables.get(frame.queue, frame.key()), tables.get(frame.queue, frame.previous_key()),
         Resource::kColour, Resource::kPreviousColour, Resource::kVelocity, Resource::kPreviousVelocity,
         Resource::kReactive, Resource::kPreviousReactive, picture(), frame.counter);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_resolve_quincunx(const PlanFacts& facts, PassList& list) {
  if (!facts.resolves_two_frames() || facts.has_form(TwoFrameForm::kReprojected)) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{.kernel = "resolve_quincunx",
                .options = settings.quincunx.sampling == Sampling::kPoint ? "-D SAMPLING=POINT"
                                                                          : "-D SAMPLING=BILINEAR",
                .reason = "the method: this frame and the previous one",
                .uses = uses_of(settings, {.reads = {Resource::kColour, Resource::kPreviousColour},
                                           .writes = {picture_of(facts)}}),
                .make = make_pass<ResolveQuincunxPass>,
                .frames = Frames::kWithHistory};
  spec.add_where(facts.weighs_velocity(), "WEIGHT", settings,
                 {.reads = {Resource::kVelocity, Resource::kPreviousVelocity}});
  spec.add_where(facts.reads_reactive(), "REACTIVE", settings,
                 {.reads = {Resource::kReactive, Resource::kPreviousReactive}});
  spec.add_options(colour_options(settings));
  if (facts.weighs_velocity() && settings.targets.storage == Storage::kBuffer)
    spec.add_options(fmt::format("-D VELOCITY_FORMAT={}", precision_of(settings.velocity)));
  spec.add_options(fmt::format("-D OUTPUT_FORMAT={}", precision_of(settings.output.linear)));
  list.passes.push_back(std::move(spec));
}

// resolve_reprojected: this frame and the previous one where its surfaces moved to, samples weighted by distance.

namespace {

float falloff(int render, int output) {
  const double reach = sample_reach(render, output);
  return static_cast<float>(1 / (reach * reach));
}

class ResolveReprojectedPass : public Pass {
 public:
  ResolveReprojectedPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent now = frame.inputs.render_extent;
    const Extent before = frame.previous.render_extent;
    PositionTables& tables = frame.tables.positions();
    const ReprojectedParams params{.output_width = extent.width,
                                   .output_height = extent.height,
                                   .frame0 = {now.width,
                                              now.height,
                                              layout_of(frame[Resource::kColour]),
                                              {},
                                              layout_of(frame[Resource::kReactive])},
                                   .frame1 = {before.width,
                                              before.height,
                                              layout_of(frame[Resource::kPreviousColour]),
                                              {},
                                              layout_of(frame[Resource::kPreviousReactive])},
                                   .reprojection = layout_of(frame[Resource::kReprojection]),
                                   .output = layout_of(frame[picture()]),
                                   .columns = position_columns(extent),
                                   .counter = frame.counter.index,
                                   .columns_per_item = columns_per_item(shape(), extent.width, 1),
                                   .falloff0_x = falloff(now.width, extent.width),
                                   .falloff0_y = falloff(now.height, extent.height),
                                   .falloff1_x = falloff(before.width, extent.width),
                                   .falloff1_y = falloff(before.height, extent.height)};
    bind(frame, params, tables.get(frame.queue, frame.key()), tables.get(frame.queue, frame.previous_key()),
         Resource::kColour, Resource::kPreviousColour, Resource::kReprojection, Resource::kReactive,
         Resource::kPreviousReactive, picture(), frame.counter, Resource::kExposure);
    launch(frame, extent, params.columns_per_item, event);
  }
};

}  // namespace

void plan_resolve_reprojected(const PlanFacts& facts, PassList& list) {
  if (!facts.has_form(TwoFrameForm::kReprojected)) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "resolve_reprojected",
      .reason = "the method: this frame and the previous one where it moved to",
      .uses = uses_of(settings, {.reads = {Resource::kColour, Resource::kPreviousColour, Resource::kExposure},
                                 .writes = {picture_of(facts)}}),
      .make = make_pass<ResolveReprojectedPass>,
      .frames = Frames::kWithHistory};
  spec.add_where(facts.reprojects(), "MOTION", settings, {.reads = {Resource::kReprojection}});
  // Where samples are reprojected, that already holds what reactive values take.
  spec.add_where(!facts.reprojects() && facts.reads_reactive(), "REACTIVE", settings,
                 {.reads = {Resource::kReactive, Resource::kPreviousReactive}});
  spec.add_options(scale_options(settings));
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
