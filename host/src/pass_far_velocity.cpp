// SPDX-License-Identifier: MIT
// far_velocity: the drawn velocity, completed where the sky has none.
#include <fmt/format.h>

#include "camera_params.h"
#include "motion/far_params.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class FarVelocityPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
    const bool fitted = facts().fits_far();
    const double aspect = static_cast<double>(frame.output.width) / frame.output.height;
    const VelocityScale to_uv = velocity_scale_to(frame.current, {1, 1});
    const FarVelocityParams params{.frame = {.width = render.width,
                                             .height = render.height,
                                             .depth = layout_of(frame[Resource::kDepth]),
                                             .velocity = layout_of(frame[Resource::kVelocity]),
                                             .columns_per_item = columns_per_item(shape(), render.width),
                                             .camera = camera_params(frame.current)},
                                   .drawn = layout_of(frame[Resource::kDrawnVelocity]),
                                   .places = far_places(frame.current, frame.output),
                                   .to_drawn_x = inverse_scale(fitted ? to_uv.x * aspect : to_uv.x),
                                   .to_drawn_y = inverse_scale(to_uv.y)};
    // With the camera's own motion there is no other: their memory is null, which OpenCL allows for a buffer.
    bind(params, frame[Resource::kDepth], frame[Resource::kDrawnVelocity], frame[Resource::kFarMotion],
         frame[Resource::kFarMatch], frame[Resource::kVelocity]);
    launch(frame, render, params.frame.columns_per_item, event);
  }
};

}  // namespace

void plan_far_velocity(const PlanFacts& facts, PassList& list) {
  if (facts.settings.far == FarMotion::kAsDrawn) return;
  if (!facts.moves_far()) {
    const char* reason =
        !facts.reads_velocity()                     ? "no pass reads velocity"
        : !facts.needs.camera_motion                ? "the camera stands still, and so does what is far away"
        : facts.velocity == VelocitySource::kTarget ? "the method uses one frame only: there is no evidence"
                                                    : "velocity comes from depth and the camera everywhere";
    list.left_out.push_back({"far_velocity", reason});
    return;
  }
  const PixelFormat velocity = facts.settings.velocity;
  PassSpec spec{.kernel = "far_velocity",
                .options = fmt::format("-D FAR={} {}", facts.fits_far() ? "EVIDENCE" : "CAMERA",
                                       velocity_options(facts.settings)),
                .reason = "what is infinitely far away moves with the camera",
                .uses = {{Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                         {Resource::kDrawnVelocity, Access::kRead, Area::kViewport, velocity},
                         {Resource::kVelocity, Access::kWrite, Area::kViewport, velocity}},
                .make = make_pass<FarVelocityPass>};
  if (facts.fits_far()) {
    spec.uses.push_back({Resource::kFarMotion, Access::kRead, Area::kWhole, {}, sizeof(FarModel)});
    spec.uses.push_back({Resource::kFarMatch, Access::kRead, Area::kWhole, {}, sizeof(FarMatch)});
  }
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
