// SPDX-License-Identifier: MIT
// turn_records: thin things that stop, start or turn about take their records with them.
#include "layer_params.h"
#include "pass_list.h"

namespace quincunx {
namespace {

class TurnRecordsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent before = frame.previous.render;
    const LayerParams params = layer_params(frame, shape(), before);
    bind(params, frame[Resource::kPreviousRecordKeys], frame[Resource::kRecordKeys],
         frame[Resource::kRecords], frame[Resource::kPreviousRecords]);
    launch(frame, before, params.columns_per_item, event);
  }
};

}  // namespace

void plan_turn_records(const PlanFacts& facts, PassList& list) {
  if (!facts.has_layers()) return;
  list.passes.push_back(
      {.kernel = "turn_records",
       .options = {},
       .reason = "the second layer: thin things that stop, start or turn about leave no ghosts",
       .uses =
           {{Resource::kPreviousRecordKeys, Access::kRead, Area::kPreviousViewport, {}, sizeof(cl_uint)},
            {Resource::kRecordKeys, Access::kRead, Area::kViewport, {}, sizeof(cl_uint)},
            {Resource::kRecords, Access::kRead, Area::kViewport, {}, sizeof(LayerRecord)},
            {Resource::kPreviousRecords, Access::kUpdate, Area::kPreviousViewport, {}, sizeof(LayerRecord)}},
       .make = make_pass<TurnRecordsPass>,
       .frames = Frames::kSparse});
}

}  // namespace quincunx
