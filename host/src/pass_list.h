// SPDX-License-Identifier: MIT
// The part of each pass_*.cpp that plans: it adds its pass where the facts ask for it, else says why not.
#pragma once

#include "pass_spec.h"

namespace quincunx {

void plan_overlay_particles(const PlanFacts& facts, PassList& list);
void plan_resolve_checkerboard(const PlanFacts& facts, PassList& list);
void plan_velocity_from_depth(const PlanFacts& facts, PassList& list);
void plan_undilate_velocity(const PlanFacts& facts, PassList& list);
void plan_far_motion(const PlanFacts& facts, PassList& list);
void plan_far_velocity(const PlanFacts& facts, PassList& list);
void plan_reproject(const PlanFacts& facts, PassList& list);
void plan_resize_history(const PlanFacts& facts, PassList& list);
void plan_resize_tiles(const PlanFacts& facts, PassList& list);
void plan_resize_layers(const PlanFacts& facts, PassList& list);
void plan_resize_records(const PlanFacts& facts, PassList& list);
void plan_layer_records(const PlanFacts& facts, PassList& list);
void plan_turn_records(const PlanFacts& facts, PassList& list);
void plan_advect_records(const PlanFacts& facts, PassList& list);
void plan_layer_split(const PlanFacts& facts, PassList& list);
void plan_temporal_tiles(const PlanFacts& facts, PassList& list);
void plan_temporal_light(const PlanFacts& facts, PassList& list);
void plan_resolve_temporal(const PlanFacts& facts, PassList& list);
void plan_resolve_layers(const PlanFacts& facts, PassList& list);
void plan_temporal_display(const PlanFacts& facts, PassList& list);
void plan_display_layers(const PlanFacts& facts, PassList& list);
void plan_resolve_quincunx(const PlanFacts& facts, PassList& list);
void plan_resolve_reprojected(const PlanFacts& facts, PassList& list);
void plan_scale(const PlanFacts& facts, PassList& list);
void plan_scale_filter(const PlanFacts& facts, PassList& list);
void plan_measure_content(const PlanFacts& facts, PassList& list);
void plan_cross_fade(const PlanFacts& facts, PassList& list);
void plan_temporal_refine(const PlanFacts& facts, PassList& list);
void plan_sharpen(const PlanFacts& facts, PassList& list);
void plan_motion_tiles(const PlanFacts& facts, PassList& list);
void plan_motion_neighbours(const PlanFacts& facts, PassList& list);
void plan_motion_blur(const PlanFacts& facts, PassList& list);
void plan_scale_to_display(const PlanFacts& facts, PassList& list);
void plan_lay_focus(const PlanFacts& facts, PassList& list);
void plan_present(const PlanFacts& facts, PassList& list);
void plan_clear_region(const PlanFacts& facts, PassList& list);

}  // namespace quincunx
