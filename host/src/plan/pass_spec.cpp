// SPDX-License-Identifier: MIT
#include "plan/pass_spec.h"

#include <algorithm>

#include "motion/velocity_params.h"
#include "temporal/temporal_params.h"

namespace quincunx {
namespace {

Extent tiles_of(Extent output, int side) {
  return {(output.width + side - 1) / side, (output.height + side - 1) / side};
}

std::int64_t rank(Area area) {
  // Only viewports share a resource with other areas, and the largest viewport may exceed the output.
  return area == Area::kViewport || area == Area::kPreviousViewport ? 1 : 0;
}

}  // namespace

void read_both_frames(std::vector<Use>& uses, Resource resource, PixelFormat format) {
  uses.push_back({resource, Access::kRead, Area::kViewport, format});
  uses.push_back({previous_of(resource), Access::kRead, Area::kPreviousViewport, format});
}

FrameExtents largest_extents(const ResolveSettings& settings) {
  const Extent output = settings.output_extent;
  return {settings.target_extent,
          settings.target_extent,
          output,
          settings.targets.particle_extent,
          output,
          output,
          settings.focus.extent};
}

Extent extent_of(Area area, const FrameExtents& extents) {
  switch (area) {
    case Area::kViewport:
      return extents.render;
    case Area::kPreviousViewport:
      return extents.previous_render;
    case Area::kParticles:
      return extents.particles;
    case Area::kOutput:
      return extents.output;
    case Area::kPreviousOutput:
      return extents.previous_output;
    case Area::kDisplay:
      return extents.display;
    case Area::kFocus:
      return extents.focus;
    case Area::kFarCells:
      return tiles_of(extents.render, kFarCell);
    case Area::kTiles:
      return tiles_of(extents.output, kTemporalTile);
    case Area::kPreviousTiles:
      return tiles_of(extents.previous_output, kTemporalTile);
    case Area::kBlurTiles:
      return tiles_of(extents.output, kTileSide);
    case Area::kWhole:
      return {1, 1};
  }
  return {};
}

std::uint64_t bytes_of(const PassSpec& spec, const FrameExtents& extents) {
  std::uint64_t bytes = 0;
  for (const Use& use : spec.uses) {
    const bool both = use.access == Access::kAccumulate || use.access == Access::kUpdate;
    const std::uint64_t times = both ? 2 : 1;
    bytes += times * static_cast<std::uint64_t>(extent_of(use.area, extents).area()) * use.element_bytes();
  }
  return bytes;
}

std::vector<ResourceUse> resources_of(const std::vector<PassSpec>& passes) {
  std::vector<ResourceUse> found;
  const auto entry = [&found](Resource resource) {
    return std::find_if(found.begin(), found.end(),
                        [resource](const ResourceUse& use) { return use.resource == resource; });
  };
  for (const PassSpec& pass : passes) {
    if (pass.frames == Frames::kOnRequest) continue;
    for (const Use& use : pass.uses) {
      auto known = entry(use.resource);
      if (known == found.end()) known = found.insert(found.end(), {use.resource, use, false});
      if (rank(use.area) > rank(known->largest.area)) known->largest = use;
      known->written |= use.access != Access::kRead;
    }
  }
  for (ResourceUse& use : found) {
    const auto before = entry(previous_of(use.resource));
    if (before != found.end() && before->resource != use.resource) before->written = use.written;
  }
  std::sort(found.begin(), found.end(),
            [](const ResourceUse& a, const ResourceUse& b) { return a.resource < b.resource; });
  return found;
}

bool reads(const std::vector<ResourceUse>& used, const InputImage& input) {
  return std::any_of(used.begin(), used.end(), [&input](const ResourceUse& use) {
    return !use.written && info_of(use.resource).input == &input;
  });
}

std::optional<Resource> unresized(const std::vector<PassSpec>& passes) {
  const auto is_resized = [&passes](const Use& kept) {
    return std::any_of(passes.begin(), passes.end(), [&kept](const PassSpec& pass) {
      return pass.frames == Frames::kResized &&
             std::any_of(pass.uses.begin(), pass.uses.end(), [&kept](const Use& use) {
               return previous_of(use.resource) == kept.resource && use.access != Access::kRead &&
                      use.area == kept.area;
             });
    });
  };
  for (const PassSpec& pass : passes) {
    for (const Use& use : pass.uses) {
      const bool follows_output =
          use.area == Area::kOutput || use.area == Area::kTiles || use.area == Area::kBlurTiles;
      if (is_previous(use.resource) && follows_output && !is_resized(use)) return use.resource;
    }
  }
  return std::nullopt;
}

namespace {

// In the order in which they run.
constexpr void (*kPlanners[])(const PlanFacts&, PassList&) = {
    // The previous frame's remains, before any other pass: PassChain::run() exchanges them after these.
    plan_resize_history,
    plan_resize_tiles,
    plan_resize_layers,
    plan_resize_records,
    // The frame, completed.
    plan_overlay_particles,
    plan_resolve_checkerboard,
    plan_velocity_from_depth,
    plan_undilate_velocity,
    plan_far_motion,
    plan_far_velocity,
    plan_check_motion,
    plan_reproject,
    // The picture: from many frames, from two, or from one.
    plan_layer_records,
    plan_turn_records,
    plan_advect_records,
    plan_layer_split,
    plan_temporal_tiles,
    plan_temporal_light,
    plan_measure_content,
    plan_resolve_temporal,
    plan_resolve_layers,
    plan_temporal_display,
    plan_display_layers,
    plan_merge_histories,
    plan_temporal_denoise,
    plan_temporal_refine,
    plan_resolve_quincunx,
    plan_resolve_reprojected,
    plan_scale,
    plan_scale_filter,
    // The picture, finished.
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

// Notes the caller's images that nobody reads.
void note_unused_inputs(const PlanFacts& facts, const std::vector<ResourceUse>& used,
                        std::vector<LeftOut>& left_out) {
  const auto note = [&left_out](const char* what, const char* why) { left_out.push_back({what, why}); };
  const bool several = facts.keeps_previous_frame();
  if (!several && !facts.fills()) note("the previous frame", "the method uses one frame only");
  if (facts.velocity == VelocitySource::kCamera) {
    note("velocity target", "nothing but the camera moves: velocity comes from depth and the camera");
  } else if (!reads(used, kVelocityInput)) {
    note("velocity", !several && !facts.fills()            ? "the method uses one frame only"
                     : facts.has_form(TwoFrameForm::kMean) ? "the form is the plain mean"
                                                           : "nothing moves: all frames count alike");
  }
  if (!reads(used, kDepthInput)) note("depth", "no pass reads it");
  if (!reads(used, kReactiveInput))
    note("reactive values",
         facts.needs.transparents ? "the method uses one frame only" : "the scene has no transparents");
}

}  // namespace

PassList list_passes(const PlanFacts& facts) {
  PassList planned;
  for (const auto plan : kPlanners)
    plan(facts, planned);
  plan_convert_inputs(facts, planned);  // of what the others read
  PassList list{std::move(planned.passes), {}};
  note_unused_inputs(facts, resources_of(list.passes), list.left_out);
  for (LeftOut& left : planned.left_out)
    list.left_out.push_back(std::move(left));
  return list;
}

}  // namespace quincunx
