// SPDX-License-Identifier: MIT
// The passes of kernels/temporal: temporal_tiles, temporal_light, resolve_temporal, temporal_display, merge_histories,
// temporal_denoise, temporal_refine.
#include <fmt/format.h>

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
    const FrameInputs& current = frame.current;
    const Extent output = frame.output;
    const Extent render = current.render_extent;
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    const Ratio spacing = ratio_of(output, render);
    const Ratio motion = ratio_of(output, frame.previous.render_extent);
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

// temporal_light: where the light has changed, and where the picture has.

namespace {

class TemporalLightPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    bind(tiles.width, tiles.height, frame[Resource::kTileReprojection], frame[Resource::kTileEvidence],
         frame[Resource::kTotalLight], frame[Resource::kPreviousTileLight], frame[Resource::kTileLight]);
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
       .uses = {{Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
                {Resource::kTileEvidence, Access::kRead, Area::kTiles, {}, sizeof(TileEvidence)},
                {Resource::kTotalLight, Access::kRead, Area::kWhole, {}, sizeof(TotalLight)},
                {Resource::kPreviousTileLight, Access::kRead, Area::kTiles, {}, sizeof(TileLight)},
                {Resource::kTileLight, Access::kWrite, Area::kTiles, {}, sizeof(TileLight)}},
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
    params.frame0.reactive = layout_if_used(frame, Resource::kReactive);
    params.frame1.reactive = layout_if_used(frame, Resource::kPreviousReactive);
    params.output = layout_of(frame[shown]);
    bind(params, frame.tables.positions().get(frame.queue, frame.key()), frame[Resource::kColour],
         view_or(frame, Resource::kReprojection, Resource::kTileReprojection),
         view_or(frame, Resource::kReactive, Resource::kColour),
         view_or(frame, Resource::kPreviousReactive, Resource::kColour), frame[Resource::kPreviousHistory],
         view_or(frame, Resource::kPreviousHistoryAlpha, Resource::kPreviousHistory),
         frame[Resource::kPreviousTileReprojection], frame[Resource::kTileReprojection],
         frame[Resource::kTileLight], view_or(frame, Resource::kLayerTiles, Resource::kTileReprojection),
         frame[Resource::kHistory], view_or(frame, Resource::kHistoryAlpha, Resource::kHistory), frame[shown],
         frame.counter);
    launch(frame, frame.output, params.columns_per_item, event, params.rows_per_item);
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

std::string options_of(const PlanFacts& facts, bool reactive) {
  const ResolveSettings& settings = facts.settings;
  std::string format;
  if (!facts.displays_history())
    format = fmt::format(" -D OUTPUT_FORMAT={}", precision_of(settings.output.linear));
  return fmt::format(
      "-D ALPHA={} -D MOTION={} -D REACTIVE={} -D TAPS={} -D LAYERS={} -D VIEW={} {} "
      "-D HISTORY_FORMAT={}{}",
      facts.accumulates_alpha() ? 1 : 0, facts.reprojects() ? 1 : 0, reactive ? 1 : 0, taps_of(facts),
      facts.has_layers() ? 1 : 0, view_option(settings.temporal.view), colour_options(settings),
      precision_of(settings.temporal.history), format);
}

}  // namespace

void plan_resolve_temporal(const PlanFacts& facts, PassList& list) {
  if (!facts.accumulates()) return;
  const ResolveSettings& settings = facts.settings;
  // Where samples are reprojected, that already holds what reactive values take.
  const bool reactive = !facts.reprojects() && facts.reads_reactive();
  PassSpec spec{
      .kernel = "resolve_temporal",
      .options = options_of(facts, reactive),
      .reason = "the method: this frame added to the history",
      .uses =
          {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
           {Resource::kPreviousHistory, Access::kRead, Area::kOutput, settings.temporal.history},
           {Resource::kPreviousTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
           {Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
           {Resource::kTileLight, Access::kRead, Area::kTiles, {}, sizeof(TileLight)},
           {Resource::kHistory, Access::kWrite, Area::kOutput, settings.temporal.history}},
      .make = make_pass<ResolveTemporalPass>,
      .frames = Frames::kSparse};
  if (facts.reprojects())
    spec.uses.push_back({Resource::kReprojection, Access::kRead, Area::kViewport, PixelFormat::kRGBA32F});
  if (facts.has_layers())
    spec.uses.push_back({Resource::kLayerTiles, Access::kRead, Area::kTiles, {}, sizeof(LayerTile)});
  if (facts.accumulates_alpha()) {
    const std::size_t bytes = alpha_bytes(settings);
    spec.uses.push_back({Resource::kPreviousHistoryAlpha, Access::kRead, Area::kOutput, {}, bytes});
    spec.uses.push_back({Resource::kHistoryAlpha, Access::kWrite, Area::kOutput, {}, bytes});
  }
  if (reactive) read_both_frames(spec.uses, Resource::kReactive, PixelFormat::kR8);
  if (!facts.displays_history())
    spec.uses.push_back({Resource::kResolved, Access::kWrite, Area::kOutput, settings.output.linear});
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
    bind(params, frame[merged ? Resource::kCentredTiles : Resource::kTileReprojection], frame[history],
         view_or(frame, merged ? Resource::kMergedAlpha : Resource::kHistoryAlpha, history), frame[shown]);
    launch(frame, frame.output, params.columns_per_item, event, params.rows_per_item);
  }
};

PassSpec display_spec(const PlanFacts& facts, Resource shown) {
  const ResolveSettings& settings = facts.settings;
  return {
      .kernel = "temporal_display",
      .options = fmt::format("-D ALPHA={} -D SMOOTH={} -D OUTPUT_FORMAT={} -D HISTORY_FORMAT={}",
                             facts.accumulates_alpha() ? 1 : 0, facts.smooths_history() ? 1 : 0,
                             precision_of(settings.output.linear), precision_of(settings.temporal.history)),
      .reason = "the method: the history's picture",
      .uses = {{shown, Access::kWrite, Area::kOutput, settings.output.linear}},
      .make = make_pass<TemporalDisplayPass>,
      .frames = Frames::kSparse};
}

}  // namespace

void plan_temporal_display(const PlanFacts& facts, PassList& list) {
  if (!facts.displays_history()) return;
  const ResolveSettings& settings = facts.settings;
  PassSpec spec = display_spec(facts, centred_of(facts));
  spec.uses.push_back(
      {Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)});
  spec.uses.push_back({Resource::kHistory, Access::kRead, Area::kOutput, settings.temporal.history});
  if (facts.accumulates_alpha())
    spec.uses.push_back({Resource::kHistoryAlpha, Access::kRead, Area::kOutput, {}, alpha_bytes(settings)});
  list.passes.push_back(std::move(spec));
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
                             .has_other = frame.merges ? 1 : 0};
    bind(params, frame[Resource::kCentred], frame[Resource::kHistory],
         view_or(frame, Resource::kNearHistory, Resource::kHistory),
         view_or(frame, Resource::kLayerStates, Resource::kHistory), frame[Resource::kOtherHistory],
         view_or(frame, Resource::kOtherAlpha, Resource::kOtherHistory), frame[Resource::kMergedHistory],
         view_or(frame, Resource::kMergedAlpha, Resource::kMergedHistory));
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_merge_histories(const PlanFacts& facts, PassList& list) {
  if (!facts.two_way) return;
  const ResolveSettings& settings = facts.settings;
  const PixelFormat history = settings.temporal.history;
  const std::size_t alpha = alpha_bytes(settings);
  PassSpec merge{.kernel = "merge_histories",
                 .options = fmt::format("-D ALPHA={} -D SOURCE_FORMAT={} -D HISTORY_FORMAT={}",
                                        facts.accumulates_alpha() ? 1 : 0,
                                        precision_of(settings.output.linear), precision_of(history)),
                 .reason = "both ways: the histories of frames before and after made one",
                 .uses = {{Resource::kCentred, Access::kRead, Area::kOutput, settings.output.linear},
                          {Resource::kHistory, Access::kRead, Area::kOutput, history},
                          {Resource::kOtherHistory, Access::kUpdate, Area::kOutput, history},
                          {Resource::kMergedHistory, Access::kWrite, Area::kOutput, history}},
                 .make = make_pass<MergeHistoriesPass>,
                 .frames = Frames::kSparse};
  PassSpec shown = display_spec(facts, shown_history_of(facts));
  shown.uses.push_back(
      {Resource::kCentredTiles, Access::kAccumulate, Area::kTiles, {}, sizeof(TileReprojection)});
  shown.uses.push_back({Resource::kMergedHistory, Access::kRead, Area::kOutput, history});
  if (facts.has_layers()) {
    merge.uses.push_back({Resource::kNearHistory, Access::kRead, Area::kOutput, history});
    merge.uses.push_back({Resource::kLayerStates, Access::kRead, Area::kOutput, {}, kLayerStateBytes});
  }
  if (facts.accumulates_alpha()) {
    merge.uses.push_back({Resource::kOtherAlpha, Access::kUpdate, Area::kOutput, {}, alpha});
    merge.uses.push_back({Resource::kMergedAlpha, Access::kWrite, Area::kOutput, {}, alpha});
    shown.uses.push_back({Resource::kMergedAlpha, Access::kRead, Area::kOutput, {}, alpha});
  }
  list.passes.push_back(std::move(merge));
  list.passes.push_back(std::move(shown));
}

// temporal_denoise, temporal_refine: the history's picture without noise; sharpened, and smoothed along its edges.

namespace {

constexpr int divided_up(int value) {
  return (value + kRefineBlock - 1) / kRefineBlock;
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
    bind(refine_params(frame, Resource::kNoisy, denoised), layout_of(albedo), frame.albedo ? 1 : 0,
         facts().settings.temporal.noise, frame[Resource::kNoisy], albedo,
         frame[displayed_history_of(facts())], frame[denoised]);
    const Extent blocks = {divided_up(frame.output.width), divided_up(frame.output.height)};
    launch(frame, blocks, columns_per_item(shape(), blocks.width, 1), event);
  }
};

class TemporalRefinePass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    bind(refine_params(frame, Resource::kUnrefined, picture()), frame[Resource::kUnrefined],
         frame[displayed_history_of(facts())], frame[picture()]);
    const Extent blocks = {divided_up(frame.output.width), divided_up(frame.output.height)};
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
       .uses = {{Resource::kNoisy, Access::kRead, Area::kOutput, settings.output.linear},
                {displayed_history_of(facts), Access::kRead, Area::kOutput, settings.temporal.history},
                {denoised_of(facts), Access::kWrite, Area::kOutput, settings.output.linear}},
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
       .uses = {{Resource::kUnrefined, Access::kRead, Area::kOutput, settings.output.linear},
                {displayed_history_of(facts), Access::kRead, Area::kOutput, settings.temporal.history},
                {picture_of(facts), Access::kWrite, Area::kOutput, settings.output.linear}},
       .make = make_pass<TemporalRefinePass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
