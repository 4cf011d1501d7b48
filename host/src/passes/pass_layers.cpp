// SPDX-License-Identifier: MIT
// The passes of kernels/layers, the second layer of history: layer_records, turn_records, advect_records, layer_split,
// resolve_layers, display_layers. Those that resize it are in pass_resize.cpp.
#include <fmt/format.h>

#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"

namespace quincunx {

// layer_records: the samples of near surfaces at edges of motion.

namespace {

class LayerRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render_extent;
    const LayerParams params = layer_params(frame, shape(), render);
    bind(params, frame[Resource::kVelocity], frame[Resource::kDepth], frame[Resource::kReprojection],
         frame[Resource::kPreviousRecordKeys], frame[Resource::kPreviousRecords],
         frame[Resource::kRecordKeys], frame[Resource::kRecords]);
    launch(frame, render, params.columns_per_item, event);
  }
};

}  // namespace

void plan_layer_records(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) {
    if (!facts.accumulates() || !facts.reprojects()) return;
    const bool is_fast = facts.settings.temporal.preset == TemporalPreset::kFast;
    list.left_out.push_back({"second layer of history",
                             is_fast ? "the preset fast has one layer"
                                     : "the view shows one layer; layers, coverage, near and far show both"});
    return;
  }
  list.passes.push_back(
      {.kernel = "layer_records",
       .options = velocity_options(facts.settings),
       .reason = "the second layer: samples of near surfaces at edges of motion",
       .uses = {{Resource::kVelocity, Access::kRead, Area::kViewport, facts.settings.velocity},
                {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                {Resource::kReprojection, Access::kRead, Area::kViewport, PixelFormat::kRGBA32F},
                {Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
                {Resource::kPreviousRecords, Access::kRead, Area::kPreviousViewport, {}, sizeof(LayerRecord)},
                {Resource::kRecordKeys, Access::kWrite, Area::kViewport, {}, sizeof(cl_uint)},
                {Resource::kRecords, Access::kWrite, Area::kViewport, {}, sizeof(LayerRecord)}},
       .make = make_pass<LayerRecordsPass>,
       .frames = Frames::kSparse});
}

// turn_records: thin things that stop, start or turn about take their records with them.

namespace {

class TurnRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent before = frame.previous.render_extent;
    const LayerParams params = layer_params(frame, shape(), before);
    bind(params, frame[Resource::kPreviousRecordKeys], frame[Resource::kRecordKeys],
         frame[Resource::kRecords], frame[Resource::kPreviousRecords]);
    launch(frame, before, params.columns_per_item, event);
  }
};

}  // namespace

void plan_turn_records(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) return;
  list.passes.push_back(
      {.kernel = "turn_records",
       .options = {},
       .reason = "the second layer: thin things that stop, start or turn about leave no ghosts",
       .uses =
           {{Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
            {Resource::kRecordKeys, Access::kRead, Area::kViewport, {}, sizeof(cl_uint)},
            {Resource::kRecords, Access::kRead, Area::kViewport, {}, sizeof(LayerRecord)},
            {Resource::kPreviousRecords, Access::kUpdate, Area::kPreviousViewport, {}, sizeof(LayerRecord)}},
       .make = make_pass<TurnRecordsPass>,
       .frames = Frames::kSparse});
}

// advect_records: thin things keep their motion where no sample of this frame shows them.

namespace {

class AdvectRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent before = frame.previous.render_extent;
    const LayerParams params = layer_params(frame, shape(), before);
    bind(params, frame[Resource::kPreviousRecordKeys], frame[Resource::kPreviousRecords],
         frame[Resource::kRecordKeys]);
    launch(frame, before, params.columns_per_item, event);
  }
};

}  // namespace

void plan_advect_records(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) return;
  list.passes.push_back(
      {.kernel = "advect_records",
       .options = {},
       .reason = "the second layer: thin things that no sample shows keep their motion",
       .uses = {{Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
                {Resource::kPreviousRecords, Access::kRead, Area::kPreviousViewport, {}, sizeof(LayerRecord)},
                {Resource::kRecordKeys, Access::kWrite, Area::kViewport, {}, sizeof(cl_uint)}},
       .make = make_pass<AdvectRecordsPass>,
       .frames = Frames::kSparse});
}

// layer_split: which samples have two layers.

namespace {

class LayerSplitPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render_extent;
    const LayerParams params = layer_params(frame, shape(), render);
    bind(params, frame[Resource::kVelocity], frame[Resource::kDepth], frame[Resource::kOpenTrust],
         frame[Resource::kPreviousRecordKeys], frame[Resource::kRecordKeys],
         frame[Resource::kPreviousRecords], frame[Resource::kRecords], frame[Resource::kReprojection],
         frame[Resource::kSplits], frame[Resource::kSplitMarks]);
    launch(frame, render, params.columns_per_item, event);
  }
};

}  // namespace

void plan_layer_split(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) return;
  list.passes.push_back(
      {.kernel = "layer_split",
       .options = velocity_options(facts.settings),
       .reason = "the second layer: which samples have two layers",
       .uses = {{Resource::kVelocity, Access::kRead, Area::kViewport, facts.settings.velocity},
                {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                {Resource::kOpenTrust, Access::kUpdate, Area::kViewport, {}, sizeof(cl_float)},
                {Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
                {Resource::kRecordKeys, Access::kRead, Area::kViewport, {}, sizeof(cl_uint)},
                {Resource::kPreviousRecords, Access::kRead, Area::kPreviousViewport, {}, sizeof(LayerRecord)},
                {Resource::kRecords, Access::kWrite, Area::kViewport, {}, sizeof(LayerRecord)},
                {Resource::kReprojection, Access::kWrite, Area::kViewport, PixelFormat::kRGBA32F},
                {Resource::kSplits, Access::kWrite, Area::kViewport, {}, sizeof(LayerSplit)},
                {Resource::kSplitMarks, Access::kAccumulate, Area::kTiles, {}, sizeof(cl_int)}},
       .make = make_pass<LayerSplitPass>,
       .frames = Frames::kSparse});
}

// resolve_layers: this frame added to the history of pixels that may have two layers.

namespace {

class ResolveLayersPass : public Pass {
 public:
  ResolveLayersPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const TemporalParams params = temporal_params(frame, shape(), facts());
    const HistorySamples before =
        history_samples(frame.previous, frame.output, layout_of(frame[Resource::kPreviousDepth]));
    bind(params, before, layout_of(frame[Resource::kDepth]),
         frame.tables.positions().get(frame.queue, frame.key()), frame[Resource::kColour],
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

// display_layers: the near layer laid over the picture.

namespace {

const char* layer_view_option(TemporalView view) {
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
    const Resource shown = centred_of(facts());
    const TemporalDisplayParams params = temporal_display_params(frame, shape(), shown);
    const HistorySamples now =
        history_samples(frame.current, frame.output, layout_of(frame[Resource::kDepth]));
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
       .options = fmt::format("-D VIEW={} {} -D HISTORY_FORMAT={}", layer_view_option(settings.temporal.view),
                              scale_options(settings), precision_of(history)),
       .reason = "the second layer: the near one laid over the picture",
       .uses = {{Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                {Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
                {Resource::kLayerTiles, Access::kRead, Area::kTiles, {}, sizeof(LayerTile)},
                {Resource::kHistory, Access::kRead, Area::kOutput, history},
                {Resource::kNearHistory, Access::kRead, Area::kOutput, history},
                {Resource::kLayerStates, Access::kRead, Area::kOutput, {}, kLayerStateBytes},
                {centred_of(facts), Access::kWrite, Area::kOutput, settings.output.linear}},
       .make = make_pass<DisplayLayersPass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
