// SPDX-License-Identifier: MIT
#include "window/window_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "catalog/scene_catalog.h"
#include "tools/image/image_io.h"
#include "tools/program/clock.h"
#include "window/key_bindings.h"

namespace quincunx::scenes {
namespace {

using tools::Clock;

constexpr double kMinimisedSeconds = 0.02;  // how long a turn waits while there is nothing to show
constexpr double kFrozenSeconds = 0.01;
constexpr double kMessageSeconds = 4;
constexpr std::size_t kWarmUp = 32;  // frames before a frozen one, for methods that accumulate

// Frames that the picture of one depends on, at most.
std::int64_t frames_before(const LookSettings& look) {
  const Method method = parse_variant(look.method)->method;
  const bool compared = look.compares_methods();
  const Method other = compared ? parse_variant(look.compared)->method : method;
  const Method most = std::max(method, other);
  if (most == Method::kTemporal || look.chooses_method) return static_cast<std::int64_t>(kWarmUp);
  return most == Method::kQuincunx || look.shading == Shading::kCheckerboard ? 1 : 0;
}

// `base`, with a number behind it where there is such a file already: a frozen frame has many pictures.
std::string unused_name(const std::filesystem::path& base, const std::string& ending) {
  std::string name = base.string();
  for (int number = 2; std::filesystem::exists(name + ending); ++number)
    name = fmt::format("{}-{}", base.string(), number);
  return name;
}

WindowSettings settings_for(const RenderOptions& options, Vec2 scale) {
  WindowSettings settings;
  settings.look.scene = options.scene.empty() ? list_scenes().front().name : options.scene;
  settings.look.method = name_of(variant_of(options.resolve));
  settings.look.shutter = options.resolve.blur.shutter;
  settings.look.blur_samples = options.resolve.blur.samples;
  settings.look.tone_map = options.resolve.output.tone_map;
  settings.look.dither = options.resolve.output.dither;
  settings.look.targets = options.resolve.targets.placement;
  settings.look.shading = options.resolve.targets.shading;
  settings.look.shadow_scale = text_of(options.parts.shadow);
  if (options.parts.particles) settings.look.particle_scale = text_of(*options.parts.particles);
  settings.look.focus = options.focus;
  settings.look.dual = options.dual;
  settings.look.jitter = options.jitter;
  settings.resolution.scale = scale.x;
  settings.show_ui = options.show_ui;
  settings.resolution.largest_controlled = static_cast<float>(options.pacing.max_scale);
  if (options.pacing.on()) settings.rate.target_fps = options.pacing.target_fps;
  if (options.pacing.controls()) {
    settings.rate.controller = options.pacing.controller;
    settings.resolution.mode = ResolutionMode::kController;
  }
  return settings;
}

}  // namespace

Result<std::unique_ptr<WindowSession>> WindowSession::create(const RenderOptions& options) {
  auto session = std::unique_ptr<WindowSession>(new WindowSession(options));
  if (Status status = session->open(); !status.ok()) return status;
  return session;
}

WindowSession::~WindowSession() = default;

Status WindowSession::open() {
  if (!options_.script.empty()) {
    auto script = Script::read(options_.script);
    if (!script.ok()) return script.status();
    script_ = std::move(script).value();
  }
  auto source = source_settings_for(options_);  // checks the options before anything opens
  if (!source.ok()) return source.status();
  settings_ = settings_for(options_, source->sequence.scale_path.at(0, 1));
  Device::list();  // some drivers want OpenCL enumerated before a GL context exists
  auto window = Window::create(options_.output, "Quincunx", options_.vsync, options_.api);
  if (!window.ok()) return window.status();
  window_ = std::move(window).value();
  ui_ = std::make_unique<Ui>(window_->handle());
  auto screen = Screen::create();
  if (!screen.ok()) return screen.status();
  screen_.emplace(std::move(screen).value());
  auto picture = LivePicture::create(options_);
  if (!picture.ok()) return picture.status();
  picture_ = std::move(picture).value();
  return {};
}

Status WindowSession::run() {
  while (!window_->closing() && !settings_.close &&
         (options_.frames == 0 || shown_count_ < options_.frames)) {
    if (Status status = turn(); !status.ok()) return status;
  }
  spdlog::debug("{} pictures of {} frames, the interface drawn {} times", shown_count_, frame_ + 1,
                ui_->drawn());
  return {};
}

Status WindowSession::turn() {
  const bool minimised = window_->minimised();
  window_->poll(minimised ? kMinimisedSeconds : settings_.frozen ? kFrozenSeconds : 0);
  script_.play(turn_++, *window_);
  take_input();
  if (window_->minimised()) {
    paced_.reset();
    return {};
  }
  if (Status status = update_picture(); !status.ok()) return status;
  show_on_screen();
  if (Status status = write_files(); !status.ok()) return status;
  window_->swap();
  ++shown_count_;
  return {};
}

void WindowSession::take_input() {
  const std::vector<KeyPress> keys = window_->take_keys();
  if (!ui_->wants_keys()) {
    for (const KeyPress& key : keys)
      act_on(key, settings_);
  }
  pointer_ = window_->take_pointer();
  if (ui_->wants_pointer()) pointer_ = {.position = pointer_.position};
  for (int notch = 0; notch < std::abs(pointer_.scrolled); ++notch) {
    int& factor = settings_.zoom.factor;
    factor = pointer_.scrolled > 0 ? std::min(factor * 2, kLargestZoom) : std::max(factor / 2, 1);
  }
  move_view();
}

void WindowSession::move_view() {
  const Extent window = window_->framebuffer();
  if (settings_.zoom.factor == 1 || window.area() == 0) return;
  Vec2& centre = settings_.zoom.centre;
  const auto factor = static_cast<float>(settings_.zoom.factor);
  const float margin = .5f / factor;
  centre.x = std::clamp(centre.x - pointer_.dragged.x / factor / static_cast<float>(window.width), margin,
                        1 - margin);
  centre.y = std::clamp(centre.y - pointer_.dragged.y / factor / static_cast<float>(window.height), margin,
                        1 - margin);
}

Status WindowSession::update_picture() {
  const Extent output = window_->framebuffer();
  settings_.look.chooses_method = settings_.chooses_method();
  const bool same =
      settings_.look == shown_.look && settings_.resolution == shown_.resolution && output == shown_output_;
  if (Status status = picture_->configure(settings_.look, settings_.resolution, output); !status.ok())
    return status;
  if (Status status = update_pacing(); !status.ok()) return status;
  shown_ = settings_;
  shown_output_ = output;
  const int step = std::exchange(settings_.step, 0);
  if (!settings_.frozen || frame_ < 0) return show_next();
  frame_ = std::max<std::int64_t>(frame_ + step, 0);
  return same && step == 0 ? Status() : show_again(LivePicture::Keep::kNothing);
}

// A controller's ladder and what it has learnt belong to one output and one rate.
Status WindowSession::update_pacing() {
  if (settings_.frozen && frame_ >= 0) {
    paced_.reset();  // a pause is no dropped frame
    return {};
  }
  const bool same = paced_ && settings_.rate == shown_.rate && shown_output_ == picture_->output() &&
                    settings_.resolution.mode == shown_.resolution.mode &&
                    settings_.look.chooses_method == shown_.look.chooses_method;
  if (same) return {};
  PacingOptions wanted = options_.pacing;
  wanted.target_fps = settings_.rate.target_fps;
  const bool controls = settings_.resolution.mode == ResolutionMode::kController;
  wanted.controller = controls ? settings_.rate.controller : ControllerKind::kFixed;
  const ErrorFront* front = picture_->front();
  if (wanted.controller == ControllerKind::kQuality && front == nullptr)
    wanted.controller = ControllerKind::kPredictive;
  if (picture_->output() != options_.output) wanted.calibration.clear();  // that is for another size
  auto pacing =
      frame_pacing_for(wanted, picture_->output(), front != nullptr ? *front : ErrorFront::built_in());
  if (!pacing.ok()) return pacing.status();
  auto paced = PacedLoop::create(std::move(pacing).value(), options_.pacing.cost,
                                 pass_timer(picture_->source().device()));
  if (!paced.ok()) return paced.status();
  paced_ = std::move(paced).value();
  return {};
}

FrameView WindowSession::next_view() {
  FrameView view = picture_->view_of(frame_, paced_->next().value_or(picture_->output()), paced_->choice());
  if (!settings_.real_time || recent_.empty()) return view;
  // As far as the display has come: as many refreshes as it took until the last frame was shown.
  const std::vector<tools::PacedFrame>& frames = paced_->pacing().run().frames;
  const int refreshes = frames.empty() ? 1 : 1 + frames.back().missed;
  view.previous_seconds = view_.seconds;
  view.seconds = view_.seconds + refreshes / settings_.rate.target_fps;
  return view;
}

Status WindowSession::show_next() {
  ++frame_;
  paced_->wait();
  view_ = next_view();
  recent_.emplace_back(frame_, view_);
  if (recent_.size() > kWarmUp + 1) recent_.pop_front();
  paced_->begin_frame(view_.render);
  picture_->point_at(pointed_pixel());
  if (Status status = picture_->draw(frame_, view_); !status.ok()) return status;
  paced_->end_draw();
  if (Status status = picture_->resolve(); !status.ok()) return status;
  paced_->finish_frame();
  const std::vector<tools::PacedFrame>& paced = paced_->pacing().run().frames;
  FrameReport report = picture_->times().report;
  report.frame_index = static_cast<std::uint64_t>(paced.back().index);
  paced_->add(report);
  const double interval_ms = paced.size() < 2 ? 0 : paced.back().shown_ms - paced[paced.size() - 2].shown_ms;
  trace_.add(picture_->times(), picture_->output(), interval_ms, paced.back().missed, paced.back().method);
  return {};
}

// Returns the frame's view as it was, but for the settings that have changed.
FrameView WindowSession::view_again(std::int64_t index) {
  const auto known =
      std::find_if(recent_.begin(), recent_.end(), [&](const auto& recent) { return recent.first == index; });
  if (known == recent_.end()) return picture_->view_of(index, view_.render);
  FrameView view = picture_->view_of(index, known->second.render);
  view.seconds = known->second.seconds;
  view.previous_seconds = known->second.previous_seconds;
  return view;
}

// Draws the same frame by other settings, with the frames that its picture depends on.
Status WindowSession::show_again(LivePicture::Keep keep) {
  const std::int64_t first = std::max<std::int64_t>(frame_ - frames_before(settings_.look), 0);
  for (std::int64_t index = first; index <= frame_; ++index) {
    view_ = view_again(index);
    const LivePicture::Keep now = index == frame_ ? keep : LivePicture::Keep::kNothing;
    if (Status status = picture_->draw(index, view_, now); !status.ok()) return status;
    if (Status status = picture_->resolve(index == first); !status.ok()) return status;
  }
  return {};
}

void WindowSession::show_on_screen() {
  const Extent window = window_->framebuffer();
  const ScreenPicture picture = {picture_->picture(), picture_->compared(), picture_->output()};
  screen_->show(picture, settings_.zoom, settings_.split, window);
  if (!settings_.show_ui) return;
  const PanelFacts told = facts();
  ui_->draw([&] { draw_panel(settings_, trace_, told); }, settings_.drawing, *screen_, window);
}

// Returns the picture's pixel under the pointer; one outside of the picture where the pointer is.
Vec2 WindowSession::pointed_pixel() const {
  const ZoomOrigin origin = zoom_origin(settings_.zoom, picture_->output());
  const auto factor = static_cast<float>(settings_.zoom.factor);
  return {static_cast<float>(origin.x) + pointer_.position.x / factor,
          static_cast<float>(origin.y) + pointer_.position.y / factor};
}

PanelFacts WindowSession::facts() {
  PanelFacts facts;
  for (const SceneEntry& entry : list_scenes())
    facts.scenes.push_back(entry.name);
  if (std::find(facts.scenes.begin(), facts.scenes.end(), settings_.look.scene) == facts.scenes.end())
    facts.scenes.push_back(settings_.look.scene);
  facts.frame = frame_;
  facts.render = view_.render;
  facts.output = picture_->output();
  facts.made = picture_->times().report.output_extent;
  facts.crossing = crossing_text(picture_->source().bridge());
  facts.target_ms = 1000 / settings_.rate.target_fps;
  if (picture_->choice()) facts.method = name_of(picture_->choice()->method);
  if (paced_ && picture_->choice()) facts.reasons = paced_->pacing().reasons();
  if (picture_->plan().settings.checks_motion) facts.motion = text_of(picture_->times().report.motion);
  if (tools::ms_since(said_) < 1000 * kMessageSeconds) facts.message = message_;
  if (settings_.zoom.factor > 1) {
    const Vec2 pixel = pointed_pixel();
    const int x = static_cast<int>(pixel.x);
    const int y = static_cast<int>(pixel.y);
    if (x >= 0 && y >= 0 && x < facts.output.width && y < facts.output.height) {
      const std::uint8_t* texel =
          picture_->pixels() + (static_cast<std::size_t>(y) * facts.output.width + x) * 4;
      facts.pixel = PickedPixel{x, y, {texel[0], texel[1], texel[2], texel[3]}};
    }
  }
  return facts;
}

Status WindowSession::write_files() {
  const std::filesystem::path folder = options_.captures;
  if (std::exchange(settings_.screenshot, false)) {
    const std::string path = unused_name(folder / fmt::format("screenshot.{:04}", frame_), ".png") + ".png";
    const Extent window = window_->framebuffer();
    if (Status status = tools::write_picture(path, window, Screen::read(window).data()); !status.ok())
      return status;
    say("wrote " + path);
  }
  if (std::exchange(settings_.dump, false)) {
    const std::string base = unused_name(folder / fmt::format("dump.{:04}", frame_), "_targets.exr");
    if (Status status = show_again(LivePicture::Keep::kForFiles); !status.ok()) return status;
    if (Status status = picture_->write(base); !status.ok()) return status;
    say("wrote " + base + "_targets.exr and _resolved.exr");
  }
  return {};
}

void WindowSession::say(std::string message) {
  spdlog::info("{}", message);
  message_ = std::move(message);
  said_ = Clock::now();
}

}  // namespace quincunx::scenes
