// SPDX-License-Identifier: MIT
// The passes that complete a frame before others read it: convert_inputs, overlay_particles, resolve_checkerboard.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "motion/velocity_params.h"
#include "passes/frame_params.h"
#include "passes/pass.h"
#include "picture_params.h"
#include "plan/inputs.h"
#include "plan/pass_spec.h"
#include "resolve_params.h"

namespace quincunx {

// resolve_checkerboard: the other half of a frame in which every other pixel is shaded.

namespace {

class ResolveCheckerboardPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const PreviousPlaces places = previous_places(frame.inputs, frame.previous);
    const Resource velocity = filled_velocity_of(facts());
    const CheckerboardParams params{
        .width = render.width,
        .height = render.height,
        .previous_width = frame.previous.render_extent.width,
        .previous_height = frame.previous.render_extent.height,
        .parity = frame.inputs.parity,
        .has_history = frame.has_history ? 1 : 0,
        .columns_per_item = columns_per_item(shape(), render.width, kCheckerboardBlock),
        .shaded = {layout_of(frame[Resource::kShadedColour]), layout_of(frame[Resource::kShadedVelocity]),
                   layout_of(frame[Resource::kShadedDepth]), layout_of(frame[Resource::kShadedReactive])},
        .filled = {layout_of(frame[Resource::kColour]), layout_of(frame[velocity]),
                   layout_of(frame[Resource::kDepth]), layout_of(frame[Resource::kReactive])},
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
        .camera = camera_params(frame.inputs)};
    bind(frame, params, Resource::kShadedColour, Resource::kShadedVelocity, Resource::kShadedDepth,
         Resource::kShadedReactive, Resource::kPreviousColour, Resource::kPreviousDepth, Resource::kColour,
         velocity, Resource::kDepth, Resource::kReactive);
    launch(frame, render, params.columns_per_item, event);
  }
};

const char* motion_option(VelocitySource velocity) {
  if (velocity == VelocitySource::kNone) return "NONE";
  return velocity == VelocitySource::kCamera ? "CAMERA" : "TARGET";
}

}  // namespace

void plan_resolve_checkerboard(const PlanFacts& facts, PassList& list) {
  if (!facts.fills()) return;
  const ResolveSettings& settings = facts.settings;
  const bool has_target = facts.velocity == VelocitySource::kTarget;
  PassSpec spec{.kernel = "resolve_checkerboard",
                .options = fmt::format("-D MOTION={}", motion_option(facts.velocity)),
                .reason = "half of the pixels are shaded: the others are filled",
                .uses = uses_of(settings, {.reads = {Resource::kPreviousColour, Resource::kPreviousDepth,
                                                     Resource::kShadedColour, Resource::kShadedDepth},
                                           .writes = {Resource::kColour, Resource::kDepth}}),
                .make = make_pass<ResolveCheckerboardPass>};
  const bool fills_velocity = has_target && facts.reads_velocity();
  if (has_target && !fills_velocity) spec.uses.push_back(use(Resource::kShadedVelocity, settings));
  spec.add_where(fills_velocity, "VELOCITY", settings,
                 {.reads = {Resource::kShadedVelocity}, .writes = {filled_velocity_of(facts)}});
  spec.add_where(facts.needs.transparents, "REACTIVE", settings,
                 {.reads = {Resource::kShadedReactive}, .writes = {Resource::kReactive}});
  spec.add_options(colour_options(settings));
  if (has_target && settings.targets.storage == Storage::kBuffer)
    spec.add_options(fmt::format("-D VELOCITY_FORMAT={}", precision_of(settings.velocity)));
  list.passes.push_back(std::move(spec));
}

// convert_inputs: the inputs that need another convention, each in an image of the service's own.

namespace {

class ConvertInputsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Use& from = spec().uses[0];
    const ImageView& given = frame[from.resource];
    const ImageView& made = frame[spec().uses[1].resource];
    const Extent extent = extent_of(from.area, frame.extents());
    const InputConventions& conventions = settings().conventions;
    const float near_plane = frame.inputs.near_plane;
    const DepthConvention depth = conventions.depth;
    const VelocityScale to_uv = velocity_scale_to(frame.inputs, {1, 1});
    const ConvertParams params{
        .width = extent.width,
        .height = extent.height,
        .given = rows_of(given, extent.height, conventions.origin),
        .made = rows_of(made, extent.height, Origin::kTop),
        .columns_per_item = columns_per_item(shape(), extent.width),
        .is_linear = depth == DepthConvention::kLinear ? 1 : 0,
        .is_reversed = depth == DepthConvention::kReversed ? 1 : 0,
        .near_plane = near_plane,
        .near_by_far = needs_far_plane(depth)
                           ? static_cast<float>(static_cast<double>(near_plane) / frame.inputs.far_plane)
                           : 0,
        .jitter_x = frame.jitter_motion.x * inverse_scale(to_uv.x),
        .jitter_y = frame.jitter_motion.y * inverse_scale(to_uv.y)};
    bind(frame, params, given, made);
    launch(frame, extent, params.columns_per_item, event);
  }
};

PassSpec conversion(Conversion kind, const InputImage& input, const Use& made, const PlanFacts& facts) {
  const char* depth = name_of(facts.settings.conventions.depth);
  const std::string storage =
      fmt::format("-D SOURCE_STORAGE={}", storage_option(facts.settings.targets.storage));
  PassSpec spec{.kernel = "convert_inputs",
                .options = "-D INPUT=ROWS " + storage,
                .reason = fmt::format("{} is an image that begins with the lowest row", input.name),
                .uses = {{given_of(*resource_of(input)), Access::kRead, made.area, made.format},
                         {made.resource, Access::kWrite, made.area, made.format}},
                .make = make_pass<ConvertInputsPass>};
  if (kind == Conversion::kDepth) {
    spec.options = "-D INPUT=DEPTH " + storage;
    spec.reason = fmt::format("{} is {}", input.name, depth);
  } else if (kind == Conversion::kVelocity) {
    spec.options = "-D INPUT=VELOCITY " + velocity_options(facts.settings);
    spec.reason = fmt::format("{} has the jitter in it", input.name);
  }
  return spec;
}

}  // namespace

void plan_convert_inputs(const PlanFacts& facts, PassList& list) {
  std::vector<PassSpec> conversions;
  for (const ResourceUse& use : resources_of(list.passes)) {
    const InputImage* input = info_of(use.resource).input;
    if (input == nullptr || use.written || is_previous(use.resource)) continue;
    const Conversion kind = conversion_of(*input, facts.settings);
    if (kind != Conversion::kNone) conversions.push_back(conversion(kind, *input, use.largest, facts));
  }
  const auto first_reader = std::find_if(list.passes.begin(), list.passes.end(), [](const PassSpec& spec) {
    return spec.frames != Frames::kResized;
  });
  list.passes.insert(first_reader, conversions.begin(), conversions.end());
}

// overlay_particles: particles of a viewport of their own, laid over the frame.

namespace {

// The shaded half of a checkerboard gets its particles before the other half is filled.
Resource colour_of(const PlanFacts& facts) {
  return facts.fills() ? Resource::kShadedColour : Resource::kColour;
}
Resource depth_of(const PlanFacts& facts) {
  return facts.fills() ? Resource::kShadedDepth : Resource::kDepth;
}
Resource reactive_of(const PlanFacts& facts) {
  return facts.fills() ? Resource::kShadedReactive : Resource::kReactive;
}
bool marks(const PlanFacts& facts) {
  return facts.reads_reactive() || (facts.fills() && facts.needs.transparents);
}

class OverlayParticlesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent, particles = frame.inputs.particle_render_extent;
    const Resource colour = colour_of(facts()), depth = depth_of(facts()), reactive = reactive_of(facts());
    const OverlayParams params{.width = render.width,
                               .height = render.height,
                               .particle_width = particles.width,
                               .particle_height = particles.height,
                               .columns_per_item = columns_per_item(shape(), render.width, kParticleBlock),
                               .bare_colour = layout_of(frame[Resource::kBareColour]),
                               .bare_reactive = layout_of(frame[Resource::kBareReactive]),
                               .depth = layout_of(frame[depth]),
                               .particle_colour = layout_of(frame[Resource::kParticleColour]),
                               .particle_reactive = layout_of(frame[Resource::kParticleReactive]),
                               .particle_depth = layout_of(frame[Resource::kParticleDepth]),
                               .colour = layout_of(frame[colour]),
                               .reactive = layout_of(frame[reactive])};
    bind(frame, params, Resource::kBareColour, depth, Resource::kBareReactive, Resource::kParticleColour,
         Resource::kParticleDepth, Resource::kParticleReactive, colour, reactive);
    launch(frame, render, params.columns_per_item, event);
  }
};

}  // namespace

void plan_overlay_particles(const PlanFacts& facts, PassList& list) {
  if (!facts.overlays_particles()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{.kernel = "overlay_particles",
                .reason = "particles are drawn at a scale of their own",
                .uses = uses_of(settings, {.reads = {Resource::kBareColour, depth_of(facts),
                                                     Resource::kParticleColour, Resource::kParticleDepth},
                                           .writes = {colour_of(facts)}}),
                .make = make_pass<OverlayParticlesPass>};
  spec.add_where(
      marks(facts), "REACTIVE", settings,
      {.reads = {Resource::kBareReactive, Resource::kParticleReactive}, .writes = {reactive_of(facts)}});
  spec.add_options(colour_options(settings));
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
