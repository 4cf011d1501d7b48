// SPDX-License-Identifier: MIT
// temporal_light: where the light has changed, and where the picture has.
#include "pass.h"
#include "pass_list.h"
#include "temporal/temporal_params.h"

namespace quincunx {
namespace {

class TemporalLightPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    bind(tiles.width, tiles.height, frame[Resource::kTileReprojection], frame[Resource::kTileEvidence],
         frame[Resource::kTotalLight], frame[Resource::kPreviousTileLight], frame[Resource::kTileLight]);
    launch(frame, tiles, columns_per_item(shape(), tiles.width, 1), event);
  }
};

}  // namespace

void plan_temporal_light(const PlanFacts& facts, PassList& list) {
  if (!facts.accumulates()) return;
  list.passes.push_back(
      {.kernel = "temporal_light",
       .options = "",
       .reason = "the method: where the light has changed",
       .uses = {{Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
                {Resource::kTileEvidence, Access::kRead, Area::kTiles, {}, sizeof(TileEvidence)},
                {Resource::kTotalLight, Access::kRead, Area::kWhole, {}, sizeof(TotalLight)},
                {Resource::kPreviousTileLight, Access::kRead, Area::kTiles, {}, sizeof(TileLight)},
                {Resource::kTileLight, Access::kWrite, Area::kTiles, {}, sizeof(TileLight)}},
       .make = make_pass<TemporalLightPass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
