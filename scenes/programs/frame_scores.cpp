// SPDX-License-Identifier: MIT
#include "programs/frame_scores.h"

#include <numeric>
#include <utility>

#include "programs/target_file.h"
#include "render/truth.h"
#include "tools/image/display_light.h"

namespace quincunx::scenes {
namespace {

std::vector<std::int64_t> all_of(std::int64_t count) {
  std::vector<std::int64_t> frames(static_cast<std::size_t>(count));
  std::iota(frames.begin(), frames.end(), 0);
  return frames;
}

std::vector<float> exposed(std::vector<float> rgba, float exposure) {
  for (std::size_t i = 0; i < rgba.size(); ++i)
    rgba[i] *= i % 4 < 3 ? exposure : 1.f;
  return rgba;
}

}  // namespace

FrameScores::FrameScores(const RenderOptions& options)
    : options_(options), scored_(all_of(options.frames), !options.report.empty()) {}

Result<std::vector<Vec2>> FrameScores::motion_of(Renderer& renderer, FrameView view) const {
  view.render = options_.output;
  view.jitter = {};
  view.parity.reset();
  const gl::RenderTargets targets({.target = options_.output, .reactive = false});
  if (Status status = renderer.draw(targets, view); !status.ok()) return status;
  return velocity_of(gl::read_targets(targets, options_.output));
}

Status FrameScores::add(FrameSource& source, std::int64_t index, const FrameView& view,
                        std::vector<float> resolved) {
  const TruthSettings settings = {.output = options_.output,
                                  .samples = options_.score,
                                  .shutter_seconds = options_.resolve.blur.shutter / options_.fps};
  auto truth = render_truth(source.renderer(), settings, view.seconds);
  if (!truth.ok()) return truth.status();
  Result<std::vector<Vec2>> motion = std::vector<Vec2>();
  if (scored_.keeps(index)) motion = motion_of(source.renderer(), view);
  if (!motion.ok()) return motion.status();
  // Colour of 8 bits went through exposure and tone map before it was resolved.
  const bool displayed = options_.resolve.colour == PixelFormat::kRGBA8;
  return queue_.push([this, displayed, index, exposure = source.exposure(),
                      velocity = std::move(motion).value(), resolved = std::move(resolved),
                      truth = std::move(truth).value()] {
    const auto lit = [&](const std::vector<float>& rgba) { return exposed(rgba, exposure); };
    return scored_.add(
        index, {options_.output, displayed ? resolved : lit(resolved)},
        {options_.output,
         displayed ? tools::display_light(truth, options_.resolve.tone_map, exposure) : lit(truth)},
        {options_.output, velocity});
  });
}

Status FrameScores::finish() {
  return queue_.finish();
}

}  // namespace quincunx::scenes
