// SPDX-License-Identifier: MIT
#include "window/frame_trace.h"

#include <algorithm>

namespace quincunx::scenes {
namespace {

constexpr double kNew = 0.1;  // weight of the newest frame in a running mean

// The first value stands for all before it.
void follow(double& mean, double value) {
  mean = mean == 0 ? value : mean + kNew * (value - mean);
}

}  // namespace

void FrameTrace::add(const FrameTimes& times, Extent output, double interval_ms, int dropped,
                     const std::string& method) {
  const FrameReport& report = times.report;
  TracePoint point = {.area = static_cast<double>(report.render.area()) / static_cast<double>(output.area()),
                      .draw_ms = times.draw_ms,
                      .cpu_ms = times.cpu_ms,
                      .interval_ms = interval_ms,
                      .dropped = dropped,
                      .method = method};
  std::vector<PassTime> passes;
  for (int i = 0; i < report.pass_count; ++i) {
    const PassReport& pass = report.passes[static_cast<std::size_t>(i)];
    const double ms = std::max(pass.ms, 0.0);
    point.opencl_ms += ms;
    const std::string name = name_of(pass);
    const auto known = std::find_if(passes_.begin(), passes_.end(),
                                    [&](const PassTime& time) { return time.kernel == name; });
    passes.push_back({name, known == passes_.end() ? 0 : known->ms});
    follow(passes.back().ms, ms);
  }
  passes_ = std::move(passes);
  follow(mean_.area, point.area);
  follow(mean_.draw_ms, point.draw_ms);
  follow(mean_.opencl_ms, point.opencl_ms);
  follow(mean_.cpu_ms, point.cpu_ms);
  follow(mean_.interval_ms, point.interval_ms);
  dropped_ += dropped;
  if (points_.size() == kLength) points_.erase(points_.begin());
  points_.push_back(point);
}

}  // namespace quincunx::scenes
