// SPDX-License-Identifier: MIT
#include "render/truth.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "render/gl_state.h"
#include "render/renderer_impl.h"

namespace quincunx::scenes {

TruthTargets::TruthTargets(gl::RenderTargets frame)
    : frame_(std::move(frame)),
      sum_(gl::Texture::create()),
      sum_framebuffer_(gl::Framebuffer::create()),
      nothing_(gl::VertexArray::create()) {
  gl::texture_storage(sum_.get(), 1, GL_RGBA32F, frame_.extent());
  gl::attach(sum_framebuffer_.get(), GL_COLOR_ATTACHMENT0, sum_.get());
}

Result<TruthTargets> TruthTargets::create(Extent output) {
  try {
    auto frame = gl::RenderTargets::create({output, false, false});
    if (!frame.ok()) return frame.status();
    TruthTargets targets(std::move(frame).value());
    if (gl::framebuffer_status(targets.sum_framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE) {
      return Status::device(
          "the driver refuses a framebuffer with an RGBA32F texture, which truth is summed up in");
    }
    Result<gl::Program> program = link_program("sky.vert.glsl", "accumulate.frag.glsl", {});
    if (!program.ok()) return program.status();
    targets.program_ = std::move(program).value();
    return targets;
  } catch (const std::runtime_error& error) {
    return Status::device(error.what());
  }
}

void TruthTargets::clear() {
  const float zero[] = {0, 0, 0, 0};
  gl::clear(sum_framebuffer_.get(), GL_COLOR, 0, zero);
}

void TruthTargets::add(float weight) {
  const DrawState state;
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, sum_framebuffer_.get());
  glViewport(0, 0, extent().width, extent().height);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBindVertexArray(nothing_.get());
  glUseProgram(program_.get());
  glProgramUniform1f(program_.get(), 0, weight);
  gl::bind_texture(0, frame_.colour());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::vector<float> TruthTargets::read() const {
  std::vector<float> pixels(static_cast<std::size_t>(frame_.extent().area()) * 4);
  gl::read_attachment(sum_framebuffer_.get(), GL_COLOR_ATTACHMENT0, frame_.extent(), GL_RGBA, GL_FLOAT,
                      pixels.data());
  return pixels;
}

namespace {

// A stride near the golden section of `count` and prime to it: neighbouring places get times far apart, and
// every row, column and block of places covers the shutter evenly (a rank-1 lattice).
int time_stride(int count) {
  constexpr double kGolden = 0.6180339887498949;
  int stride = std::max(1, static_cast<int>(std::lround(kGolden * count)));
  while (std::gcd(stride, count) != 1)
    ++stride;
  return stride;
}

Status check(const TruthSettings& settings) {
  constexpr int kMostSamples = 256;
  if (settings.output.width < 1 || settings.output.height < 1) {
    return Status::invalid(fmt::format("TruthSettings::output is {} x {}; it must be at least 1 x 1",
                                       settings.output.width, settings.output.height));
  }
  if (settings.samples < 1 || settings.samples > kMostSamples) {
    return Status::invalid(fmt::format("TruthSettings::samples is {}; it must lie between 1 and {}",
                                       settings.samples, kMostSamples));
  }
  if (!std::isfinite(settings.shutter_seconds) || settings.shutter_seconds < 0) {
    return Status::invalid("TruthSettings::shutter_seconds must be finite and not negative");
  }
  return {};
}

}  // namespace

Result<std::vector<float>> render_truth(Renderer& renderer, const TruthSettings& settings, double seconds) {
  if (Status status = check(settings); !status.ok()) return status;
  std::unique_ptr<TruthTargets>& targets = renderer.impl_->truth;
  if (!targets || targets->extent() != settings.output) {
    Result<TruthTargets> made = TruthTargets::create(settings.output);
    if (!made.ok()) return made.status();
    targets = std::make_unique<TruthTargets>(std::move(made).value());
  }
  const int n = settings.samples;
  const int count = n * n;
  const int stride = time_stride(count);
  targets->clear();
  for (int k = 0; k < count; ++k) {
    const auto place = [n](int i) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 0.5f; };
    const int moment = static_cast<int>(static_cast<long long>(k) * stride % count);
    FrameView view;
    view.render = settings.output;
    view.jitter = {place(k % n), place(k / n)};
    view.seconds = seconds - settings.shutter_seconds * (1 - (moment + 0.5) / count);
    view.previous_seconds = view.seconds;
    view.window = view.previous_window = settings.window;
    view.aspect = settings.aspect;
    view.lod_bias = -std::log2(static_cast<float>(n));
    if (Status status = renderer.draw(targets->frame(), view); !status.ok()) return status;
    targets->add(1.0f / static_cast<float>(count));
  }
  return targets->read();
}

}  // namespace quincunx::scenes
