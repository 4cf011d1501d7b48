// SPDX-License-Identifier: MIT
// resolve_temporal: this frame added to the history.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal/temporal_params.h"

namespace quincunx {
namespace {

const char* view_option(TemporalView view) {
  switch (view) {
    case TemporalView::kPicture:
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
    const Extent output = frame.output;
    const Extent now = frame.current.render;
    const Extent before = frame.previous.render;
    const Extent tiles = extent_of(Area::kTiles, frame.extents());
    const Ratio spacing = ratio_of(output, now);
    const Ratio motion = ratio_of(output, before);
    PositionTables& tables = frame.tables.positions();
    // A debug view is written here, the picture by temporal_display.
    const Resource shown = uses(Resource::kResolved) ? Resource::kResolved : Resource::kHistory;
    const TemporalParams params{
        .output_width = output.width,
        .output_height = output.height,
        .frame0 = {now.width,
                   now.height,
                   layout_of(frame[Resource::kColour]),
                   {},
                   layout_if_used(frame, Resource::kReactive)},
        .frame1 = {before.width, before.height, {}, {}, layout_if_used(frame, Resource::kPreviousReactive)},
        .reprojection = layout_if_used(frame, Resource::kReprojection),
        .output = layout_of(frame[shown]),
        .columns = tables.columns(),
        .counter = frame.counter.index,
        .columns_per_item = columns_per_item(device(), output.width, kTemporalTile),
        .motion_x = motion.x,
        .motion_y = motion.y,
        .spacing_x = spacing.x,
        .spacing_y = spacing.y,
        .tiles_x = tiles.width,
        .tiles_y = tiles.height};
    bind(params, tables.get(frame.queue, now, frame.current.jitter), frame[Resource::kColour],
         view_or(frame, Resource::kReprojection, Resource::kTileReprojection),
         view_or(frame, Resource::kReactive, Resource::kColour),
         view_or(frame, Resource::kPreviousReactive, Resource::kColour), frame[Resource::kPreviousHistory],
         view_or(frame, Resource::kPreviousHistoryAlpha, Resource::kPreviousHistory),
         frame[Resource::kPreviousTileReprojection], frame[Resource::kTileReprojection],
         frame[Resource::kTileLight], frame[Resource::kHistory],
         view_or(frame, Resource::kHistoryAlpha, Resource::kHistory), frame[shown], frame.counter);
    launch(frame, output, params.columns_per_item, event);
  }
};

std::string options_of(const PlanFacts& facts, bool reactive) {
  const ResolveSettings& settings = facts.settings;
  const TemporalPreset preset = settings.temporal.preset;
  const bool moves = facts.reprojects();
  std::string format;
  if (!facts.shows_picture()) format = fmt::format(" -D OUTPUT_FORMAT={}", precision_of(settings.resolved));
  return fmt::format(
      "-D ALPHA={} -D MOTION={} -D REACTIVE={} -D TAPS={} -D TRUST={} -D VIEW={} {} -D HISTORY_FORMAT={}{}",
      facts.accumulates_alpha() ? 1 : 0, moves ? 1 : 0, reactive ? 1 : 0,
      moves && preset == TemporalPreset::kFast ? 4 : 16,
      moves && preset == TemporalPreset::kQuality ? "BILINEAR" : "NEAREST",
      view_option(settings.temporal.view), colour_options(settings), precision_of(settings.temporal.history),
      format);
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
  if (facts.accumulates_alpha()) {
    const std::size_t bytes = alpha_bytes(settings);
    spec.uses.push_back({Resource::kPreviousHistoryAlpha, Access::kRead, Area::kOutput, {}, bytes});
    spec.uses.push_back({Resource::kHistoryAlpha, Access::kWrite, Area::kOutput, {}, bytes});
  }
  if (reactive) read_both_frames(spec.uses, Resource::kReactive, PixelFormat::kR8);
  if (!facts.shows_picture())
    spec.uses.push_back({Resource::kResolved, Access::kWrite, Area::kOutput, settings.resolved});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
