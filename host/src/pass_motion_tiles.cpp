// SPDX-License-Identifier: MIT
// motion_tiles: how far the surfaces of each tile move while the shutter is open.
#include "motion/blur_params.h"
#include "motion_params.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class MotionTilesPass : public Pass {
 public:
  MotionTilesPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) { setup.tables.axis(); }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    bind(motion_params(frame, shape(), settings().blur), frame.tables.axis().get(frame.queue, frame.key()),
         frame[Resource::kVelocity], frame[Resource::kStreaks], frame[Resource::kLongestStreak]);
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
  list.passes.push_back(
      {.kernel = "motion_tiles",
       .options = velocity_options(facts.settings),
       .reason = "motion blur: how far the surfaces of a tile move",
       .uses = {{Resource::kVelocity, Access::kRead, Area::kViewport, facts.settings.velocity},
                {Resource::kStreaks, Access::kWrite, Area::kBlurTiles, {}, sizeof(TileStreaks)},
                {Resource::kLongestStreak, Access::kAccumulate, Area::kWhole, {}, sizeof(cl_int)}},
       .make = make_pass<MotionTilesPass>});
}

}  // namespace quincunx
