// SPDX-License-Identifier: MIT
// resize_history, resize_tiles: the history where the output has another size than in the previous frame.
#include <fmt/format.h>

#include "layers/layer.h"
#include "pass_list.h"
#include "pass_options.h"
#include "resize_params.h"

namespace quincunx {
namespace {

class ResizeHistoryPass : public Pass {
 public:
  ResizeHistoryPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ResizeParams params = resize_params(frame, shape());
    bind(params, frame.tables.positions().get(frame.queue, resize_key(frame)),
         frame[Resource::kPreviousTileReprojection], frame[Resource::kPreviousHistory],
         view_or(frame, Resource::kPreviousHistoryAlpha, Resource::kPreviousHistory),
         frame[Resource::kHistory], view_or(frame, Resource::kHistoryAlpha, Resource::kHistory));
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

class ResizeTilesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ResizeParams params = resize_params(frame, shape());
    bind(params, frame[Resource::kPreviousTileReprojection], frame[Resource::kPreviousTileLight],
         view_or(frame, Resource::kPreviousLayerTiles, Resource::kPreviousTileReprojection),
         frame[Resource::kTileReprojection], frame[Resource::kTileLight],
         view_or(frame, Resource::kLayerTiles, Resource::kTileReprojection));
    launch(frame, {params.tiles_x, params.tiles_y}, 1, event);
  }
};

constexpr const char* kReason = "where the output's size changes: the history in the new one";

}  // namespace

void plan_resize_history(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history()) return;
  const PixelFormat history = facts.settings.temporal.history;
  const bool alpha = facts.accumulates_alpha();
  PassSpec spec{
      .kernel = "resize_history",
      .options = fmt::format("-D ALPHA={} -D HISTORY_FORMAT={}", alpha ? 1 : 0, precision_of(history)),
      .reason = kReason,
      .uses = {{Resource::kPreviousTileReprojection,
                Access::kRead,
                Area::kPreviousTiles,
                {},
                sizeof(TileReprojection)},
               {Resource::kPreviousHistory, Access::kRead, Area::kPreviousOutput, history},
               {Resource::kHistory, Access::kWrite, Area::kOutput, history}},
      .make = make_pass<ResizeHistoryPass>,
      .frames = Frames::kResized};
  if (alpha) {
    const std::size_t bytes = alpha_bytes(facts.settings);
    spec.uses.push_back({Resource::kPreviousHistoryAlpha, Access::kRead, Area::kPreviousOutput, {}, bytes});
    spec.uses.push_back({Resource::kHistoryAlpha, Access::kWrite, Area::kOutput, {}, bytes});
  }
  list.passes.push_back(std::move(spec));
}

void plan_resize_tiles(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history()) return;
  PassSpec spec{.kernel = "resize_tiles",
                .options = fmt::format("-D LAYERS={}", facts.has_layers() ? 1 : 0),
                .reason = kReason,
                .uses = {},
                .make = make_pass<ResizeTilesPass>,
                .frames = Frames::kResized};
  const auto add = [&spec](Resource resource, std::size_t bytes) {
    spec.uses.push_back({previous_of(resource), Access::kRead, Area::kPreviousTiles, {}, bytes});
    spec.uses.push_back({resource, Access::kWrite, Area::kTiles, {}, bytes});
  };
  add(Resource::kTileReprojection, sizeof(TileReprojection));
  add(Resource::kTileLight, sizeof(TileLight));
  if (facts.has_layers()) add(Resource::kLayerTiles, sizeof(LayerTile));
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
