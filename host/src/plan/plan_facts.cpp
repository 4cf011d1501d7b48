// SPDX-License-Identifier: MIT
#include "plan/plan_facts.h"

namespace quincunx {
namespace {

bool method_reads_velocity(const ResolveSettings& settings) {
  if (settings.method == Method::kTemporal) return true;
  return settings.method == Method::kQuincunx && settings.quincunx.form != TwoFrameForm::kMean;
}

VelocitySource velocity_source(const SceneNeeds& needs, const ResolveSettings& settings) {
  const bool fills = settings.targets.shading == Shading::kCheckerboard;
  if (!method_reads_velocity(settings) && settings.blur.shutter == 0 && !fills &&
      !settings.control.measures_content)
    return VelocitySource::kNone;
  if (needs.moving_objects) return VelocitySource::kTarget;
  return needs.camera_motion ? VelocitySource::kCamera : VelocitySource::kNone;
}

}  // namespace

PlanFacts::PlanFacts(const SceneNeeds& scene_needs, const ResolveSettings& resolve_settings)
    : needs(scene_needs), settings(resolve_settings), velocity(velocity_source(needs, settings)) {
  if (settings.output.min_extent == Extent{}) settings.output.min_extent = settings.output_extent;
}

bool PlanFacts::may_widen() const {
  return widens(settings.target_extent, settings.output.min_extent);
}

bool PlanFacts::may_be_dense() const {
  return is_dense(settings.target_extent, settings.output.min_extent);
}

bool PlanFacts::reads_velocity() const {
  return has_velocity() &&
         (method_reads_velocity(settings) || settings.blur.shutter > 0 || settings.control.measures_content);
}

bool is_dense(Extent render, Extent output) {
  constexpr double kDense = .64;  // output pixels a sample
  return static_cast<double>(output.area()) < kDense * static_cast<double>(render.area());
}

bool widens(Extent render, Extent output) {
  return render.width > output.width || render.height > output.height;
}

}  // namespace quincunx
