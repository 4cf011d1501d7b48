// SPDX-License-Identifier: MIT
// scale_filter: the finished picture, where its size is dynamic, to the size in which it is shown.
#include <fmt/format.h>

#include "filter_params.h"
#include "pass_list.h"
#include "pass_options.h"
#include "scale_params.h"

namespace quincunx {
namespace {

const Filter& display_filter() {
  return filter_of(Method::kCatmullRom);
}

class ScaleToDisplayPass : public Pass {
 public:
  ScaleToDisplayPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.filter(display_filter());
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ImageView& finished = frame[finished_of(facts())];
    const ImageView& displayed = frame[Resource::kDisplayed];
    const FilterParams params = filter_params(display_filter(), shape(), {frame.output, finished},
                                              {frame.display, displayed}, frame.counter);
    bind(params, frame.tables.filter(display_filter()).get(frame.queue, {frame.display, frame.output, {}}),
         finished, displayed, frame.counter);
    launch(frame, frame.display, params.columns_per_item, event);
  }
};

}  // namespace

void plan_scale_to_display(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!facts.is_dual()) return;
  list.passes.push_back(
      {.kernel = "scale_filter",
       .options = fmt::format(
           "-D TAPS=4 -D CLAMP=1 -D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}",
           precision_of(settings.resolved)),
       .reason = "the output is dynamic: its picture in the size in which it is shown",
       .uses = {{finished_of(facts), Access::kRead, Area::kOutput, settings.resolved},
                {Resource::kDisplayed, Access::kWrite, Area::kDisplay, settings.resolved}},
       .make = make_pass<ScaleToDisplayPass>,
       .frames = Frames::kScaledOutput});
}

}  // namespace quincunx
