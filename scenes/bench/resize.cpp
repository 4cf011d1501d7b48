// SPDX-License-Identifier: MIT
#include "bench/resize.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "bench/bench_options.h"
#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_run.h"
#include "bench/speed_error/contender.h"
#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"

namespace quincunx::bench {
namespace {

constexpr double kMebi = 1 << 20;
constexpr const char* kRandomPath = "random:0.5,1";

struct ResizeSettings {
  Extent largest;
  int resizes = 0;  // counted ones for each way
  std::uint64_t seed = 0;
};

struct TargetFramesSettings {
  Extent output;
  BenchMethod method;
  std::string scale_path;  // as ScalePath::parse() takes it; empty: `scale`
  double scale = 1;
  int warm_up = 0;
  int frames = 0;
  std::uint64_t seed = 0;
  double fps = 60;
};

Quantiles quantiles_of(const Samples& samples) {
  if (samples.empty()) return {};
  return {*std::min_element(samples.begin(), samples.end()), median_of(samples), p95_of(samples)};
}

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

// The render targets of a frame under names that stay while their size changes (glTexImage2D), to be measured beside
// those that are made anew and those that are kept.
class RespecifiedTargets {
 public:
  RespecifiedTargets() : framebuffer_(gl::Framebuffer::create()) {
    for (gl::Texture& texture : textures_) {
      texture = gl::Texture::create();
      gl::texture_parameter(texture.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST});
      gl::texture_parameter(texture.get(), GL_TEXTURE_MAG_FILTER, GLint{GL_NEAREST});
      gl::texture_parameter(texture.get(), GL_TEXTURE_MAX_LEVEL, GLint{0});
    }
    gl::draw_buffers(framebuffer_.get(), {kOutputs[0], kOutputs[1], kOutputs[2]});
  }

  void resize(Extent extent) {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      const auto& plane = kPlanes[i];
      glBindTexture(GL_TEXTURE_2D, textures_[i].get());
      glTexImage2D(GL_TEXTURE_2D, 0, plane.internal, extent.width, extent.height, 0, plane.format, plane.type,
                   nullptr);
      gl::attach(framebuffer_.get(), plane.attachment, textures_[i].get());
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    if (gl::framebuffer_status(framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE)
      throw Failure(Status::device("a framebuffer of textures that were specified again is not complete"));
  }

  void clear() const {
    constexpr std::array<GLfloat, 4> kZero = {0, 0, 0, 0};
    gl::clear(framebuffer_.get(), GL_DEPTH, 0, kZero.data());
    for (int output = 0; output < static_cast<int>(kOutputs.size()); ++output)
      gl::clear(framebuffer_.get(), GL_COLOR, output, kZero.data());
  }

 private:
  gl::Framebuffer framebuffer_;
  std::array<gl::Texture, 4> textures_;
};

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
  ResizeCost cost{.way = std::move(name), .what = std::move(what), .resize_us = {}, .first_use_ms = {}};
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
  cost.first_use_ms = quantiles_of(first_ms);
  return cost;
}

// A bridge's own way: what begin_draw() says that the resize took.
Way bridge_way(const scenes::FrameSource& stage, Extent largest, Targets targets) {
  auto bridge = checked(gl::Bridge::create(stage.context(), stage.device(),
                                           {.interop = gl::Interop::kCopy,
                                            .target_extent = largest,
                                            .output_extent = {16, 16},
                                            .depth = true,
                                            .velocity = true,
                                            .reactive = true,
                                            .targets = targets}));
  struct State {
    std::unique_ptr<gl::Bridge> bridge;
    const gl::RenderTargets* targets = nullptr;
    int slot = 0;
  };
  const auto state = std::make_shared<State>(State{std::move(bridge)});
  return {.resize_us =
              [state](Extent size) {
                state->targets = checked(state->bridge->begin_draw(state->slot, size));
                return state->bridge->traffic().resize_us;
              },
          .clear = [state](Extent size) { state->targets->clear(size); },
          .finish =
              [state] {
                checked(state->bridge->submit(state->slot));
                checked(state->bridge->acquire(state->slot));
                state->slot = (state->slot + 1) % state->bridge->slots();
              }};
}

// New targets each time, after the old ones have gone.
Way anew_way() {
  const auto targets = std::make_shared<std::optional<gl::RenderTargets>>();
  return {.resize_us =
              [targets](Extent size) {
                return timed_us(
                    [&] { targets->emplace(checked(gl::RenderTargets::create({.target_extent = size}))); });
              },
          .clear = [targets](Extent size) { (*targets)->clear(size); }};
}

Way respecified_way() {
  const auto targets = std::make_shared<RespecifiedTargets>();
  return {.resize_us = [targets](Extent size) { return timed_us([&] { targets->resize(size); }); },
          .clear = [targets](Extent) { targets->clear(); }};
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
  static std::unique_ptr<Kind> create(const scenes::FrameSource& stage,
                                      const scenes::SequenceSettings& sequence, ResolveSettings resolve,
                                      Targets targets) {
    resolve.targets.placement = targets;
    auto feed = FrameFeed::create(stage, sequence, {resolve});
    auto contender = Contender::create(stage.device(), feed.plans().front());
    return std::unique_ptr<Kind>(new Kind(targets, std::move(feed), std::move(contender)));
  }

  void run_frame(bool keep) {
    auto inputs = feed_.next();
    auto presented = checked(feed_.bridge().begin_present());
    auto time = contender_.dispatch(inputs, nullptr, {.presented = presented});
    const StepClock clock;
    checked(feed_.bridge().present());
    StepTime interop = feed_.interop_time();
    interop += clock.elapsed();
    render_ = inputs.render_extent;
    feed_.release();
    if (keep) add(interop, time.step);
  }

  TargetFrames row(const std::string& scale) const {
    const gl::Bridge::Memory memory = feed_.bridge().memory();
    return {.scale = scale,
            .targets = name_of(targets_),
            .render = {render_.width, render_.height},
            .draw_ms = quantiles_of(draw_ms_),
            .interop_ms = quantiles_of(interop_ms_),
            .resolve_ms = quantiles_of(resolve_ms_),
            .frame_ms = quantiles_of(frame_ms_),
            .frame_processor_ms = median_of(processor_ms_),
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

scenes::SequenceSettings sequence_of(const TargetFramesSettings& settings) {
  const auto scale = static_cast<float>(settings.scale);
  auto path =
      checked(settings.scale_path.empty() ? scenes::ScalePath::fixed({scale, scale})
                                          : scenes::ScalePath::parse(settings.scale_path, settings.seed));
  scenes::SequenceSettings sequence;
  sequence.output = settings.output;
  sequence.scale_path = path;
  sequence.jitter = settings.method.jitter;
  sequence.frames = settings.warm_up + settings.frames;
  sequence.fps = settings.fps;
  sequence.detail = settings.method.detail;
  return sequence;
}

// Takes host times with nothing else at work: GL is waited for before each resize. The context of `stage` is current.
std::vector<ResizeCost> measure_resizes(const scenes::FrameSource& stage, const ResizeSettings& settings) {
  const std::vector<Extent> sizes = random_sizes(settings);
  std::vector<ResizeCost> costs;
  costs.push_back(measure("viewport", "large targets: another part of them is used", sizes,
                          bridge_way(stage, settings.largest, Targets::kViewport)));
  costs.push_back(measure("kept", "placed: two sizes in turn, both still there", returning_sizes(settings),
                          bridge_way(stage, settings.largest, Targets::kPlaced)));
  costs.push_back(
      measure("new", "placed: a new size", sizes, bridge_way(stage, settings.largest, Targets::kPlaced)));
  costs.push_back(measure("anew", "OpenGL only: new textures, none are kept", sizes, anew_way()));
  costs.push_back(measure("respecified", "OpenGL only: the same textures are given another size", sizes,
                          respecified_way()));
  return costs;
}

// Measures the same frames with both kinds, viewport targets first; in each frame the kinds take turns in going first.
// On the device of `stage`, whose context is current.
std::vector<TargetFrames> measure_frames(const scenes::FrameSource& stage,
                                         const TargetFramesSettings& settings) {
  const auto sequence = sequence_of(settings);
  std::vector<std::unique_ptr<Kind>> kinds;
  for (const Targets targets : {Targets::kViewport, Targets::kPlaced})
    kinds.push_back(Kind::create(stage, sequence, settings.method.resolve, targets));
  for (int frame = 0; frame < settings.warm_up + settings.frames; ++frame) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      Kind& kind = *kinds[(i + static_cast<std::size_t>(frame)) % kinds.size()];
      kind.run_frame(frame >= settings.warm_up);
    }
  }
  const std::string scale = settings.scale_path.empty() ? fmt::format("{:g}", settings.scale) : "random";
  std::vector<TargetFrames> rows;
  for (const auto& kind : kinds)
    rows.push_back(kind->row(scale));
  return rows;
}

}  // namespace

std::string text_of(const ResizeResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}, {} -> {}x{}, {}, {}, load {:.1f} to {:.1f}\n", result.scene, result.method,
                 result.output[0], result.output[1], result.machine.cl_device, result.machine.gl_renderer,
                 result.machine.load_before, result.machine.load_after);
  fmt::format_to(out, "\nA resize, {} of each\n{:<13}{:>9}{:>9}{:>9}{:>12}{:>8}{:>8}  us; first use in ms\n",
                 result.resizes, "way", "min", "median", "p95", "first min", "median", "p95");
  for (const ResizeCost& cost : result.costs) {
    fmt::format_to(out, "{:<13}{:>9.2f}{:>9.2f}{:>9.2f}{:>12.3f}{:>8.3f}{:>8.3f}  {}\n", cost.way,
                   cost.resize_us.min, cost.resize_us.median, cost.resize_us.p95, cost.first_use_ms.min,
                   cost.first_use_ms.median, cost.first_use_ms.p95, cost.what);
  }
  fmt::format_to(out, "\nFrames, {} of each\n{:<8}{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>11}{:>10}{:>10}\n",
                 result.frames, "scale", "targets", "draw", "interop", "resolve", "frame", "min", "p95",
                 "processor", "GL MiB", "CL MiB");
  for (const TargetFrames& row : result.rows) {
    fmt::format_to(out,
                   "{:<8}{:<10}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>11.2f}{:>10.1f}{:>10.1f}\n",
                   row.scale, row.targets, row.draw_ms.median, row.interop_ms.median, row.resolve_ms.median,
                   row.frame_ms.median, row.frame_ms.min, row.frame_ms.p95, row.frame_processor_ms,
                   static_cast<double>(row.gl_bytes) / kMebi, static_cast<double>(row.opencl_bytes) / kMebi);
  }
  text +=
      "\nms, medians but for min and p95, which are the frame's; processor: of all threads.  random: "
      "another size in each frame.\n";
  return text;
}

std::string csv_of(const ResizeResult& result) {
  std::string text =
      "scale,targets,draw_ms,interop_ms,resolve_ms,frame_ms,frame_min_ms,frame_p95_ms,frame_processor_ms,"
      "gl_bytes,opencl_bytes\n";
  for (const TargetFrames& row : result.rows) {
    text += fmt::format("{},{},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{},{}\n", row.scale, row.targets,
                        row.draw_ms.median, row.interop_ms.median, row.resolve_ms.median, row.frame_ms.median,
                        row.frame_ms.min, row.frame_ms.p95, row.frame_processor_ms, row.gl_bytes,
                        row.opencl_bytes);
  }
  return text;
}

ResizeResult run_resize(const BenchOptions& options) {
  auto plan = checked(single_plan_from(options));
  const BenchMethod& method = plan.methods.front();
  auto stage = open_stage(options, plan.scenes.front(), sequence_for(plan, 1, method));
  ResizeResult result{facts_of(options, *stage),
                      plan.scenes.front(),
                      method.name,
                      {options.output.width, options.output.height},
                      options.resize.resizes,
                      static_cast<int>(options.frames) * options.rounds,
                      {},
                      {}};
  result.machine.interop = "copy";
  result.costs = measure_resizes(*stage, {options.output, options.resize.resizes, options.seed});
  TargetFramesSettings settings{.output = options.output,
                                .method = method,
                                .scale_path = {},
                                .warm_up = options.warm_up,
                                .frames = result.frames,
                                .seed = options.seed,
                                .fps = options.fps};
  const auto add = [&] {
    std::ranges::move(measure_frames(*stage, settings), std::back_inserter(result.rows));
  };
  for (const double scale : plan.scales) {
    settings.scale = scale;
    add();
  }
  settings.scale_path = kRandomPath;
  add();
  result.machine.load_after = load_of_last_minute();
  return result;
}

}  // namespace quincunx::bench
