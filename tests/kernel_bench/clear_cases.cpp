// SPDX-License-Identifier: MIT
#include "clear_cases.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "pass_clear_region.h"
#include "quincunx_gl/handle.h"

namespace quincunx::bench {
namespace {

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
