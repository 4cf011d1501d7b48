// SPDX-License-Identifier: MIT
// advect_records: thin things keep their motion where no sample of this frame shows them.
#include "layer_params.h"
#include "pass_list.h"

namespace quincunx {
namespace {

class AdvectRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent before = frame.previous.render;
    const LayerParams params = layer_params(frame, shape(), before);
    bind(params, frame[Resource::kPreviousRecordKeys], frame[Resource::kPreviousRecords],
         frame[Resource::kRecordKeys]);
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
       .uses = {{Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
                {Resource::kPreviousRecords, Access::kRead, Area::kPreviousViewport, {}, sizeof(LayerRecord)},
                {Resource::kRecordKeys, Access::kWrite, Area::kViewport, {}, sizeof(cl_uint)}},
       .make = make_pass<AdvectRecordsPass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
