// SPDX-License-Identifier: MIT
// convert_inputs: the inputs that need another convention, each in an image of the service's own.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "motion/velocity_params.h"
#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/native_frame.h"
#include "plan/pass_spec.h"

namespace quincunx {
namespace {

class ConvertInputsPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Use& from = spec().uses[0];
    const ImageView& given = frame[from.resource];
    const ImageView& made = frame[spec().uses[1].resource];
    const Extent extent = extent_of(from.area, frame.extents());
    const InputConventions& conventions = settings().conventions;
    const float near_plane = frame.current.near_plane;
    const DepthConvention depth = conventions.depth;
    const VelocityScale to_uv = velocity_scale_to(frame.current, {1, 1});
    const ConvertParams params{
        .width = extent.width,
        .height = extent.height,
        .given = rows_of(given, extent.height, conventions.origin),
        .made = rows_of(made, extent.height, Origin::kTop),
        .columns_per_item = columns_per_item(shape(), extent.width),
        .is_linear = depth == DepthConvention::kLinear ? 1 : 0,
        .is_reversed = depth == DepthConvention::kReversed ? 1 : 0,
        .near_plane = near_plane,
        .near_by_far = needs_far_plane(depth)
                           ? static_cast<float>(static_cast<double>(near_plane) / frame.current.far_plane)
                           : 0,
        .jitter_x = frame.jitter_motion.x * inverse_scale(to_uv.x),
        .jitter_y = frame.jitter_motion.y * inverse_scale(to_uv.y)};
    bind(params, given, made);
    launch(frame, extent, params.columns_per_item, event);
  }
};

PassSpec conversion(Conversion kind, const InputImage& input, const Use& made, const PlanFacts& facts) {
  const char* depth = name_of(facts.settings.conventions.depth);
  const std::string storage =
      fmt::format("-D SOURCE_STORAGE={}", storage_option(facts.settings.targets.storage));
  PassSpec spec{.kernel = "convert_inputs",
                .options = "-D INPUT=ROWS " + storage,
                .reason = fmt::format("{} is an image that begins with the lowest row", input.field),
                .uses = {{input.given, Access::kRead, made.area, made.format},
                         {made.resource, Access::kWrite, made.area, made.format}},
                .make = make_pass<ConvertInputsPass>};
  if (kind == Conversion::kDepth) {
    spec.options = "-D INPUT=DEPTH " + storage;
    spec.reason = fmt::format("{} is {}", input.field, depth);
  } else if (kind == Conversion::kVelocity) {
    spec.options = "-D INPUT=VELOCITY " + velocity_options(facts.settings);
    spec.reason = fmt::format("{} has the jitter in it", input.field);
  }
  return spec;
}

}  // namespace

void plan_convert_inputs(const PlanFacts& facts, PassList& list) {
  std::vector<PassSpec> conversions;
  for (const ResourceUse& use : resources_of(list.passes)) {
    const InputImage* input = info_of(use.resource).input;
    if (input == nullptr || use.written || is_previous(use.resource)) continue;
    const Conversion kind = conversion_of(*input, facts.settings);
    if (kind != Conversion::kNone) conversions.push_back(conversion(kind, *input, use.largest, facts));
  }
  const auto first_reader = std::find_if(list.passes.begin(), list.passes.end(), [](const PassSpec& spec) {
    return spec.frames != Frames::kResized;
  });
  list.passes.insert(first_reader, conversions.begin(), conversions.end());
}

}  // namespace quincunx
