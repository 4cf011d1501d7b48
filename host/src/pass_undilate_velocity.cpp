// SPDX-License-Identifier: MIT
// undilate_velocity: each sample's own velocity, where the renderer has spread that of the nearest.
#include "camera_params.h"
#include "motion/velocity_params.h"
#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"

namespace quincunx {
namespace {

class UndilateVelocityPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render;
    const Resource own = drawn_velocity_of(facts());
    const VelocityScale to_uv = velocity_scale_to(frame.current, {1, 1});
    const bool has_camera =
        frame.current.camera.clip_to_previous_clip != CameraMotion{}.clip_to_previous_clip;
    const UndilateParams params{.frame = {.width = render.width,
                                          .height = render.height,
                                          .depth = layout_of(frame[Resource::kDepth]),
                                          .velocity = layout_of(frame[own]),
                                          .columns_per_item = columns_per_item(shape(), render.width),
                                          .camera = camera_params(frame.current)},
                                .dilated = layout_of(frame[Resource::kDilatedVelocity]),
                                .to_drawn_x = inverse_scale(to_uv.x),
                                .to_drawn_y = inverse_scale(to_uv.y),
                                .has_camera = has_camera ? 1 : 0};
    bind(params, frame[Resource::kDepth], frame[Resource::kDilatedVelocity], frame[own]);
    launch(frame, render, params.frame.columns_per_item, event);
  }
};

}  // namespace

void plan_undilate_velocity(const PlanFacts& facts, PassList& list) {
  if (facts.settings.drawn_velocity == DrawnVelocity::kOwn) return;
  if (!facts.undilates_velocity()) {
    list.left_out.push_back({"undilate_velocity", facts.reads_velocity()
                                                      ? "velocity comes from depth and the camera everywhere"
                                                      : "no pass reads velocity"});
    return;
  }
  const PixelFormat velocity = facts.settings.velocity;
  list.passes.push_back({.kernel = "undilate_velocity",
                         .options = velocity_options(facts.settings),
                         .reason = "each sample gets its own velocity back from the nearest's of 3x3",
                         .uses = {{Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
                                  {Resource::kDilatedVelocity, Access::kRead, Area::kViewport, velocity},
                                  {drawn_velocity_of(facts), Access::kWrite, Area::kViewport, velocity}},
                         .make = make_pass<UndilateVelocityPass>});
}

}  // namespace quincunx
