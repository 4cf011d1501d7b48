// SPDX-License-Identifier: MIT
// temporal_display: the history's picture, smoothed where little is known.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal_pass_params.h"

namespace quincunx {
namespace {

class TemporalDisplayPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Resource shown = shown_history_of(facts());
    const TemporalDisplayParams params = temporal_display_params(frame, shape(), shown);
    bind(params, frame[Resource::kTileReprojection], frame[Resource::kHistory],
         view_or(frame, Resource::kHistoryAlpha, Resource::kHistory), frame[shown]);
    launch(frame, frame.output, params.columns_per_item, event, params.rows_per_item);
  }
};

}  // namespace

void plan_temporal_display(const PlanFacts& facts, PassList& list) {
  if (!facts.displays_history()) return;
  const ResolveSettings& settings = facts.settings;
  const bool alpha = facts.accumulates_alpha();
  PassSpec spec{
      .kernel = "temporal_display",
      .options = fmt::format("-D ALPHA={} -D SMOOTH={} -D OUTPUT_FORMAT={} -D HISTORY_FORMAT={}",
                             alpha ? 1 : 0, facts.smooths_history() ? 1 : 0, precision_of(settings.resolved),
                             precision_of(settings.temporal.history)),
      .reason = "the method: the history's picture",
      .uses = {{Resource::kTileReprojection, Access::kRead, Area::kTiles, {}, sizeof(TileReprojection)},
               {Resource::kHistory, Access::kRead, Area::kOutput, settings.temporal.history},
               {shown_history_of(facts), Access::kWrite, Area::kOutput, settings.resolved}},
      .make = make_pass<TemporalDisplayPass>,
      .frames = Frames::kSparse};
  if (alpha)
    spec.uses.push_back({Resource::kHistoryAlpha, Access::kRead, Area::kOutput, {}, alpha_bytes(settings)});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
