// SPDX-License-Identifier: MIT
#include "bench/traces/replay.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/harness/measuring.h"

namespace quincunx::traces {
namespace {

// When things happened to a frame, in ms.
struct Moments {
  double cpu_ready = 0;
  double start = 0;
  double finish = 0;
  double flip = 0;
};

class Pipeline {
 public:
  explicit Pipeline(const Display& display) : buffers_(display.buffers), refresh_ms_(display.target_ms()) {}

  const Moments& draw(double gpu_ms, double cpu_ms) {
    const int frame = static_cast<int>(list_.size());
    Moments at;
    // The processor prepares one frame ahead of the one that is drawn.
    at.cpu_ready = std::max(past(1).cpu_ready, past(1).start) + cpu_ms;
    const double free = std::max(past(1).finish, frame >= buffers_ ? past(buffers_ - 1).flip : 0.0);
    at.start = std::max(free, at.cpu_ready);
    at.finish = at.start + gpu_ms;
    const double refresh = std::ceil(at.finish / refresh_ms_ - 1e-9) * refresh_ms_;
    at.flip = std::max(refresh, past(1).flip + refresh_ms_);
    list_.push_back(at);
    waited_for_cpu_ = at.cpu_ready > free + 1e-9;
    return list_.back();
  }

  // The finished frames that are not shown when frame `index` is finished, itself included.
  int queued(int index) const {
    int count = 0;
    for (int frame = index; frame >= 0; --frame) {
      if (list_[static_cast<std::size_t>(frame)].flip <= list_[static_cast<std::size_t>(index)].finish) break;
      ++count;
    }
    return count;
  }
  int dropped() const {
    if (list_.size() < 2) return 0;
    return static_cast<int>(std::lround((past(1).flip - past(2).flip) / refresh_ms_)) - 1;
  }
  double interval() const { return list_.size() < 2 ? 0 : past(1).start - past(2).start; }
  bool waited_for_cpu() const { return waited_for_cpu_; }

 private:
  // `back` = 1 is the last frame.
  const Moments& past(int back) const {
    static const Moments kBefore;
    const auto size = static_cast<int>(list_.size());
    return back > size ? kBefore : list_[static_cast<std::size_t>(size - back)];
  }

  int buffers_;
  double refresh_ms_;
  std::vector<Moments> list_;
  bool waited_for_cpu_ = false;
};

// Frames after `step` until the area stays within 5 % of its mean over the last quarter before the next step.
double settling(const std::vector<ReplayedFrame>& frames, int step, int end) {
  constexpr double kNear = 0.05;
  double mean = 0;
  const int quarter = std::max(1, (end - step) / 4);
  for (int frame = end - quarter; frame < end; ++frame)
    mean += frames[static_cast<std::size_t>(frame)].area;
  mean /= quarter;
  int settled = end;
  while (settled > step &&
         std::abs(frames[static_cast<std::size_t>(settled - 1)].area - mean) <= kNear * mean) {
    --settled;
  }
  return settled - step;
}

std::optional<double> mean_settling(const LoadTrace& trace, const std::vector<ReplayedFrame>& frames,
                                    const std::vector<int>& steps) {
  if (steps.empty()) return {};
  std::vector<int> all = trace.steps_up;
  all.insert(all.end(), trace.steps_down.begin(), trace.steps_down.end());
  all.push_back(static_cast<int>(frames.size()));
  std::sort(all.begin(), all.end());
  double sum = 0;
  for (const int step : steps)
    sum += settling(frames, step, *std::upper_bound(all.begin(), all.end(), step));
  return sum / static_cast<double>(steps.size());
}

FrameTiming timing_of(const std::vector<ReplayedFrame>& frames, int index, int missed) {
  const ReplayedFrame& frame = frames[static_cast<std::size_t>(index)];
  return {.frame = static_cast<std::uint64_t>(index),
          .next_frame = frames.size(),
          .render_extent = frame.render,
          .gpu_ms = frame.gpu_ms,
          .cpu_ms = frame.cpu_ms,
          .interval_ms = frame.interval_ms,
          .queued = frame.queued,
          .missed_vsyncs = missed};
}

}  // namespace

double largest_area(const ResolutionLadder& ladder, const std::function<bool(double area)>& fits) {
  int low = 0;
  int high = ladder.top();
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (fits(ladder.area_fraction(middle))) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return ladder.area_fraction(low);
}

std::vector<ReplayedFrame> replay(const LoadTrace& trace, const Display& display,
                                  ResolutionController& controller) {
  return replay(trace, display,
                {.ladder = controller.ladder(),
                 .observe = [&](const FrameTiming& timing) { bench::checked(controller.observe(timing)); },
                 .next = [&](std::size_t) { return controller.next(); }});
}

std::vector<ReplayedFrame> replay(const LoadTrace& trace, const Display& display,
                                  const ReplayedProgram& program) {
  Pipeline pipeline(display);
  std::vector<ReplayedFrame> frames;
  const double target_ms = display.target_ms();
  for (const FrameLoad& load : trace.frames) {
    const int known = static_cast<int>(frames.size()) - display.timer_latency_frames;
    if (known >= 0) {
      const int missed = frames[static_cast<std::size_t>(known)].dropped;
      program.observe(timing_of(frames, known, missed));
    }
    ReplayedFrame frame{.render = program.next(frames.size())};
    frame.area = program.ladder.area_fraction(frame.render);
    frame.oracle_area = largest_area(program.ladder, [&load](double area) { return load.gpu(area) <= 1; });
    frame.gpu_ms = load.gpu(frame.area) * target_ms + program.besides_ms();
    frame.cpu_ms = load.cpu * target_ms;
    pipeline.draw(frame.gpu_ms, frame.cpu_ms);
    frame.interval_ms = pipeline.interval();
    frame.dropped = pipeline.dropped();
    frame.cpu_late = pipeline.waited_for_cpu();
    frame.queued = pipeline.queued(static_cast<int>(frames.size()));
    frames.push_back(frame);
  }
  return frames;
}

ReplayScore score(const LoadTrace& trace, const Display& display, const std::vector<ReplayedFrame>& frames) {
  ReplayScore result{.frames = std::max(0, static_cast<int>(frames.size()) - kWarmUp)};
  double area = 0;
  double oracle = 0;
  int changes = 0;
  int reversals = 0;
  int direction = 0;
  for (std::size_t index = kWarmUp; index < frames.size(); ++index) {
    const ReplayedFrame& frame = frames[index];
    area += frame.area;
    oracle += frame.oracle_area;
    (frame.cpu_late ? result.cpu_dropped : result.dropped) += frame.dropped;
    if (frame.area == frames[index - 1].area) continue;
    const int now = frame.area > frames[index - 1].area ? 1 : -1;
    ++changes;
    reversals += direction == -now ? 1 : 0;
    direction = now;
  }
  const double seconds = result.frames / display.refresh_hz;
  result.pixels_over_oracle = area / oracle;
  result.changes_per_second = changes / seconds;
  result.reversals_per_second = reversals / seconds;
  result.settle_up_frames = mean_settling(trace, frames, trace.steps_up);
  result.settle_down_frames = mean_settling(trace, frames, trace.steps_down);
  return result;
}

}  // namespace quincunx::traces
