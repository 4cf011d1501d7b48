// SPDX-License-Identifier: MIT
// resize_layers, resize_records: the second layer of history where the output has another size than in the previous
// frame.
#include <fmt/format.h>

#include "layer_params.h"
#include "pass_list.h"
#include "pass_options.h"
#include "resize_params.h"

namespace quincunx {
namespace {

class ResizeLayersPass : public Pass {
 public:
  ResizeLayersPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ResizeParams params = resize_params(frame, shape());
    const LayerPastParams past = layer_past_params(frame.previous, frame.previous_output,
                                                   layout_of(frame[Resource::kPreviousDepth]), {});
    const ResizeSamples before{past.depth0,    past.width,   past.height, past.spacing_x,
                               past.spacing_y, past.start_x, past.start_y};
    bind(params, before, frame.tables.positions().get(frame.queue, resize_key(frame)),
         frame[Resource::kPreviousDepth], frame[Resource::kPreviousTileReprojection],
         frame[Resource::kPreviousLayerTiles], frame[Resource::kPreviousHistory],
         frame[Resource::kPreviousNearHistory], frame[Resource::kPreviousLayerStates],
         frame[Resource::kLayerTiles], frame[Resource::kNearHistory], frame[Resource::kLayerStates]);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

class ResizeRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent grid = frame.previous.render;
    const Ratio ratio = ratio_of(frame.output, frame.previous_output);
    const int columns = columns_per_item(shape(), grid.width);
    bind(grid.width, grid.height, columns, cl_float2{{ratio.x, ratio.y}},
         frame[Resource::kPreviousRecordKeys], frame[Resource::kPreviousRecords]);
    launch(frame, grid, columns, event);
  }
};

constexpr const char* kReason = "where the output's size changes: the second layer in the new one";

}  // namespace

void plan_resize_layers(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history() || !facts.has_layers()) return;
  const PixelFormat history = facts.settings.temporal.history;
  const auto tiles = [](Resource resource, Area area, std::size_t bytes) {
    return Use{resource, Access::kRead, area, {}, bytes};
  };
  list.passes.push_back(
      {.kernel = "resize_layers",
       .options = fmt::format("-D SOURCE_STORAGE={} -D HISTORY_FORMAT={}",
                              storage_option(facts.settings.storage), precision_of(history)),
       .reason = kReason,
       .uses = {{Resource::kPreviousDepth, Access::kRead, Area::kPreviousViewport, PixelFormat::kR32F},
                tiles(Resource::kPreviousTileReprojection, Area::kPreviousTiles, sizeof(TileReprojection)),
                tiles(Resource::kPreviousLayerTiles, Area::kPreviousTiles, sizeof(LayerTile)),
                {Resource::kPreviousHistory, Access::kRead, Area::kPreviousOutput, history},
                {Resource::kPreviousNearHistory, Access::kRead, Area::kPreviousOutput, history},
                tiles(Resource::kPreviousLayerStates, Area::kPreviousOutput, kLayerStateBytes),
                tiles(Resource::kLayerTiles, Area::kTiles, sizeof(LayerTile)),
                {Resource::kNearHistory, Access::kWrite, Area::kOutput, history},
                {Resource::kLayerStates, Access::kWrite, Area::kOutput, {}, kLayerStateBytes}},
       .make = make_pass<ResizeLayersPass>,
       .frames = Frames::kResized});
}

void plan_resize_records(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history() || !facts.has_layers()) return;
  list.passes.push_back(
      {.kernel = "resize_records",
       .options = {},
       .reason = "where the output's size changes: records in its pixels",
       .uses =
           {{Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
            {Resource::kPreviousRecords, Access::kWrite, Area::kPreviousViewport, {}, sizeof(LayerRecord)}},
       .make = make_pass<ResizeRecordsPass>,
       .frames = Frames::kResized});
}

}  // namespace quincunx
