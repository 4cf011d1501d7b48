// SPDX-License-Identifier: MIT
// layer_records: the samples of near surfaces at edges of motion.
#include "layer_params.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class LayerRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
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

}  // namespace quincunx
