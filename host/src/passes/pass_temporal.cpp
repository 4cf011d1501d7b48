// SPDX-License-Identifier: MIT
// The passes of kernels/temporal: temporal_tiles, temporal_light, resolve_temporal, temporal_display, merge_histories,
// temporal_denoise, temporal_refine.
#include <fmt/format.h>

#include <cstddef>

#include "layers/layer.h"
#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "temporal/temporal_params.h"

namespace quincunx {

// temporal_tiles: which tiles move as a whole, and what their samples say of the history.

namespace {

class TemporalTilesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FrameInputs& inputs = frame.inputs;
    const Extent output = frame.output;
    const Extent render = inputs.render_extent;
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    const Ratio spacing = ratio_of(output, render);
    const Ratio motion = ratio_of(output, frame.previous.render_extent);
    const TemporalTileParams params{
        .frame = {render.width, render.height, layout_of(frame[Resource::kColour]), {}, {}},
        .output_width = output.width,
        .output_height = output.height,
        .tiles_x = tiles.width,
        .tiles_y = tiles.height,
        .reprojection = layout_of(frame[Resource::kReprojection]),
        .spacing_x = spacing.x,
        .spacing_y = spacing.y,
        .start_x = (.5f + inputs.jitter.x) * spacing.x,
        .start_y = (.5f + inputs.jitter.y) * spacing.y,
        .motion_x = motion.x,
        .motion_y = motion.y,
        .parity = shaded_parity(facts(), inputs)};
    bind(frame, params, Resource::kColour, Resource::kReprojection, Resource::kPreviousHistory,
         Resource::kPreviousTileReprojection, Resource::kDepth, layout_of(frame[Resource::kDepth]),
         Resource::kSplits, Resource::kSplitMarks, Resource::kPreviousLayerTiles, Resource::kLayerTiles,
         Resource::kLayeredTileList, Resource::kTileReprojection, Resource::kTileEvidence,
         Resource::kTotalLight, Resource::kExposure);
    launch(frame, tiles, columns_per_item(shape(), tiles.width, 1), event);
  }
};

}  // namespace

void plan_temporal_tiles(const PlanFacts& facts, PassList& list) {
  if (!facts.accumulates()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "temporal_tiles",
      .reason = "the method: which tiles move as a whole",
      .uses = uses_of(settings, {.reads = {Resource::kColour, Resource::kPreviousHistory,
                                           Resource::kPreviousTileReprojection, Resource::kExposure},
                                 .writes = {Resource::kTileReprojection, Resource::kTileEvidence},
                                 .sums = {Resource::kTotalLight}}),
      .make = make_pass<TemporalTilesPass>,
      .frames = Frames::kSparse};
  spec.add_where(facts.reprojects(), "MOTION", settings, {.reads = {Resource::kReprojection}});
  spec.add_where(
      facts.has_layers(), "LAYERS", settings,
      {.reads = {Resource::kDepth, Resource::kSplits, Resource::kSplitMarks, Resource::kPreviousLayerTiles},
       .writes = {Resource::kLayerTiles, Resource::kLayeredTileList}});
  spec.add_options(fmt::format("{} -D HISTORY_FORMAT={}", colour_options(settings),
                               precision_of(settings.temporal.history)));
  list.passes.push_back(std::move(spec));
}

// temporal_light: where the light has changed, and where the picture has.

namespace {

// The kernel loads these together.
static_assert(offsetof(TileEvidence, brightening) == 0 &&
              offsetof(TileEvidence, lag) == 7 * sizeof(cl_float));
static_assert(offsetof(TileLight, recent_outliers) == offsetof(TileLight, confirmation) + sizeof(cl_float));

class TemporalLightPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    bind(frame, tiles.width, tiles.height, Resource::kTileReprojection, Resource::kTileEvidence,
         Resource::kTotalLight, Resource::kPreviousTileLight, Resource::kTileLight);
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
       .uses = uses_of(facts.settings, {.reads = {Resource::kTileReprojection, Resource::kTileEvidence,
                                                  Resource::kTotalLight, Resource::kPreviousTileLight},
                                        .writes = {Resource::kTileLight}}),
       .make = make_pass<TemporalLightPass>,
       .frames = Frames::kSparse});
}

// resolve_temporal: this frame added to the history.

namespace {

const char* view_option(TemporalView view) {
  switch (view) {
    case TemporalView::kPicture:
    case TemporalView::kLayers:
    case TemporalView::kCoverage:
    case TemporalView::kNear:
    case TemporalView::kFar:
      return "PICTURE";
    case TemporalView::kConfidence:
      return "CONFIDENCE";
    case TemporalView::kRejection:
      return "REJECTION";
    case TemporalView::kPhase:
      return "PHASE";
  }
  return "PICTURE";
}

class ResolveTemporalPass : public Pass {
 public:
  ResolveTemporalPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    // A debug view is written here, the picture by temporal_display.
    const Resource shown = uses(Resource::kResolved) ? Resource::kResolved : Resource::kHistory;
    TemporalParams params = temporal_params(frame, shape(), facts());
    params.frame0.reactive = layout_of(frame[Resource::kReactive]);
    params.frame1.reactive = layout_of(frame[Resource::kPreviousReactive]);
    params.output = layout_of(frame[shown]);
    bind(frame, params, frame.tables.positions().get(frame.queue, frame.key()), Resource::kColour,
         Resource::kReprojection, Resource::kReactive, Resource::kPreviousReactive,
         Resource::kPreviousHistory, Resource::kPreviousHistoryAlpha, Resource::kPreviousTileReprojection,
         Resource::kTileReprojection, Resource::kTileLight, Resource::kLayerTiles, Resource::kHistory,
         Resource::kHistoryAlpha, shown, frame.counter, Resource::kExposure);
    launch(frame, frame.output, params.columns_per_item, event, kTemporalTile);
  }
};

// Where nothing moves hardly anything is resampled.
int taps_of(const PlanFacts& facts) {
  if (!facts.reprojects()) return 16;
  switch (facts.settings.temporal.preset) {
    case TemporalPreset::kFast:
      return 4;
    case TemporalPreset::kBalanced:
      break;
    case TemporalPreset::kQuality:
      return 36;
  }
  return 16;
}

}  // namespace

void plan_resolve_temporal(const PlanFacts& facts, PassList& list) {
  if (!facts.accumulates()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "resolve_temporal",
      .reason = "the method: this frame added to the history",
      .uses = uses_of(settings, {.reads = {Resource::kColour, Resource::kPreviousHistory,
                                           Resource::kPreviousTileReprojection, Resource::kTileReprojection,
                                           Resource::kTileLight, Resource::kExposure},
                                 .writes = {Resource::kHistory}}),
      .make = make_pass<ResolveTemporalPass>,
      .frames = Frames::kSparse,
      .registers = 64};
  spec.add_where(facts.accumulates_alpha(), "ALPHA", settings,
                 {.reads = {Resource::kPreviousHistoryAlpha}, .writes = {Resource::kHistoryAlpha}});
  spec.add_where(facts.reprojects(), "MOTION", settings, {.reads = {Resource::kReprojection}});
  // Where samples are reprojected, that already holds what reactive values take.
  spec.add_where(!facts.reprojects() && facts.reads_reactive(), "REACTIVE", settings,
                 {.reads = {Resource::kReactive, Resource::kPreviousReactive}});
  spec.add_options(fmt::format("-D TAPS={}", taps_of(facts)));
  spec.add_where(facts.has_layers(), "LAYERS", settings, {.reads = {Resource::kLayerTiles}});
  spec.add_options(fmt::format("-D VIEW={} {} -D HISTORY_FORMAT={}", view_option(settings.temporal.view),
                               colour_options(settings), precision_of(settings.temporal.history)));
  if (!facts.displays_history()) {
    spec.add_options(fmt::format("-D OUTPUT_FORMAT={}", precision_of(settings.output.linear)));
    spec.uses.push_back(use(Resource::kResolved, settings, Access::kWrite));
  }
  list.passes.push_back(std::move(spec));
}

// temporal_display: the history's picture, smoothed where little is known.

namespace {

class TemporalDisplayPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    // The merged history, which has no phases, or this frame's.
    const bool merged = uses(Resource::kMergedHistory);
    const Resource shown = merged ? shown_history_of(facts()) : centred_of(facts());
    const Resource history = merged ? Resource::kMergedHistory : Resource::kHistory;
    TemporalDisplayParams params = temporal_display_params(frame, shape(), shown);
    bind(frame, params, merged ? Resource::kCentredTiles : Resource::kTileReprojection, history,
         merged ? Resource::kMergedAlpha : Resource::kHistoryAlpha, shown, Resource::kExposure);
    launch(frame, frame.output, params.columns_per_item, event, kTemporalTile);
  }
};

PassSpec display_spec(const PlanFacts& facts, const Touched& touched, Resource alpha) {
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{.kernel = "temporal_display",
                .reason = "the method: the history's picture",
                .uses = uses_of(settings, touched),
                .make = make_pass<TemporalDisplayPass>,
                .frames = Frames::kSparse};
  spec.add_where(facts.accumulates_alpha(), "ALPHA", settings, {.reads = {alpha}});
  spec.add_options(fmt::format("-D SMOOTH={} -D OUTPUT_FORMAT={} -D HISTORY_FORMAT={}",
                               facts.smooths_history() ? 1 : 0, precision_of(settings.output.linear),
                               precision_of(settings.temporal.history)));
  return spec;
}

}  // namespace

void plan_temporal_display(const PlanFacts& facts, PassList& list) {
  if (!facts.displays_history()) return;
  list.passes.push_back(
      display_spec(facts,
                   {.reads = {Resource::kTileReprojection, Resource::kHistory, Resource::kExposure},
                    .writes = {centred_of(facts)}},
                   Resource::kHistoryAlpha));
}

// merge_histories: the histories of frames before and after, made one; its picture.

namespace {

class MergeHistoriesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const MergeParams params{.width = frame.output.width,
                             .height = frame.output.height,
                             .centred = layout_of(frame[Resource::kCentred]),
                             .columns_per_item = columns_per_item(shape(), frame.output.width),
                             .other_exposure = frame.other_exposure};
    bind(frame, params, Resource::kCentred, Resource::kHistory, Resource::kNearHistory,
         Resource::kLayerStates, Resource::kOtherHistory, Resource::kOtherAlpha, Resource::kMergedHistory,
         Resource::kMergedAlpha, Resource::kExposure);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_merge_histories(const PlanFacts& facts, PassList& list) {
  if (!facts.two_way) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec merge{
      .kernel = "merge_histories",
      .reason = "both ways: the histories of frames before and after made one",
      .uses = uses_of(settings, {.reads = {Resource::kCentred, Resource::kHistory, Resource::kExposure},
                                 .writes = {Resource::kMergedHistory},
                                 .updates = {Resource::kOtherHistory}}),
      .make = make_pass<MergeHistoriesPass>,
      .frames = Frames::kSparse};
  if (facts.has_layers()) {
    for (const Resource layer : {Resource::kNearHistory, Resource::kLayerStates})
      merge.uses.push_back(use(layer, settings));
  }
  merge.add_where(facts.accumulates_alpha(), "ALPHA", settings,
                  {.writes = {Resource::kMergedAlpha}, .updates = {Resource::kOtherAlpha}});
  merge.add_options(fmt::format("-D SOURCE_FORMAT={} -D HISTORY_FORMAT={}",
                                precision_of(settings.output.linear),
                                precision_of(settings.temporal.history)));
  list.passes.push_back(std::move(merge));
  list.passes.push_back(display_spec(facts,
                                     {.reads = {Resource::kMergedHistory, Resource::kExposure},
                                      .writes = {shown_history_of(facts)},
                                      .sums = {Resource::kCentredTiles}},
                                     Resource::kMergedAlpha));
}

// temporal_denoise, temporal_refine: the history's picture without noise; sharpened, and smoothed along its edges.

namespace {

// The blocks of `width` x kRefineBlock pixels that cover an extent.
Extent blocks_of(Extent extent, int width) {
  return {(extent.width + width - 1) / width, (extent.height + kRefineBlock - 1) / kRefineBlock};
}

RefineParams refine_params(const PassFrame& frame, Resource source, Resource output) {
  return {.width = frame.output.width,
          .height = frame.output.height,
          .source = layout_of(frame[source]),
          .output = layout_of(frame[output])};
}

class TemporalDenoisePass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Resource denoised = denoised_of(facts());
    const ImageView& albedo = frame.albedo ? frame.albedo : frame[Resource::kNoisy];
    bind(frame, refine_params(frame, Resource::kNoisy, denoised), layout_of(albedo), frame.albedo ? 1 : 0,
         facts().settings.temporal.noise, Resource::kNoisy, albedo, displayed_history_of(facts()), denoised,
         Resource::kExposure);
    const Extent blocks = blocks_of(frame.output, kRefineBlock);
    launch(frame, blocks, columns_per_item(shape(), blocks.width, 1), event);
  }
};

class TemporalRefinePass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    bind(frame, refine_params(frame, Resource::kUnrefined, picture()), Resource::kUnrefined,
         displayed_history_of(facts()), picture(), Resource::kExposure);
    const Extent blocks = blocks_of(frame.output, lanes());
    launch(frame, blocks, columns_per_item(shape(), blocks.width, 1), event);
  }
};

}  // namespace

void plan_temporal_denoise(const PlanFacts& facts, PassList& list) {
  if (!facts.denoises()) return;
  const ResolveSettings& settings = facts.settings;
  list.passes.push_back(
      {.kernel = "temporal_denoise",
       .options = fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0} -D HISTORY_FORMAT={1}",
                              precision_of(settings.output.linear), precision_of(settings.temporal.history)),
       .reason = "the frames' noise: pixels become means of such around them as differ by chance alone",
       .uses =
           uses_of(settings, {.reads = {Resource::kNoisy, displayed_history_of(facts), Resource::kExposure},
                              .writes = {denoised_of(facts)}}),
       .make = make_pass<TemporalDenoisePass>,
       .frames = Frames::kSparse});
}

void plan_temporal_refine(const PlanFacts& facts, PassList& list) {
  if (!facts.refines()) return;
  const ResolveSettings& settings = facts.settings;
  list.passes.push_back(
      {.kernel = "temporal_refine",
       .options = fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0} -D HISTORY_FORMAT={1}",
                              precision_of(settings.output.linear), precision_of(settings.temporal.history)),
       .reason = "the preset, or both ways: sharpened, and smoothed along edges where little is known",
       .uses = uses_of(settings,
                       {.reads = {Resource::kUnrefined, displayed_history_of(facts), Resource::kExposure},
                        .writes = {picture_of(facts)}}),
       .make = make_pass<TemporalRefinePass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
