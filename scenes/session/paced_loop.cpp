// SPDX-License-Identifier: MIT
#include "session/paced_loop.h"

#include <algorithm>
#include <ctime>
#include <string_view>
#include <thread>
#include <utility>

namespace quincunx::scenes {
namespace {

bool is_of_method(std::string_view kernel) {
  return kernel != "present" && kernel != "measure_content" && !kernel.starts_with("motion_");
}

// Time that this thread has computed; waiting for a device is none.
double thread_cpu_ms() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

}  // namespace

PassTimes pass_times(const FrameReport& report) {
  PassTimes times;
  for (const PassReport& pass : report.passes) {
    if (pass.ms < 0) return {};
    times.all_ms += pass.ms;
    if (is_of_method(pass.kernel)) times.method_ms += pass.ms;
  }
  return times;
}

Result<FrameMeter> FrameMeter::create(FrameCost cost, PassTimer passes) {
  const bool events = passes == PassTimer::kEvents;
  if (cost == FrameCost::kSpan || (cost == FrameCost::kAuto && !events)) return FrameMeter(std::nullopt);
  if (!events) {
    return Status::unsupported(
        "--frame-cost device needs OpenCL events that agree with the host's clock, and this device's do not; "
        "choose span or auto");
  }
  std::optional<gl::TimerMethod> method;
  if (cost == FrameCost::kDevice) method = gl::TimerMethod::kQuery;
  auto timer = gl::FrameTimer::create(method);
  if (!timer.ok()) return timer.status();
  if (timer->method() != gl::TimerMethod::kQuery) return FrameMeter(std::nullopt);
  return FrameMeter(std::move(timer).value());
}

std::string FrameMeter::method() const {
  return measures_device() ? "GL_TIME_ELAPSED of the drawing and OpenCL events of the passes"
                           : "host clock, from a frame's beginning until its picture is complete";
}

void FrameMeter::begin(std::uint64_t frame, Extent render) {
  if (timer_) timer_->begin(frame, render);
}

void FrameMeter::end() {
  if (timer_) timer_->end();
}

void FrameMeter::add(const FrameReport& report) {
  const PassTimes times = pass_times(report);
  if (timer_ && times.all_ms > 0)
    cl_.push_back({report.frame_index, times.all_ms, times.method_ms, report.content});
}

std::optional<FrameMeter::Cost> FrameMeter::next() {
  if (!timer_) return std::nullopt;
  while (auto timed = timer_->poll())
    gl_.push_back({timed->frame, timed->gpu_ms, 0, {}});
  while (!gl_.empty() && !cl_.empty() && gl_.front().frame != cl_.front().frame) {
    std::deque<Cost>& older = gl_.front().frame < cl_.front().frame ? gl_ : cl_;
    older.pop_front();
  }
  if (gl_.empty() || cl_.empty()) return std::nullopt;
  Cost cost = cl_.front();
  cost.ms += gl_.front().ms;
  gl_.pop_front();
  cl_.pop_front();
  return cost;
}

Result<PacedLoop> PacedLoop::create(FramePacing pacing, FrameCost cost, PassTimer passes) {
  auto meter = FrameMeter::create(cost, passes);
  if (!meter.ok()) return meter.status();
  return PacedLoop(std::move(pacing), std::move(meter).value());
}

double PacedLoop::now_ms() const {
  return tools::ms_since(start_);
}

bool PacedLoop::ready() const {
  const auto free_at = pacing_.free_at();
  return free_at && *free_at <= now_ms();
}

void PacedLoop::wait() const {
  const auto free_at = pacing_.free_at();
  if (!free_at) return;
  const double wait_ms = *free_at - now_ms();
  if (wait_ms > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(wait_ms));
}

void PacedLoop::begin_frame(Extent render, double blur_px, int detail) {
  cpu_at_begin_ms_ = thread_cpu_ms();
  const std::uint64_t frame = pacing_.begin(now_ms(), render, blur_px, detail);
  meter_.begin(frame, render);
}

void PacedLoop::end_draw() {
  meter_.end();
  cpu_ms_.push_back(thread_cpu_ms() - cpu_at_begin_ms_);
}

void PacedLoop::finish_frame() {
  const std::uint64_t frame = pacing_.run().frames.size();
  pacing_.finish(frame, now_ms(), cpu_ms_.empty() ? 0 : cpu_ms_.front());
  if (!cpu_ms_.empty()) cpu_ms_.pop_front();
}

void PacedLoop::add(const FrameReport& report) {
  if (!meter_.measures_device()) {
    pacing_.observe(report.frame_index,
                    {pacing_.busy_ms(report.frame_index), pass_times(report).method_ms, report.content});
    return;
  }
  meter_.add(report);
  while (const auto cost = meter_.next())
    pacing_.observe(cost->frame, {cost->ms, cost->method_ms, cost->content});
}

tools::PacingRun PacedLoop::run() const {
  tools::PacingRun run = pacing_.run();
  run.measured_by = meter_.method();
  run.reasons = pacing_.reasons();
  return run;
}

}  // namespace quincunx::scenes
