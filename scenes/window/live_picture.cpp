// SPDX-License-Identifier: MIT
#include "window/live_picture.h"

#include <algorithm>

#include "quincunx_gl/gl_calls.h"
#include "render/truth.h"
#include "tools/image/image_io.h"
#include "tools/program/clock.h"

namespace quincunx::scenes {
namespace {

using tools::Clock;

constexpr Extent kLowestExtent = {8, 8};
constexpr std::int64_t kSweepFrames = 240;
constexpr const char* kSweep = "sweep:0.25,1,0.25";
constexpr const char* kRandom = "random:0.25,1";
constexpr int kTruthSamples = 4;  // 4 x 4 a pixel: a compromise, because it is drawn for every frame

void choose_method(ResolveSettings& settings, const std::string& name) {
  apply(parse_variant(name).value(), settings);
}

}  // namespace

Result<std::unique_ptr<LivePicture>> LivePicture::create(const PictureOptions& options) {
  // By fences: the queries belong to those who feed a controller, and cannot be nested.
  auto timer = gl::FrameTimer::create(gl::TimerMethod::kFence);
  if (!timer.ok()) return timer.status();
  auto picture = std::unique_ptr<LivePicture>(new LivePicture(options, std::move(timer).value()));
  picture->options_.platform = gl::Platform::kCurrent;
  picture->options_.frames = 1;          // the number does not matter where no path depends on it
  picture->options_.scale_path.clear();  // the window has modes of its own
  auto sweep = ScalePath::parse(kSweep, options.seed);
  if (!sweep.ok()) return sweep.status();
  auto random = ScalePath::parse(kRandom, options.seed);
  if (!random.ok()) return random.status();
  picture->sweep_ = sweep.value();
  picture->random_ = random.value();
  return picture;
}

PictureOptions LivePicture::options_for(const LookSettings& look, Extent output) const {
  PictureOptions wanted = options_;
  wanted.scene = look.scene;
  wanted.output = output;
  wanted.jitter = look.jitter;
  wanted.resolve.blur.shutter = look.shutter;
  wanted.resolve.blur.samples = look.blur_samples;
  wanted.resolve.output.tone_map = look.tone_map;
  wanted.resolve.output.dither = look.dither;
  wanted.resolve.targets.placement = look.targets;
  wanted.resolve.targets.shading = look.shading;
  wanted.parts.shadow = part_option(look.shadow_scale, options_.parts.shadow.budget_ms);
  const double budget_ms = options_.parts.particles ? options_.parts.particles->budget_ms : 0;
  wanted.parts.particles.reset();
  if (look.particle_scale != kParticlesInFrame)
    wanted.parts.particles = part_option(look.particle_scale, budget_ms);
  // A window may have become too small for a rectangle.
  wanted.focus =
      look.focus.empty() || FocusTarget::parse(look.focus, output).ok() ? look.focus : std::string();
  wanted.dual = look.dual;
  choose_method(wanted.resolve, look.method);
  return wanted;
}

Status LivePicture::configure(const LookSettings& look, const ResolutionSettings& resolution, Extent output) {
  const bool same_look = source_ && look == look_;
  if (same_look && resolution == resolution_ && source_->sequence().output() == output) return {};
  const PictureOptions wanted = options_for(look, output);
  auto settings = source_settings_for(wanted);
  if (!settings.ok()) return settings.status();
  settings->focus.endless = true;
  const float scale = resolution.mode == ResolutionMode::kFixed        ? resolution.scale
                      : resolution.mode == ResolutionMode::kController ? resolution.largest_controlled
                                                                       : 1;
  auto path = ScalePath::fixed({scale, scale});
  if (!path.ok()) return path.status();
  settings->sequence.scale_path = path.value();
  auto sequence = FrameSequence::create(settings->sequence);
  if (!sequence.ok()) return sequence.status();
  sequence_ = sequence.value();
  resolution_ = resolution;
  // Another scale within the same targets needs nothing new.
  if (same_look && source_->sequence().output() == output &&
      source_->sequence().target() == sequence_->target()) {
    return {};
  }
  if (resolves_) {
    if (Status status = resolves_->finish(); !status.ok()) return status;
  }
  if (source_ && look.scene != look_.scene) source_.reset();
  look_ = look;
  if (Status status = open_source(settings.value()); !status.ok()) return status;
  return open_services(wanted.resolve);
}

Status LivePicture::open_source(const FrameSourceSettings& settings) {
  auto source = source_ ? source_->another(settings.sequence, settings.parts, settings.focus)
                        : FrameSource::create(settings);
  if (!source.ok()) return source.status();
  source_ = std::move(source).value();
  return {};
}

Status LivePicture::open_services(const ResolveSettings& wanted) {
  std::vector<MethodVariant> methods;
  front_.reset();
  choice_.reset();
  if (look_.chooses_method) {
    front_ = find_front(front_key(source_->device().info(), source_->scene().name));
    methods.assign(front_->front.methods().begin(), front_->front.methods().end());
  }
  std::vector<ResolveSettings> compared;
  if (look_.compares_methods()) choose_method(compared.emplace_back(wanted), look_.compared);
  auto resolves = MethodResolves::create(*source_, wanted, std::move(methods), std::move(compared));
  if (!resolves.ok()) return resolves.status();
  resolves_.emplace(std::move(resolves).value());
  resolves_->allow_timing_waits(true);  // each picture is waited for anyway
  resolved_ = Image();
  return open_compared(look_.compares_methods() ? resolves_->plans_beside().front() : plan());
}

Status LivePicture::open_compared(const ResolvePlan& plan) {
  other_service_.reset();
  truth_presenter_.reset();
  compared_ = gl::Texture();
  if (look_.compared == kCompareNothing) return {};
  const Device& device = source_->device();
  if (look_.compares_methods()) {
    auto service = ResolveService::create(device, plan);
    if (!service.ok()) return service.status();
    other_service_.emplace(std::move(service).value());
    auto image = device.allocate(output(), PixelFormat::kRGBA8, plan.presented_storage());
    if (!image.ok()) return image.status();
    other_image_ = std::move(image).value();
  } else {
    auto presenter =
        PicturePresenter::create(device, output(), look_.tone_map, look_.dither, source_->exposure());
    if (!presenter.ok()) return presenter.status();
    truth_presenter_.emplace(std::move(presenter).value());
  }
  compared_ = gl::Texture::create();
  gl::texture_storage(compared_.get(), 1, GL_RGBA8, output());
  return {};
}

FrameView LivePicture::view_of(std::int64_t index, Extent chosen,
                               const std::optional<QualityChoice>& choice) {
  if (choice) {
    choice_ = choice;
  } else if (choice_) {
    choice_->fading_from.reset();
    choice_->weight = 1;
  }
  if (choice_) {
    const MethodSampling sampling = sampling_for(*choice_);
    sequence_->set_sampling(sampling.jitter, sampling.detail);
  }
  Vec2 scale;
  switch (resolution_.mode) {
    case ResolutionMode::kFixed:
      return sequence_->at(index);
    case ResolutionMode::kController:
      return sequence_->at(index, chosen);
    case ResolutionMode::kLowest:
      return sequence_->at(index, kLowestExtent);
    case ResolutionMode::kSweep:
      scale = sweep_.at(index % kSweepFrames, kSweepFrames);
      break;
    case ResolutionMode::kRandom:
      scale = random_.at(index, 1);
      break;
  }
  // The rungs of a viewport whose targets are the output's.
  auto viewport = DynamicViewport::create(output());
  if (!viewport.ok() || !viewport->set_scale(scale.x, scale.y).ok()) return sequence_->at(index);
  return sequence_->at(index, viewport->render());
}

Status LivePicture::draw(std::int64_t index, const FrameView& view, Keep keep) {
  const Clock::time_point start = Clock::now();
  keep_ = keep;
  timer_.begin(++timed_, view.render);
  const Status status = source_->begin(index, view, keep == Keep::kForFiles);
  timer_.end();
  if (!status.ok()) return status;
  times_ = FrameTimes();
  times_.cpu_ms = tools::ms_since(start);
  return source_->submit();
}

Status LivePicture::resolve(bool reset) {
  if (Status status = dispatch(reset); !status.ok()) return status;
  const FrameView view = source_->oldest().view;
  if (keep_ == Keep::kForFiles) {
    kept_.emplace(std::move(source_->oldest()));
  } else {
    kept_.reset();
  }
  source_->release();
  collect_times();
  return bring_compared(view);
}

Status LivePicture::dispatch(bool reset) {
  auto inputs = source_->acquire();
  if (!inputs.ok()) return inputs.status();
  inputs->reset |= reset;
  poll_timer();  // now, because the fall-back counts until it is asked
  auto presented = source_->bridge().begin_present();
  if (!presented.ok()) return presented.status();
  if (keep_ == Keep::kForFiles && !resolved_) {
    auto image = source_->device().allocate(output(), plan().settings.output.linear);
    if (!image.ok()) return image.status();
    resolved_ = std::move(image).value();
  }
  const ImageView linear = keep_ == Keep::kForFiles ? resolved_.view() : ImageView();
  const FrameOutputs outputs{linear, presented.value()};
  if (const FrameReport report = resolves_->dispatch(inputs.value(), source_->focus(), outputs, choice_);
      !report.ok())
    return report.status;
  if (other_service_) {
    const FrameReport report = scenes::dispatch(*other_service_, inputs.value(), source_->focus(),
                                                {.presented = other_image_.view()});
    if (!report.ok()) return report.status;
  }
  if (Status status = source_->bridge().present(); !status.ok()) return status;
  return resolves_->finish();
}

// Brings the other side of the split view.
Status LivePicture::bring_compared(const FrameView& view) {
  if (!compared_) return {};
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(output().area()) * 4);
  if (other_service_) {
    if (Status status = source_->device().download(other_image_.view(), output(), pixels.data());
        !status.ok())
      return status;
  } else {
    const double shutter_seconds = look_.shutter * (view.seconds - view.previous_seconds);
    auto truth = render_truth(
        source_->renderer(),
        {.output = output(), .samples = kTruthSamples, .shutter_seconds = shutter_seconds}, view.seconds);
    if (!truth.ok()) return truth.status();
    auto presented = truth_presenter_->present(truth.value());
    if (!presented.ok()) return presented.status();
    pixels = std::move(presented).value();
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl::texture_write(compared_.get(), 0, output(), GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  return {};
}

void LivePicture::poll_timer() {
  while (auto timed = timer_.poll())
    times_.draw_ms = timed->gpu_ms;
}

void LivePicture::collect_times() {
  poll_timer();
  while (auto report = resolves_->next_completed())
    times_.report = *report;
}

Status LivePicture::write(const std::string& base) const {
  if (!kept_) return Status::invalid("no frame was kept for files");
  const Extent size = output();
  const TargetFile file = {.frame = *kept_,
                           .camera = source_->scene().camera(kept_->view.seconds),
                           .output = size,
                           .fps = options_.fps};
  if (Status status = write_targets(base + "_targets.exr", file); !status.ok()) return status;
  const auto rgba = download_rgba(source_->device(), resolved_.view(), size);
  return rgba.ok() ? tools::write_light(base + "_resolved.exr", size, rgba.value()) : rgba.status();
}

}  // namespace quincunx::scenes
