// SPDX-License-Identifier: MIT
#include "programs/front_reference.h"

#include <fmt/format.h>

#include "programs/front_methods.h"
#include "programs/picture_options.h"
#include "render/truth.h"
#include "tools/program/clock.h"

namespace quincunx::scenes {
namespace {

Result<tools::MeasuredPicture> truth_at(FrameSource& stage, const PictureCrop& crop, int samples,
                                        double seconds) {
  auto rgba = render_truth(
      stage.renderer(),
      {.output = crop.extent, .samples = samples, .window = crop.window, .aspect = crop.aspect}, seconds);
  if (!rgba.ok()) return rgba.status();
  return tools::measured(crop.extent, std::move(rgba).value(), stage.exposure());
}

// The second of two draws: the first one may upload and compile.
Result<double> seconds_of_a_draw(FrameSource& stage, const FrontFeed& feed) {
  double seconds = 0;
  for (int i = 0; i < 2; ++i) {
    const tools::Clock::time_point start = tools::Clock::now();
    const auto drawn = truth_at(stage, feed.crop, 1, feed.seconds);
    if (!drawn.ok()) return drawn.status();
    seconds = tools::ms_since(start) / 1000;
  }
  return seconds;
}

Status add_truth(FrameSource& stage, const FrontFeed& feed, int samples, FrontReference& reference) {
  for (int i = 0; i < feed.frames; ++i) {
    auto picture = truth_at(stage, feed.crop, samples, feed.seconds + i / feed.fps);
    if (!picture.ok()) return picture.status();
    reference.moving.push_back(std::move(picture).value());
  }
  reference.held.push_back(reference.moving.front());
  return {};
}

Status add_best(FrameSource& stage, FrontFeed feed, const std::string& best, FrontReference& reference) {
  feed.scale = 1;
  feed.warm_up = kWarmUpFrames;
  for (const bool held : {false, true}) {
    feed.held = held;
    const Status status = run_feed(stage, feed, {&best, 1}, [&](const FrontFrame& frame) -> Status {
      if (frame.index < 0 || (held && frame.index + 1 < feed.frames)) return {};
      std::vector<float> rgba(static_cast<std::size_t>(feed.crop.extent.area()) * 4);
      const Status read = stage.device().download(frame.resolved, feed.crop.extent, rgba.data());
      auto& pictures = held ? reference.held : reference.moving;
      if (read.ok()) pictures.push_back(tools::measured(feed.crop.extent, std::move(rgba), stage.exposure()));
      return read;
    });
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace

int truth_samples(double draw_seconds, double most_seconds) {
  for (const int samples : {8, 6, 4}) {
    if (draw_seconds * samples * samples <= most_seconds) return samples;
  }
  return 0;
}

Result<FrontReference> reference_of(FrameSource& stage, const FrontFeed& feed, double most_seconds) {
  const auto draw_seconds = seconds_of_a_draw(stage, feed);
  if (!draw_seconds.ok()) return draw_seconds.status();
  const int samples = truth_samples(draw_seconds.value() * feed.frames, most_seconds);
  FrontReference reference;
  const std::string& best = front_methods().back();
  const std::string where =
      fmt::format("of {}x{} pixels in the middle", feed.crop.extent.width, feed.crop.extent.height);
  reference.what = samples > 0 ? fmt::format("{} samples a pixel {}", samples * samples, where)
                               : fmt::format("{} at scale 1 {}, as truth takes too long", best, where);
  const Status status =
      samples > 0 ? add_truth(stage, feed, samples, reference) : add_best(stage, feed, best, reference);
  if (!status.ok()) return status;
  return reference;
}

}  // namespace quincunx::scenes
