// SPDX-License-Identifier: MIT
// motion_neighbours: the motion that reaches each tile from those around it.
#include "motion/blur_params.h"
#include "motion_params.h"
#include "pass_list.h"

namespace quincunx {
namespace {

class MotionNeighboursPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    bind(motion_params(frame, shape(), settings().blur), frame[Resource::kStreaks],
         frame[Resource::kLongestStreak], frame[Resource::kTileBlurs]);
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
       .uses = {{Resource::kStreaks, Access::kRead, Area::kBlurTiles, {}, sizeof(TileStreaks)},
                {Resource::kLongestStreak, Access::kRead, Area::kWhole, {}, sizeof(cl_int)},
                {Resource::kTileBlurs, Access::kWrite, Area::kBlurTiles, {}, sizeof(TileBlur)}},
       .make = make_pass<MotionNeighboursPass>});
}

}  // namespace quincunx
