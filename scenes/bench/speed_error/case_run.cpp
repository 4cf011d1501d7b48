// SPDX-License-Identifier: MIT
#include "bench/speed_error/case_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <map>
#include <thread>
#include <tuple>
#include <utility>

#include "bench/speed_error/two_way_run.h"
#include "tools/image/display_light.h"

namespace quincunx::bench {
namespace {

// The pictures of a frame are measured on all processors: nothing is timed meanwhile.
template <typename Task>
void for_each_in_parallel(std::size_t count, const Task& task) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++)
      task(i);
  };
  std::vector<std::future<void>> workers(std::min<std::size_t>(count, std::thread::hardware_concurrency()));
  for (auto& worker : workers)
    worker = std::async(std::launch::async, work);
  for (auto& worker : workers)
    worker.get();
}

// What a frame takes in both directions, by what it takes in one: each is added forwards once, and each window of 24
// backwards with eight more, as quincunx-resolve does.
DispatchTime both_ways(DispatchTime time) {
  constexpr double kFrames = 1 + (24. + 8) / 24;
  time.step.ms *= kFrames;
  time.step.processor_ms *= kFrames;
  time.resolve_ms *= kFrames;
  time.bytes = static_cast<std::uint64_t>(static_cast<double>(time.bytes) * kFrames);
  return time;
}

}  // namespace

CaseRun::CaseRun(const scenes::FrameSource& stage, const BenchPlan& plan, const SceneTruth& truth,
                 double scale)
    : plan_(plan), truth_(truth), scale_(scale), device_(stage.device()) {}

Result<std::unique_ptr<CaseRun>> CaseRun::create(const scenes::FrameSource& stage, const BenchPlan& plan,
                                                 const SceneTruth& truth, double scale) {
  auto run = std::unique_ptr<CaseRun>(new CaseRun(stage, plan, truth, scale));
  if (Status status = run->open(stage); !status.ok()) return status;
  return run;
}

Status CaseRun::open(const scenes::FrameSource& stage) {
  auto resolved = device_.allocate(plan_.conditions.output, ResolveSettings{}.output.linear);
  if (!resolved.ok()) return resolved.status();
  resolved_ = std::move(resolved).value();
  auto copy = CopyKernel::create(device_, plan_.conditions.output);
  if (!copy.ok()) return copy.status();
  copy_.emplace(std::move(copy).value());

  using Feeding =
      std::tuple<Shading, scenes::Jitter, scenes::TextureDetail, bool, PixelFormat, bool, std::string>;
  std::map<Feeding, std::vector<std::size_t>> feeds;
  for (std::size_t i = 0; i < plan_.methods.size(); ++i) {
    const BenchMethod& method = plan_.methods[i];
    feeds[{method.resolve.targets.shading, method.jitter, method.detail, method.accumulates,
           method.resolve.colour, method.focuses, method.dual}]
        .push_back(i);
  }
  entries_.resize(plan_.methods.size());
  for (const auto& [frames, methods] : feeds) {
    if (Status status = open_feed(stage, methods); !status.ok()) return status;
  }
  inputs_.resize(feeds_.size());
  return {};
}

Status CaseRun::open_feed(const scenes::FrameSource& stage, const std::vector<std::size_t>& methods) {
  std::vector<ResolveSettings> resolves;
  for (const std::size_t method : methods) {
    resolves.push_back(plan_.methods[method].resolve);
    resolves.back().output.present = false;
  }
  const bool presents = std::find(methods.begin(), methods.end(), plan_.frame_method) != methods.end();
  if (presents) resolves.push_back(plan_.methods[plan_.frame_method].resolve);
  const BenchMethod& any = plan_.methods[methods.front()];
  auto feed = FrameFeed::create(stage, sequence_for(plan_, scale_, any), resolves, std::nullopt,
                                focus_for(plan_.conditions, any), plan_.conditions.noise);
  if (!feed.ok()) return feed.status();
  for (std::size_t i = 0; i < resolves.size(); ++i) {
    auto contender = Contender::create(device_, feed->plans()[i]);
    if (!contender.ok()) return contender.status();
    if (i < methods.size()) {
      const bool is_encoded = resolves[i].colour == PixelFormat::kRGBA8;
      entries_[methods[i]] =
          std::make_unique<Entry>(Entry{feeds_.size(), is_encoded, std::move(contender).value()});
    } else {
      presenter_ = std::make_unique<Contender>(std::move(contender).value());
      presenter_feed_ = feeds_.size();
    }
  }
  feeds_.push_back({first_frame_for(plan_.conditions, any), std::move(feed).value()});
  return {};
}

Status CaseRun::draw(int frame) {
  for (std::size_t i = 0; i < feeds_.size(); ++i) {
    if (!has_begun(i, frame)) continue;
    auto inputs = feeds_[i].frames.next();
    if (!inputs.ok()) return inputs.status();
    inputs_[i] = inputs.value();
  }
  return {};
}

void CaseRun::release(int frame) {
  for (std::size_t i = 0; i < feeds_.size(); ++i) {
    if (has_begun(i, frame)) feeds_[i].frames.release();
  }
}

Result<std::vector<float>> CaseRun::resolve_and_read(Entry& entry) {
  auto time = entry.contender.dispatch(inputs_[entry.feed], feeds_[entry.feed].frames.focus(),
                                       {.linear = resolved_.view()});
  if (!time.ok()) return time.status();
  const Extent output = plan_.conditions.output;
  std::vector<float> rgba(static_cast<std::size_t>(output.area()) * 4);
  if (Status status = device_.download(resolved_.view(), output, rgba.data()); !status.ok()) return status;
  return entry.is_encoded ? tools::light_before_reinhard(rgba) : rgba;
}

Status CaseRun::measure_frame(int frame) {
  std::vector<std::vector<float>> pictures(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!has_begun(entries_[i]->feed, frame)) continue;
    auto rgba = resolve_and_read(*entries_[i]);
    if (!rgba.ok()) return rgba.status();
    pictures[i] = std::move(rgba).value();
  }
  if (frame < plan_.conditions.warm_up) return {};
  const auto at = static_cast<std::size_t>(frame - plan_.conditions.warm_up);
  for_each_in_parallel(entries_.size(), [&](std::size_t i) {
    if (!plan_.methods[i].two_way) tally(i, at, std::move(pictures[i]));
  });
  return {};
}

// Adds the picture of measured frame `at` to what is known of a method.
void CaseRun::tally(std::size_t entry, std::size_t at, std::vector<float> picture) {
  Entry& to = *entries_[entry];
  const tools::MeasuredPicture* previous = at > 0 ? &truth_.pictures[at - 1] : nullptr;
  to.tally.add(tools::measured(plan_.conditions.output, std::move(picture),
                               to.is_encoded ? 1 : inputs_[to.feed].exposure),
               truth_.pictures[at], previous, truth_.masks[at]);
}

Status CaseRun::measure_two_way(const scenes::FrameSource& stage) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!plan_.methods[i].two_way) continue;
    auto pictures = two_way_pictures(stage, plan_, scale_, plan_.methods[i]);
    if (!pictures.ok()) return pictures.status();
    for (std::size_t at = 0; at < pictures->size(); ++at) {
      std::vector<float>& picture = pictures.value()[at];
      tally(i, at, entries_[i]->is_encoded ? tools::light_before_reinhard(picture) : std::move(picture));
    }
  }
  return {};
}

Status CaseRun::run_quality(const scenes::FrameSource& stage) {
  int first = 0;
  for (const Feed& feed : feeds_)
    first = std::min(first, feed.first_frame);
  next_frame_ = plan_.conditions.warm_up + plan_.conditions.frames;
  for (int frame = first; frame < next_frame_; ++frame) {
    if (Status status = draw(frame); !status.ok()) return status;
    if (Status status = measure_frame(frame); !status.ok()) return status;
    if (has_begun(presenter_feed_, frame)) {
      if (Status status = time_whole_frame(false); !status.ok()) return status;
    }
    if (Status status = time_copy(false); !status.ok()) return status;
    release(frame);
  }
  if (Status status = measure_two_way(stage); !status.ok()) return status;
  // Refills the caches, which the work on errors may have emptied.
  return time_frames(plan_.conditions.warm_up, false);
}

Status CaseRun::run_timed() {
  for (auto& entry : entries_)
    entry->contender.begin_round();
  for (Rounds* rounds : {&copy_ms_, &copy_processor_ms_})
    rounds->emplace_back();
  for (std::size_t step = 0; step < kSteps; ++step) {
    frame_.ms[step].emplace_back();
    frame_.processor_ms[step].emplace_back();
  }
  return time_frames(plan_.conditions.frames, true);
}

Status CaseRun::time_frames(int count, bool keep) {
  for (const int end = next_frame_ + count; next_frame_ < end; ++next_frame_) {
    if (Status status = draw(next_frame_); !status.ok()) return status;
    if (Status status = time_frame(next_frame_, keep); !status.ok()) return status;
    release(next_frame_);
  }
  return {};
}

// Each frame another method goes first, so that no place in the order is always the same method's.
Status CaseRun::time_frame(int frame, bool keep) {
  if (Status status = time_copy(keep); !status.ok()) return status;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::size_t method = (i + static_cast<std::size_t>(frame)) % entries_.size();
    Entry& entry = *entries_[method];
    auto time = entry.contender.dispatch(inputs_[entry.feed], feeds_[entry.feed].frames.focus(),
                                         {.linear = resolved_.view()});
    if (!time.ok()) return time.status();
    if (keep) entry.contender.keep(plan_.methods[method].two_way ? both_ways(time.value()) : time.value());
  }
  return time_whole_frame(keep);
}

Status CaseRun::time_copy(bool keep) {
  const StepClock clock;
  auto ms = copy_->run();
  const StepTime step = clock.elapsed();
  if (!ms.ok()) return ms.status();
  if (!keep) return {};
  copy_ms_.back().push_back(ms.value());
  copy_processor_ms_.back().push_back(step.processor_ms);
  return {};
}

Status CaseRun::time_whole_frame(bool keep) {
  FrameFeed& feed = feeds_[presenter_feed_].frames;
  auto presented = feed.bridge().begin_present();
  if (!presented.ok()) return presented.status();
  auto time = presenter_->dispatch(inputs_[presenter_feed_], feed.focus(), {.presented = presented.value()});
  if (!time.ok()) return time.status();
  const StepClock clock;
  if (Status status = feed.bridge().present(); !status.ok()) return status;
  StepTime interop = feed.interop_time();
  interop += clock.elapsed();
  render_ = inputs_[presenter_feed_].render_extent;
  frame_.interop_bytes = feed.bytes_in() + feed.bridge().traffic().bytes_out;
  if (!keep) return {};
  StepTime whole = feed.draw_time();
  whole += interop;
  whole += time->step;
  const StepTime steps[kSteps] = {feed.draw_time(), interop, time->step, whole};
  for (std::size_t i = 0; i < kSteps; ++i) {
    frame_.ms[i].back().push_back(steps[i].ms);
    frame_.processor_ms[i].back().push_back(steps[i].processor_ms);
  }
  return {};
}

std::vector<Row> CaseRun::rows(const std::string& scene) const {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    rows.push_back({.scene = scene,
                    .scale = scale_,
                    .method = plan_.methods[i].name,
                    .render = render_,
                    .quality = entries_[i]->tally.quality(),
                    .speed = entries_[i]->contender.speed(copy_ms_, copy_processor_ms_),
                    .front = {}});
  }
  return rows;
}

std::string CaseRun::interop() const {
  const gl::Bridge& bridge = feeds_[presenter_feed_].frames.bridge();
  return fmt::format("{}: {}", gl::name_of(bridge.kind()), bridge.reason());
}

CopyRow CaseRun::copy_row(const std::string& scene) const {
  CopyRow row{.scene = scene,
              .scale = scale_,
              .ms = spread_of(copy_ms_),
              .processor_ms = spread_of(copy_processor_ms_)};
  row.gigabytes_per_second = static_cast<double>(copy_->bytes()) / row.ms.median * 1e-6;
  return row;
}

FrameRow CaseRun::frame_row(const std::string& scene) const {
  const auto ms = [this](Step step) { return spread_of(frame_.ms[step]); };
  const auto processor_ms = [this](Step step) { return spread_of(frame_.processor_ms[step]); };
  return {.scene = scene,
          .scale = scale_,
          .method = plan_.methods[plan_.frame_method].name,
          .render = render_,
          .draw_ms = ms(kDraw),
          .interop_ms = ms(kInterop),
          .resolve_ms = ms(kResolve),
          .frame_ms = ms(kWhole),
          .draw_processor_ms = processor_ms(kDraw),
          .interop_processor_ms = processor_ms(kInterop),
          .resolve_processor_ms = processor_ms(kResolve),
          .frame_processor_ms = processor_ms(kWhole),
          .interop_bytes = frame_.interop_bytes};
}

}  // namespace quincunx::bench
