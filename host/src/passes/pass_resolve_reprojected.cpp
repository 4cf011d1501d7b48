// SPDX-License-Identifier: MIT
// resolve_reprojected: this frame and the previous one where its surfaces moved to, samples weighted by distance.
#include <fmt/format.h>

#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "resolve_params.h"

namespace quincunx {
namespace {

float falloff(int render, int output) {
  const double reach = sample_reach(render, output);
  return static_cast<float>(1 / (reach * reach));
}

class ResolveReprojectedPass : public Pass {
 public:
  ResolveReprojectedPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec) {
    setup.tables.positions();
  }

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent extent = frame.output;
    const Extent now = frame.current.render_extent;
    const Extent before = frame.previous.render_extent;
    PositionTables& tables = frame.tables.positions();
    const ReprojectedParams params{.output_width = extent.width,
                                   .output_height = extent.height,
                                   .frame0 = {now.width,
                                              now.height,
                                              layout_of(frame[Resource::kColour]),
                                              {},
                                              layout_if_used(frame, Resource::kReactive)},
                                   .frame1 = {before.width,
                                              before.height,
                                              layout_of(frame[Resource::kPreviousColour]),
                                              {},
                                              layout_if_used(frame, Resource::kPreviousReactive)},
                                   .reprojection = layout_if_used(frame, Resource::kReprojection),
                                   .output = layout_of(frame[picture()]),
                                   .columns = position_columns(extent),
                                   .counter = frame.counter.index,
                                   .columns_per_item = columns_per_item(shape(), extent.width, 1),
                                   .falloff0_x = falloff(now.width, extent.width),
                                   .falloff0_y = falloff(now.height, extent.height),
                                   .falloff1_x = falloff(before.width, extent.width),
                                   .falloff1_y = falloff(before.height, extent.height)};
    bind(params, tables.get(frame.queue, frame.key()), tables.get(frame.queue, frame.previous_key()),
         frame[Resource::kColour], frame[Resource::kPreviousColour],
         view_or(frame, Resource::kReprojection, picture()),
         view_or(frame, Resource::kReactive, Resource::kColour),
         view_or(frame, Resource::kPreviousReactive, Resource::kColour), frame[picture()], frame.counter);
    launch(frame, extent, params.columns_per_item, event);
  }
};

}  // namespace

void plan_resolve_reprojected(const PlanFacts& facts, PassList& list) {
  if (!facts.has_form(TwoFrameForm::kReprojected)) return;
  const ResolveSettings& settings = facts.settings;
  // Where samples are reprojected, that already holds what reactive values take.
  const bool reactive = !facts.reprojects() && facts.reads_reactive();
  PassSpec spec{.kernel = "resolve_reprojected",
                .options = fmt::format("-D MOTION={} -D REACTIVE={} {}", facts.reprojects() ? 1 : 0,
                                       reactive ? 1 : 0, scale_options(settings)),
                .reason = "the method: this frame and the previous one where it moved to",
                .uses = {{Resource::kColour, Access::kRead, Area::kViewport, settings.colour},
                         {Resource::kPreviousColour, Access::kRead, Area::kPreviousViewport, settings.colour},
                         {picture_of(facts), Access::kWrite, Area::kOutput, settings.output.linear}},
                .make = make_pass<ResolveReprojectedPass>,
                .frames = Frames::kWithHistory};
  if (facts.reprojects())
    spec.uses.push_back({Resource::kReprojection, Access::kRead, Area::kViewport, PixelFormat::kRGBA32F});
  if (reactive) read_both_frames(spec.uses, Resource::kReactive, PixelFormat::kR8);
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
