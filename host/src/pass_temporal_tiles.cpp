// SPDX-License-Identifier: MIT
// temporal_tiles: which tiles move as a whole, and what their samples say of the history.
#include <fmt/format.h>

#include "layers/layer.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal/temporal_params.h"
#include "temporal_pass_params.h"

namespace quincunx {
namespace {

// One of how many samples judges history. Of a checkerboard only every second one is shaded.
int judged_apart(const PlanFacts& facts) {
  switch (facts.settings.temporal.preset) {
    case TemporalPreset::kFast:
      return 4;
    case TemporalPreset::kBalanced:
      break;
    case TemporalPreset::kQuality:
      if (!facts.fills()) return 1;
      break;
  }
  return 2;
}

class TemporalTilesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& current = frame.current;
    const Extent output = frame.output;
    const Extent render = current.render;
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    const Ratio spacing = ratio_of(output, render);
    const Ratio motion = ratio_of(output, frame.previous.render);
    const TemporalTileParams params{
        .frame = {render.width, render.height, layout_of(frame[Resource::kColour]), {}, {}},
        .output_width = output.width,
        .output_height = output.height,
        .tiles_x = tiles.width,
        .tiles_y = tiles.height,
        .reprojection = layout_if_used(frame, Resource::kReprojection),
        .spacing_x = spacing.x,
        .spacing_y = spacing.y,
        .start_x = (.5f + current.jitter.x) * spacing.x,
        .start_y = (.5f + current.jitter.y) * spacing.y,
        .motion_x = motion.x,
        .motion_y = motion.y,
        .judged_apart = judged_apart(facts()),
        .parity = shaded_parity(facts(), current)};
    bind(params, frame[Resource::kColour],
         view_or(frame, Resource::kReprojection, Resource::kTileReprojection),
         frame[Resource::kPreviousHistory], frame[Resource::kPreviousTileReprojection],
         view_or(frame, Resource::kDepth, Resource::kColour), layout_if_used(frame, Resource::kDepth),
         view_or(frame, Resource::kSplits, Resource::kTileReprojection),
         view_or(frame, Resource::kSplitMarks, Resource::kTileReprojection),
         view_or(frame, Resource::kPreviousLayerTiles, Resource::kTileReprojection),
         view_or(frame, Resource::kLayerTiles, Resource::kTileReprojection),
         frame[Resource::kTileReprojection], frame[Resource::kTileEvidence], frame[Resource::kTotalLight]);
    launch(frame, tiles, columns_per_item(shape(), tiles.width, 1), event);
  }
};

}  // namespace

void plan_temporal_tiles(const PlanFacts& facts, PassList& list) {
  if (!facts.accumulates()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "temporal_tiles",
      .options = fmt::format("-D MOTION={} -D LAYERS={} {} -D HISTORY_FORMAT={}", facts.reprojects() ? 1 : 0,
                             facts.has_layers() ? 1 : 0, colour_options(settings),
                             precision_of(settings.temporal.history)),
      .reason = "the method: which tiles move as a whole",
      .uses =
          {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
           {Resource::kPreviousHistory, Access::kRead, Area::kOutput, settings.temporal.history},
           {Resource::kPreviousTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
           {Resource::kTileReprojection, Access::kWrite, Area::kTiles, {}, sizeof(TileReprojection)},
           {Resource::kTileEvidence, Access::kWrite, Area::kTiles, {}, sizeof(TileEvidence)},
           {Resource::kTotalLight, Access::kAccumulate, Area::kWhole, {}, sizeof(TotalLight)}},
      .make = make_pass<TemporalTilesPass>,
      .frames = Frames::kSparse};
  if (facts.reprojects())
    spec.uses.push_back({Resource::kReprojection, Access::kRead, Area::kViewport, PixelFormat::kRGBA32F});
  if (facts.has_layers()) {
    spec.uses.insert(spec.uses.end(),
                     {{Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                      {Resource::kSplits, Access::kRead, Area::kViewport, {}, sizeof(LayerSplit)},
                      {Resource::kSplitMarks, Access::kRead, Area::kTiles, {}, sizeof(int)},
                      {Resource::kPreviousLayerTiles, Access::kRead, Area::kTiles, {}, sizeof(LayerTile)},
                      {Resource::kLayerTiles, Access::kWrite, Area::kTiles, {}, sizeof(LayerTile)}});
  }
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
