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
    bind(frame, params, frame.tables.positions().get(frame.queue, resize_key(frame)),
         Resource::kPreviousTileReprojection, Resource::kPreviousHistory, Resource::kPreviousHistoryAlpha,
         Resource::kHistory, Resource::kHistoryAlpha);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

class ResizeTilesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ResizeParams params = resize_params(frame, shape());
    bind(frame, params, Resource::kPreviousTileReprojection, Resource::kPreviousTileLight,
         Resource::kPreviousLayerTiles, Resource::kTileReprojection, Resource::kTileLight,
         Resource::kLayerTiles);
    launch(frame, {params.tiles_x, params.tiles_y}, 1, event);
  }
};

constexpr const char* kHistoryReason = "where the output's size changes: the history in the new one";

}  // namespace

void plan_resize_history(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "resize_history",
      .reason = kHistoryReason,
      .uses = uses_of(settings, {.reads = {Resource::kPreviousTileReprojection, Resource::kPreviousHistory},
                                 .writes = {Resource::kHistory},
                                 .resizes = true}),
      .make = make_pass<ResizeHistoryPass>,
      .frames = Frames::kResized};
  spec.add_where(
      facts.accumulates_alpha(), "ALPHA", settings,
      {.reads = {Resource::kPreviousHistoryAlpha}, .writes = {Resource::kHistoryAlpha}, .resizes = true});
  spec.add_options(fmt::format("-D HISTORY_FORMAT={}", precision_of(settings.temporal.history)));
  list.passes.push_back(std::move(spec));
}

void plan_resize_tiles(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history()) return;
  PassSpec spec{.kernel = "resize_tiles",
                .options = "",
                .reason = kHistoryReason,
                .uses = uses_of(facts.settings,
                                {.reads = {Resource::kPreviousTileReprojection, Resource::kPreviousTileLight},
                                 .writes = {Resource::kTileReprojection, Resource::kTileLight},
                                 .resizes = true}),
                .make = make_pass<ResizeTilesPass>,
                .frames = Frames::kResized};
  spec.add_where(
      facts.has_layers(), "LAYERS", facts.settings,
      {.reads = {Resource::kPreviousLayerTiles}, .writes = {Resource::kLayerTiles}, .resizes = true});
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
    bind(frame, params, before, frame.tables.positions().get(frame.queue, resize_key(frame)),
         Resource::kPreviousDepth, Resource::kPreviousTileReprojection, Resource::kPreviousLayerTiles,
         Resource::kPreviousHistory, Resource::kPreviousHistoryAlpha, Resource::kPreviousNearHistory,
         Resource::kPreviousLayerStates, Resource::kLayerTiles, Resource::kNearHistory,
         Resource::kLayerStates);
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
    bind(frame, grid.width, grid.height, columns, cl_float2{{ratio.x, ratio.y}},
         Resource::kPreviousRecordKeys, Resource::kPreviousRecords);
    launch(frame, grid, columns, event);
  }
};

}  // namespace

void plan_resize_layers(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history() || !facts.has_layers()) return;
  const PixelFormat history = facts.settings.temporal.history;
  PassSpec spec{.kernel = "resize_layers",
                .reason = "where the output's size changes: the second layer in the new one",
                .uses = uses_of(facts.settings,
                                {.reads = {Resource::kPreviousDepth, Resource::kPreviousTileReprojection,
                                           Resource::kPreviousLayerTiles, Resource::kPreviousHistory,
                                           Resource::kPreviousNearHistory, Resource::kPreviousLayerStates,
                                           Resource::kLayerTiles},
                                 .writes = {Resource::kNearHistory, Resource::kLayerStates},
                                 .resizes = true}),
                .make = make_pass<ResizeLayersPass>,
                .frames = Frames::kResized};
  spec.add_where(facts.accumulates_alpha(), "ALPHA", facts.settings,
                 {.reads = {Resource::kPreviousHistoryAlpha}, .resizes = true});
  spec.add_options(fmt::format("-D SOURCE_STORAGE={} -D HISTORY_FORMAT={}",
                               storage_option(facts.settings.targets.storage), precision_of(history)));
  list.passes.push_back(std::move(spec));
}

void plan_resize_records(const PlanFacts& facts, PassList& list) {
  if (!facts.resizes_history() || !facts.has_layers()) return;
  list.passes.push_back({.kernel = "resize_records",
                         .options = {},
                         .reason = "where the output's size changes: records in its pixels",
                         .uses = uses_of(facts.settings, {.reads = {Resource::kPreviousRecordKeys},
                                                          .writes = {Resource::kPreviousRecords}}),
                         .make = make_pass<ResizeRecordsPass>,
                         .frames = Frames::kResized});
}

}  // namespace quincunx
