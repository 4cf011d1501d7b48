// SPDX-License-Identifier: MIT
#include "session/frame_pacing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace quincunx::scenes {
namespace {

constexpr double kLeastFps = 1000 / ResolutionController::kMaxMs;
constexpr double kMostHeadroom = 0.5;
constexpr int kLeastBuffers = 2;
constexpr int kMostBuffers = 8;
constexpr double kSameMoment = 1e-9;  // part of a refresh interval: rounding of sums of intervals

Status check(const PacingSettings& settings) {
  if (!(settings.target_fps >= kLeastFps && std::isfinite(settings.target_fps))) {
    return Status::invalid(
        fmt::format("the target is {} frames a second; it must be a finite number of at least {:.4f}",
                    settings.target_fps, kLeastFps));
  }
  if (settings.buffers < kLeastBuffers || settings.buffers > kMostBuffers) {
    return Status::invalid(fmt::format("there are {} buffers; there must be {} to {}", settings.buffers,
                                       kLeastBuffers, kMostBuffers));
  }
  if (!(settings.headroom >= 0 && settings.headroom <= kMostHeadroom)) {
    return Status::invalid(
        fmt::format("the headroom is {}; it must lie within [0, {}]", settings.headroom, kMostHeadroom));
  }
  return {};
}

double target_ms(const PacingSettings& settings) {
  return 1000 / settings.target_fps * (1 - settings.headroom);
}

PredictiveSettings predictive(const PacingSettings& settings) {
  return {.ladder = settings.ladder,
          .target_ms = target_ms(settings),
          .buffers = settings.buffers,
          .calibration = settings.calibration,
          .cpu_bound = settings.cpu_bound,
          .blur_aware = settings.blur_aware};
}

Result<std::unique_ptr<ResolutionController>> make_resolution_controller(const PacingSettings& settings) {
  switch (settings.controller) {
    case ControllerKind::kPredictive:
      return make_predictive_controller(predictive(settings));
    case ControllerKind::kProportional:
      return make_proportional_controller({.ladder = settings.ladder, .target_ms = target_ms(settings)});
    case ControllerKind::kMinimumOfN:
      return make_minimum_of_n_controller({.ladder = settings.ladder, .target_ms = target_ms(settings)});
    case ControllerKind::kQuality:
    case ControllerKind::kFixed:
      break;
  }
  return std::unique_ptr<ResolutionController>();
}

constexpr std::array<float, 3> kMetres = {2, 8, 32};
constexpr std::array<float, 5> kPlaces = {-0.8f, -0.4f, 0, 0.4f, 0.8f};  // in normalised device coordinates

// -1 where the point was behind the camera.
double way_px(const std::array<float, 16>& m, float x, float y, float depth, Extent output) {
  const auto row = [&](std::size_t i) { return m[i] * x + m[4 + i] * y + m[8 + i] * depth + m[12 + i]; };
  const float w = row(3);
  if (!(w > 0)) return -1;
  return std::hypot(0.5 * output.width * (x - row(0) / w), 0.5 * output.height * (y - row(1) / w));
}

}  // namespace

const char* name_of(ControllerKind kind) {
  constexpr const char* kNames[] = {"predictive", "proportional", "minimum-of-n", "quality", "fixed"};
  return kNames[static_cast<std::size_t>(kind)];
}

Result<FramePacing> FramePacing::create(const PacingSettings& settings) {
  if (Status status = check(settings); !status.ok()) return status;
  auto controllers = make_controller(settings);
  if (!controllers.ok()) return controllers.status();
  return FramePacing(settings, 1000 / settings.target_fps, std::move(controllers).value());
}

FramePacing FramePacing::free_running(Extent output) {
  return FramePacing(
      {.controller = ControllerKind::kFixed, .ladder = {.output_extent = output}, .target_fps = 0}, 0, {});
}

Result<FramePacing::Controllers> FramePacing::make_controller(const PacingSettings& settings) {
  Controllers made;
  if (settings.controller == ControllerKind::kQuality) {
    auto quality = make_quality_controller({.pacing = predictive(settings), .front = settings.front});
    if (!quality.ok()) return quality.status();
    made.quality = quality.value().get();
    made.controller = std::move(quality).value();
    return made;
  }
  auto controller = make_resolution_controller(settings);
  if (!controller.ok()) return controller.status();
  made.controller = std::move(controller).value();
  return made;
}

FramePacing::FramePacing(const PacingSettings& settings, double refresh_ms, Controllers controllers)
    : controller_(std::move(controllers.controller)), quality_(controllers.quality), refresh_ms_(refresh_ms) {
  run_.controller = name_of(settings.controller);
  run_.target_fps = settings.target_fps;
  run_.buffers = settings.buffers;
  run_.output = settings.ladder.output_extent;
}

std::optional<Extent> FramePacing::next() const {
  if (!controller_) return std::nullopt;
  return controller_->next();
}

std::optional<QualityChoice> FramePacing::choice() const {
  if (quality_ == nullptr) return std::nullopt;
  return quality_->choice();
}

std::string FramePacing::reasons() const {
  return quality_ == nullptr ? std::string() : explain(quality_->reasons());
}

void FramePacing::note_method(std::uint64_t frame, const QualityChoice& choice) {
  if (method_ && !(*method_ == choice.method)) {
    run_.method_changes.push_back(
        {static_cast<std::int64_t>(frame), name_of(*method_), name_of(choice.method), reasons()});
  }
  method_ = choice.method;
}

std::optional<double> FramePacing::free_at() const {
  const std::size_t frame = run_.frames.size() + under_way_.size();
  const auto buffers = static_cast<std::size_t>(run_.buffers);
  if (!has_display() || frame < buffers) return -std::numeric_limits<double>::infinity();
  const std::size_t last_to_replace = frame - buffers + 1;
  if (last_to_replace >= run_.frames.size()) return std::nullopt;
  return origin_ms_ + run_.frames[last_to_replace].shown_ms;
}

std::uint64_t FramePacing::begin(double now_ms, Extent render, double blur_px, int detail) {
  const std::uint64_t frame = run_.frames.size() + under_way_.size();
  under_way_.push_back({now_ms, render, blur_px, detail, choice()});
  if (quality_ != nullptr) note_method(frame, *under_way_.back().choice);
  return frame;
}

void FramePacing::finish(std::uint64_t frame, double now_ms, double cpu_ms) {
  if (frame != run_.frames.size() || under_way_.empty()) return;
  const Begun begun = under_way_.front();
  under_way_.erase(under_way_.begin());
  if (frame == 0) origin_ms_ = now_ms;
  tools::PacedFrame paced = {
      .index = static_cast<std::int64_t>(frame), .render = begun.render, .cpu_ms = cpu_ms};
  paced.blur_px = begun.blur_px;
  paced.detail = begun.detail;
  if (begun.choice) {
    paced.method = name_of(begun.choice->method);
    if (begun.choice->fading_from) paced.fading_from = name_of(*begun.choice->fading_from);
    paced.weight = begun.choice->weight;
  }
  paced.finished_ms = now_ms - origin_ms_;
  paced.start_ms = begun.begin_ms - origin_ms_;
  if (frame > 0) paced.start_ms = std::max(paced.start_ms, run_.frames.back().finished_ms);
  if (!has_display()) {
    paced.shown_ms = paced.finished_ms;
  } else if (frame > 0) {
    const tools::PacedFrame& before = run_.frames.back();
    const double refresh = std::ceil(paced.finished_ms / refresh_ms_ - kSameMoment) * refresh_ms_;
    paced.shown_ms = std::max(refresh, before.shown_ms + refresh_ms_);
    paced.missed = static_cast<int>(std::lround((paced.shown_ms - before.shown_ms) / refresh_ms_)) - 1;
  }
  paced.busy_ms = paced.finished_ms - paced.start_ms;
  paced.queued = 1;
  for (auto past = run_.frames.rbegin(); past != run_.frames.rend() && past->shown_ms > paced.finished_ms;
       ++past) {
    ++paced.queued;
  }
  run_.frames.push_back(paced);
}

double FramePacing::busy_ms(std::uint64_t frame) const {
  return frame < run_.frames.size() ? run_.frames[frame].finished_ms - run_.frames[frame].start_ms : 0;
}

void FramePacing::observe(std::uint64_t frame, const FrameCosts& costs) {
  const double gpu_ms = costs.gpu_ms;
  if (frame >= run_.frames.size() || !(gpu_ms > 0 && gpu_ms <= ResolutionController::kMaxMs)) return;
  tools::PacedFrame& paced = run_.frames[frame];
  FrameTiming timing = {.frame = frame,
                        .next_frame = run_.frames.size() + under_way_.size(),
                        .render_extent = paced.render,
                        .gpu_ms = gpu_ms,
                        .cpu_ms = paced.cpu_ms,
                        .queued = paced.queued,
                        .missed_vsyncs = paced.missed,
                        .blur_px = paced.blur_px};
  if (frame > 0) timing.interval_ms = paced.start_ms - run_.frames[frame - 1].start_ms;
  // Passes cannot take all of a frame.
  const double resolve_ms = costs.resolve_ms > 0 && costs.resolve_ms < gpu_ms ? costs.resolve_ms : 0;
  Status told;
  if (quality_ != nullptr) {
    told = quality_->observe(QualityFrame{timing, resolve_ms, costs.content});
  } else if (controller_) {
    told = controller_->observe(timing);
  }
  // The report has what the controller was told; without one, what it would have been told.
  if (!told.ok()) return;
  paced.busy_ms = gpu_ms;
  paced.resolve_ms = resolve_ms;
  paced.content = costs.content;
}

double camera_streak_px(const CameraMotion& motion, float near_plane, Extent output, float shutter) {
  double sum = 0;
  int count = 0;
  for (const float metres : kMetres) {
    for (const float y : kPlaces) {
      for (const float x : kPlaces) {
        const double way = way_px(motion.clip_to_previous_clip, x, y, near_plane / metres, output);
        if (way < 0 || !std::isfinite(way)) continue;
        sum += way;
        ++count;
      }
    }
  }
  return count > 0 ? shutter * sum / count : 0;
}

}  // namespace quincunx::scenes
