// SPDX-License-Identifier: MIT
// reproject: where each sample of a frame was in the previous one, and whether it could be seen there.
#include <fmt/format.h>

#include <cmath>

#include "motion/velocity_params.h"
#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"

namespace quincunx {
namespace {

void set_positions(ReprojectParams& params, const FrameInputs& inputs, const FrameInputs& previous) {
  const PreviousPlaces places = previous_places(inputs, previous);
  params.step_x = places.step_x;
  params.step_y = places.step_y;
  params.start_x = places.start_x;
  params.start_y = places.start_y;
  params.motion_x = places.motion_x;
  params.motion_y = places.motion_y;
  params.edge_x = places.edge_x;
  params.edge_y = places.edge_y;
}

void set_motion_edge(ReprojectParams& params, const FrameInputs& inputs, Extent output) {
  const VelocityScale to_output = velocity_scale_to(inputs, output);
  params.motion_edge_x = static_cast<float>(to_output.x);
  params.motion_edge_y = static_cast<float>(to_output.y);
}

void set_speeds(ReprojectParams& params, const FrameInputs& inputs, const FrameInputs& previous,
                float weight) {
  const double root = std::sqrt(static_cast<double>(weight));
  const VelocityScale now = velocity_scale_to(inputs, inputs.render_extent);
  const VelocityScale before = velocity_scale_to(previous, previous.render_extent);
  params.speed0_x = static_cast<float>(root * now.x);
  params.speed0_y = static_cast<float>(root * now.y);
  params.speed1_x = static_cast<float>(root * before.x);
  params.speed1_y = static_cast<float>(root * before.y);
}

// From the fourth row of the camera's matrix, which gives the previous clip coordinates' w over the present one. The
// third makes the depth of the previous frame of the same: both may have a common factor, which is taken out.
void set_distances(ReprojectParams& params, const FrameInputs& inputs) {
  const auto& m = inputs.camera.clip_to_previous_clip;
  const CameraVelocity camera = camera_params(inputs);
  const double unit = m[10] > 0 && std::isfinite(m[10]) ? m[10] : 1;
  params.distance_x = static_cast<float>(m[3] / unit * camera.step_x);
  params.distance_y = static_cast<float>(m[7] / unit * camera.step_y);
  params.distance_depth = static_cast<float>(m[11] / unit);
  params.distance_start =
      static_cast<float>((m[15] + double{m[3]} * camera.start_x + double{m[7]} * camera.start_y) / unit);
}

class ReprojectPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& inputs = frame.inputs;
    const FrameInputs& previous = frame.previous;
    ReprojectParams params{};
    params.width = inputs.render_extent.width;
    params.height = inputs.render_extent.height;
    params.previous_width = previous.render_extent.width;
    params.previous_height = previous.render_extent.height;
    params.velocity0 = layout_of(frame[Resource::kVelocity]);
    params.velocity1 = layout_of(frame[Resource::kPreviousVelocity]);
    params.depth0 = layout_of(frame[Resource::kDepth]);
    params.depth1 = layout_of(frame[Resource::kPreviousDepth]);
    params.reprojection = layout_of(frame[Resource::kReprojection]);
    params.previous_reprojection = layout_of(frame[Resource::kPreviousReprojection]);
    params.columns_per_item = columns_per_item(shape(), inputs.render_extent.width);
    params.reactive0 = layout_of(frame[Resource::kReactive]);
    params.reactive1 = layout_of(frame[Resource::kPreviousReactive]);
    set_positions(params, inputs, previous);
    set_motion_edge(params, inputs, frame.output);
    set_distances(params, inputs);
    if (facts().weighs_residual()) set_speeds(params, inputs, previous, settings().quincunx.residual_weight);
    bind(frame, params, Resource::kVelocity, Resource::kPreviousVelocity, Resource::kDepth,
         Resource::kPreviousDepth, Resource::kReactive, Resource::kPreviousReactive,
         Resource::kPreviousReprojection, Resource::kReprojection, Resource::kOpenTrust);
    launch(frame, inputs.render_extent, params.columns_per_item, event);
  }
};

}  // namespace

void plan_reproject(const PlanFacts& facts, PassList& list) {
  if (!facts.reprojects()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "reproject",
      .reason = "the method: where each sample was, and whether it could be seen",
      .uses = uses_of(settings, {.reads = {Resource::kVelocity, Resource::kDepth, Resource::kPreviousDepth},
                                 .writes = {Resource::kReprojection}}),
      .make = make_pass<ReprojectPass>,
      .frames = facts.accumulates() ? Frames::kSparse : Frames::kWithHistory};
  spec.add_where(facts.reads_reactive(), "REACTIVE", settings,
                 {.reads = {Resource::kReactive, Resource::kPreviousReactive}});
  spec.add_where(facts.weighs_residual(), "RESIDUAL", settings, {.reads = {Resource::kPreviousVelocity}});
  spec.add_where(facts.accumulates(), "MOTION_EDGE", settings, {.reads = {Resource::kPreviousReprojection}});
  spec.add_where(facts.has_layers(), "OPEN_TRUST", settings, {.writes = {Resource::kOpenTrust}});
  spec.add_options(velocity_options(settings));
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
