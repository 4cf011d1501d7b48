// SPDX-License-Identifier: MIT
#include "quincunx_gl/frame_timer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <utility>

#include "fence.h"
#include "quincunx/advanced/log.h"
#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"
#include "state_scope.h"

namespace quincunx::gl {
namespace {

constexpr double kLeastMs = 1e-6;  // work of none may come back as 0, which no controller takes

constexpr const char* kCoveringSource = R"(#version 310 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); })";

constexpr const char* kFragmentSource = R"(#version 310 es
precision highp float;
layout(location = 0) out vec4 colour;
void main() { colour = vec4(sin(gl_FragCoord.xy), 0.25, 0.5); })";

// Makes a program whose three vertices, drawn as triangles without any attribute, cover the viewport.
Program covering_program() {
  Program program = Program::create();
  for (const auto& [stage, source] :
       {std::pair{GL_VERTEX_SHADER, kCoveringSource}, {GL_FRAGMENT_SHADER, kFragmentSource}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) throw InteropError("the frame timer's program does not link");
  return program;
}

// Blended layers in one target, like a frame: each needs the one below, so that no driver can leave one out.
class KnownLoad {
 public:
  KnownLoad() : program_(covering_program()) {
    texture_storage(texture_.get(), 1, GL_RGBA16F, {kSide, kSide});
    attach(framebuffer_.get(), GL_COLOR_ATTACHMENT0, texture_.get());
    state_.emplace(framebuffer_.get(), program_.get(), vertex_array_.get(), kSide);
  }

  void draw(int layers) const {
    for (int layer = 0; layer < layers; ++layer)
      glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  static constexpr GLint kSide = 256;
  Program program_;
  Texture texture_ = Texture::create();
  Framebuffer framebuffer_ = Framebuffer::create();
  VertexArray vertex_array_ = VertexArray::create();
  std::optional<DrawScope> state_;  // ends first
};

double query_ms(GLuint query) {
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
  return static_cast<double>(nanoseconds) * 1e-6;
}

// Returns whether something, a change of the clock for example, has made the times since the last look worthless.
// OpenGL ES asks its callers to look (GL_EXT_disjoint_timer_query).
bool times_are_disjoint() {
  if (capabilities().api != Api::kEs3) return false;
  GLint disjoint = 0;
  glGetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
  return disjoint != 0;
}

// The times of a load, ms.
struct LoadTimes {
  double host = 0;
  double query = 0;
};

LoadTimes time_load(const KnownLoad& load, GLuint query, int layers) {
  glFinish();
  const Stopwatch stopwatch;
  glBeginQuery(GL_TIME_ELAPSED, query);
  load.draw(layers);
  glEndQuery(GL_TIME_ELAPSED);
  Fence fence;
  fence.set();
  fence.wait();
  const double host = stopwatch.milliseconds();
  return {host, query_ms(query)};
}

// Returns whether a query sees a load grow as the host's clock does.
bool grow_alike(const LoadTimes& light, const LoadTimes& heavy) {
  constexpr double kLeastAgreement = 0.7;
  constexpr double kMostAgreement = 1.2;
  const double grown = heavy.host - light.host;
  const double seen = heavy.query - light.query;
  log_line(
      LogLevel::kDebug,
      fmt::format("frame timer: a known load grew by {:.2f} ms, by GL_TIME_ELAPSED {:.2f} ms", grown, seen));
  // llvmpipe may answer with the time since the machine started: then only differences are right.
  const bool plausible =
      heavy.query <= kMostAgreement * heavy.host && light.query <= kMostAgreement * light.host;
  return plausible && grown > 0 && seen >= kLeastAgreement * grown && seen <= kMostAgreement * grown;
}

// Returns whether queries do so each time: where other programs run, wrong ones agree now and then by chance.
bool queries_agree() {
  const ErrorScope callers;
  constexpr double kEnoughMs = 8;  // least load, beside which submission and waking up are small
  constexpr int kMostLayers = 1 << 16;
  constexpr int kTimes = 4;
  const KnownLoad load;
  const TimeQuery query = TimeQuery::create();
  if (!query) return false;
  int layers = 4;
  while (time_load(load, query.get(), layers).host < kEnoughMs && layers < kMostLayers)
    layers *= 2;
  for (int i = 0; i < kTimes; ++i) {
    const LoadTimes heavy = time_load(load, query.get(), layers);
    if (!grow_alike(time_load(load, query.get(), layers / 4), heavy)) return false;
  }
  return true;
}

// Returns why queries are not to be used, "" where they are.
const char* fault_of_queries() {
  if (!capabilities().time_queries) return "the OpenGL ES context has no GL_EXT_disjoint_timer_query";
  GLint active = 0;
  glGetQueryiv(GL_TIME_ELAPSED, GL_CURRENT_QUERY, &active);
  if (active != 0) return "a query of the caller's is active, so that none could be tried";
  return queries_agree() ? "" : "GL_TIME_ELAPSED does not agree with them on a known load";
}

// A name becomes a query when it is first used, so it may be one of any kind.
TimeQuery stamp_query() {
  GLuint name = 0;
  glGenQueries(1, &name);
  return TimeQuery::adopt(name);
}

}  // namespace

struct FrameTimer::Impl {
  struct Slot {
    TimedFrame frame;
    TimeQuery query;
    Fence fence;
    double begun_ms = 0;
  };

  TimerMethod method = TimerMethod::kFence;
  std::array<Slot, kRing> slots;
  std::size_t first = 0;  // the oldest under way
  std::size_t count = 0;
  bool open = false;
  double last_done_ms = 0;
  Stopwatch clock;

  bool done(const Slot& slot) const {
    if (method == TimerMethod::kFence) return slot.fence.done();
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(slot.query.get(), GL_QUERY_RESULT_AVAILABLE, &available);
    return available != GL_FALSE;
  }
};

FrameTimer::FrameTimer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameTimer::~FrameTimer() = default;
FrameTimer::FrameTimer(FrameTimer&&) noexcept = default;
FrameTimer& FrameTimer::operator=(FrameTimer&&) noexcept = default;

Result<FrameTimer> FrameTimer::create(std::optional<TimerMethod> method) try {
  auto impl = std::make_unique<Impl>();
  if (!method) {
    const char* fault = fault_of_queries();
    method = *fault == '\0' ? TimerMethod::kQuery : TimerMethod::kFence;
    log_line(LogLevel::kInfo, *fault == '\0' ? "frame timer: GL_TIME_ELAPSED"
                                             : fmt::format("frame timer: fences ({})", fault));
  }
  impl->method = *method;
  for (Impl::Slot& slot : impl->slots) {
    if (*method != TimerMethod::kQuery) break;
    slot.query = TimeQuery::create();
    if (!slot.query) return Status::device("OpenGL made no GL_TIME_ELAPSED query");
  }
  return FrameTimer(std::move(impl));
} catch (const std::exception& error) {
  return Status::device(error.what());
}

TimerMethod FrameTimer::method() const {
  return impl_->method;
}

bool FrameTimer::begin(std::uint64_t frame, Extent render) {
  if (impl_->open || impl_->count == impl_->slots.size()) return false;
  Impl::Slot& slot = impl_->slots[(impl_->first + impl_->count) % impl_->slots.size()];
  slot.frame = {.frame = frame, .render_extent = render, .gpu_ms = 0};
  slot.begun_ms = impl_->clock.milliseconds();
  if (impl_->method == TimerMethod::kQuery) glBeginQuery(GL_TIME_ELAPSED, slot.query.get());
  impl_->open = true;
  return true;
}

void FrameTimer::end() {
  if (!impl_->open) return;
  Impl::Slot& slot = impl_->slots[(impl_->first + impl_->count) % impl_->slots.size()];
  if (impl_->method == TimerMethod::kQuery) {
    glEndQuery(GL_TIME_ELAPSED);
  } else {
    slot.fence.set();
  }
  impl_->open = false;
  ++impl_->count;
}

std::optional<TimedFrame> FrameTimer::poll() try {
  if (impl_->count == 0) return std::nullopt;
  Impl::Slot& slot = impl_->slots[impl_->first];
  if (!impl_->done(slot)) return std::nullopt;
  TimedFrame result = slot.frame;
  bool lost = false;
  if (impl_->method == TimerMethod::kQuery) {
    result.gpu_ms = query_ms(slot.query.get());
    lost = times_are_disjoint();
  } else {
    const double now = impl_->clock.milliseconds();
    result.gpu_ms = now - std::max(slot.begun_ms, impl_->last_done_ms);
    impl_->last_done_ms = now;
  }
  result.gpu_ms = std::max(result.gpu_ms, kLeastMs);
  impl_->first = (impl_->first + 1) % impl_->slots.size();
  --impl_->count;
  return lost ? poll() : result;
} catch (const std::exception&) {
  return std::nullopt;
}

struct PartTimer::Impl {
  struct Slot {
    TimedFrame part;
    TimeQuery begun, done;
  };

  TimerMethod method = TimerMethod::kFence;
  int every = 1;
  std::uint64_t parts = 0;  // begun so far, timed or not
  std::array<Slot, kRing> slots;
  std::size_t first = 0;  // the oldest under way
  std::size_t count = 0;
  bool open = false;
  std::optional<Stopwatch> watch;

  Slot& next() { return slots[(first + count) % slots.size()]; }
};

PartTimer::PartTimer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PartTimer::~PartTimer() = default;
PartTimer::PartTimer(PartTimer&&) noexcept = default;
PartTimer& PartTimer::operator=(PartTimer&&) noexcept = default;

Result<PartTimer> PartTimer::create(TimerMethod method, int every) try {
  if (every < 1) return Status::invalid(fmt::format("every is {}; it must be at least 1", every));
  auto impl = std::make_unique<Impl>();
  impl->method = method;
  impl->every = method == TimerMethod::kFence ? every : 1;
  for (Impl::Slot& slot : impl->slots) {
    if (method != TimerMethod::kQuery) break;
    slot.begun = stamp_query();
    slot.done = stamp_query();
    if (!slot.begun || !slot.done) return Status::device("OpenGL made no query for a time stamp");
  }
  return PartTimer(std::move(impl));
} catch (const std::exception& error) {
  return Status::device(error.what());
}

void PartTimer::begin(std::uint64_t frame, Extent extent) {
  const bool timed = impl_->parts++ % static_cast<std::uint64_t>(impl_->every) == 0;
  if (!timed || impl_->open || impl_->count == impl_->slots.size()) return;
  Impl::Slot& slot = impl_->next();
  slot.part = {.frame = frame, .render_extent = extent, .gpu_ms = 0};
  impl_->open = true;
  if (impl_->method == TimerMethod::kQuery) {
    glQueryCounter(slot.begun.get(), GL_TIMESTAMP);
    return;
  }
  glFinish();
  impl_->watch.emplace();
}

void PartTimer::end() {
  if (!impl_->open) return;
  Impl::Slot& slot = impl_->next();
  if (impl_->method == TimerMethod::kQuery) {
    glQueryCounter(slot.done.get(), GL_TIMESTAMP);
  } else {
    glFinish();
    slot.part.gpu_ms = impl_->watch->milliseconds();
  }
  impl_->open = false;
  ++impl_->count;
}

std::optional<TimedFrame> PartTimer::poll() {
  if (impl_->count == 0) return std::nullopt;
  Impl::Slot& slot = impl_->slots[impl_->first];
  if (impl_->method == TimerMethod::kQuery) {
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(slot.done.get(), GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return std::nullopt;
    slot.part.gpu_ms = query_ms(slot.done.get()) - query_ms(slot.begun.get());
  }
  impl_->first = (impl_->first + 1) % impl_->slots.size();
  --impl_->count;
  TimedFrame result = slot.part;
  result.gpu_ms = std::max(result.gpu_ms, kLeastMs);
  return result;
}

}  // namespace quincunx::gl
