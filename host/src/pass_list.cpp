// SPDX-License-Identifier: MIT
#include "pass_list.h"

namespace quincunx {
namespace {

// In the order in which they run.
constexpr void (*kPlanners[])(const PlanFacts&, PassList&) = {
    // What the previous frame left behind, before any other pass: PassChain::run() exchanges it after these.
    plan_resize_history,
    plan_resize_tiles,
    plan_resize_layers,
    plan_resize_records,
    // What completes the frame.
    plan_overlay_particles,
    plan_resolve_checkerboard,
    plan_velocity_from_depth,
    plan_undilate_velocity,
    plan_far_motion,
    plan_far_velocity,
    plan_measure_content,
    plan_reproject,
    // The picture: from many frames, from two, or from one.
    plan_layer_records,
    plan_turn_records,
    plan_advect_records,
    plan_layer_split,
    plan_temporal_tiles,
    plan_temporal_light,
    plan_resolve_temporal,
    plan_resolve_layers,
    plan_temporal_display,
    plan_display_layers,
    plan_temporal_refine,
    plan_resolve_quincunx,
    plan_resolve_reprojected,
    plan_scale,
    plan_scale_filter,
    // What is made of the picture.
    plan_sharpen,
    plan_motion_tiles,
    plan_motion_neighbours,
    plan_motion_blur,
    plan_scale_to_display,
    plan_lay_focus,
    plan_cross_fade,
    plan_present,
    plan_clear_region,
};

// Of the caller's images, those that nobody reads.
void note_unused_inputs(const PlanFacts& facts, const std::vector<ResourceUse>& used,
                        std::vector<LeftOut>& left_out) {
  const auto note = [&left_out](const char* what, const char* why) { left_out.push_back({what, why}); };
  const auto reads = [&used](Resource resource) {
    for (const ResourceUse& use : used) {
      if (use.resource == resource) return true;
    }
    return false;
  };
  const bool several = facts.keeps_previous_frame();
  if (!several && !facts.fills()) note("the previous frame", "the method uses one frame only");
  if (facts.velocity == VelocitySource::kCamera) {
    note("velocity target", "nothing but the camera moves: velocity comes from depth and the camera");
  } else if (!reads(Resource::kVelocity) && !reads(Resource::kShadedVelocity)) {
    note("velocity", !several && !facts.fills()            ? "the method uses one frame only"
                     : facts.has_form(TwoFrameForm::kMean) ? "the form is the plain mean"
                                                           : "nothing moves: all frames count alike");
  }
  if (!reads(Resource::kDepth)) note("depth", "no pass reads it");
  if (!reads(Resource::kReactive) && !reads(Resource::kShadedReactive))
    note("reactive values",
         facts.needs.transparents ? "the method uses one frame only" : "the scene has no transparents");
}

}  // namespace

PassList list_passes(const PlanFacts& facts) {
  PassList planned;
  for (const auto plan : kPlanners)
    plan(facts, planned);
  PassList list{std::move(planned.passes), {}};
  note_unused_inputs(facts, resources_of(list.passes), list.left_out);
  for (LeftOut& left : planned.left_out)
    list.left_out.push_back(std::move(left));
  return list;
}

}  // namespace quincunx
