// SPDX-License-Identifier: MIT
// resolve_temporal: this frame added to the history.
#include <fmt/format.h>

#include "layers/layer.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal_pass_params.h"

namespace quincunx {
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
    format = fmt::format(" -D OUTPUT_FORMAT={}", precision_of(settings.resolved));
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
    spec.uses.push_back({Resource::kResolved, Access::kWrite, Area::kOutput, settings.resolved});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
