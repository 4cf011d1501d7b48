// SPDX-License-Identifier: MIT
#include "programs/paced_loop.h"

#include <ctime>
#include <thread>
#include <utility>

namespace quincunx::scenes {
namespace {

// Time that this thread has computed; waiting for a device is none.
double thread_cpu_ms() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

}  // namespace

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
