// SPDX-License-Identifier: MIT
// The passes that complete velocity: velocity_from_depth, undilate_velocity, far_surroundings, far_fit, far_match,
// far_velocity.
#include <fmt/format.h>

#include <algorithm>

#include "motion/velocity_params.h"
#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"

namespace quincunx {

// velocity_from_depth: the velocity target of a frame in which only the camera moves.

namespace {

class VelocityFromDepthPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const ImageView& depth = frame[Resource::kDepth];
    const ImageView& velocity = frame[Resource::kVelocity];
    const VelocityParams params{.width = render.width,
                                .height = render.height,
                                .depth = layout_of(depth),
                                .velocity = layout_of(velocity),
                                .columns_per_item = columns_per_item(shape(), render.width),
                                .camera = camera_params(frame.inputs)};
    bind(frame, params, depth, velocity);
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
       .uses = uses_of(facts.settings, {.reads = {Resource::kDepth}, .writes = {Resource::kVelocity}}),
       .make = make_pass<VelocityFromDepthPass>});
}

// undilate_velocity: each sample's own velocity, where the renderer has spread that of the nearest.

namespace {

class UndilateVelocityPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const Resource own = drawn_velocity_of(facts());
    const VelocityScale to_uv = velocity_scale_to(frame.inputs, {1, 1});
    const bool has_camera = frame.inputs.camera.clip_to_previous_clip != CameraMotion{}.clip_to_previous_clip;
    const UndilateParams params{.frame = {.width = render.width,
                                          .height = render.height,
                                          .depth = layout_of(frame[Resource::kDepth]),
                                          .velocity = layout_of(frame[own]),
                                          .columns_per_item = columns_per_item(shape(), render.width),
                                          .camera = camera_params(frame.inputs)},
                                .dilated = layout_of(frame[Resource::kDilatedVelocity]),
                                .to_drawn_x = inverse_scale(to_uv.x),
                                .to_drawn_y = inverse_scale(to_uv.y),
                                .has_camera = has_camera ? 1 : 0};
    bind(frame, params, Resource::kDepth, Resource::kDilatedVelocity, own);
    launch(frame, render, params.frame.columns_per_item, event);
  }
};

}  // namespace

void plan_undilate_velocity(const PlanFacts& facts, PassList& list) {
  if (facts.settings.conventions.drawn_velocity == DrawnVelocity::kOwn) return;
  if (!facts.undilates_velocity()) {
    list.left_out.push_back({"undilate_velocity", facts.reads_velocity()
                                                      ? "velocity comes from depth and the camera everywhere"
                                                      : "no pass reads velocity"});
    return;
  }
  list.passes.push_back(
      {.kernel = "undilate_velocity",
       .options = velocity_options(facts.settings),
       .reason = "each sample gets its own velocity back from the nearest's of 3x3",
       .uses = uses_of(facts.settings, {.reads = {Resource::kDepth, Resource::kDilatedVelocity},
                                        .writes = {drawn_velocity_of(facts)}}),
       .make = make_pass<UndilateVelocityPass>});
}

// far_surroundings, far_fit, far_match: how the camera moves what is infinitely far away, from what all else does.

namespace {

class FarSurroundingsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const Extent cells = extent_of(Area::kFarCells, frame.extents());
    const VelocityScale to_uv = velocity_scale_to(frame.inputs, {1, 1});
    const double aspect = static_cast<double>(frame.output.width) / frame.output.height;
    const FarSumsParams params{.width = render.width,
                               .height = render.height,
                               .cells_x = cells.width,
                               .cells_y = cells.height,
                               .depth = layout_of(frame[Resource::kDepth]),
                               .drawn = layout_of(frame[Resource::kDrawnVelocity]),
                               .places = far_places(frame.inputs, frame.output),
                               .from_drawn_x = static_cast<float>(to_uv.x * aspect),
                               .from_drawn_y = static_cast<float>(to_uv.y),
                               .pixels = static_cast<float>(frame.output.height)};
    bind(frame, params, Resource::kDepth, Resource::kDrawnVelocity, Resource::kPreviousFarMotion,
         Resource::kFarSums);
    launch(frame, cells, 1, event);
  }
};

class FarFitPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const auto cells = static_cast<cl_int>(extent_of(Area::kFarCells, frame.extents()).area());
    bind(frame, cells, Resource::kFarSums, Resource::kPreviousFarMotion, Resource::kFarMatch,
         Resource::kFarMotion);
    launch_group(frame, event);
  }
};

class FarMatchPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& inputs = frame.inputs;
    const FrameInputs& previous = frame.previous;
    const Extent cells = extent_of(Area::kFarCells, frame.extents());
    const auto step = [](int to, int from) { return static_cast<double>(to) / from; };
    const double step_x = step(previous.render_extent.width, inputs.render_extent.width);
    const double step_y = step(previous.render_extent.height, inputs.render_extent.height);
    const double aspect = static_cast<double>(frame.output.width) / frame.output.height;
    // So that the sum over all cells fits into an int.
    constexpr double kMost = 1 << 30, kSamples = kFarCell * kFarCell / 4.;
    const FarMatchParams params{
        .width = inputs.render_extent.width,
        .height = inputs.render_extent.height,
        .previous_width = previous.render_extent.width,
        .previous_height = previous.render_extent.height,
        .cells_x = cells.width,
        .cells_y = cells.height,
        .depth0 = layout_of(frame[Resource::kDepth]),
        .depth1 = layout_of(frame[Resource::kPreviousDepth]),
        .drawn = layout_of(frame[Resource::kDrawnVelocity]),
        .colour0 = layout_of(frame[Resource::kColour]),
        .colour1 = layout_of(frame[Resource::kPreviousColour]),
        .places = far_places(inputs, frame.output),
        .step_x = static_cast<float>(step_x),
        .step_y = static_cast<float>(step_y),
        .start_x = static_cast<float>((.5 + inputs.jitter.x) * step_x - .5 - previous.jitter.x),
        .start_y = static_cast<float>((.5 + inputs.jitter.y) * step_y - .5 - previous.jitter.y),
        .to_previous_x = static_cast<float>(previous.render_extent.width / aspect),
        .to_previous_y = static_cast<float>(previous.render_extent.height),
        .units = static_cast<float>(std::min(1024., kMost / (kSamples * static_cast<double>(cells.area()))))};
    bind(frame, params, Resource::kDepth, Resource::kPreviousDepth, Resource::kDrawnVelocity,
         Resource::kColour, Resource::kPreviousColour, Resource::kFarMotion, Resource::kFarMatch,
         Resource::kExposure);
    launch(frame, cells, 1, event);
  }
};

}  // namespace

void plan_far_motion(const PlanFacts& facts, PassList& list) {
  if (!facts.fits_sky()) return;
  const ResolveSettings& settings = facts.settings;
  list.passes.push_back({.kernel = "far_surroundings",
                         .options = velocity_options(settings),
                         .reason = "how the camera moves, by what is drawn with motion",
                         .uses = uses_of(settings, {.reads = {Resource::kDepth, Resource::kDrawnVelocity,
                                                              Resource::kPreviousFarMotion},
                                                    .writes = {Resource::kFarSums}}),
                         .make = make_pass<FarSurroundingsPass>});
  // far_match, which comes after it, has not yet begun this frame's sums: these are the previous one's.
  list.passes.push_back(
      {.kernel = "far_fit",
       .options = "",
       .reason = "how the camera moves: the fit",
       .uses = uses_of(settings,
                       {.reads = {Resource::kFarSums, Resource::kPreviousFarMotion, Resource::kFarMatch},
                        .writes = {Resource::kFarMotion}}),
       .make = make_pass<FarFitPass>});
  PassSpec match{.kernel = "far_match",
                 .options = colour_options(settings),
                 .reason = "whether that explains the colour of what is infinitely far away",
                 .uses = uses_of(settings, {.reads = {Resource::kDrawnVelocity, Resource::kDepth,
                                                      Resource::kPreviousDepth, Resource::kColour,
                                                      Resource::kPreviousColour, Resource::kFarMotion,
                                                      Resource::kExposure},
                                            .sums = {Resource::kFarMatch}}),
                 .make = make_pass<FarMatchPass>};
  if (settings.targets.storage == Storage::kBuffer)
    match.options += std::string(" -D VELOCITY_FORMAT=") + precision_of(settings.velocity);
  list.passes.push_back(std::move(match));
}

// far_velocity: the drawn velocity, completed where the sky has none.

namespace {

class FarVelocityPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const bool fitted = facts().fits_sky();
    const double aspect = static_cast<double>(frame.output.width) / frame.output.height;
    const VelocityScale to_uv = velocity_scale_to(frame.inputs, {1, 1});
    const FarVelocityParams params{.frame = {.width = render.width,
                                             .height = render.height,
                                             .depth = layout_of(frame[Resource::kDepth]),
                                             .velocity = layout_of(frame[Resource::kVelocity]),
                                             .columns_per_item = columns_per_item(shape(), render.width),
                                             .camera = camera_params(frame.inputs)},
                                   .drawn = layout_of(frame[Resource::kDrawnVelocity]),
                                   .places = far_places(frame.inputs, frame.output),
                                   .to_drawn_x = inverse_scale(fitted ? to_uv.x * aspect : to_uv.x),
                                   .to_drawn_y = inverse_scale(to_uv.y)};
    bind(frame, params, Resource::kDepth, Resource::kDrawnVelocity, Resource::kFarMotion, Resource::kFarMatch,
         Resource::kVelocity);
    launch(frame, render, params.frame.columns_per_item, event);
  }
};

}  // namespace

void plan_far_velocity(const PlanFacts& facts, PassList& list) {
  if (facts.settings.conventions.sky_motion == SkyMotion::kAsDrawn) return;
  if (!facts.moves_sky()) {
    const char* reason =
        !facts.reads_velocity()                     ? "no pass reads velocity"
        : !facts.needs.camera_motion                ? "the camera stands still, and so does what is far away"
        : facts.velocity == VelocitySource::kTarget ? "the method uses one frame only: there is no evidence"
                                                    : "velocity comes from depth and the camera everywhere";
    list.left_out.push_back({"far_velocity", reason});
    return;
  }
  PassSpec spec{.kernel = "far_velocity",
                .options = fmt::format("-D FAR={} {}", facts.fits_sky() ? "EVIDENCE" : "CAMERA",
                                       velocity_options(facts.settings)),
                .reason = "what is infinitely far away moves with the camera",
                .uses = uses_of(facts.settings, {.reads = {Resource::kDepth, Resource::kDrawnVelocity},
                                                 .writes = {Resource::kVelocity}}),
                .make = make_pass<FarVelocityPass>};
  if (facts.fits_sky()) {
    for (const Resource found : {Resource::kFarMotion, Resource::kFarMatch})
      spec.uses.push_back(use(found, facts.settings));
  }
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
