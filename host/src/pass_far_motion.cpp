// SPDX-License-Identifier: MIT
// far_surroundings, far_fit, far_match: how the camera moves what is infinitely far away, from what all else does.
#include <algorithm>

#include "camera_params.h"
#include "motion/far_params.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class FarSurroundingsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
    const Extent cells = extent_of(Area::kFarCells, frame.extents());
    const VelocityScale to_uv = velocity_scale_to(frame.current, {1, 1});
    const double aspect = static_cast<double>(frame.output.width) / frame.output.height;
    const FarSumsParams params{.width = render.width,
                               .height = render.height,
                               .cells_x = cells.width,
                               .cells_y = cells.height,
                               .depth = layout_of(frame[Resource::kDepth]),
                               .drawn = layout_of(frame[Resource::kDrawnVelocity]),
                               .places = far_places(frame.current, frame.output),
                               .from_drawn_x = static_cast<float>(to_uv.x * aspect),
                               .from_drawn_y = static_cast<float>(to_uv.y),
                               .pixels = static_cast<float>(frame.output.height)};
    bind(params, frame[Resource::kDepth], frame[Resource::kDrawnVelocity],
         frame[Resource::kPreviousFarMotion], frame[Resource::kFarSums]);
    launch(frame, cells, 1, event);
  }
};

class FarFitPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const auto cells = static_cast<cl_int>(extent_of(Area::kFarCells, frame.extents()).area());
    bind(cells, frame[Resource::kFarSums], frame[Resource::kPreviousFarMotion], frame[Resource::kFarMatch],
         frame[Resource::kFarMotion]);
    launch(frame, {1, 1}, 1, event);
  }
};

class FarMatchPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& current = frame.current;
    const FrameInputs& previous = frame.previous;
    const Extent cells = extent_of(Area::kFarCells, frame.extents());
    const auto step = [](int to, int from) { return static_cast<double>(to) / from; };
    const double step_x = step(previous.render.width, current.render.width);
    const double step_y = step(previous.render.height, current.render.height);
    const double aspect = static_cast<double>(frame.output.width) / frame.output.height;
    // So that the sum over all cells fits into an int.
    constexpr double kMost = 1 << 30, kSamples = kFarCell * kFarCell / 4.;
    const FarMatchParams params{
        .width = current.render.width,
        .height = current.render.height,
        .previous_width = previous.render.width,
        .previous_height = previous.render.height,
        .cells_x = cells.width,
        .cells_y = cells.height,
        .depth0 = layout_of(frame[Resource::kDepth]),
        .depth1 = layout_of(frame[Resource::kPreviousDepth]),
        .drawn = layout_of(frame[Resource::kDrawnVelocity]),
        .colour0 = layout_of(frame[Resource::kColour]),
        .colour1 = layout_of(frame[Resource::kPreviousColour]),
        .places = far_places(current, frame.output),
        .step_x = static_cast<float>(step_x),
        .step_y = static_cast<float>(step_y),
        .start_x = static_cast<float>((.5 + current.jitter.x) * step_x - .5 - previous.jitter.x),
        .start_y = static_cast<float>((.5 + current.jitter.y) * step_y - .5 - previous.jitter.y),
        .to_previous_x = static_cast<float>(previous.render.width / aspect),
        .to_previous_y = static_cast<float>(previous.render.height),
        .units = static_cast<float>(std::min(1024., kMost / (kSamples * static_cast<double>(cells.area()))))};
    bind(params, frame[Resource::kDepth], frame[Resource::kPreviousDepth], frame[Resource::kDrawnVelocity],
         frame[Resource::kColour], frame[Resource::kPreviousColour], frame[Resource::kFarMotion],
         frame[Resource::kFarMatch]);
    launch(frame, cells, 1, event);
  }
};

}  // namespace

void plan_far_motion(const PlanFacts& facts, PassList& list) {
  if (!facts.fits_far()) return;
  const ResolveSettings& settings = facts.settings;
  const Use depth = {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F};
  const Use drawn = {Resource::kDrawnVelocity, Access::kRead, Area::kViewport, settings.velocity};
  list.passes.push_back(
      {.kernel = "far_surroundings",
       .options = velocity_options(settings),
       .reason = "how the camera moves, by what is drawn with motion",
       .uses = {depth,
                drawn,
                {Resource::kPreviousFarMotion, Access::kRead, Area::kWhole, {}, sizeof(FarModel)},
                {Resource::kFarSums, Access::kWrite, Area::kFarCells, {}, sizeof(FarSums)}},
       .make = make_pass<FarSurroundingsPass>});
  // far_match, which comes after it, has not yet begun this frame's sums: these are the previous one's.
  list.passes.push_back(
      {.kernel = "far_fit",
       .options = "",
       .reason = "how the camera moves: the fit",
       .uses = {{Resource::kFarSums, Access::kRead, Area::kFarCells, {}, sizeof(FarSums)},
                {Resource::kPreviousFarMotion, Access::kRead, Area::kWhole, {}, sizeof(FarModel)},
                {Resource::kFarMatch, Access::kRead, Area::kWhole, {}, sizeof(FarMatch)},
                {Resource::kFarMotion, Access::kWrite, Area::kWhole, {}, sizeof(FarModel)}},
       .make = make_pass<FarFitPass>});
  PassSpec match{.kernel = "far_match",
                 .options = colour_options(settings),
                 .reason = "whether that explains the colour of what is infinitely far away",
                 .uses = {drawn,
                          {Resource::kFarMotion, Access::kRead, Area::kWhole, {}, sizeof(FarModel)},
                          {Resource::kFarMatch, Access::kAccumulate, Area::kWhole, {}, sizeof(FarMatch)}},
                 .make = make_pass<FarMatchPass>};
  if (settings.storage == Storage::kBuffer)
    match.options += std::string(" -D VELOCITY_FORMAT=") + precision_of(settings.velocity);
  read_both_frames(match.uses, Resource::kDepth, PixelFormat::kR32F);
  read_both_frames(match.uses, Resource::kColour, settings.colour);
  list.passes.push_back(std::move(match));
}

}  // namespace quincunx
