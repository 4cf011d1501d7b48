// SPDX-License-Identifier: MIT
#include "bench/resize/resize_costs.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "bench/speed_error/contender.h"
#include "quincunx/advanced/extent.h"
#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"

namespace quincunx::bench {
namespace {

// The render targets of a frame under names that stay while their size changes (glTexImage2D), to be measured beside
// those that are made anew and those that are kept.
class RespecifiedTargets {
 public:
  RespecifiedTargets();

  // Throws std::runtime_error where the framebuffer is not complete.
  void resize(Extent extent);
  void clear() const;

 private:
  gl::Framebuffer framebuffer_;
  std::array<gl::Texture, 4> textures_;
};

constexpr struct {
  GLint internal;
  GLenum format;
  GLenum type;
  GLenum attachment;
} kPlanes[] = {{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, GL_COLOR_ATTACHMENT0},
               {GL_RG16F, GL_RG, GL_HALF_FLOAT, GL_COLOR_ATTACHMENT1},
               {GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT2},
               {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, GL_DEPTH_ATTACHMENT}};
constexpr std::array<GLenum, 3> kOutputs = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};

RespecifiedTargets::RespecifiedTargets() : framebuffer_(gl::Framebuffer::create()) {
  for (gl::Texture& texture : textures_) {
    texture = gl::Texture::create();
    gl::texture_parameter(texture.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST});
    gl::texture_parameter(texture.get(), GL_TEXTURE_MAG_FILTER, GLint{GL_NEAREST});
    gl::texture_parameter(texture.get(), GL_TEXTURE_MAX_LEVEL, GLint{0});
  }
  gl::draw_buffers(framebuffer_.get(), {kOutputs[0], kOutputs[1], kOutputs[2]});
}

void RespecifiedTargets::resize(Extent extent) {
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    const auto& plane = kPlanes[i];
    glBindTexture(GL_TEXTURE_2D, textures_[i].get());
    glTexImage2D(GL_TEXTURE_2D, 0, plane.internal, extent.width, extent.height, 0, plane.format, plane.type,
                 nullptr);
    gl::attach(framebuffer_.get(), plane.attachment, textures_[i].get());
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  if (gl::framebuffer_status(framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("a framebuffer of textures that were specified again is not complete");
}

void RespecifiedTargets::clear() const {
  constexpr std::array<GLfloat, 4> kZero = {0, 0, 0, 0};
  gl::clear(framebuffer_.get(), GL_DEPTH, 0, kZero.data());
  for (int output = 0; output < static_cast<int>(kOutputs.size()); ++output)
    gl::clear(framebuffer_.get(), GL_COLOR, output, kZero.data());
}

constexpr int kWarmUp = 16;

// Sizes of half to all of the largest size's length, no two in a row the same.
std::vector<Extent> random_sizes(const ResizeSettings& settings) {
  std::mt19937_64 random(settings.seed + 1);
  std::vector<Extent> sizes;
  while (sizes.size() < static_cast<std::size_t>(settings.resizes + kWarmUp)) {
    const double scale = 0.5 + static_cast<double>(random() % 4096) / 8192;
    const Extent size = {std::max(1, static_cast<int>(std::lround(settings.largest.width * scale))),
                         std::max(1, static_cast<int>(std::lround(settings.largest.height * scale)))};
    if (sizes.empty() || sizes.back() != size || settings.largest.area() < 16) sizes.push_back(size);
  }
  return sizes;
}

// One way to resize. `resize_us` returns the host time that the resize took; `clear` follows it.
struct Way {
  std::function<double(Extent)> resize_us;
  std::function<void(Extent)> clear;
  std::function<void()> finish = [] {};  // ends the frame; not timed
};

double timed_us(const std::function<void()>& work) {
  const StepClock clock;
  work();
  return 1000 * clock.elapsed().ms;
}

ResizeCost measure(std::string name, std::string what, const std::vector<Extent>& sizes, const Way& way) {
  ResizeCost cost{.name = std::move(name), .what = std::move(what), .resize_us = {}, .first_ms = {}};
  Samples resize_us, first_ms;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    glFinish();
    const double us = way.resize_us(sizes[i]);
    const double ms = timed_us([&] {
                        way.clear(sizes[i]);
                        glFinish();
                      }) /
                      1000;
    way.finish();
    if (i < kWarmUp) continue;
    resize_us.push_back(us);
    first_ms.push_back(ms);
  }
  cost.resize_us = quantiles_of(resize_us);
  cost.first_ms = quantiles_of(first_ms);
  return cost;
}

// A bridge's own way: what begin_draw() says that the resize took.
class BridgeWay {
 public:
  BridgeWay(const scenes::FrameSource& stage, Extent largest, Targets targets) {
    auto bridge = gl::Bridge::create(stage.context(), stage.device(),
                                     {.interop = gl::Interop::kCopy,
                                      .target_extent = largest,
                                      .output_extent = {16, 16},
                                      .depth = true,
                                      .velocity = true,
                                      .reactive = true,
                                      .targets = targets});
    if (!bridge.ok()) throw std::runtime_error(bridge.status().message());
    bridge_ = std::move(bridge).value();
  }

  Way way() {
    return {.resize_us = [this](Extent size) { return resize(size); },
            .clear = [this](Extent size) { targets_->clear(size); },
            .finish = [this] { hand_over(); }};
  }

 private:
  double resize(Extent size) {
    auto targets = bridge_->begin_draw(slot_, size);
    check(targets.status());
    targets_ = targets.value();
    return bridge_->traffic().resize_us;
  }

  void hand_over() {
    check(bridge_->submit(slot_));
    check(bridge_->acquire(slot_).status());
    slot_ = (slot_ + 1) % bridge_->slots();
  }

  static void check(const Status& status) {
    if (!status.ok()) throw std::runtime_error(status.message());
  }

  std::unique_ptr<gl::Bridge> bridge_;
  const gl::RenderTargets* targets_ = nullptr;
  int slot_ = 0;
};

// New targets each time, after the old ones have gone.
class AnewWay {
 public:
  Way way() {
    return {.resize_us =
                [this](Extent size) {
                  return timed_us(
                      [&] { targets_.emplace(gl::RenderTargets::create({.target_extent = size}).value()); });
                },
            .clear = [this](Extent size) { targets_->clear(size); }};
  }

 private:
  std::optional<gl::RenderTargets> targets_;
};

Way respecified(RespecifiedTargets& targets) {
  return {.resize_us = [&targets](Extent size) { return timed_us([&] { targets.resize(size); }); },
          .clear = [&targets](Extent) { targets.clear(); }};
}

// A few sizes in turn, as a controller goes to and fro between them.
std::vector<Extent> returning_sizes(const ResizeSettings& settings) {
  const Extent largest = settings.largest;
  const auto part = [&](int percent) {
    return Extent{std::max(1, largest.width * percent / 100), std::max(1, largest.height * percent / 100)};
  };
  std::vector<Extent> sizes;
  for (int i = 0; i < settings.resizes + kWarmUp; ++i)
    sizes.push_back(part(i % 2 == 0 ? 70 : 72));
  return sizes;
}

class Kind {
 public:
  static Result<std::unique_ptr<Kind>> create(const scenes::FrameSource& stage,
                                              const scenes::SequenceSettings& sequence,
                                              ResolveSettings resolve, Targets targets) {
    resolve.targets.placement = targets;
    auto feed = FrameFeed::create(stage, sequence, {resolve});
    if (!feed.ok()) return feed.status();
    auto contender = Contender::create(stage.device(), feed->plans().front());
    if (!contender.ok()) return contender.status();
    return std::unique_ptr<Kind>(new Kind(targets, std::move(feed).value(), std::move(contender).value()));
  }

  Status run_frame(bool keep) {
    auto inputs = feed_.next();
    if (!inputs.ok()) return inputs.status();
    auto presented = feed_.bridge().begin_present();
    if (!presented.ok()) return presented.status();
    auto time = contender_.dispatch(inputs.value(), nullptr, {.presented = presented.value()});
    if (!time.ok()) return time.status();
    const StepClock clock;
    if (Status status = feed_.bridge().present(); !status.ok()) return status;
    StepTime interop = feed_.interop_time();
    interop += clock.elapsed();
    render_ = inputs->render_extent;
    feed_.release();
    if (keep) add(interop, time->step);
    return {};
  }

  TargetFrames row(const std::string& scale) const {
    const gl::Bridge::Memory memory = feed_.bridge().memory();
    return {.scale = scale,
            .targets = targets_,
            .render = render_,
            .draw_ms = quantiles_of(draw_ms_),
            .interop_ms = quantiles_of(interop_ms_),
            .resolve_ms = quantiles_of(resolve_ms_),
            .frame_ms = quantiles_of(frame_ms_),
            .processor_ms = median_of(processor_ms_),
            .gl_bytes = memory.gl_bytes,
            .opencl_bytes = memory.opencl_bytes};
  }

 private:
  Kind(Targets targets, FrameFeed feed, Contender contender)
      : targets_(targets), feed_(std::move(feed)), contender_(std::move(contender)) {}

  void add(const StepTime& interop, const StepTime& resolve) {
    StepTime whole = feed_.draw_time();
    whole += interop;
    whole += resolve;
    draw_ms_.push_back(feed_.draw_time().ms);
    interop_ms_.push_back(interop.ms);
    resolve_ms_.push_back(resolve.ms);
    frame_ms_.push_back(whole.ms);
    processor_ms_.push_back(whole.processor_ms);
  }

  Targets targets_;
  FrameFeed feed_;
  Contender contender_;
  Extent render_;
  Samples draw_ms_, interop_ms_, resolve_ms_, frame_ms_, processor_ms_;
};

Result<scenes::SequenceSettings> sequence_of(const TargetFramesSettings& settings) {
  const auto scale = static_cast<float>(settings.scale);
  auto path = settings.scale_path.empty() ? scenes::ScalePath::fixed({scale, scale})
                                          : scenes::ScalePath::parse(settings.scale_path, settings.seed);
  if (!path.ok()) return path.status();
  scenes::SequenceSettings sequence;
  sequence.output = settings.output;
  sequence.scale_path = path.value();
  sequence.jitter = settings.method.jitter;
  sequence.frames = settings.warm_up + settings.frames;
  sequence.fps = settings.fps;
  sequence.detail = settings.method.detail;
  return sequence;
}

}  // namespace

Result<std::vector<ResizeCost>> measure_resizes(const scenes::FrameSource& stage,
                                                const ResizeSettings& settings) {
  const std::vector<Extent> sizes = random_sizes(settings);
  std::vector<ResizeCost> costs;
  try {
    BridgeWay viewport(stage, settings.largest, Targets::kViewport);
    costs.push_back(
        measure("viewport", "large targets: another part of them is used", sizes, viewport.way()));
    BridgeWay kept(stage, settings.largest, Targets::kPlaced);
    costs.push_back(measure("kept", "placed: two sizes in turn, both still there", returning_sizes(settings),
                            kept.way()));
    BridgeWay placed(stage, settings.largest, Targets::kPlaced);
    costs.push_back(measure("new", "placed: a new size", sizes, placed.way()));
    AnewWay anew;
    costs.push_back(measure("anew", "OpenGL only: new textures, none are kept", sizes, anew.way()));
    RespecifiedTargets same_names;
    costs.push_back(measure("respecified", "OpenGL only: the same textures are given another size", sizes,
                            respecified(same_names)));
  } catch (const std::exception& error) {
    return Status::device(error.what());
  }
  return costs;
}

Result<std::vector<TargetFrames>> measure_frames(const scenes::FrameSource& stage,
                                                 const TargetFramesSettings& settings) {
  const auto sequence = sequence_of(settings);
  if (!sequence.ok()) return sequence.status();
  std::vector<std::unique_ptr<Kind>> kinds;
  for (const Targets targets : {Targets::kViewport, Targets::kPlaced}) {
    auto kind = Kind::create(stage, sequence.value(), settings.method.resolve, targets);
    if (!kind.ok()) return kind.status();
    kinds.push_back(std::move(kind).value());
  }
  for (int frame = 0; frame < settings.warm_up + settings.frames; ++frame) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      Kind& kind = *kinds[(i + static_cast<std::size_t>(frame)) % kinds.size()];
      if (Status status = kind.run_frame(frame >= settings.warm_up); !status.ok()) return status;
    }
  }
  const std::string scale = settings.scale_path.empty() ? fmt::format("{:g}", settings.scale) : "random";
  std::vector<TargetFrames> rows;
  for (const auto& kind : kinds)
    rows.push_back(kind->row(scale));
  return rows;
}

}  // namespace quincunx::bench
