// SPDX-License-Identifier: MIT
// cross_fade: the picture mixed with that of another service, while one method gives way to another.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "picture_params.h"

namespace quincunx {
namespace {

class CrossFadePass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ImageView& picture = frame[shown_of(facts())];
    const ImageView& other = frame[Resource::kFadingFrom];
    const CrossFadeParams params{.width = frame.display.width,
                                 .height = frame.display.height,
                                 .other = layout_of(other),
                                 .output = layout_of(picture),
                                 .columns_per_item = columns_per_item(shape(), frame.display.width, 1),
                                 .weight = frame.current.fade_weight};
    bind(params, other, picture);
    launch(frame, frame.display, params.columns_per_item, event);
  }
};

}  // namespace

void plan_cross_fade(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!settings.fades) return;
  list.passes.push_back(
      {.kernel = "cross_fade",
       .options = fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}", precision_of(settings.resolved)),
       .reason = "a change of method is faded: the picture of the other one is mixed in",
       .uses = {{Resource::kFadingFrom, Access::kRead, Area::kDisplay, settings.resolved},
                {shown_of(facts), Access::kUpdate, Area::kDisplay, settings.resolved}},
       .make = make_pass<CrossFadePass>,
       .frames = Frames::kFading});
}

}  // namespace quincunx
