// SPDX-License-Identifier: MIT
#include "session/calibration.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "frames/method_resolves.h"
#include "quincunx/control/front_file.h"
#include "quincunx/resolve_service.h"
#include "session/paced_loop.h"
#include "tools/page/scored_frames.h"
#include "tools/program/atomic_file.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

constexpr int kRungs = 9;
constexpr int kSettling = 2;  // frames at a new resolution before those that count
constexpr int kCounted = 5;
constexpr int kFramesPerRung = kSettling + kCounted;

// Equal steps of area from the lowest rung to the highest, and no rung twice.
std::vector<Extent> test_points(const ResolutionLadder& ladder) {
  const double low = ladder.area_fraction(0);
  const double step = (ladder.area_fraction(ladder.top()) - low) / (kRungs - 1);
  std::vector<Extent> points;
  for (int i = 0; i < kRungs; ++i) {
    const Extent extent = ladder[ladder.max_rung_within(low + i * step)];
    if (points.empty() || points.back() != extent) points.push_back(extent);
  }
  return points;
}

class CostRun {
 public:
  static Result<CostRun> create(const RenderOptions& options, const ResolutionLadder& ladder);

  Status measure(const ResolutionLadder& ladder, bool quiet);
  Result<CostTable> table(const ResolutionLadder& ladder) const;

 private:
  CostRun(std::unique_ptr<FrameSource> source, ResolveService service, PacedLoop loop)
      : source_(std::move(source)), service_(std::move(service)), loop_(std::move(loop)) {}
  Status draw(std::int64_t index, Extent render);
  void take_reports();

  std::unique_ptr<FrameSource> source_;
  ResolveService service_;
  PacedLoop loop_;
};

Result<CostRun> CostRun::create(const RenderOptions& options, const ResolutionLadder& ladder) {
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  auto source = FrameSource::create(settings.value());
  if (!source.ok()) return source.status();
  auto plan = source.value()->connect(options.resolve);
  if (!plan.ok()) return plan.status();
  auto service = ResolveService::create(source.value()->device(), plan.value());
  if (!service.ok()) return service.status();
  auto loop = PacedLoop::create(FramePacing::free_running(ladder.output()), options.pacing.cost,
                                pass_timer(source.value()->device()));
  if (!loop.ok()) return loop.status();
  return CostRun(std::move(source).value(), std::move(service).value(), std::move(loop).value());
}

// Two moments in turn, one frame apart: still, but for what is drawn anew in every frame because it moves.
Status CostRun::draw(std::int64_t index, Extent render) {
  const FrameView view = source_->sequence().at(index % 2, render);
  loop_.begin_frame(render);
  if (Status status = source_->draw(index, view); !status.ok()) return status;
  loop_.end_draw();
  auto inputs = source_->acquire();
  if (!inputs.ok()) return inputs.status();
  auto presented = source_->bridge().begin_present();
  if (!presented.ok()) return presented.status();
  const FrameReport report =
      dispatch(service_, inputs.value(), source_->focus(), {.presented = presented.value()});
  if (!report.ok()) return report.status;
  if (Status status = source_->bridge().present(); !status.ok()) return status;
  loop_.finish_frame();
  source_->release();
  take_reports();
  return {};
}

void CostRun::take_reports() {
  while (auto report = service_.next_completed())
    loop_.add(*report);
}

Status CostRun::measure(const ResolutionLadder& ladder, bool quiet) {
  using Show = tools::Progress::Show;
  const std::vector<Extent> points = test_points(ladder);
  const auto frames = static_cast<std::int64_t>(points.size()) * kFramesPerRung;
  tools::Progress progress("calibrating", frames, quiet ? Show::kNever : Show::kOnTerminal);
  for (std::int64_t index = 0; index < frames; ++index) {
    const Extent render = points[static_cast<std::size_t>(index / kFramesPerRung)];
    if (Status status = draw(index, render); !status.ok()) return status;
    progress.update(index + 1, fmt::format("{}x{}", render.width, render.height));
  }
  if (Status status = service_.finish(); !status.ok()) return status;
  take_reports();
  return {};
}

Result<CostTable> CostRun::table(const ResolutionLadder& ladder) const {
  auto table = CostTable::create();
  if (!table.ok()) return table;
  for (const tools::PacedFrame& frame : loop_.run().frames) {
    if (frame.index % kFramesPerRung < kSettling) continue;
    const Status status = table->record(static_cast<std::uint64_t>(frame.index),
                                        ladder.area_fraction(frame.render), frame.busy_ms);
    if (!status.ok()) return status;
  }
  return table;
}

void print(const CostTable& table, const std::vector<Extent>& points, const ResolutionLadder& ladder) {
  for (const Extent& point : points) {
    const double area = ladder.area_fraction(point);
    fmt::print("{:>5}x{:<5} {:.3f} of the pixels {:8.2f} ms\n", point.width, point.height, area,
               table.predict(area).value_or(0));
  }
  if (const auto fixed = table.fixed_part()) {
    fmt::print("{:.0f} % of the cost at the output's resolution do not follow the resolution\n",
               100 * *fixed);
  }
}

Status calibrate_costs(const RenderOptions& options) {
  auto ladder = ResolutionLadder::create(ladder_for(options.pacing, options.output));
  if (!ladder.ok()) return ladder.status();
  auto calibration = CostRun::create(options, ladder.value());
  if (!calibration.ok()) return calibration.status();
  if (Status status = calibration->measure(ladder.value(), options.quiet); !status.ok()) return status;
  auto table = calibration->table(ladder.value());
  if (!table.ok()) return table.status();
  if (Status status = tools::write_text(options.pacing.calibrate, table->to_json()); !status.ok())
    return status;
  if (!options.quiet) print(table.value(), test_points(ladder.value()), ladder.value());
  return {};
}

std::vector<double> front_scales(const PacingOptions& pacing) {
  const double high = std::min(pacing.max_scale, 1.0);
  const double low = std::min(pacing.min_scale, high);
  if (low == high) return {high};
  return {low, (low + high) / 2, high};
}

Status calibrate_methods(const RenderOptions& options) {
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  auto stage = FrameSource::create(settings.value());
  if (!stage.ok()) return stage.status();
  const auto front = calibrate_front(*stage.value(), {.output = options.output,
                                                      .scales = front_scales(options.pacing),
                                                      .fps = options.fps,
                                                      .seconds = options.start,
                                                      .truth_seconds = options.pacing.truth_seconds,
                                                      .command = options.command_line,
                                                      .date = tools::date_now()});
  if (!front.ok()) return front.status();
  const auto path = front_path(front_key(stage.value()->device().info(), stage.value()->scene().name));
  if (!path) {
    spdlog::warn("what methods err and cost is not kept: QUINCUNX_CACHE_DIR is empty");
  } else if (Status status = tools::write_text(path->string(), front->to_json()); !status.ok()) {
    return status;
  }
  if (!options.quiet)
    fmt::print("\n{}{}", text_of_scene(front.value()), path ? "kept in " + path->string() + "\n" : "");
  return {};
}

}  // namespace

Status run_calibration(const RenderOptions& options) {
  if (Status status = tools::ScoredFrames::check(options.output, "--calibrate"); !status.ok()) return status;
  if (Status status = calibrate_costs(options); !status.ok()) return status;
  return calibrate_methods(options);
}

}  // namespace quincunx::scenes
