// SPDX-License-Identifier: MIT
// resolve_layers: this frame added to the history of pixels that may have two layers.
#include <fmt/format.h>

#include "layer_params.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal_pass_params.h"

namespace quincunx {
namespace {

class ResolveLayersPass : public Pass {
 public:
  ResolveLayersPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const TemporalParams params = temporal_params(frame, shape(), facts());
    const LayerPastParams before =
        layer_past_params(frame.previous, frame.output, layout_of(frame[Resource::kDepth]),
                          layout_of(frame[Resource::kPreviousDepth]));
    bind(params, before, frame.tables.positions().get(frame.queue, frame.key()), frame[Resource::kColour],
         frame[Resource::kReprojection], frame[Resource::kDepth], frame[Resource::kPreviousDepth],
         frame[Resource::kOpenTrust], frame[Resource::kSplits], frame[Resource::kPreviousHistory],
         view_or(frame, Resource::kPreviousHistoryAlpha, Resource::kPreviousHistory),
         frame[Resource::kPreviousNearHistory], frame[Resource::kPreviousLayerStates],
         frame[Resource::kPreviousTileReprojection], frame[Resource::kPreviousLayerTiles],
         frame[Resource::kTileReprojection], frame[Resource::kLayerTiles], frame[Resource::kTileLight],
         frame[Resource::kHistory], view_or(frame, Resource::kHistoryAlpha, Resource::kHistory),
         frame[Resource::kNearHistory], frame[Resource::kLayerStates], frame.counter);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_resolve_layers(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) return;
  const ResolveSettings& settings = facts.settings;
  const PixelFormat history = settings.temporal.history;
  PassSpec spec{
      .kernel = "resolve_layers",
      .options = fmt::format("-D ALPHA={} {} -D HISTORY_FORMAT={}", facts.accumulates_alpha() ? 1 : 0,
                             colour_options(settings), precision_of(history)),
      .reason = "the second layer: this frame added to the history of pixels that have two",
      .uses =
          {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
           {Resource::kReprojection, Access::kRead, Area::kViewport, PixelFormat::kRGBA32F},
           {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
           {Resource::kPreviousDepth, Access::kRead, Area::kPreviousViewport, PixelFormat::kR32F},
           {Resource::kOpenTrust, Access::kRead, Area::kViewport, {}, sizeof(cl_float)},
           {Resource::kSplits, Access::kRead, Area::kViewport, {}, sizeof(LayerSplit)},
           {Resource::kPreviousHistory, Access::kRead, Area::kOutput, history},
           {Resource::kPreviousNearHistory, Access::kRead, Area::kOutput, history},
           {Resource::kPreviousLayerStates, Access::kRead, Area::kOutput, {}, kLayerStateBytes},
           {Resource::kPreviousTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
           {Resource::kPreviousLayerTiles, Access::kRead, Area::kTiles, {}, sizeof(LayerTile)},
           {Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
           {Resource::kLayerTiles, Access::kRead, Area::kTiles, {}, sizeof(LayerTile)},
           {Resource::kTileLight, Access::kRead, Area::kTiles, {}, sizeof(TileLight)},
           {Resource::kHistory, Access::kWrite, Area::kOutput, history},
           {Resource::kNearHistory, Access::kWrite, Area::kOutput, history},
           {Resource::kLayerStates, Access::kWrite, Area::kOutput, {}, kLayerStateBytes}},
      .make = make_pass<ResolveLayersPass>,
      .frames = Frames::kSparse};
  if (facts.accumulates_alpha()) {
    const std::size_t bytes = alpha_bytes(settings);
    spec.uses.push_back({Resource::kPreviousHistoryAlpha, Access::kRead, Area::kOutput, {}, bytes});
    spec.uses.push_back({Resource::kHistoryAlpha, Access::kWrite, Area::kOutput, {}, bytes});
  }
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
