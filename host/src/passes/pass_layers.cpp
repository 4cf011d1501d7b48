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
    const Extent render = frame.inputs.render_extent;
    const LayerParams params = layer_params(frame, shape(), render);
    bind(frame, params, Resource::kVelocity, Resource::kDepth, Resource::kOpenTrust,
         Resource::kPreviousRecordKeys, Resource::kPreviousRecords, Resource::kRecordKeys,
         Resource::kRecords);
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
       .uses = uses_of(facts.settings, {.reads = {Resource::kVelocity, Resource::kDepth, Resource::kOpenTrust,
                                                  Resource::kPreviousRecordKeys, Resource::kPreviousRecords},
                                        .writes = {Resource::kRecordKeys, Resource::kRecords}}),
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
    bind(frame, params, Resource::kPreviousRecordKeys, Resource::kRecordKeys, Resource::kRecords,
         Resource::kPreviousRecords);
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
       .uses = uses_of(facts.settings,
                       {.reads = {Resource::kPreviousRecordKeys, Resource::kRecordKeys, Resource::kRecords},
                        .updates = {Resource::kPreviousRecords}}),
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
    bind(frame, params, Resource::kPreviousRecordKeys, Resource::kPreviousRecords, Resource::kRecordKeys);
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
       .uses = uses_of(facts.settings, {.reads = {Resource::kPreviousRecordKeys, Resource::kPreviousRecords},
                                        .writes = {Resource::kRecordKeys}}),
       .make = make_pass<AdvectRecordsPass>,
       .frames = Frames::kSparse});
}

// layer_split: which samples have two layers.

namespace {

class LayerSplitPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const LayerParams params = layer_params(frame, shape(), render);
    bind(frame, params, Resource::kVelocity, Resource::kDepth, Resource::kOpenTrust,
         Resource::kPreviousRecordKeys, Resource::kRecordKeys, Resource::kPreviousRecords, Resource::kRecords,
         Resource::kReprojection, Resource::kSplits, Resource::kSplitMarks);
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
       .uses = uses_of(facts.settings,
                       {.reads = {Resource::kVelocity, Resource::kDepth, Resource::kPreviousRecordKeys,
                                  Resource::kRecordKeys, Resource::kPreviousRecords},
                        .writes = {Resource::kRecords, Resource::kReprojection, Resource::kSplits},
                        .updates = {Resource::kOpenTrust},
                        .sums = {Resource::kSplitMarks}}),
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
    bind(frame, params, before, layout_of(frame[Resource::kDepth]),
         frame.tables.positions().get(frame.queue, frame.key()), Resource::kColour, Resource::kReprojection,
         Resource::kDepth, Resource::kPreviousDepth, Resource::kOpenTrust, Resource::kSplits,
         Resource::kPreviousHistory, Resource::kPreviousHistoryAlpha, Resource::kPreviousNearHistory,
         Resource::kPreviousLayerStates, Resource::kPreviousTileReprojection, Resource::kPreviousLayerTiles,
         Resource::kTileReprojection, Resource::kLayerTiles, Resource::kTileLight, Resource::kLayeredTileList,
         Resource::kTotalLight, Resource::kHistory, Resource::kHistoryAlpha, Resource::kNearHistory,
         Resource::kLayerStates, frame.counter, Resource::kExposure);
    launch_over_list(frame, event);
  }
};

}  // namespace

void plan_resolve_layers(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) return;
  const ResolveSettings& settings = facts.settings;
  const PixelFormat history = settings.temporal.history;
  PassSpec spec{
      .kernel = "resolve_layers",
      .reason = "the second layer: this frame added to the history of pixels that have two",
      .uses = uses_of(
          settings,
          {.reads = {Resource::kColour, Resource::kReprojection, Resource::kDepth, Resource::kPreviousDepth,
                     Resource::kOpenTrust, Resource::kSplits, Resource::kPreviousHistory,
                     Resource::kPreviousNearHistory, Resource::kPreviousLayerStates,
                     Resource::kPreviousTileReprojection, Resource::kPreviousLayerTiles,
                     Resource::kTileReprojection, Resource::kLayerTiles, Resource::kTileLight,
                     Resource::kLayeredTileList, Resource::kTotalLight, Resource::kExposure},
           .writes = {Resource::kHistory, Resource::kNearHistory, Resource::kLayerStates}}),
      .make = make_pass<ResolveLayersPass>,
      .frames = Frames::kSparse,
      .registers = 128};
  spec.add_where(facts.accumulates_alpha(), "ALPHA", settings,
                 {.reads = {Resource::kPreviousHistoryAlpha}, .writes = {Resource::kHistoryAlpha}});
  spec.add_options(fmt::format("{} -D HISTORY_FORMAT={}", colour_options(settings), precision_of(history)));
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
        history_samples(frame.inputs, frame.output, layout_of(frame[Resource::kDepth]));
    bind(frame, params, now, Resource::kDepth, Resource::kTileReprojection, Resource::kLayerTiles,
         Resource::kLayeredTileList, Resource::kTotalLight, Resource::kHistory, Resource::kHistoryAlpha,
         Resource::kNearHistory, Resource::kLayerStates, shown, Resource::kExposure);
    launch_over_list(frame, event);
  }
};

}  // namespace

void plan_display_layers(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers() || facts.settings.temporal.view == TemporalView::kFar) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "display_layers",
      .reason = "the second layer: the near one laid over the picture",
      .uses =
          uses_of(settings, {.reads = {Resource::kDepth, Resource::kTileReprojection, Resource::kLayerTiles,
                                       Resource::kLayeredTileList, Resource::kTotalLight, Resource::kHistory,
                                       Resource::kNearHistory, Resource::kLayerStates, Resource::kExposure},
                             .writes = {centred_of(facts)}}),
      .make = make_pass<DisplayLayersPass>,
      .frames = Frames::kSparse};
  spec.add_where(facts.accumulates_alpha(), "ALPHA", settings, {.reads = {Resource::kHistoryAlpha}});
  spec.add_options(fmt::format("-D VIEW={} -D SOURCE_STORAGE={} -D OUTPUT_FORMAT={} -D HISTORY_FORMAT={}",
                               layer_view_option(settings.temporal.view),
                               storage_option(settings.targets.storage), precision_of(settings.output.linear),
                               precision_of(settings.temporal.history)));
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
