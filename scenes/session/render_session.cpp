// SPDX-License-Identifier: MIT
#include "session/render_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <utility>

#include "frames/target_file.h"
#include "render/truth.h"
#include "session/frame_pacing.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/program/clock.h"
#include "tools/program/program.h"

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

using tools::Clock;

constexpr int kContactSheetFrames = 24;

}  // namespace

FrameScores::FrameScores(const RenderOptions& options)
    : options_(options), scored_(all_of(options.frames), !options.report.empty()) {}

Result<std::vector<Vec2>> FrameScores::motion_of(Renderer& renderer, FrameView view) const {
  view.render = options_.output;
  view.jitter = {};
  view.parity.reset();
  const auto targets = gl::RenderTargets::create({.target_extent = options_.output, .reactive = false});
  if (!targets.ok()) return targets.status();
  if (Status status = renderer.draw(*targets, view); !status.ok()) return status;
  const auto pixels = gl::read_targets(*targets, options_.output);
  if (!pixels.ok()) return pixels.status();
  return velocity_of(*pixels);
}

Result<std::vector<float>> FrameScores::truth_at(FrameSource& source, double seconds) const {
  const TruthSettings settings = {.output = options_.output,
                                  .samples = options_.score,
                                  .shutter_seconds = options_.resolve.blur.shutter / options_.fps};
  return render_truth(source.renderer(), settings, seconds);
}

tools::MeasuredPicture FrameScores::measured_truth(std::vector<float> truth, float exposure) const {
  if (options_.resolve.colour == PixelFormat::kRGBA8)
    return {options_.output, tools::display_light(truth, options_.resolve.output.tone_map, exposure)};
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
  // Wrong options are named before a device is opened.
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
  options.pacing.cost = loop_->overlaps() ? FrameCost::kDevice : FrameCost::kSpan;
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
  return open_pacing();
}

Status RenderSession::open_pacing() {
  auto pacing =
      frame_pacing_for(options_.pacing, options_.output, front_ ? front_->front : ErrorFront::built_in());
  if (!pacing.ok()) return pacing.status();
  const bool paced = pacing->has_display();
  resolves_->allow_timing_waits(!paced);
  const FrameCost cost = paced ? options_.pacing.cost : FrameCost::kSpan;
  auto loop = PacedLoop::create(std::move(pacing).value(), cost, pass_timer(source_->device()));
  if (!loop.ok()) return loop.status();
  loop_ = std::move(loop).value();
  if (!options_.pacing.detail_follows) return {};
  auto detail = FrameDetail::create();
  if (!detail.ok()) return detail.status();
  detail_ = detail.value();
  return {};
}

// Before anything is drawn, so that a long run does not end in a wrong name.
Status RenderSession::check_outputs() {
  if (!options_.out.empty()) {
    auto pattern = tools::output_pattern(options_.out);
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
  std::vector<MethodVariant> methods;
  if (front_) methods.assign(front_->front.methods().begin(), front_->front.methods().end());
  auto resolves = MethodResolves::create(*source_, options_.resolve, std::move(methods));
  if (!resolves.ok()) return resolves.status();
  resolves_.emplace(std::move(resolves).value());
  if (!wants_resolved()) return {};
  auto image = source_->device().allocate(options_.output, plan().settings.output.linear);
  if (!image.ok()) return image.status();
  resolved_ = std::move(image).value();
  return {};
}

bool RenderSession::wants_resolved() const {
  return options_.exr_frame >= 0 || scores_ || (pattern_ && !tools::has_8_bits(format_of(*pattern_)));
}

// The view as a controller wants it, where there is one.
FrameView RenderSession::begin_frame(std::int64_t index) {
  if (const auto choice = loop_->choice()) {
    const MethodSampling sampling = sampling_for(*choice);
    source_->sequence().set_sampling(sampling.jitter, sampling.detail);
  }
  choices_.push_back(loop_->choice());
  FrameView view = source_->sequence().at(index);
  if (const auto render = loop_->next()) view = source_->sequence().at(index, *render);
  const auto area = static_cast<double>(view.render.area()) / static_cast<double>(options_.output.area());
  if (detail_) detail_->follow(area, view);
  double blur_px = 0;
  if (options_.pacing.blur_aware) {
    blur_px = camera_streak_px(source_->renderer().camera_motion(view),
                               source_->scene().camera(view.seconds).near_plane, options_.output,
                               options_.resolve.blur.shutter);
  }
  loop_->begin_frame(view.render, blur_px, detail_ ? detail_->level() : 0);
  return view;
}

Status RenderSession::draw(std::int64_t index) {
  loop_->wait();
  const Clock::time_point start = Clock::now();
  const FrameView view = begin_frame(index);
  if (Status status = source_->draw(index, view, index == options_.exr_frame); !status.ok()) return status;
  loop_->end_draw();
  draw_ms_.push_back(tools::ms_since(start));
  return {};
}

Status RenderSession::dispatch() {
  auto inputs = source_->acquire();
  if (!inputs.ok()) return inputs.status();
  auto presented = source_->bridge().begin_present();
  if (!presented.ok()) return presented.status();
  const std::optional<QualityChoice> choice = choices_.front();
  choices_.pop_front();
  // The files hold the picture as it is before the tone map.
  const FrameOutputs outputs{resolved_.view(), presented.value()};
  const FrameReport report = resolves_->dispatch(inputs.value(), source_->focus(), outputs, choice);
  acquire_ms_.push_back(source_->bridge().traffic().acquire_ms);
  bytes_in_.push_back(source_->bytes_in());
  return report.status;
}

Status RenderSession::deliver(std::int64_t index) {
  if (Status status = source_->bridge().present(); !status.ok()) return status;
  loop_->finish_frame();
  present_ms_.push_back(source_->bridge().traffic().present_ms);
  bytes_out_.push_back(source_->bridge().traffic().bytes_out);
  const Clock::time_point start = Clock::now();
  if (stops_clock()) loop_->stop_clock();
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
    loop_->start_clock();
  }
  last_delivery_ = Clock::now();
  source_->release();
  return {};
}

Status RenderSession::score_frame() {
  auto resolved = download_resolved();
  if (!resolved.ok()) return resolved.status();
  const int repeats = loop_->pacing().run().frames.back().missed;
  return scores_->add(*source_, source_->oldest().index, source_->oldest().view, std::move(resolved).value(),
                      repeats);
}

Status RenderSession::write_frame(std::int64_t index) {
  const FrameView& view = source_->oldest().view;
  if (sheet_ && std::binary_search(sheet_frames_.begin(), sheet_frames_.end(), static_cast<int>(index))) {
    const float ratio = static_cast<float>(view.render.width) / static_cast<float>(options_.output.width);
    const tools::ContactSheetCaption caption = {
        fmt::format("frame {:04}", index),
        fmt::format("{:.2f} · {}×{}", ratio, view.render.width, view.render.height), std::min(ratio, 1.0f)};
    if (Status status = sheet_->add(options_.output, source_->bridge().presented_pixels(), caption);
        !status.ok())
      return status;
  }
  if (!pattern_) return {};
  const std::string path = pattern_->expand(index);
  if (index == 0 || index + 1 == options_.frames) files_.push_back(path);
  const Extent output = options_.output;
  if (tools::has_8_bits(format_of(*pattern_))) {
    const std::uint8_t* const pixels = source_->bridge().presented_pixels();
    std::vector<std::uint8_t> copy(pixels, pixels + output.area() * 4);
    return writer_.push(
        [path, output, copy = std::move(copy)] { return tools::write_picture(path, output, copy.data()); });
  }
  auto resolved = download_resolved();
  if (!resolved.ok()) return resolved.status();
  note_clipping(index, path, resolved.value());
  // Colour of 8 bits is the screen's light already.
  const bool shown = options_.resolve.colour == PixelFormat::kRGBA8;
  const tools::Display display = {shown ? ToneMap::kClamp : options_.resolve.output.tone_map,
                                  shown ? 1 : source_->exposure()};
  return writer_.push([path, output, display, rgba = std::move(resolved).value()] {
    return tools::write_light(path, output, rgba, tools::ChannelType::kHalf, display);
  });
}

Status RenderSession::write_exr_frame(std::int64_t index) {
  const TargetFile file = {.frame = source_->oldest(),
                           .camera = source_->scene().camera(source_->oldest().view.seconds),
                           .output = options_.output,
                           .fps = options_.fps};
  const std::filesystem::path folder = std::filesystem::path(options_.out).parent_path();
  const std::string targets_path = (folder / fmt::format("frame_{:04}_targets.exr", index)).string();
  const std::string resolved_path = (folder / fmt::format("frame_{:04}_resolved.exr", index)).string();
  if (Status status = write_targets(targets_path, file); !status.ok()) return status;
  auto resolved = download_resolved();
  if (!resolved.ok()) return resolved.status();
  note_clipping(index, resolved_path, resolved.value());
  files_.push_back(targets_path);
  files_.push_back(resolved_path);
  return tools::write_light(resolved_path, options_.output, resolved.value());
}

void RenderSession::note_clipping(std::int64_t index, const std::string& path, std::span<const float> rgba) {
  if (has_clipped_ || tools::format_of(path) != tools::FileFormat::kExr || !tools::exceed_halves(rgba))
    return;
  has_clipped_ = true;
  spdlog::warn("frame {} has light above 65504, the largest half, which is written in its place", index);
}

Result<std::vector<float>> RenderSession::download_resolved() const {
  return download_rgba(source_->device(), resolved_.view(), options_.output);
}

Status RenderSession::finish_files() {
  if (Status status = writer_.finish(); !status.ok()) return status;
  return scores_ ? scores_->finish() : Status();
}

void RenderSession::collect_reports() {
  while (auto report = resolves_->next_completed()) {
    loop_->add(*report);
    measured_.add(*report);
  }
}

void RenderSession::begin_contact_sheet() {
  if (options_.contact_sheet.empty()) return;
  sheet_.emplace(tools::ContactSheetSettings{
      .title = fmt::format("Quincunx · {}", source_->scene().name),
      .subtitle = fmt::format("{}×{} · {} · {} · {}", options_.output.width, options_.output.height,
                              name_of(variant_of(options_.resolve)), source_->context().info().renderer,
                              source_->device().info().name)});
  sheet_frames_ = tools::evenly_spaced(static_cast<int>(options_.frames), kContactSheetFrames);
}

// With overlap, GL draws the next frame while OpenCL works on this one.
bool RenderSession::draws_ahead() const {
  if (stops_clock()) return false;
  return options_.overlap && loop_->overlaps() && loop_->ready();
}

bool RenderSession::stops_clock() const {
  return loop_->pacing().has_display() && (scores_ || !loop_->overlaps());
}

bool RenderSession::times_by_waiting() const {
  return !loop_->pacing().has_display() && pass_timer(source_->device()) == PassTimer::kHostClock;
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
