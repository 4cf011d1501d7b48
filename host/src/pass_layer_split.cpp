// SPDX-License-Identifier: MIT
// layer_split: which samples have two layers.
#include "layer_params.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class LayerSplitPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
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

}  // namespace quincunx
