// SPDX-License-Identifier: MIT
// The error front of one scene: feeds of frames, truth to hold them against, and the points made of both.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "frames/picture_options.h"
#include "frames/target_file.h"
#include "quincunx/control/front_file.h"
#include "render/truth.h"
#include "session/calibration.h"
#include "session/paced_loop.h"
#include "tools/program/clock.h"

namespace quincunx::scenes {
namespace {

std::vector<ResolveSettings> resolves_of(std::span<const MethodVariant> methods) {
  std::vector<ResolveSettings> resolves;
  for (const MethodVariant& variant : methods) {
    apply(variant, resolves.emplace_back());
    resolves.back().output.present = false;
    resolves.back().control.measures_content = true;
  }
  return resolves;
}

Result<SequenceSettings> sequence_of(const FrontFeed& feed, Method method) {
  const auto path = ScalePath::fixed({feed.scale, feed.scale});
  if (!path.ok()) return path.status();
  SequenceSettings sequence;
  sequence.output = feed.crop.extent;
  sequence.scale_path = path.value();
  sequence.jitter = jitter_for(method);
  sequence.frames = feed.warm_up + feed.frames;
  sequence.fps = feed.fps;
  sequence.start_seconds = feed.seconds - feed.warm_up / feed.fps;
  sequence.detail = texture_detail_for(method, sequence.jitter);
  return sequence;
}

FrameView view_of(FrameSource& source, const FrontFeed& feed, int index) {
  FrameView view = source.sequence().at(index);
  view.window = view.previous_window = feed.crop.window;
  view.aspect = feed.crop.aspect;
  if (feed.held) view.seconds = view.previous_seconds = feed.seconds;
  return view;
}

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

Status add_best(FrameSource& stage, FrontFeed feed, const MethodVariant& best, FrontReference& reference) {
  feed.scale = 1;
  feed.warm_up = kWarmUpFrames;
  for (const bool held : {false, true}) {
    feed.held = held;
    const Status status = run_feed(stage, feed, {&best, 1}, [&](const FrontFrame& frame) -> Status {
      if (frame.index < 0 || (held && frame.index + 1 < feed.frames)) return {};
      auto rgba = download_rgba(stage.device(), frame.resolved, feed.crop.extent);
      auto& pictures = held ? reference.held : reference.moving;
      if (rgba.ok())
        pictures.push_back(tools::measured(feed.crop.extent, std::move(rgba).value(), stage.exposure()));
      return rgba.status();
    });
    if (!status.ok()) return status;
  }
  return {};
}

constexpr Extent kMostCrop = {320, 180};
constexpr int kMeasuredFrames = 2;
constexpr int kTimedFrames = 4;
constexpr int kTimedWarmUp = 2;
constexpr double kMostStill = 0.8;  // share of the picture: moving parts are to be measured, too

// The figures of one method at one scale.
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

class FrontRun {
 public:
  FrontRun(FrameSource& stage, const FrontCalibration& settings) : stage_(stage), settings_(settings) {}

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
    const auto variants = front_variants();
    std::vector<Cell> cells(variants.size());
    const auto jitter_of = [&](std::size_t i) { return jitter_for(variants[i].method); };
    for (std::size_t first = 0, last = 0; first < variants.size(); first = last) {
      while (last < variants.size() && jitter_of(last) == jitter_of(first))
        ++last;
      const auto methods = variants.subspan(first, last - first);
      const std::span<Cell> of_feed(&cells[first], last - first);
      if (Status status = measure(scale, methods, of_feed); !status.ok()) return status;
      if (Status status = time(scale, methods, of_feed); !status.ok()) return status;
    }
    for (std::size_t i = 0; i < variants.size(); ++i)
      add_points(scale, variants[i], cells[i]);
    return {};
  }

  Status measure(double scale, std::span<const MethodVariant> methods, std::span<Cell> cells) {
    FrontFeed feed = feed_;
    feed.scale = static_cast<float>(scale);
    const bool accumulates = methods.front().method == Method::kTemporal;
    feed.warm_up = accumulates ? kWarmUpFrames : 1;
    for (const bool held : {false, true}) {
      feed.held = held;
      const Status status = run_feed(stage_, feed, methods, [&](const FrontFrame& frame) -> Status {
        if (frame.index < 0) return {};
        auto rgba = download_rgba(stage_.device(), frame.resolved, feed.crop.extent);
        if (!rgba.ok()) return rgba.status();
        const auto picture = tools::measured(feed.crop.extent, std::move(rgba).value(), stage_.exposure());
        const auto& truth =
            held ? reference_.held.front() : reference_.moving[static_cast<std::size_t>(frame.index)];
        const tools::PictureScores scores = tools::measure(picture, truth);
        Measured& measured = held ? cells[frame.method].held : cells[frame.method].moving;
        measured.flip.push_back(scores.flip);
        measured.psnr.push_back(std::min(scores.psnr_tone_mapped, FrontPoint::kMaxPsnr));
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

  Status time(double scale, std::span<const MethodVariant> methods, std::span<Cell> cells) {
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

  void add_points(double scale, const MethodVariant& method, const Cell& cell) {
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
            .psnr_db = std::min(-10 * std::log10(squared), FrontPoint::kMaxPsnr),
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
            .output_extent = settings_.output};
  }

  FrameSource& stage_;
  const FrontCalibration& settings_;
  FrontFeed feed_;
  FrontReference reference_;
  double still_share_ = 0;  // still pixels of the last moment that was measured as the scene goes on
  std::vector<FrontPoint> points_;
};

}  // namespace

PictureCrop PictureCrop::middle_of(Extent output, Extent most) {
  const Extent extent = {std::min(output.width, most.width), std::min(output.height, most.height)};
  const glm::dvec2 picture(output.width, output.height);
  const glm::dvec2 corner((output.width - extent.width) / 2, (output.height - extent.height) / 2);
  return {.extent = extent,
          .window = {corner / picture, glm::dvec2(extent.width, extent.height) / picture},
          .aspect = static_cast<float>(output.width) / static_cast<float>(output.height)};
}

Status run_feed(const FrameSource& stage, const FrontFeed& feed, std::span<const MethodVariant> methods,
                const std::function<Status(const FrontFrame&)>& each) {
  const std::vector<ResolveSettings> resolves = resolves_of(methods);
  const auto sequence = sequence_of(feed, resolves.front().method);
  if (!sequence.ok()) return sequence.status();
  auto source = stage.another(sequence.value(), PartsSettings(), FocusOptions());
  if (!source.ok()) return source.status();
  const auto plans = source.value()->connect_all(resolves);
  if (!plans.ok()) return plans.status();
  auto resolved = stage.device().allocate(feed.crop.extent, ResolveSettings{}.output.linear);
  if (!resolved.ok()) return resolved.status();
  std::vector<ResolveService> services;
  for (const ResolvePlan& plan : plans.value()) {
    auto service = ResolveService::create(stage.device(), plan);
    if (!service.ok()) return service.status();
    services.push_back(std::move(service).value());
    services.back().allow_timing_waits(true);
  }
  for (int index = 0; index < feed.warm_up + feed.frames; ++index) {
    const FrameView view = view_of(*source.value(), feed, index);
    if (Status status = source.value()->draw(index, view); !status.ok()) return status;
    const auto inputs = source.value()->acquire();
    if (!inputs.ok()) return inputs.status();
    for (std::size_t i = 0; i < services.size(); ++i) {
      const FrameReport accepted = services[i].dispatch(inputs.value(), {.linear = resolved->view()});
      if (!accepted.ok()) return accepted.status;
      if (Status status = services[i].finish(); !status.ok()) return status;
      const auto report = services[i].next_completed();
      if (!report) return Status::device("a finished frame has no report");
      const Status status = each({i, index - feed.warm_up, *report, resolved->view()});
      if (!status.ok()) return status;
    }
    source.value()->release();
  }
  return {};
}

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
  const MethodVariant best = front_variants().back();
  const std::string where =
      fmt::format("of {}x{} pixels in the middle", feed.crop.extent.width, feed.crop.extent.height);
  reference.what = samples > 0
                       ? fmt::format("{} samples a pixel {}", samples * samples, where)
                       : fmt::format("{} at scale 1 {}, as truth takes too long", name_of(best), where);
  const Status status =
      samples > 0 ? add_truth(stage, feed, samples, reference) : add_best(stage, feed, best, reference);
  if (!status.ok()) return status;
  return reference;
}

std::span<const MethodVariant> front_variants() {
  using Form = TwoFrameForm;
  using Preset = TemporalPreset;
  static constexpr MethodVariant kVariants[] = {
      {.method = Method::kBilinear},
      {.method = Method::kCatmullRom},
      {.method = Method::kQuincunx, .form = Form::kVelocity},
      {.method = Method::kQuincunx, .form = Form::kReprojected},
      {.method = Method::kTemporal, .preset = Preset::kFast},
      {.method = Method::kTemporal, .preset = Preset::kBalanced},
      {.method = Method::kTemporal, .preset = Preset::kQuality},
  };
  return kVariants;
}

Result<ErrorFront> calibrate_front(FrameSource& stage, const FrontCalibration& calibration) {
  return FrontRun(stage, calibration).run();
}

double error_of_moving(double whole, double held, double still_share) {
  return std::max((whole - still_share * held) / (1 - still_share), whole / 2);
}

std::string text_of_scene(const ErrorFront& front) {
  std::string text = fmt::format("scale:FLIP against {}, ms at {}x{}", front.source().truth,
                                 front.source().output_extent.width, front.source().output_extent.height);
  const double megapixels = static_cast<double>(front.source().output_extent.area()) * 1e-6;
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
