// SPDX-License-Identifier: MIT
#include "programs/front_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "programs/frame_meter.h"
#include "programs/front_feed.h"
#include "programs/front_methods.h"
#include "programs/front_reference.h"
#include "programs/picture_options.h"
#include "quincunx/front_file.h"
#include "tools/program/method_names.h"

namespace quincunx::scenes {
namespace {

constexpr Extent kMostCrop = {320, 180};
constexpr int kMeasuredFrames = 2;
constexpr int kTimedFrames = 4;
constexpr int kTimedWarmUp = 2;
constexpr double kMostStill = 0.8;  // of the picture: what moves is to be measured, too

// What is known of one method at one scale.
struct Measured {
  std::vector<double> flip, psnr;
};
struct Cell {
  Measured held, moving;
  std::vector<double> ms;
};

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values)
    squares += (value - mean_of(values)) * (value - mean_of(values));
  return values.size() < 2 ? 0 : std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double squared_error(double psnr_db) {
  return std::pow(10, -psnr_db / 10);
}

class Calibration {
 public:
  Calibration(FrameSource& stage, const FrontCalibration& settings) : stage_(stage), settings_(settings) {}

  Result<ErrorFront> run() {
    feed_.crop = PictureCrop::middle_of(settings_.output, kMostCrop);
    feed_.fps = settings_.fps;
    feed_.seconds = settings_.seconds;
    feed_.frames = kMeasuredFrames;
    auto reference = reference_of(stage_, feed_, settings_.truth_seconds);
    if (!reference.ok()) return reference.status();
    reference_ = std::move(reference).value();
    for (const double scale : settings_.scales) {
      if (Status status = run_scale(scale); !status.ok()) return status;
    }
    return ErrorFront::create(source(), std::move(points_));
  }

 private:
  Status run_scale(double scale) {
    const std::vector<std::string>& names = front_methods();
    std::vector<Cell> cells(names.size());
    const auto jitter_of = [&](std::size_t i) {
      return jitter_for(tools::method_choices().at(names[i]).method);
    };
    for (std::size_t first = 0, last = 0; first < names.size(); first = last) {
      while (last < names.size() && jitter_of(last) == jitter_of(first))
        ++last;
      const std::span<const std::string> methods(&names[first], last - first);
      const std::span<Cell> of_feed(&cells[first], last - first);
      if (Status status = measure(scale, methods, of_feed); !status.ok()) return status;
      if (Status status = time(scale, methods, of_feed); !status.ok()) return status;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      add_points(scale, front_method(names[i]).value(), cells[i]);
    return {};
  }

  Status measure(double scale, std::span<const std::string> methods, std::span<Cell> cells) {
    FrontFeed feed = feed_;
    feed.scale = static_cast<float>(scale);
    const bool accumulates = tools::method_choices().at(methods.front()).method == Method::kTemporal;
    feed.warm_up = accumulates ? kWarmUpFrames : 1;
    std::vector<float> rgba(static_cast<std::size_t>(feed.crop.extent.area()) * 4);
    for (const bool held : {false, true}) {
      feed.held = held;
      const Status status = run_feed(stage_, feed, methods, [&](const FrontFrame& frame) -> Status {
        if (frame.index < 0) return {};
        if (Status read = stage_.device().download(frame.resolved, feed.crop.extent, rgba.data()); !read.ok())
          return read;
        const auto picture = tools::measured(feed.crop.extent, rgba, stage_.exposure());
        const auto& truth =
            held ? reference_.held.front() : reference_.moving[static_cast<std::size_t>(frame.index)];
        const tools::PictureScores scores = tools::measure(picture, truth);
        Measured& measured = held ? cells[frame.method].held : cells[frame.method].moving;
        measured.flip.push_back(scores.flip);
        measured.psnr.push_back(std::min(scores.psnr_tone_mapped, FrontPoint::kHighestPsnr));
        if (!held && frame.report.content) {
          const SceneMix mix = mix_of(*frame.report.content);
          still_share_ = std::min(mix.share[static_cast<std::size_t>(SceneClass::kStill)], kMostStill);
        }
        return {};
      });
      if (!status.ok()) return status;
    }
    return {};
  }

  Status time(double scale, std::span<const std::string> methods, std::span<Cell> cells) {
    FrontFeed feed = feed_;
    feed.crop = PictureCrop::middle_of(settings_.output, settings_.output);
    feed.scale = static_cast<float>(scale);
    feed.warm_up = kTimedWarmUp;
    feed.frames = kTimedFrames;
    return run_feed(stage_, feed, methods, [&](const FrontFrame& frame) -> Status {
      if (frame.index < 0) return {};
      const double ms = pass_times(frame.report).method_ms;
      if (!(ms > 0))
        return Status::unsupported(fmt::format("'{}' gives no times", stage_.device().info().name));
      cells[frame.method].ms.push_back(ms / (static_cast<double>(settings_.output.area()) * 1e-6));
      return {};
    });
  }

  void add_points(double scale, const FrontMethod& method, const Cell& cell) {
    for (std::size_t i = 0; i < kSceneClasses; ++i) {
      const auto scene_class = static_cast<SceneClass>(i);
      points_.push_back(scene_class == SceneClass::kStill ? held_point(cell) : moving_point(cell));
      points_.back().scene_class = scene_class;
      points_.back().method = method;
      points_.back().scale = scale;
      points_.back().ms_per_megapixel = *std::min_element(cell.ms.begin(), cell.ms.end());
      points_.back().ms_spread = deviation_of(cell.ms);
    }
  }

  static FrontPoint held_point(const Cell& cell) {
    return {.flip = mean_of(cell.held.flip),
            .flip_spread = deviation_of(cell.held.flip),
            .psnr_db = mean_of(cell.held.psnr),
            .psnr_spread = deviation_of(cell.held.psnr)};
  }

  FrontPoint moving_point(const Cell& cell) const {
    const double squared = error_of_moving(squared_error(mean_of(cell.moving.psnr)),
                                           squared_error(mean_of(cell.held.psnr)), still_share_);
    return {.flip = error_of_moving(mean_of(cell.moving.flip), mean_of(cell.held.flip), still_share_),
            .flip_spread = deviation_of(cell.moving.flip) / (1 - still_share_),
            .psnr_db = std::min(-10 * std::log10(squared), FrontPoint::kHighestPsnr),
            .psnr_spread = deviation_of(cell.moving.psnr) / (1 - still_share_)};
  }

  FrontSource source() const {
    const FrontKey key = front_key(stage_.device().info(), stage_.scene().name);
    return {.device = key.device,
            .driver = key.driver,
            .scene = key.scene,
            .date = settings_.date,
            .command = settings_.command,
            .truth = reference_.what,
            .output = settings_.output};
  }

  FrameSource& stage_;
  const FrontCalibration& settings_;
  FrontFeed feed_;
  FrontReference reference_;
  double still_share_ = 0;  // of the last moment that was measured as the scene goes on
  std::vector<FrontPoint> points_;
};

}  // namespace

Result<ErrorFront> calibrate_front(FrameSource& stage, const FrontCalibration& calibration) {
  return Calibration(stage, calibration).run();
}

double error_of_moving(double whole, double held, double still_share) {
  return std::max((whole - still_share * held) / (1 - still_share), whole / 2);
}

std::string text_of_scene(const ErrorFront& front) {
  std::string text = fmt::format("scale:FLIP against {}, ms at {}x{}", front.source().truth,
                                 front.source().output.width, front.source().output.height);
  const double megapixels = static_cast<double>(front.source().output.area()) * 1e-6;
  const FrontPoint* last = nullptr;
  for (const FrontPoint& point : front.points()) {
    if (point.scene_class != SceneClass::kStill && point.scene_class != SceneClass::kPan) continue;
    const bool same =
        last != nullptr && last->scene_class == point.scene_class && last->method == point.method;
    const char* state = point.scene_class == SceneClass::kStill ? "still" : "moving";
    if (!same) text += fmt::format("\n{:<7} {:<21}", state, name_of(point.method));
    text +=
        fmt::format("  {:.2f}:{:.4f} {:6.2f}", point.scale, point.flip, point.ms_per_megapixel * megapixels);
    last = &point;
  }
  return text + "\n";
}

}  // namespace quincunx::scenes
