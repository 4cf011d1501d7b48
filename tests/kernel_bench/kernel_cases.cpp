// SPDX-License-Identifier: MIT
#include "kernel_cases.h"

#include <fmt/format.h>

#include <memory>

#include "frame_traffic.h"
#include "pass_clear.h"
#include "pass_motion_blur.h"
#include "pass_present.h"
#include "pass_reproject.h"
#include "pass_resolve.h"
#include "pass_scale.h"
#include "pass_sharpen.h"
#include "pass_temporal.h"
#include "pass_velocity.h"

namespace quincunx::bench {
namespace {

// Two frames at one scale, and the plan for them.
struct Scene {
  std::string suffix;  // " 0.71 half"
  double scale = 1;
  ResolvePlan plan;
  FrameInputs current, previous;
};

Scene scene_of(Stage& stage, double scale, PixelFormat colour) {
  const Extent render = scaled(stage.output(), scale);
  Scene scene;
  scene.suffix = fmt::format(" {:.2f} {}", scale, colour == PixelFormat::kRGBA16F ? "half" : "float");
  scene.scale = scale;
  scene.plan.settings = {.output = stage.output(), .target = render, .colour = colour};
  scene.plan.velocity = VelocitySource::kTarget;
  scene.current = stage.frame(render, colour, .25f, 0);
  scene.previous = stage.frame(render, colour, -.25f, 1);
  return scene;
}

// A filter's kernel serves several methods, so both are named.
std::string method_name(Method method, const ScalePass& pass, const Scene& scene) {
  const std::string kernel = pass.kernel_name(scene.current.render);
  return kernel == FilterPass::kernel_name() ? fmt::format("{} {}", kernel, name_of(method)) : kernel;
}

void add_scale(std::vector<Case>& cases, Stage& stage, const Scene& scene, Method method, double wanted,
               const std::string& suffix = {}) {
  const ResolveSettings& settings = scene.plan.settings;
  auto pass = std::make_shared<ScalePass>(stage.impl(), method, settings);
  Stage::add(cases,
             {.name = method_name(method, *pass, scene) + scene.suffix + suffix,
              .scale = scene.scale,
              .wanted = wanted,
              .bytes = scale_bytes(settings, scene.current.render)},
             [pass, &stage, inputs = scene.current,
              resolved = stage.noise(stage.output(), settings.resolved)](cl::Event* event) {
               pass->enqueue(stage.impl().queue, stage.tables(), inputs, resolved, stage.counter(), event);
             });
}

void add_resolve(std::vector<Case>& cases, Stage& stage, const Scene& scene, double wanted,
                 const std::string& suffix = {}) {
  const ResolvePlan& plan = scene.plan;
  auto pass = std::make_shared<ResolvePass>(stage.impl(), plan);
  Stage::add(cases,
             {.name = "resolve_quincunx" + scene.suffix + suffix,
              .scale = scene.scale,
              .wanted = wanted,
              .bytes = quincunx_bytes(plan, scene.current.render, scene.previous.render)},
             [pass, &stage, current = scene.current, previous = scene.previous,
              resolved = stage.noise(stage.output(), plan.settings.resolved)](cl::Event* event) {
               pass->enqueue(stage.impl().queue, stage.tables(), current, previous, resolved, stage.counter(),
                             event);
             });
}

// Both kernels, or where nothing moves the second alone.
void add_reprojected(std::vector<Case>& cases, Stage& stage, const Scene& scene, double wanted,
                     const std::string& suffix, double pixels) {
  ResolvePlan plan = scene.plan;
  plan.settings.quincunx.form = TwoFrameForm::kReprojected;
  plan.settings.velocity = PixelFormat::kRG32F;
  if (pixels == 0) plan.velocity = VelocitySource::kNone;
  auto pass = std::make_shared<ReprojectPass>(stage.impl(), plan);
  FrameInputs current = scene.current;
  current.velocity = stage.velocity(current.render, [&](int x, int y) {
    // Surfaces of some size that move apart.
    const bool odd = (x / 97 + y / 83) % 2 != 0;
    return static_cast<float>((odd ? pixels : -.3 * pixels) / stage.output().width);
  });
  std::uint64_t bytes = reprojected_bytes(plan, current.render, scene.previous.render);
  if (pass->moves()) bytes += reproject_bytes(plan, current.render, scene.previous.render);
  Stage::add(
      cases,
      {.name = "resolve_reprojected" + scene.suffix + suffix,
       .scale = scene.scale,
       .wanted = wanted,
       .bytes = bytes},
      [pass, &stage, current, previous = scene.previous,
       resolved = stage.noise(stage.output(), plan.settings.resolved)](cl::Event* events) {
        pass->enqueue(stage.impl().queue, current, previous, resolved, stage.counter(), events);
      },
      pass->moves() ? 2 : 1);
}

// All kernels; everything moves by `pixels`, or if surfaces move `apart`, those of the case above. As these
// stay where they are, what flows through them has many offsets, more than surfaces that move would leave.
void add_temporal(std::vector<Case>& cases, Stage& stage, const Scene& scene, double wanted,
                  const std::string& suffix, TemporalPreset preset, double pixels, bool apart = false) {
  ResolvePlan plan = scene.plan;
  plan.settings.method = Method::kTemporal;
  plan.settings.temporal.preset = preset;
  plan.settings.velocity = PixelFormat::kRG32F;
  auto pass = std::make_shared<TemporalPass>(stage.impl(), plan);
  pass->forget(stage.impl().queue);
  FrameInputs current = scene.current;
  current.velocity = stage.velocity(current.render, [&](int x, int y) {
    const bool odd = apart && (x / 97 + y / 83) % 2 != 0;
    return static_cast<float>((odd ? -pixels / .3 : pixels) / stage.output().width);
  });
  plan.needs.background = true;
  // A wall of one colour: whatever moves, history agrees with the frame.
  current.colour = stage.constant(current.render, scene.plan.settings.colour);
  current.depth = stage.constant(current.render, PixelFormat::kR32F);
  FrameInputs previous = current;
  previous.jitter = scene.previous.jitter;
  const std::uint64_t bytes = reproject_bytes(plan, current.render, scene.previous.render) +
                              temporal_tiles_bytes(plan, current.render) + temporal_light_bytes(plan) +
                              temporal_bytes(plan, current.render, scene.previous.render) +
                              temporal_display_bytes(plan, current.render);
  Stage::add(
      cases,
      {.name = fmt::format("temporal:{}{}{}", name_of(preset), scene.suffix, suffix),
       .scale = scene.scale,
       .wanted = wanted,
       .bytes = bytes},
      [pass, &stage, current, previous,
       resolved = stage.noise(stage.output(), plan.settings.resolved)](cl::Event* events) {
        pass->enqueue(stage.impl().queue, current, previous, resolved, stage.counter(), events);
      },
      5);
}

void add_velocity(std::vector<Case>& cases, Stage& stage, const Scene& scene) {
  const ResolveSettings& settings = scene.plan.settings;
  auto pass = std::make_shared<VelocityPass>(stage.impl(), settings);
  Stage::add(
      cases,
      {.name = pass->kernel_name() + scene.suffix,
       .scale = scene.scale,
       .bytes = velocity_bytes(settings, scene.current.render)},
      [pass, &stage, inputs = scene.current, velocity = stage.noise(scene.current.render, settings.velocity)](
          cl::Event* event) { pass->enqueue(stage.impl().queue, inputs, velocity, event); });
}

// All three kernels of the blur. `pixels`: how far a sample moves over the output while the shutter is open.
void add_blur(std::vector<Case>& cases, Stage& stage, const Scene& scene, double wanted,
              const std::string& suffix, const std::function<double(int x, int y)>& pixels) {
  ResolveSettings settings = scene.plan.settings;
  settings.blur.shutter = 1;
  settings.velocity = PixelFormat::kRG32F;
  auto pass = std::make_shared<MotionBlurPass>(stage.impl(), settings);
  FrameInputs inputs = scene.current;
  inputs.velocity = stage.velocity(
      inputs.render, [&](int x, int y) { return static_cast<float>(pixels(x, y) / stage.output().width); });
  const std::uint64_t bytes = motion_tiles_bytes(settings, inputs.render) +
                              motion_neighbours_bytes(settings) + motion_blur_bytes(settings, inputs.render);
  Stage::add(
      cases,
      {.name = "motion_blur" + scene.suffix + suffix, .scale = scene.scale, .wanted = wanted, .bytes = bytes},
      [pass, &stage, inputs, resolved = stage.noise(stage.output(), settings.resolved, 0),
       blurred = stage.noise(stage.output(), settings.resolved, 1)](cl::Event* events) {
        pass->enqueue(stage.impl().queue, stage.tables(), inputs, resolved, blurred, events);
      },
      static_cast<int>(MotionBlurPass::kKernels.size()));
}

void add_blurs(std::vector<Case>& cases, Stage& stage, const Scene& scene) {
  add_blur(cases, stage, scene, 1.2, " still", [](int, int) { return 0; });
  add_blur(cases, stage, scene, 11, " all moving", [](int, int) { return 24; });
  // Bars that move against each other, so that every tile needs depth.
  add_blur(cases, stage, scene, 0, " mixed", [](int x, int) { return x / 24 % 2 == 0 ? 24 : -8; });
}

void add_sharpens(std::vector<Case>& cases, Stage& stage) {
  for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    const ResolveSettings settings{.output = stage.output(), .resolved = resolved, .sharpness = .5f};
    auto pass = std::make_shared<SharpenPass>(stage.impl(), settings);
    Stage::add(cases,
               {.name = fmt::format("sharpen {}", resolved == PixelFormat::kRGBA32F ? "float" : "half"),
                .wanted = 2,
                .bytes = sharpen_bytes(settings)},
               [pass, &stage, source = stage.noise(stage.output(), resolved, 0),
                sharpened = stage.noise(stage.output(), resolved, 1)](cl::Event* event) {
                 pass->enqueue(stage.impl().queue, source, sharpened, event);
               });
  }
}

void add_presents(std::vector<Case>& cases, Stage& stage) {
  for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
      const ResolveSettings settings{.output = stage.output(), .resolved = resolved, .tone_map = tone_map};
      auto pass = std::make_shared<PresentPass>(stage.impl(), settings);
      Stage::add(cases,
                 {.name = fmt::format("present {} {}", name_of(tone_map),
                                      resolved == PixelFormat::kRGBA32F ? "float" : "half"),
                  .wanted = 1.2,
                  .bytes = present_bytes(settings)},
                 [pass, &stage, source = stage.noise(stage.output(), resolved),
                  presented = stage.noise(stage.output(), PixelFormat::kRGBA8)](cl::Event* event) {
                   pass->enqueue(stage.impl().queue, source, 1.0f, presented, stage.counter(), event);
                 });
    }
  }
}

void add_clears(std::vector<Case>& cases, Stage& stage) {
  for (const PixelFormat format : {PixelFormat::kRGBA16F, PixelFormat::kRG16F}) {
    auto pass = std::make_shared<ClearPass>(stage.impl(), Storage::kBuffer, format);
    Stage::add(cases,
               {.name = fmt::format("clear_region {}", name_of(format)),
                .wanted = 0.4,
                .bytes = bytes_of(stage.output(), format)},
               [pass, &stage, image = stage.noise(stage.output(), format)](cl::Event* event) {
                 const float value[4] = {0, 0, 0, 1};
                 pass->enqueue(stage.impl().queue, image, stage.output(), value, event);
               });
  }
}

}  // namespace

void add_scaled_cases(std::vector<Case>& cases, Stage& stage, double scale) {
  for (const PixelFormat colour : {PixelFormat::kRGBA16F, PixelFormat::kRGBA32F}) {
    Scene scene = scene_of(stage, scale, colour);
    add_scale(cases, stage, scene, Method::kPoint, 1.0);
    add_scale(cases, stage, scene, Method::kBilinear, 1.1);
    add_scale(cases, stage, scene, Method::kBSpline, 1.7);
    add_scale(cases, stage, scene, Method::kCatmullRom, 1.7);
    add_scale(cases, stage, scene, Method::kNoise, 1.3);
    add_scale(cases, stage, scene, Method::kNoiseOffset, 1.6);
    add_resolve(cases, stage, scene, 5);
    add_reprojected(cases, stage, scene, 9, "", 12);
    if (colour != PixelFormat::kRGBA16F) continue;
    add_velocity(cases, stage, scene);
    add_blurs(cases, stage, scene);
    add_reprojected(cases, stage, scene, 9, " still", 0);
    add_temporal(cases, stage, scene, 10, "", TemporalPreset::kFast, -3.6);
    add_temporal(cases, stage, scene, 18, "", TemporalPreset::kBalanced, -3.6);
    add_temporal(cases, stage, scene, 35, "", TemporalPreset::kQuality, -3.6);
    add_temporal(cases, stage, scene, 10, " apart", TemporalPreset::kFast, -3.6, true);
    add_temporal(cases, stage, scene, 18, " apart", TemporalPreset::kBalanced, -3.6, true);
    add_temporal(cases, stage, scene, 0, " still", TemporalPreset::kBalanced, 0);
    scene.plan.settings.quincunx.sampling = Sampling::kPoint;
    add_resolve(cases, stage, scene, 5, " point");
    scene.plan.settings.quincunx.sampling = Sampling::kBilinear;
    scene.plan.settings.clamp_ringing = false;
    add_scale(cases, stage, scene, Method::kCatmullRom, 1.7, " unclamped");
    scene.plan.settings.clamp_ringing = true;
    scene.plan.reads_reactive = true;
    add_resolve(cases, stage, scene, 5, " reactive");
    scene.plan.settings.quincunx.residual_weight = 1;
    add_reprojected(cases, stage, scene, 0, " reactive residual", 12);
    scene.plan.settings.quincunx.residual_weight = 0;
    scene.plan.reads_reactive = false;
    scene.plan.velocity = VelocitySource::kNone;
    add_resolve(cases, stage, scene, 5, " still");
    scene.plan.velocity = VelocitySource::kTarget;
    scene.plan.settings.resolved = PixelFormat::kRGBA16F;
    add_scale(cases, stage, scene, Method::kBilinear, 1.1, " to half");
    add_resolve(cases, stage, scene, 5, " to half");
  }
}

void add_output_cases(std::vector<Case>& cases, Stage& stage) {
  add_sharpens(cases, stage);
  add_presents(cases, stage);
  add_clears(cases, stage);
}

}  // namespace quincunx::bench
