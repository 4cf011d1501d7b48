// SPDX-License-Identifier: MIT
#include "programs/frame_meter.h"

#include <algorithm>
#include <string_view>

namespace quincunx::scenes {
namespace {

bool is_of_method(std::string_view kernel) {
  return kernel != "present" && kernel != "measure_content" && !kernel.starts_with("motion_");
}

}  // namespace

PassTimes pass_times(const FrameReport& report) {
  PassTimes times;
  for (int i = 0; i < report.pass_count; ++i) {
    const PassReport& pass = report.passes[static_cast<std::size_t>(i)];
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

}  // namespace quincunx::scenes
