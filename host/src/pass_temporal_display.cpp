// SPDX-License-Identifier: MIT
// temporal_display: the history's picture, smoothed where little is known.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal/temporal_params.h"

namespace quincunx {
namespace {

class TemporalDisplayPass : public Pass {
 public:
  TemporalDisplayPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent output = frame.output;
    const Extent render = frame.current.render;
    PositionTables& tables = frame.tables.positions();
    const TemporalDisplayParams params{
        .output_width = output.width,
        .output_height = output.height,
        .frame0 = {render.width, render.height, layout_of(frame[Resource::kColour]), {}, {}},
        .output = layout_of(frame[picture()]),
        .tiles_x = extent_of(Area::kTiles, frame.extents()).width,
        .columns = tables.columns(),
        .columns_per_item = columns_per_item(device(), output.width, kTemporalTile),
        .first = frame.has_history ? 0 : 1};
    bind(params, tables.get(frame.queue, render, frame.current.jitter), frame[Resource::kColour],
         frame[Resource::kTileReprojection], frame[Resource::kHistory], frame[picture()]);
    launch(frame, output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_temporal_display(const PlanFacts& facts, PassList& list) {
  if (!facts.accumulates() || !facts.shows_picture()) return;
  const ResolveSettings& settings = facts.settings;
  const bool alpha = !facts.needs.background;
  PassSpec spec{
      .kernel = "temporal_display",
      .options = fmt::format("-D ALPHA={} -D SMOOTH={} {} -D HISTORY_FORMAT={}", alpha ? 1 : 0,
                             settings.temporal.preset == TemporalPreset::kFast ? 0 : 1,
                             scale_options(settings), precision_of(settings.temporal.history)),
      .reason = "the method: the history's picture",
      .uses = {{Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
               {Resource::kHistory, Access::kRead, Area::kOutput, settings.temporal.history},
               {picture_of(facts), Access::kWrite, Area::kOutput, settings.resolved}},
      .make = make_pass<TemporalDisplayPass>,
      .frames = Frames::kSparse};
  if (alpha) spec.uses.push_back({Resource::kColour, Access::kRead, Area::kViewport, settings.colour});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
