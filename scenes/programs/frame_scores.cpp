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

Result<std::vector<float>> FrameScores::truth_at(FrameSource& source, double seconds) const {
  const TruthSettings settings = {.output = options_.output,
                                  .samples = options_.score,
                                  .shutter_seconds = options_.resolve.blur.shutter / options_.fps};
  return render_truth(source.renderer(), settings, seconds);
}

tools::MeasuredPicture FrameScores::measured_truth(std::vector<float> truth, float exposure) const {
  if (options_.resolve.colour == PixelFormat::kRGBA8)
    return {options_.output, tools::display_light(truth, options_.resolve.tone_map, exposure)};
  return {options_.output, exposed(std::move(truth), exposure)};
}

Status FrameScores::add_repeat(FrameSource& source, double seconds) {
  auto truth = truth_at(source, seconds);
  if (!truth.ok()) return truth.status();
  return queue_.push([this, exposure = source.exposure(), truth = std::move(truth).value()] {
    scored_.repeat(measured_truth(truth, exposure));
    return Status();
  });
}

Status FrameScores::add(FrameSource& source, std::int64_t index, const FrameView& view,
                        std::vector<float> resolved, int repeats) {
  for (int refresh = 1; refresh <= repeats; ++refresh) {
    const double seconds = view.seconds + (refresh - 1) / options_.fps;
    if (Status status = add_repeat(source, seconds); !status.ok()) return status;
  }
  auto truth = truth_at(source, view.seconds);
  if (!truth.ok()) return truth.status();
  Result<std::vector<Vec2>> motion = std::vector<Vec2>();
  if (scored_.keeps(index)) motion = motion_of(source.renderer(), view);
  if (!motion.ok()) return motion.status();
  return queue_.push([this, index, exposure = source.exposure(), velocity = std::move(motion).value(),
                      resolved = std::move(resolved), truth = std::move(truth).value()] {
    // Colour of 8 bits went through exposure before it was resolved.
    const bool displayed = options_.resolve.colour == PixelFormat::kRGBA8;
    return scored_.add(index, {options_.output, displayed ? resolved : exposed(resolved, exposure)},
                       measured_truth(truth, exposure), {options_.output, velocity});
  });
}

Status FrameScores::finish() {
  return queue_.finish();
}

}  // namespace quincunx::scenes
