// SPDX-License-Identifier: MIT
// display_layers: the near layer laid over the picture.
#include <fmt/format.h>

#include "layer_params.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal_pass_params.h"

namespace quincunx {
namespace {

const char* view_option(TemporalView view) {
  switch (view) {
    case TemporalView::kLayers:
      return "LAYERS";
    case TemporalView::kCoverage:
      return "COVERAGE";
    case TemporalView::kNear:
      return "NEAR";
    default:
      return "PICTURE";
  }
}

class DisplayLayersPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Resource shown = shown_history_of(facts());
    const TemporalDisplayParams params = temporal_display_params(frame, shape(), shown);
    const LayerPastParams now =
        layer_past_params(frame.current, frame.output, layout_of(frame[Resource::kDepth]), {});
    bind(params, now, frame[Resource::kDepth], frame[Resource::kTileReprojection],
         frame[Resource::kLayerTiles], frame[Resource::kHistory], frame[Resource::kNearHistory],
         frame[Resource::kLayerStates], frame[shown]);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_display_layers(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers() || facts.settings.temporal.view == TemporalView::kFar) return;
  const ResolveSettings& settings = facts.settings;
  const PixelFormat history = settings.temporal.history;
  list.passes.push_back(
      {.kernel = "display_layers",
       .options = fmt::format("-D VIEW={} {} -D HISTORY_FORMAT={}", view_option(settings.temporal.view),
                              scale_options(settings), precision_of(history)),
       .reason = "the second layer: the near one laid over the picture",
       .uses = {{Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                {Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
                {Resource::kLayerTiles, Access::kRead, Area::kTiles, {}, sizeof(LayerTile)},
                {Resource::kHistory, Access::kRead, Area::kOutput, history},
                {Resource::kNearHistory, Access::kRead, Area::kOutput, history},
                {Resource::kLayerStates, Access::kRead, Area::kOutput, {}, kLayerStateBytes},
                {shown_history_of(facts), Access::kWrite, Area::kOutput, settings.resolved}},
       .make = make_pass<DisplayLayersPass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
