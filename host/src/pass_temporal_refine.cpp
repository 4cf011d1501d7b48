// SPDX-License-Identifier: MIT
// temporal_refine: the history's picture sharpened, and smoothed along its edges.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "temporal/refine_params.h"

namespace quincunx {
namespace {

constexpr int divided_up(int value) {
  return (value + kRefineBlock - 1) / kRefineBlock;
}

class TemporalRefinePass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const RefineParams params{.width = frame.output.width,
                              .height = frame.output.height,
                              .source = layout_of(frame[Resource::kUnrefined]),
                              .output = layout_of(frame[picture()])};
    bind(params, frame[Resource::kUnrefined], frame[Resource::kHistory], frame[picture()]);
    const Extent blocks = {divided_up(frame.output.width), divided_up(frame.output.height)};
    launch(frame, blocks, columns_per_item(shape(), blocks.width, 1), event);
  }
};

}  // namespace

void plan_temporal_refine(const PlanFacts& facts, PassList& list) {
  if (!facts.refines()) return;
  const ResolveSettings& settings = facts.settings;
  list.passes.push_back(
      {.kernel = "temporal_refine",
       .options = fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0} -D HISTORY_FORMAT={1}",
                              precision_of(settings.resolved), precision_of(settings.temporal.history)),
       .reason = "the preset: sharpened, and smoothed along edges where little is known",
       .uses = {{Resource::kUnrefined, Access::kRead, Area::kOutput, settings.resolved},
                {Resource::kHistory, Access::kRead, Area::kOutput, settings.temporal.history},
                {picture_of(facts), Access::kWrite, Area::kOutput, settings.resolved}},
       .make = make_pass<TemporalRefinePass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
