// SPDX-License-Identifier: MIT
#include "programs/render_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "programs/camera_streak.h"
#include "programs/target_file.h"
#include "tools/image/image_io.h"
#include "tools/program/clock.h"
#include "tools/program/method_names.h"
#include "tools/program/progress.h"

namespace quincunx::scenes {
namespace {

using tools::Clock;

constexpr int kContactSheetFrames = 24;

}  // namespace

RenderSession::RenderSession(const RenderOptions& options) : options_(options) {}
RenderSession::~RenderSession() = default;

Result<std::unique_ptr<RenderSession>> RenderSession::create(const RenderOptions& options) {
  auto session = std::unique_ptr<RenderSession>(new RenderSession(options));
  if (Status status = session->check_outputs(); !status.ok()) return status;
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  if (options.focus == kFocusPointer)
    return Status::invalid(
        "--focus pointer is for a window; give it with --window, or an object or a rectangle");
  // What can be said against the options is said before a device is opened.
  if (const auto pacing = frame_pacing_for(options.pacing, options.output); !pacing.ok())
    return pacing.status();
  auto source = FrameSource::create(settings.value());
  if (!source.ok()) return source.status();
  if (Status status = session->open(std::move(source).value()); !status.ok()) return status;
  return session;
}

Result<std::unique_ptr<RenderSession>> RenderSession::at_fixed_scale(float scale) const {
  RenderOptions options = options_;
  options.pacing.controller = ControllerKind::kFixed;
  options.pacing.detail_follows = false;
  // Measured alike, or the times could not be compared.
  options.pacing.cost = paced_->overlaps() ? FrameCost::kDevice : FrameCost::kSpan;
  options.scale = fmt::format("{}", scale);
  options.scale_path.clear();
  options.out.clear();
  options.contact_sheet.clear();
  options.exr_frame = -1;
  options.score = 0;
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  auto source = source_->another(settings.value().sequence);
  if (!source.ok()) return source.status();
  auto session = std::unique_ptr<RenderSession>(new RenderSession(options));
  if (Status status = session->open(std::move(source).value()); !status.ok()) return status;
  return session;
}

Status RenderSession::open(std::unique_ptr<FrameSource> source) {
  source_ = std::move(source);
  if (options_.pacing.chooses_method())
    front_ = find_front(front_key(source_->device().info(), source_->scene().name));
  if (Status status = open_resolves(); !status.ok()) return status;
  resolves_->allow_timing_waits(!options_.pacing.on());
  return options_.pacing.on() ? open_pacing() : Status();
}

Status RenderSession::open_pacing() {
  auto pacing =
      frame_pacing_for(options_.pacing, options_.output, front_ ? front_->front : ErrorFront::built_in());
  if (!pacing.ok()) return pacing.status();
  auto paced =
      PacedLoop::create(*std::move(pacing).value(), options_.pacing.cost, pass_timer(source_->device()));
  if (!paced.ok()) return paced.status();
  paced_ = std::move(paced).value();
  if (!options_.pacing.detail_follows) return {};
  auto detail = FrameDetail::create();
  if (!detail.ok()) return detail.status();
  detail_ = detail.value();
  return {};
}

// Before anything is drawn, so that a long run does not end in a wrong name.
Status RenderSession::check_outputs() {
  if (!options_.out.empty()) {
    auto pattern = tools::FramePattern::parse(options_.out);
    if (!pattern.ok()) return pattern.status();
    if (Status status = pattern->check_count(options_.frames); !status.ok()) return status;
    pattern_ = pattern.value();
  }
  if (options_.exr_frame >= options_.frames) {
    return Status::invalid(fmt::format("--exr-frame {} is not drawn; there are frames 0 to {}",
                                       options_.exr_frame, options_.frames - 1));
  }
  if (options_.exr_frame >= 0 && !pattern_) {
    return Status::invalid("--exr-frame needs --out, beside which its files are written");
  }
  if (options_.score > 0) {
    if (Status status = tools::ScoredFrames::check(options_.output, "--score"); !status.ok()) return status;
    scores_.emplace(options_);
  }
  return {};
}

Status RenderSession::open_resolves() {
  std::vector<FrontMethod> methods;
  if (front_) methods.assign(front_->front.methods().begin(), front_->front.methods().end());
  auto resolves = MethodResolves::create(*source_, options_.resolve, std::move(methods));
  if (!resolves.ok()) return resolves.status();
  resolves_.emplace(std::move(resolves).value());
  if (!wants_resolved()) return {};
  auto image = source_->device().allocate(options_.output, plan().settings.resolved);
  if (!image.ok()) return image.status();
  resolved_ = std::move(image).value();
  return {};
}

bool RenderSession::wants_resolved() const {
  return options_.exr_frame >= 0 || scores_ || (pattern_ && pattern_->format() == tools::FileFormat::kExr);
}

// The view as the controller wants it.
FrameView RenderSession::begin_paced(std::int64_t index) {
  if (const auto choice = paced_->choice()) {
    const MethodSampling sampling = sampling_for(*choice);
    source_->sequence().set_sampling(sampling.jitter, sampling.detail);
  }
  choices_.push_back(paced_->choice());
  FrameView view = source_->sequence().at(index);
  if (const auto render = paced_->next()) view = source_->sequence().at(index, *render);
  const auto area = static_cast<double>(view.render.area()) / static_cast<double>(options_.output.area());
  if (detail_) detail_->follow(area, view);
  double blur_px = 0;
  if (options_.pacing.blur_aware) {
    blur_px = camera_streak_px(source_->renderer().camera_motion(view),
                               source_->scene().camera(view.seconds).near_plane, options_.output,
                               options_.resolve.blur.shutter);
  }
  paced_->begin_frame(view.render, blur_px, detail_ ? detail_->level() : 0);
  return view;
}

Status RenderSession::draw(std::int64_t index) {
  if (paced_) paced_->wait();
  const Clock::time_point start = Clock::now();
  const FrameView view = paced_ ? begin_paced(index) : source_->sequence().at(index);
  if (Status status = source_->draw(index, view, index == options_.exr_frame); !status.ok()) return status;
  if (paced_) paced_->end_draw();
  draw_ms_.push_back(tools::ms_since(start));
  return {};
}

Status RenderSession::dispatch() {
  auto inputs = source_->acquire();
  if (!inputs.ok()) return inputs.status();
  auto presented = source_->bridge().begin_present();
  if (!presented.ok()) return presented.status();
  std::optional<QualityChoice> choice;
  if (paced_) {
    choice = choices_.front();
    choices_.pop_front();
  }
  // The files hold the picture as it is before the tone map.
  const FrameOutputs outputs = outputs_for(plan(), resolved_.view(), presented.value());
  const FrameReport report = resolves_->dispatch(*source_, inputs.value(), outputs, choice);
  acquire_ms_.push_back(source_->bridge().traffic().acquire_ms);
  bytes_in_.push_back(source_->bytes_in());
  return report.status;
}

Status RenderSession::deliver(std::int64_t index) {
  if (Status status = source_->bridge().present(); !status.ok()) return status;
  if (paced_) paced_->finish_frame();
  present_ms_.push_back(source_->bridge().traffic().present_ms);
  bytes_out_.push_back(source_->bridge().traffic().bytes_out);
  const Clock::time_point start = Clock::now();
  if (stops_clock()) paced_->stop_clock();
  if (Status status = write_frame(index); !status.ok()) return status;
  if (index == options_.exr_frame) {
    if (Status status = write_exr_frame(index); !status.ok()) return status;
  }
  write_ms_.push_back(tools::ms_since(start));
  const DrawnFrame& frame = source_->oldest();
  rows_.push_back({.index = index,
                   .seconds = frame.view.seconds,
                   .render = frame.view.render,
                   .jitter = frame.view.jitter,
                   .frame_ms = tools::ms_since(last_delivery_)});
  if (scores_) {
    if (Status status = score_frame(); !status.ok()) return status;
  }
  if (stops_clock()) {
    if (Status status = finish_files(); !status.ok()) return status;
    paced_->start_clock();
  }
  last_delivery_ = Clock::now();
  source_->release();
  return {};
}

Status RenderSession::score_frame() {
  auto resolved = download_resolved();
  if (!resolved.ok()) return resolved.status();
  const int repeats = paced_ ? paced_->pacing().run().frames.back().missed : 0;
  return scores_->add(*source_, source_->oldest().index, source_->oldest().view, std::move(resolved).value(),
                      repeats);
}

Status RenderSession::write_frame(std::int64_t index) {
  const std::uint8_t* pixels = source_->bridge().presented_pixels();
  const FrameView& view = source_->oldest().view;
  if (sheet_ && std::binary_search(sheet_frames_.begin(), sheet_frames_.end(), static_cast<int>(index))) {
    const float ratio = static_cast<float>(view.render.width) / static_cast<float>(options_.output.width);
    const tools::ContactSheetCaption caption = {
        fmt::format("frame {:04}", index),
        fmt::format("{:.2f} · {}×{}", ratio, view.render.width, view.render.height), std::min(ratio, 1.0f)};
    if (Status status = sheet_->add(options_.output, pixels, caption); !status.ok()) return status;
  }
  if (!pattern_) return {};
  const std::string path = pattern_->expand(index);
  if (index == 0 || index + 1 == options_.frames) files_.push_back(path);
  const Extent output = options_.output;
  if (pattern_->format() == tools::FileFormat::kPng) {
    std::vector<std::uint8_t> copy(pixels, pixels + output.area() * 4);
    return writer_.push(
        [path, output, copy = std::move(copy)] { return tools::write_png(path, output, copy.data()); });
  }
  auto resolved = download_resolved();
  if (!resolved.ok()) return resolved.status();
  return writer_.push(
      [path, output, rgba = std::move(resolved).value()] { return write_rgba(path, output, rgba); });
}

Status RenderSession::write_exr_frame(std::int64_t index) {
  DrawnFrame& frame = source_->oldest();
  const FrameView& view = frame.view;
  const TargetFile file = {.pixels = std::move(frame.targets),
                           .view = view,
                           .camera = source_->scene().camera(view.seconds),
                           .output = options_.output,
                           .index = index,
                           .reset = frame.reset,
                           .fps = options_.fps};
  const std::filesystem::path folder = std::filesystem::path(options_.out).parent_path();
  const std::string targets_path = (folder / fmt::format("frame_{:04}_targets.exr", index)).string();
  const std::string resolved_path = (folder / fmt::format("frame_{:04}_resolved.exr", index)).string();
  if (Status status = write_targets(targets_path, file); !status.ok()) return status;
  auto resolved = download_resolved();
  if (!resolved.ok()) return resolved.status();
  files_.push_back(targets_path);
  files_.push_back(resolved_path);
  return write_rgba(resolved_path, options_.output, resolved.value());
}

Result<std::vector<float>> RenderSession::download_resolved() const {
  std::vector<float> rgba(static_cast<std::size_t>(options_.output.area()) * 4);
  if (Status status = source_->device().download(resolved_.view(), options_.output, rgba.data());
      !status.ok())
    return status;
  return rgba;
}

Status RenderSession::finish_files() {
  if (Status status = writer_.finish(); !status.ok()) return status;
  return scores_ ? scores_->finish() : Status();
}

void RenderSession::collect_reports() {
  while (auto report = resolves_->next_completed()) {
    if (paced_) paced_->add(*report);
    reports_.push_back(*report);
  }
}

void RenderSession::begin_contact_sheet() {
  if (options_.contact_sheet.empty()) return;
  sheet_.emplace(tools::ContactSheetSettings{
      .title = fmt::format("Quincunx · {}", source_->scene().name),
      .subtitle = fmt::format("{}×{} · {} · {} · {}", options_.output.width, options_.output.height,
                              tools::method_name(options_.resolve), source_->context().info().renderer,
                              source_->device().info().name)});
  sheet_frames_ = tools::evenly_spaced(static_cast<int>(options_.frames), kContactSheetFrames);
}

// With overlap, GL draws the next frame while OpenCL works on this one.
bool RenderSession::draws_ahead() const {
  if (stops_clock()) return false;
  return options_.overlap && (!paced_ || (paced_->overlaps() && paced_->ready()));
}

bool RenderSession::stops_clock() const {
  return paced_ && (scores_ || !paced_->overlaps());
}

bool RenderSession::times_by_waiting() const {
  return !paced_ && pass_timer(source_->device()) == PassTimer::kHostClock;
}

Status RenderSession::run_frame(std::int64_t index) {
  const bool draw_next = index + 1 < options_.frames;
  if (Status status = dispatch(); !status.ok()) return status;
  const bool draw_now = draw_next && draws_ahead();
  if (draw_now) {
    if (Status status = draw(index + 1); !status.ok()) return status;
  }
  if (Status status = deliver(index); !status.ok()) return status;
  collect_reports();
  if (draw_next && !draw_now) {
    if (Status status = draw(index + 1); !status.ok()) return status;
  }
  return {};
}

Status RenderSession::run() {
  using Show = tools::Progress::Show;
  const Clock::time_point start = Clock::now();
  begin_contact_sheet();
  {
    tools::Progress progress("rendering", options_.frames, options_.quiet ? Show::kNever : Show::kOnTerminal);
    last_delivery_ = start;
    if (Status status = draw(0); !status.ok()) return status;
    for (std::int64_t index = 0; index < options_.frames; ++index) {
      if (Status status = run_frame(index); !status.ok()) return status;
      progress.update(index + 1, fmt::format("{}x{}", rows_.back().render.width, rows_.back().render.height));
    }
  }
  if (Status status = resolves_->finish(); !status.ok()) return status;
  collect_reports();
  if (Status status = finish_files(); !status.ok()) return status;
  if (sheet_) {
    if (Status status = sheet_->write(options_.contact_sheet); !status.ok()) return status;
    files_.push_back(options_.contact_sheet);
  }
  wall_seconds_ = tools::ms_since(start) / 1000;
  return {};
}

}  // namespace quincunx::scenes
