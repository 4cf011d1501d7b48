// SPDX-License-Identifier: MIT
#include "pass_rig.h"

#include "plan/inputs.h"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace quincunx::testing {

PassSpec spec_of(const PlanFacts& facts, std::string_view kernel) {
  for (PassSpec& spec : list_passes(facts).passes) {
    if (spec.kernel == kernel) return std::move(spec);
  }
  std::fprintf(stderr, "the plan has no %s\n", std::string(kernel).c_str());
  std::abort();
}

PassRig::PassRig(const PlanFacts& facts, std::string_view kernel) : facts_(facts) {
  PassTables tables(impl(), {{1, 1}, {1, 1}, {1, 1}});
  const PassSpec spec = spec_of(facts_, kernel);
  pass_ = spec.make({impl(), facts_, tables}, spec);
}

void PassRig::run(const FrameInputs& current, const FrameInputs& previous, Extent output, Counter counter,
                  Bound bound, Extent previous_output) {
  PassTables tables(impl(), {current.render_extent, output, output});
  PassFrame frame{.queue = impl().queue,
                  .tables = tables,
                  .inputs = current,
                  .previous = previous,
                  .jitter_motion = jitter_motion(current, previous),
                  .has_history = true,
                  .other_exposure = other_exposure_,
                  .albedo = albedo_,
                  .focus = focus_,
                  .focus_extent = facts_.settings.focus.extent,
                  .output = output,
                  .previous_output = previous_output == Extent{} ? output : previous_output,
                  .display = output,
                  .counter = counter};
  bind_inputs(frame);
  const cl::Buffer exposure(impl().context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof(Exposure),
                            &exposure_);
  frame[Resource::kExposure].memory = exposure();
  for (const auto& [resource, view] : bound)
    frame[resource] = view;
  PassChain::enqueue(*pass_, frame, nullptr);
  impl().queue.finish();
}

}  // namespace quincunx::testing
