// SPDX-License-Identifier: MIT
// The passes that resize the history where the output has another size than in the previous frame: resize_history,
// resize_tiles, resize_layers, resize_records.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "layers/layer.h"
#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "temporal/temporal_params.h"
#include "temporal/tile.h"

namespace quincunx {
namespace {

// Returns at how many places of a pixel history is read on one axis: at its centre, but where history is clearly denser
// at as many as there are texels, so that none is skipped.
int places_of(int previous, int output) {
  constexpr double kDenser = 1.5;
  constexpr double kMost = 4;
  const double ratio = static_cast<double>(previous) / output;
  return ratio <= kDenser ? 1 : static_cast<int>(std::min(std::ceil(ratio), kMost));
}

// The confidence that is left at most: that of all history that was resampled; where the output grows less, because
// history cannot have the detail that is to come.
constexpr float kResampled = 8;
constexpr float kGrown = 1;

ResizeParams resize_params(const PassFrame& frame, const WorkShape& shape) {
  const Extent output = frame.output;
  const Extent before = frame.previous_output;
  const Extent tiles = extent_of(Area::kTiles, frame.extents());
  const Extent tiles_before = extent_of(Area::kPreviousTiles, frame.extents());
  const Ratio ratio = ratio_of(before, output);
  const double texels_a_pixel = static_cast<double>(before.area()) / static_cast<double>(output.area());
  return {.width = output.width,
          .height = output.height,
          .previous_width = before.width,
          .previous_height = before.height,
          .tiles_x = tiles.width,
          .tiles_y = tiles.height,
          .previous_tiles_x = tiles_before.width,
          .previous_tiles_y = tiles_before.height,
          .columns = position_columns(output),
          .columns_per_item = columns_per_item(shape, output.width, 1),
          .ratio_x = ratio.x,
          .ratio_y = ratio.y,
          .places_x = places_of(before.width, output.width),
          .places_y = places_of(before.height, output.height),
          .share = static_cast<float>(std::min(texels_a_pixel, 1.0)),
          .most = texels_a_pixel < 1 ? kGrown : kResampled};
}

// Returns the key of where the output's pixels lie among the texels of the history.
TableKey resize_key(const PassFrame& frame) {
  return {frame.output, frame.previous_output, {}};
}

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

constexpr const char* kHistoryReason = "where the output's size changes: the history in the new one";

}  // namespace

void plan_resize_history(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history()) return;
  const PixelFormat history = facts.settings.temporal.history;
  const bool alpha = facts.accumulates_alpha();
  PassSpec spec{
      .kernel = "resize_history",
      .options = fmt::format("-D ALPHA={} -D HISTORY_FORMAT={}", alpha ? 1 : 0, precision_of(history)),
      .reason = kHistoryReason,
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
                .reason = kHistoryReason,
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

// The second layer of history.

namespace {

class ResizeLayersPass : public Pass {
 public:
  ResizeLayersPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ResizeParams params = resize_params(frame, shape());
    const HistorySamples before =
        history_samples(frame.previous, frame.previous_output, layout_of(frame[Resource::kPreviousDepth]));
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
    const Extent grid = frame.previous.render_extent;
    const Ratio ratio = ratio_of(frame.output, frame.previous_output);
    const int columns = columns_per_item(shape(), grid.width);
    bind(grid.width, grid.height, columns, cl_float2{{ratio.x, ratio.y}},
         frame[Resource::kPreviousRecordKeys], frame[Resource::kPreviousRecords]);
    launch(frame, grid, columns, event);
  }
};

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
                              storage_option(facts.settings.targets.storage), precision_of(history)),
       .reason = "where the output's size changes: the second layer in the new one",
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
