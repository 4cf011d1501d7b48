// SPDX-License-Identifier: MIT
#include "passes/pass_measure_content.h"

#include <algorithm>
#include <cmath>

#include "passes/pass.h"
#include "picture_params.h"
#include "plan/pass_spec.h"
#include "temporal/tile.h"

namespace quincunx {
namespace {

constexpr double kSpeedUnits = 16;  // steps of ContentSums::speed in an output pixel

constexpr double kThinReach = 3;  // output pixels to either side of what is thin

int reach(int render, int output) {
  return std::max(1, static_cast<int>(std::lround(kThinReach * render / output)));
}

float step(int output, int tiles) {
  return static_cast<float>(static_cast<double>(output) / (tiles * kContentSamples));
}

class MeasureContentPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.current.render_extent;
    const Extent tiles = content_tiles(frame.output);
    const VelocityScale pixels = velocity_scale_to(frame.current, frame.output);
    const bool is_judged = uses(Resource::kTileLight) && frame.has_history && !is_dense(render, frame.output);
    const Extent judged = is_judged ? frame.output : Extent{};
    const ContentParams params{.width = render.width,
                               .height = render.height,
                               .tiles_x = tiles.width,
                               .tiles_y = tiles.height,
                               .velocity = layout_of(frame[Resource::kVelocity]),
                               .depth = layout_of(frame[Resource::kDepth]),
                               .reactive = layout_if_used(frame, Resource::kReactive),
                               .reach_x = reach(render.width, frame.output.width),
                               .reach_y = reach(render.height, frame.output.height),
                               .pixels_x = static_cast<float>(pixels.x),
                               .pixels_y = static_cast<float>(pixels.y),
                               .step_x = step(frame.output.width, tiles.width),
                               .step_y = step(frame.output.height, tiles.height),
                               .judged_width = judged.width,
                               .judged_height = judged.height};
    bind(params, frame[Resource::kVelocity], frame[Resource::kDepth],
         view_or(frame, Resource::kReactive, Resource::kDepth),
         view_or(frame, Resource::kTileLight, Resource::kContentSums), frame[Resource::kContentSums]);
    launch(frame, tiles, 1, event);
  }
};

}  // namespace

Extent content_tiles(Extent output) {
  return {(output.width + kContentTile - 1) / kContentTile,
          (output.height + kContentTile - 1) / kContentTile};
}

ContentStatistics statistics_of(const ContentSums& sums, Extent output) {
  constexpr int kSamples = kContentSamples * kContentSamples;
  const auto all = static_cast<double>(content_tiles(output).area() * kSamples);
  ContentStatistics content;
  content.moving = sums.moving / all;
  if (sums.moving > 0) content.speed_px = sums.speed / kSpeedUnits / sums.moving;
  content.apart = sums.apart / all;
  content.thin = sums.thin / all;
  content.light = sums.light / all;
  content.zoom = sums.zoom / all;
  content.judged = sums.judged > 0;
  return content;
}

void plan_measure_content(const PlanFacts& facts, PassList& list) {
  if (!facts.measures_content()) return;
  const bool reactive = facts.needs.transparents;
  PassSpec spec{
      .kernel = "measure_content",
      .options =
          std::string(reactive ? "-D REACTIVE=1 " : "-D REACTIVE=0 ") + velocity_options(facts.settings),
      .reason = "what the picture shows is wanted: a sample of it",
      .uses = {{Resource::kVelocity, Access::kRead, Area::kViewport, facts.settings.velocity},
               {Resource::kDepth, Access::kRead, Area::kViewport, PixelFormat::kR32F},
               {Resource::kContentSums, Access::kAccumulate, Area::kWhole, {}, sizeof(ContentSums)}},
      .make = make_pass<MeasureContentPass>};
  if (reactive) spec.uses.push_back({Resource::kReactive, Access::kRead, Area::kViewport, PixelFormat::kR8});
  if (facts.accumulates())
    spec.uses.push_back({Resource::kTileLight, Access::kRead, Area::kTiles, {}, sizeof(TileLight)});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
