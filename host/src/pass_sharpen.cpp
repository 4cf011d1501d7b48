// SPDX-License-Identifier: MIT
// sharpen: the resolved picture made crisper.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "picture_params.h"

namespace quincunx {
namespace {

class SharpenPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const SharpenParams params{.width = frame.output.width,
                               .height = frame.output.height,
                               .source = layout_of(frame[Resource::kUnsharpened]),
                               .output = layout_of(frame[Resource::kResolved]),
                               .columns_per_item = columns_per_item(shape(), frame.output.width),
                               .sharpness = settings().sharpness};
    bind(params, frame[Resource::kUnsharpened], frame[Resource::kResolved]);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_sharpen(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!facts.sharpens()) {
    list.left_out.push_back(
        {"sharpen", settings.sharpness > 0 ? "the view is no picture" : "sharpness is 0"});
    return;
  }
  list.passes.push_back(
      {.kernel = "sharpen",
       .options = fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}", precision_of(settings.resolved)),
       .reason = "sharpness is wanted: contrast between neighbours, within their range",
       .uses = {{Resource::kUnsharpened, Access::kRead, Area::kOutput, settings.resolved},
                {Resource::kResolved, Access::kWrite, Area::kOutput, settings.resolved}},
       .make = make_pass<SharpenPass>});
}

}  // namespace quincunx
