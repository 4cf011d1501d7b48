// SPDX-License-Identifier: MIT
// The passes of motion blur: motion_tiles, motion_neighbours, motion_blur.
#include <fmt/format.h>

#include <bit>

#include "motion/blur_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"

namespace quincunx {
namespace {

int log2_of(int power) {
  return std::bit_width(static_cast<unsigned>(power)) - 1;
}

// Returns the factors from the units of the velocity target to streaks: a frame's motion in output pixels, times the
// open part of the frame.
Vec2 streak_scale(const FrameInputs& inputs, Extent output, float shutter) {
  const VelocityScale pixels = velocity_scale_to(inputs, output);
  const double units = static_cast<double>(shutter) * static_cast<int>(kStreakUnits);
  return {static_cast<float>(units * pixels.x), static_cast<float>(units * pixels.y)};
}

MotionParams motion_params(const PassFrame& frame, const WorkShape& shape,
                           const MotionBlurSettings& settings) {
  const Extent grid = extent_of(Area::kBlurTiles, frame.extents());
  const Vec2 scale = streak_scale(frame.inputs, frame.output, settings.shutter);
  return {.output_width = frame.output.width,
          .output_height = frame.output.height,
          .tiles_x = grid.width,
          .tiles_y = grid.height,
          .source = layout_of(frame[Resource::kResolved]),
          .velocity = layout_of(frame[Resource::kVelocity]),
          .depth = layout_of(frame[Resource::kDepth]),
          .output = layout_of(frame[Resource::kBlurred]),
          .row_axis = padded_columns(frame.output),
          .columns_per_item = columns_per_item(shape, frame.output.width),
          .most_samples_log2 = log2_of(settings.samples),
          .scale_x = scale.x,
          .scale_y = scale.y};
}

}  // namespace

// motion_tiles: how far the surfaces of each tile move while the shutter is open.

namespace {

class MotionTilesPass : public Pass {
 public:
  MotionTilesPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) { setup.tables.axis(); }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    bind(frame, motion_params(frame, shape(), settings().blur),
         frame.tables.axis().get(frame.queue, frame.key()), Resource::kVelocity, Resource::kStreaks,
         Resource::kLongestStreak);
    launch(frame, extent_of(Area::kBlurTiles, frame.extents()), 1, event);
  }
};

}  // namespace

void plan_motion_tiles(const PlanFacts& facts, PassList& list) {
  if (!facts.blurs()) {
    list.left_out.push_back(
        {"motion blur", facts.settings.blur.shutter > 0 ? "nothing moves" : "the shutter opens for no time"});
    return;
  }
  list.passes.push_back({.kernel = "motion_tiles",
                         .options = velocity_options(facts.settings),
                         .reason = "motion blur: how far the surfaces of a tile move",
                         .uses = uses_of(facts.settings, {.reads = {Resource::kVelocity},
                                                          .writes = {Resource::kStreaks},
                                                          .sums = {Resource::kLongestStreak}}),
                         .make = make_pass<MotionTilesPass>});
}

// motion_neighbours: the motion that reaches each tile from those around it.

namespace {

class MotionNeighboursPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    bind(frame, motion_params(frame, shape(), settings().blur), Resource::kStreaks, Resource::kLongestStreak,
         Resource::kTileBlurs);
    launch(frame, extent_of(Area::kBlurTiles, frame.extents()), 1, event);
  }
};

}  // namespace

void plan_motion_neighbours(const PlanFacts& facts, PassList& list) {
  if (!facts.blurs()) return;
  list.passes.push_back(
      {.kernel = "motion_neighbours",
       .options = "",
       .reason = "motion blur: what reaches a tile",
       .uses = uses_of(facts.settings, {.reads = {Resource::kStreaks, Resource::kLongestStreak},
                                        .writes = {Resource::kTileBlurs}}),
       .make = make_pass<MotionNeighboursPass>});
}

// motion_blur: the mean of the resolved picture along its motion over the shutter's time.

namespace {

class MotionBlurPass : public Pass {
 public:
  MotionBlurPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) { setup.tables.axis(); }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const MotionParams params = motion_params(frame, shape(), settings().blur);
    bind(frame, params, frame.tables.axis().get(frame.queue, frame.key()), Resource::kTileBlurs,
         Resource::kResolved, Resource::kVelocity, Resource::kDepth, Resource::kBlurred);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_motion_blur(const PlanFacts& facts, PassList& list) {
  if (!facts.blurs()) return;
  const ResolveSettings& settings = facts.settings;
  list.passes.push_back(
      {.kernel = "motion_blur",
       .options = fmt::format("{0} -D SOURCE_FORMAT={1} -D OUTPUT_FORMAT={1}", velocity_options(settings),
                              precision_of(settings.output.linear)),
       .reason = "motion blur: the mean over the shutter's time",
       .uses = uses_of(settings, {.reads = {Resource::kResolved, Resource::kVelocity, Resource::kDepth,
                                            Resource::kTileBlurs},
                                  .writes = {Resource::kBlurred}}),
       .make = make_pass<MotionBlurPass>});
}

}  // namespace quincunx
