// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>

#include "frame_check.h"
#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

bool lies_within(const Rectangle& inner, const Rectangle& outer) {
  return inner.width >= 1 && inner.height >= 1 && inner.x >= outer.x && inner.y >= outer.y &&
         inner.width <= outer.width && inner.height <= outer.height &&
         inner.x - outer.x <= outer.width - inner.width && inner.y - outer.y <= outer.height - inner.height;
}

void check_rectangles(FrameCheck& check, const FocusInputs& focus, const Rectangle& region) {
  if (focus.rectangle_count < 0 || focus.rectangle_count > FocusInputs::kMostRectangles) {
    check.complain(fmt::format("focus.rectangle_count is {}; it must lie in [0, {}]", focus.rectangle_count,
                               FocusInputs::kMostRectangles));
    return;
  }
  for (int i = 0; i < focus.rectangle_count; ++i) {
    const Rectangle& where = focus.rectangles[static_cast<std::size_t>(i)];
    if (lies_within(where, region)) continue;
    check.complain(fmt::format(
        "focus.rectangles[{}] is {}x{} at {}, {}; it must lie within the region of {}x{} at {}, {}", i,
        where.width, where.height, where.x, where.y, region.width, region.height, region.x, region.y));
  }
}

void check_place(FrameCheck& check, const ResolvePlan& plan, const FocusInputs& focus) {
  constexpr float kLongestFeather = 32768;
  const Extent output = plan.settings.output;
  const Rectangle region = {focus.x, focus.y, plan.settings.focus.extent.width,
                            plan.settings.focus.extent.height};
  if (!lies_within(region, {0, 0, output.width, output.height})) {
    check.complain(fmt::format("the focus's region of {}x{} at {}, {} leaves the output's {}x{}",
                               region.width, region.height, region.x, region.y, output.width, output.height));
  }
  check_rectangles(check, focus, region);
  check.finite("focus.feather", focus.feather, 0, kLongestFeather);
}

}  // namespace

Status validate_focus(const ResolvePlan& plan, const ResolvePlan* region, const FocusInputs& focus) {
  if (region == nullptr)
    return Status::invalid("focus is given, but the plan has none; set settings.focus.extent");
  FrameCheck check(plan);
  check_place(check, plan, focus);
  if (plan.settings.focus.mask)
    check.output("focus.mask", focus.mask, PixelFormat::kR8, Storage::kBuffer, plan.settings.focus.extent,
                 "region");
  FrameCheck frame(*region);
  check_inputs(frame, *region, focus.frame);
  if (const Status status = frame.status(); !status.ok())
    check.complain("of focus.frame: " + std::string(status.message()));
  return check.status();
}

Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FocusInputs& focus,
                const FrameOutputs& outputs) {
  if (Status status = validate(plan, inputs, outputs); !status.ok()) return status;
  const std::optional<ResolvePlan> region = plan.focus_plan();
  return validate_focus(plan, region ? &*region : nullptr, focus);
}

}  // namespace quincunx
