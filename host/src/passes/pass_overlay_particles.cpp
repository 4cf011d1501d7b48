// SPDX-License-Identifier: MIT
// overlay_particles: particles of a viewport of their own, laid over the frame.
#include <fmt/format.h>

#include "passes/pass.h"
#include "picture_params.h"
#include "plan/pass_spec.h"

namespace quincunx {
namespace {

// The shaded half of a checkerboard gets its particles before the other half is filled.
Resource colour_of(const PlanFacts& facts) {
  return facts.fills() ? Resource::kShadedColour : Resource::kColour;
}
Resource depth_of(const PlanFacts& facts) {
  return facts.fills() ? Resource::kShadedDepth : Resource::kDepth;
}
Resource reactive_of(const PlanFacts& facts) {
  return facts.fills() ? Resource::kShadedReactive : Resource::kReactive;
}
bool marks(const PlanFacts& facts) {
  return facts.reads_reactive() || (facts.fills() && facts.needs.transparents);
}

class OverlayParticlesPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render_extent, particles = frame.current.particle_render_extent;
    const Resource colour = colour_of(facts()), depth = depth_of(facts()), reactive = reactive_of(facts());
    const OverlayParams params{.width = render.width,
                               .height = render.height,
                               .particle_width = particles.width,
                               .particle_height = particles.height,
                               .columns_per_item = columns_per_item(shape(), render.width, kParticleBlock),
                               .bare_colour = layout_of(frame[Resource::kBareColour]),
                               .bare_reactive = layout_if_used(frame, Resource::kBareReactive),
                               .depth = layout_of(frame[depth]),
                               .particle_colour = layout_of(frame[Resource::kParticleColour]),
                               .particle_reactive = layout_if_used(frame, Resource::kParticleReactive),
                               .particle_depth = layout_of(frame[Resource::kParticleDepth]),
                               .colour = layout_of(frame[colour]),
                               .reactive = layout_if_used(frame, reactive)};
    bind(params, frame[Resource::kBareColour], frame[depth], view_or(frame, Resource::kBareReactive, depth),
         frame[Resource::kParticleColour], frame[Resource::kParticleDepth],
         view_or(frame, Resource::kParticleReactive, Resource::kParticleDepth), frame[colour],
         view_or(frame, reactive, colour));
    launch(frame, render, params.columns_per_item, event);
  }
};

}  // namespace

void plan_overlay_particles(const PlanFacts& facts, PassList& list) {
  if (!facts.overlays_particles()) return;
  const PixelFormat colour = facts.settings.colour;
  PassSpec spec{
      .kernel = "overlay_particles",
      .options = fmt::format("-D REACTIVE={} {}", marks(facts) ? 1 : 0, colour_options(facts.settings)),
      .reason = "particles are drawn at a scale of their own",
      .uses = {{Resource::kBareColour, Access::kRead, Area::kViewport, colour},
               {depth_of(facts), Access::kRead, Area::kViewport, PixelFormat::kR32F},
               {Resource::kParticleColour, Access::kRead, Area::kParticles, colour},
               {Resource::kParticleDepth, Access::kRead, Area::kParticles, PixelFormat::kR32F},
               {colour_of(facts), Access::kWrite, Area::kViewport, colour}},
      .make = make_pass<OverlayParticlesPass>};
  if (marks(facts)) {
    spec.uses.push_back({Resource::kBareReactive, Access::kRead, Area::kViewport, PixelFormat::kR8});
    spec.uses.push_back({Resource::kParticleReactive, Access::kRead, Area::kParticles, PixelFormat::kR8});
    spec.uses.push_back({reactive_of(facts), Access::kWrite, Area::kViewport, PixelFormat::kR8});
  }
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
