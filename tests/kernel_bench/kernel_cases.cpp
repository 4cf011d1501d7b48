// SPDX-License-Identifier: MIT
#include "kernel_cases.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "passes/pass_chain.h"
#include "passes/pass_clear_region.h"
#include "quincunx_gl/handle.h"

namespace quincunx::bench {
namespace {

// Two frames at one scale, and what is planned for them: no transparents, and nothing but the resolved picture.
struct Scene {
  std::string suffix;  // " 0.71 half"
  double scale = 1;
  SceneNeeds needs = {.transparents = false};
  ResolveSettings settings;
  FrameInputs current, previous;
  // What sharpen and motion_blur read; the service's own memory holds nothing yet.
  ImageView unsharpened = {}, resolved = {};
};

Scene scene_of(Stage& stage, double scale, PixelFormat colour) {
  const Extent render = scaled(stage.output(), scale);
  Scene scene;
  scene.suffix = fmt::format(" {:.2f} {}", scale, colour == PixelFormat::kRGBA16F ? "half" : "float");
  scene.scale = scale;
  scene.settings = {.method = Method::kQuincunx,
                    .output_extent = stage.output(),
                    .target_extent = render,
                    .colour = colour,
                    .output = {.present = false}};
  scene.current = stage.frame(render, colour, .25f, 0);
  scene.previous = stage.frame(render, colour, -.25f, 1);
  return scene;
}

// Times the passes of these kernels, in this order, on what the scene and the outputs bind.
void add_passes(std::vector<Case>& cases, Stage& stage, Case what, const Scene& scene,
                const FrameOutputs& outputs, const std::vector<std::string>& kernels) {
  auto chain = std::make_shared<PassChain>(stage.device(), PlanFacts(scene.needs, scene.settings));
  std::vector<Pass*> passes;
  for (const std::string& kernel : kernels) {
    passes.push_back(chain->find(kernel));
    if (passes.back() == nullptr) throw std::logic_error("the plan has no pass " + kernel);
    what.bytes += bytes_of(passes.back()->spec(), largest_extents(scene.settings));
  }
  if (Pass* const exposure = chain->find("exposure"); exposure != nullptr)
    PassChain::enqueue(*exposure, chain->frame(scene.current, &scene.previous, outputs, stage.counter()),
                       nullptr);
  Stage::add(
      cases, std::move(what),
      [chain, passes, &stage, outputs, scene](cl::Event* events) {
        PassFrame frame = chain->frame(scene.current, &scene.previous, outputs, stage.counter());
        if (scene.unsharpened) frame[Resource::kUnsharpened] = scene.unsharpened;
        if (scene.resolved) frame[Resource::kResolved] = scene.resolved;
        for (Pass* pass : passes)
          PassChain::enqueue(*pass, frame, events++);
      },
      static_cast<int>(passes.size()));
}

// Frames of a scene, each with the history and the jitter that follow those of the one before.
class Run {
 public:
  Run(Stage& stage, Scene scene)
      : stage_(stage),
        scene_(std::move(scene)),
        chain_(stage.device(), PlanFacts(scene_.needs, scene_.settings)),
        outputs_{.linear = stage.noise(stage.output(), scene_.settings.output.linear)} {}

  FrameReport next(cl::Event* events) {
    scene_.previous.jitter = scene_.current.jitter;
    scene_.current.jitter = jitter(index_, scene_.current.render_extent, stage_.output());
    const FrameInputs* const previous = index_++ > 0 ? &scene_.previous : nullptr;
    FrameReport report;
    chain_.run(chain_.frame(scene_.current, previous, outputs_, stage_.counter()), outputs_, report, events);
    return report;
  }

 private:
  Stage& stage_;
  Scene scene_;
  PassChain chain_;
  FrameOutputs outputs_;
  std::uint64_t index_ = 0;
};

// Times whole frames, after a cycle of the jitter, by which history is known as well as it is while a game runs.
void add_frames(std::vector<Case>& cases, Stage& stage, Case what, const Scene& scene) {
  auto run = std::make_shared<Run>(stage, scene);
  FrameReport report;
  for (int i = 0; i <= jitter_phases(scene.current.render_extent, stage.output()); ++i)
    report = run->next(nullptr);
  for (const PassReport& pass : report.passes)
    what.bytes += pass.bytes;
  Stage::add(
      cases, std::move(what), [run](cl::Event* events) { static_cast<void>(run->next(events)); },
      static_cast<int>(report.passes.size()));
}

void add_scale(std::vector<Case>& cases, Stage& stage, Scene scene, Method method, double wanted,
               const std::string& suffix = {}) {
  scene.settings.method = method;
  std::string kernel;
  for (const PassSpec& spec : list_passes(PlanFacts(scene.needs, scene.settings)).passes) {
    const bool is_wider = widens(scene.current.render_extent, stage.output());
    if (spec.viewports == Viewports::kAll || (spec.viewports == Viewports::kWider) == is_wider)
      kernel = spec.kernel;
  }
  const bool filters = kernel == "scale_filter";
  // A filter's kernel serves several methods, so both are named.
  const std::string name = filters ? fmt::format("{} {}", kernel, name_of(method)) : kernel;
  add_passes(cases, stage, {.name = name + scene.suffix + suffix, .scale = scene.scale, .wanted = wanted},
             scene, {.linear = stage.noise(stage.output(), scene.settings.output.linear)}, {kernel});
}

void add_resolve(std::vector<Case>& cases, Stage& stage, const Scene& scene, double wanted,
                 const std::string& suffix = {}) {
  add_passes(cases, stage,
             {.name = "resolve_quincunx" + scene.suffix + suffix, .scale = scene.scale, .wanted = wanted},
             scene, {.linear = stage.noise(stage.output(), scene.settings.output.linear)},
             {"resolve_quincunx"});
}

// Both kernels, or where nothing moves the second alone.
void add_reprojected(std::vector<Case>& cases, Stage& stage, Scene scene, double wanted,
                     const std::string& suffix, double pixels) {
  scene.settings.quincunx.form = TwoFrameForm::kReprojected;
  scene.settings.velocity = PixelFormat::kRG32F;
  scene.needs.moving_objects = pixels != 0;
  scene.needs.camera_motion = pixels != 0;
  scene.current.velocity = stage.velocity(scene.current.render_extent, [&](int x, int y) {
    // Surfaces of some size that move apart.
    const bool odd = (x / 97 + y / 83) % 2 != 0;
    return static_cast<float>((odd ? pixels : -.3 * pixels) / stage.output().width);
  });
  scene.previous.velocity = scene.current.velocity;
  std::vector<std::string> kernels = {"resolve_reprojected"};
  if (pixels != 0) kernels.insert(kernels.begin(), "reproject");
  add_passes(cases, stage,
             {.name = "resolve_reprojected" + scene.suffix + suffix, .scale = scene.scale, .wanted = wanted},
             scene, {.linear = stage.noise(stage.output(), scene.settings.output.linear)}, kernels);
}

// All kernels; everything moves by `pixels`, or if surfaces move `apart`, those of the case above. As these
// stay where they are, what flows through them has many phases, more than surfaces that move would leave.
void add_temporal(std::vector<Case>& cases, Stage& stage, Scene scene, double wanted,
                  const std::string& suffix, TemporalPreset preset, double pixels, bool apart = false) {
  scene.settings.method = Method::kTemporal;
  scene.settings.temporal.preset = preset;
  scene.settings.velocity = PixelFormat::kRG32F;
  scene.current.velocity = stage.velocity(scene.current.render_extent, [&](int x, int y) {
    const bool odd = apart && (x / 97 + y / 83) % 2 != 0;
    return static_cast<float>((odd ? -pixels / .3 : pixels) / stage.output().width);
  });
  // A wall of one colour: whatever moves, history agrees with the frame.
  scene.current.colour = stage.constant(scene.current.render_extent, scene.settings.colour);
  scene.current.depth = stage.constant(scene.current.render_extent, PixelFormat::kR32F);
  scene.previous = scene.current;
  add_frames(cases, stage,
             {.name = fmt::format("temporal:{}{}{}", name_of(preset), scene.suffix, suffix),
              .scale = scene.scale,
              .wanted = wanted},
             scene);
}

void add_velocity(std::vector<Case>& cases, Stage& stage, Scene scene) {
  scene.needs.moving_objects = false;
  add_passes(cases, stage, {.name = "velocity_from_depth" + scene.suffix, .scale = scene.scale}, scene, {},
             {"velocity_from_depth"});
}

// Fills one of two frames of the same wall, which differ in which half of their noise is shaded. `pixels`: how far it
// moves over the output; where surfaces move `apart`, blocks of it against each other.
void add_checkerboard(std::vector<Case>& cases, Stage& stage, Scene scene, double wanted,
                      const std::string& suffix, double pixels, bool apart = false) {
  scene.settings.method = Method::kBilinear;
  scene.settings.targets.shading = Shading::kCheckerboard;
  scene.settings.velocity = PixelFormat::kRG32F;
  scene.needs.moving_objects = scene.needs.camera_motion = pixels != 0;
  scene.current.velocity = stage.velocity(scene.current.render_extent, [&](int x, int y) {
    const bool odd = apart && (x / 97 + y / 83) % 2 != 0;
    return static_cast<float>((odd ? -pixels / .3 : pixels) / stage.output().width);
  });
  scene.previous.velocity = scene.current.velocity;
  scene.current.depth = scene.previous.depth =
      stage.constant(scene.current.render_extent, PixelFormat::kR32F);
  scene.current.parity = 1;
  auto chain = std::make_shared<PassChain>(stage.device(), PlanFacts(scene.needs, scene.settings));
  Pass* const pass = chain->find("resolve_checkerboard");
  const FrameOutputs outputs{.linear = stage.noise(stage.output(), scene.settings.output.linear)};
  FrameReport unused;  // report of the frame that leaves its history
  chain->run(chain->frame(scene.previous, nullptr, outputs, stage.counter()), outputs, unused, nullptr);
  Stage::add(cases,
             {.name = "resolve_checkerboard" + scene.suffix + suffix,
              .scale = scene.scale,
              .wanted = wanted,
              .bytes = bytes_of(pass->spec(), largest_extents(scene.settings))},
             [chain, pass, &stage, outputs, scene](cl::Event* events) {
               PassChain::enqueue(
                   *pass, chain->frame(scene.current, &scene.previous, outputs, stage.counter()), events);
             });
}

// All three kernels of the blur. `pixels`: how far a sample moves over the output while the shutter is open.
void add_blur(std::vector<Case>& cases, Stage& stage, Scene scene, double wanted, const std::string& suffix,
              const std::function<double(int x, int y)>& pixels) {
  scene.settings.blur.shutter = 1;
  scene.settings.velocity = PixelFormat::kRG32F;
  scene.current.velocity = stage.velocity(scene.current.render_extent, [&](int x, int y) {
    return static_cast<float>(pixels(x, y) / stage.output().width);
  });
  scene.resolved = stage.noise(stage.output(), scene.settings.output.linear, 1);
  add_passes(cases, stage,
             {.name = "motion_blur" + scene.suffix + suffix, .scale = scene.scale, .wanted = wanted}, scene,
             {.linear = stage.noise(stage.output(), scene.settings.output.linear)},
             {"motion_tiles", "motion_neighbours", "motion_blur"});
}

void add_blurs(std::vector<Case>& cases, Stage& stage, const Scene& scene) {
  add_blur(cases, stage, scene, 1.2, " still", [](int, int) { return 0; });
  add_blur(cases, stage, scene, 11, " all moving", [](int, int) { return 24; });
  // Bars that move against each other, so that every tile needs depth.
  add_blur(cases, stage, scene, 0, " mixed", [](int x, int) { return x / 24 % 2 == 0 ? 24 : -8; });
}

void add_sharpens(std::vector<Case>& cases, Stage& stage) {
  for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    Scene scene = scene_of(stage, 1, PixelFormat::kRGBA16F);
    scene.settings.output.linear = resolved;
    scene.settings.sharpness = .5f;
    scene.unsharpened = stage.noise(stage.output(), resolved, 1);
    add_passes(cases, stage,
               {.name = fmt::format("sharpen {}", resolved == PixelFormat::kRGBA32F ? "float" : "half"),
                .wanted = 2},
               scene, {.linear = stage.noise(stage.output(), resolved)}, {"sharpen"});
  }
}

void add_presents(std::vector<Case>& cases, Stage& stage) {
  for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
      Scene scene = scene_of(stage, 1, PixelFormat::kRGBA16F);
      scene.settings.output.linear = resolved;
      scene.settings.output.tone_map = tone_map;
      scene.settings.output.present = true;
      add_passes(cases, stage,
                 {.name = fmt::format("present {} {}", name_of(tone_map),
                                      resolved == PixelFormat::kRGBA32F ? "float" : "half"),
                  .wanted = 1.2},
                 scene,
                 {.linear = stage.noise(stage.output(), resolved),
                  .presented = stage.noise(stage.output(), PixelFormat::kRGBA8)},
                 {"present"});
    }
  }
}

void add_clears(std::vector<Case>& cases, Stage& stage) {
  add_clear(cases, stage, PixelFormat::kRGBA16F, stage.output(),
            {.name = "clear_region RGBA16F", .wanted = 0.4});
  add_clear(cases, stage, PixelFormat::kRG16F, stage.output(), {.name = "clear_region RG16F", .wanted = 0.4});
}

constexpr double kAimOfColour = 0.4;  // times the copy, of the whole area

std::uint64_t bytes_of_both(Extent extent) {
  return bytes_of(extent, PixelFormat::kRGBA16F) + bytes_of(extent, PixelFormat::kRG16F);
}

// GL's colour and velocity targets.
class Targets {
 public:
  explicit Targets(Extent extent) {
    glTextureStorage2D(colour_.get(), 1, GL_RGBA16F, extent.width, extent.height);
    glTextureStorage2D(velocity_.get(), 1, GL_RG16F, extent.width, extent.height);
    glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, colour_.get(), 0);
    glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT1, velocity_.get(), 0);
    const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(framebuffer_.get(), 2, attachments);
    if (glCheckNamedFramebufferStatus(framebuffer_.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("GL cannot draw to RGBA16F and RG16F targets");
  }

  void clear_whole() const {
    const GLfloat black[] = {0, 0, 0, 1};
    glClearNamedFramebufferfv(framebuffer_.get(), GL_COLOR, 0, black);
    glClearNamedFramebufferfv(framebuffer_.get(), GL_COLOR, 1, black);
    finish();
  }

  void clear(Extent render) const {
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, render.width, render.height);
    clear_whole();
    glDisable(GL_SCISSOR_TEST);
  }

 private:
  static void finish() {
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, ~GLuint64{0});
    glDeleteSync(fence);
  }

  gl::Texture colour_ = gl::Texture::create();
  gl::Texture velocity_ = gl::Texture::create();
  gl::Framebuffer framebuffer_ = gl::Framebuffer::create();
};

// One kernel for each target.
void add_kernel(std::vector<Case>& cases, Stage& stage, double scale) {
  const Extent render = scaled(stage.output(), scale);
  const auto add = [&](PixelFormat format, double wanted) {
    const std::string name = fmt::format("clear_region {:.1f} {}", scale, name_of(format));
    add_clear(cases, stage, format, render, {.name = name, .scale = scale, .wanted = wanted});
  };
  add(PixelFormat::kRGBA16F, kAimOfColour * scale * scale);
  add(PixelFormat::kRG16F, 0);
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
    add_checkerboard(cases, stage, scene, 5, "", -3.6);
    if (colour != PixelFormat::kRGBA16F) continue;
    add_checkerboard(cases, stage, scene, 3, " still", 0);
    add_checkerboard(cases, stage, scene, 5, " apart", -3.6, true);
    add_velocity(cases, stage, scene);
    add_blurs(cases, stage, scene);
    add_reprojected(cases, stage, scene, 9, " still", 0);
    add_temporal(cases, stage, scene, 10, "", TemporalPreset::kFast, -3.6);
    add_temporal(cases, stage, scene, 18, "", TemporalPreset::kBalanced, -3.6);
    add_temporal(cases, stage, scene, 35, "", TemporalPreset::kQuality, -3.6);
    add_temporal(cases, stage, scene, 10, " apart", TemporalPreset::kFast, -3.6, true);
    add_temporal(cases, stage, scene, 18, " apart", TemporalPreset::kBalanced, -3.6, true);
    add_temporal(cases, stage, scene, 0, " still", TemporalPreset::kBalanced, 0);
    scene.settings.quincunx.sampling = Sampling::kPoint;
    add_resolve(cases, stage, scene, 5, " point");
    scene.settings.quincunx.sampling = Sampling::kBilinear;
    scene.settings.filter.clamp_ringing = false;
    add_scale(cases, stage, scene, Method::kCatmullRom, 1.7, " unclamped");
    scene.settings.filter.clamp_ringing = true;
    scene.needs.transparents = true;
    add_resolve(cases, stage, scene, 5, " reactive");
    scene.settings.quincunx.residual_weight = 1;
    add_reprojected(cases, stage, scene, 0, " reactive residual", 12);
    scene.settings.quincunx.residual_weight = 0;
    scene.needs.transparents = false;
    scene.needs.moving_objects = scene.needs.camera_motion = false;
    add_resolve(cases, stage, scene, 5, " still");
    scene.needs.moving_objects = scene.needs.camera_motion = true;
    scene.settings.output.linear = PixelFormat::kRGBA16F;
    add_scale(cases, stage, scene, Method::kBilinear, 1.1, " to half");
    add_resolve(cases, stage, scene, 5, " to half");
  }
}

void add_output_cases(std::vector<Case>& cases, Stage& stage) {
  add_sharpens(cases, stage);
  add_presents(cases, stage);
  add_clears(cases, stage);
}

void add_clear(std::vector<Case>& cases, Stage& stage, PixelFormat format, Extent render, Case what) {
  struct Clear {
    Clear(Stage& stage, PixelFormat format)
        : facts({}, {}),
          tables(stage.impl(), {{1, 1}, {1, 1}, {1, 1}}),
          pass({stage.impl(), facts, tables},
               clear_region_spec(Storage::kBuffer, Resource::kColour, format)) {}

    PlanFacts facts;
    PassTables tables;
    ClearRegionPass pass;
  };
  auto clear = std::make_shared<Clear>(stage, format);
  what.bytes = bytes_of(render, format);
  Stage::add(cases, std::move(what),
             [clear, &stage, render, image = stage.noise(stage.output(), format)](cl::Event* event) {
               const float value[4] = {0, 0, 0, 1};
               clear->pass.clear({.queue = stage.impl().queue, .tables = clear->tables}, image, render, value,
                                 event);
             });
}

void add_clear_cases(std::vector<Case>& cases, Stage& stage, bool opengl) {
  constexpr double kScales[] = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
  for (const double scale : kScales)
    add_kernel(cases, stage, scale);
  if (!opengl) return;
  const auto targets = std::make_shared<Targets>(stage.output());
  const auto add = [&](const std::string& name, double scale, std::function<void()> run) {
    cases.push_back({.name = name,
                     .scale = scale,
                     .bytes = bytes_of_both(scaled(stage.output(), scale)),
                     .run = [run = std::move(run)] { return wall_ms(run); }});
  };
  add("GL clear, whole", 1, [targets] { targets->clear_whole(); });
  for (const double scale : kScales) {
    const Extent render = scaled(stage.output(), scale);
    add(fmt::format("GL clear {:.1f}, scissored", scale), scale,
        [targets, render] { targets->clear(render); });
  }
}

}  // namespace quincunx::bench
