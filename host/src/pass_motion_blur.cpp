// SPDX-License-Identifier: MIT
// motion_blur: the mean of the resolved picture along its motion over the shutter's time.
#include <fmt/format.h>

#include "motion/blur_params.h"
#include "motion_params.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class MotionBlurPass : public Pass {
 public:
  MotionBlurPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) { setup.tables.axis(); }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const MotionParams params = motion_params(frame, shape(), settings().blur);
    bind(params, frame.tables.axis().get(frame.queue, frame.key()), frame[Resource::kTileBlurs],
         frame[Resource::kResolved], frame[Resource::kVelocity], frame[Resource::kDepth],
         frame[Resource::kBlurred]);
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
                              precision_of(settings.resolved)),
       .reason = "motion blur: the mean over the shutter's time",
       .uses = {{Resource::kResolved, Access::kRead, Area::kOutput, settings.resolved},
                {Resource::kVelocity, Access::kRead, Area::kViewport, settings.velocity},
                {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                {Resource::kTileBlurs, Access::kRead, Area::kBlurTiles, {}, sizeof(TileBlur)},
                {Resource::kBlurred, Access::kWrite, Area::kOutput, settings.resolved}},
       .make = make_pass<MotionBlurPass>});
}

}  // namespace quincunx
