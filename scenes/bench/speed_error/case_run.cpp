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

#include "src/passes/two_way.h"
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

constexpr int kAhead = 8;  // as --two-way has it by itself

struct KeptFrame {
  KeptHistory history;
  FrameInputs inputs;  // without images
};

FrameInputs without_images(FrameInputs inputs) {
  inputs.colour = inputs.velocity = inputs.depth = inputs.reactive = {};
  return inputs;
}

// A direction of the frames, and the service that accumulates them.
struct Direction {
  FrameFeed feed;
  ResolveService service;

  static Direction create(const scenes::FrameSource& stage, const scenes::SequenceSettings& sequence,
                          ResolveSettings resolve, std::optional<int> noise) {
    resolve.output.present = false;
    auto feed = FrameFeed::create(stage, sequence, {resolve}, std::nullopt, std::nullopt, noise);
    auto service = checked(TwoWay::create(stage.device(), feed.plans().front()));
    return Direction{std::move(feed), std::move(service)};
  }

  // Adds the next frame; `kept` null: it is not measured. Gives its inputs without images.
  FrameInputs add(bool merges, KeptHistory* kept) {
    const auto inputs = feed.next();
    const bool both = merges && !inputs.reset;
    const FrameReport report = TwoWay::add(service, inputs, both, both || !merges ? kept : nullptr);
    checked(report.status);
    checked(service.finish());
    feed.release();
    return without_images(inputs);
  }
};

std::vector<std::vector<float>> show(ResolveService& service, const std::vector<KeptFrame>& frames) {
  const Extent output = service.plan().settings.output_extent;
  auto image = checked(service.device().allocate(output, service.plan().settings.output.linear));
  std::vector<std::vector<float>> pictures;
  for (const KeptFrame& frame : frames) {
    const FrameReport report = TwoWay::show(service, frame.inputs, frame.history, {.linear = image.view()});
    checked(report.status);
    pictures.emplace_back(static_cast<std::size_t>(output.area()) * 4);
    checked(service.device().download(image.view(), output, pictures.back().data()));
  }
  return pictures;
}

// Returns the linear pictures of the measured frames, in order, as quincunx-resolve --two-way 8 makes them: RGBA of the
// output's extent. What is to come cannot be resolved beside the other methods, so these frames are drawn by
// themselves, forwards and backwards.
std::vector<std::vector<float>> two_way_pictures(const scenes::FrameSource& stage, const BenchPlan& plan,
                                                 double scale, const BenchMethod& method) {
  const int before = plan.conditions.warm_up - first_frame_for(plan.conditions, method);
  const int measured = plan.conditions.frames;
  scenes::SequenceSettings sequence = sequence_for(plan, scale, method);
  sequence.frames = before + measured + kAhead;
  auto forward = Direction::create(stage, sequence, method.resolve, plan.conditions.noise);
  std::vector<KeptFrame> frames(static_cast<std::size_t>(measured));
  for (int i = -before; i < measured + kAhead; ++i) {
    const bool keeps = i >= 0 && i < measured;
    KeptFrame unused, &frame = keeps ? frames[static_cast<std::size_t>(i)] : unused;
    frame.inputs = forward.add(false, keeps ? &frame.history : nullptr);
  }
  sequence.backwards = true;
  auto backward = Direction::create(stage, sequence, method.resolve, plan.conditions.noise);
  for (int i = measured + kAhead; i-- > 0;) {
    KeptHistory* const kept = i < measured ? &frames[static_cast<std::size_t>(i)].history : nullptr;
    backward.add(kept != nullptr, kept);
    if (i + 1 < measured + kAhead) continue;
    checked(TwoWay::turn(backward.service, forward.service));
  }
  return show(forward.service, frames);
}

}  // namespace

CaseRun::CaseRun(const scenes::FrameSource& stage, const BenchPlan& plan, const SceneTruth& truth,
                 double scale)
    : plan_(plan), truth_(truth), scale_(scale), device_(stage.device()) {}

std::unique_ptr<CaseRun> CaseRun::create(const scenes::FrameSource& stage, const BenchPlan& plan,
                                         const SceneTruth& truth, double scale) {
  auto run = std::unique_ptr<CaseRun>(new CaseRun(stage, plan, truth, scale));
  run->open(stage);
  return run;
}

void CaseRun::open(const scenes::FrameSource& stage) {
  resolved_ = checked(device_.allocate(plan_.conditions.output, ResolveSettings{}.output.linear));
  copy_.emplace(checked(CopyKernel::create(device_, plan_.conditions.output)));

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
    open_feed(stage, methods);
  }
  inputs_.resize(feeds_.size());
}

void CaseRun::open_feed(const scenes::FrameSource& stage, const std::vector<std::size_t>& methods) {
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
  for (std::size_t i = 0; i < resolves.size(); ++i) {
    auto contender = Contender::create(device_, feed.plans()[i]);
    if (i < methods.size()) {
      const bool is_encoded = resolves[i].colour == PixelFormat::kRGBA8;
      entries_[methods[i]] = std::make_unique<Entry>(Entry{feeds_.size(), is_encoded, std::move(contender)});
    } else {
      presenter_ = std::make_unique<Contender>(std::move(contender));
      presenter_feed_ = feeds_.size();
    }
  }
  feeds_.push_back({first_frame_for(plan_.conditions, any), std::move(feed)});
}

void CaseRun::draw(int frame) {
  for (std::size_t i = 0; i < feeds_.size(); ++i) {
    if (!has_begun(i, frame)) continue;
    inputs_[i] = feeds_[i].frames.next();
  }
}

void CaseRun::release(int frame) {
  for (std::size_t i = 0; i < feeds_.size(); ++i) {
    if (has_begun(i, frame)) feeds_[i].frames.release();
  }
}

std::vector<float> CaseRun::resolve_and_read(Entry& entry) {
  auto time = entry.contender.dispatch(inputs_[entry.feed], feeds_[entry.feed].frames.focus(),
                                       {.linear = resolved_.view()});
  const Extent output = plan_.conditions.output;
  std::vector<float> rgba(static_cast<std::size_t>(output.area()) * 4);
  checked(device_.download(resolved_.view(), output, rgba.data()));
  return entry.is_encoded ? tools::light_before_reinhard(rgba) : rgba;
}

void CaseRun::measure_frame(int frame) {
  std::vector<std::vector<float>> pictures(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!has_begun(entries_[i]->feed, frame)) continue;
    pictures[i] = resolve_and_read(*entries_[i]);
  }
  if (frame < plan_.conditions.warm_up) return;
  const auto at = static_cast<std::size_t>(frame - plan_.conditions.warm_up);
  for_each_in_parallel(entries_.size(), [&](std::size_t i) {
    if (!plan_.methods[i].two_way) tally(i, at, std::move(pictures[i]));
  });
}

// Adds the picture of measured frame `at` to what is known of a method.
void CaseRun::tally(std::size_t entry, std::size_t at, std::vector<float> picture) {
  Entry& to = *entries_[entry];
  const tools::MeasuredPicture* previous = at > 0 ? &truth_.pictures[at - 1] : nullptr;
  to.tally.add(tools::measured(plan_.conditions.output, std::move(picture),
                               to.is_encoded ? 1 : inputs_[to.feed].exposure),
               truth_.pictures[at], previous, truth_.masks[at]);
}

void CaseRun::measure_two_way(const scenes::FrameSource& stage) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!plan_.methods[i].two_way) continue;
    auto pictures = two_way_pictures(stage, plan_, scale_, plan_.methods[i]);
    for (std::size_t at = 0; at < pictures.size(); ++at) {
      std::vector<float>& picture = pictures[at];
      tally(i, at, entries_[i]->is_encoded ? tools::light_before_reinhard(picture) : std::move(picture));
    }
  }
}

void CaseRun::run_quality(const scenes::FrameSource& stage) {
  int first = 0;
  for (const Feed& feed : feeds_)
    first = std::min(first, feed.first_frame);
  next_frame_ = plan_.conditions.warm_up + plan_.conditions.frames;
  for (int frame = first; frame < next_frame_; ++frame) {
    draw(frame);
    measure_frame(frame);
    if (has_begun(presenter_feed_, frame)) {
      time_whole_frame(false);
    }
    time_copy(false);
    release(frame);
  }
  measure_two_way(stage);
  // Refills the caches, which the work on errors may have emptied.
  time_frames(plan_.conditions.warm_up, false);
}

void CaseRun::run_timed() {
  for (auto& entry : entries_)
    entry->contender.begin_round();
  for (Rounds* rounds : {&copy_ms_, &copy_processor_ms_})
    rounds->emplace_back();
  for (std::size_t step = 0; step < kSteps; ++step) {
    frame_.ms[step].emplace_back();
    frame_.processor_ms[step].emplace_back();
  }
  time_frames(plan_.conditions.frames, true);
}

void CaseRun::time_frames(int count, bool keep) {
  for (const int end = next_frame_ + count; next_frame_ < end; ++next_frame_) {
    draw(next_frame_);
    time_frame(next_frame_, keep);
    release(next_frame_);
  }
}

// Each frame another method goes first, so that no place in the order is always the same method's.
void CaseRun::time_frame(int frame, bool keep) {
  time_copy(keep);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::size_t method = (i + static_cast<std::size_t>(frame)) % entries_.size();
    Entry& entry = *entries_[method];
    auto time = entry.contender.dispatch(inputs_[entry.feed], feeds_[entry.feed].frames.focus(),
                                         {.linear = resolved_.view()});
    if (keep) entry.contender.keep(plan_.methods[method].two_way ? both_ways(time) : time);
  }
  time_whole_frame(keep);
}

void CaseRun::time_copy(bool keep) {
  const StepClock clock;
  const double ms = checked(copy_->run());
  const StepTime step = clock.elapsed();
  if (!keep) return;
  copy_ms_.back().push_back(ms);
  copy_processor_ms_.back().push_back(step.processor_ms);
}

void CaseRun::time_whole_frame(bool keep) {
  FrameFeed& feed = feeds_[presenter_feed_].frames;
  auto presented = checked(feed.bridge().begin_present());
  auto time = presenter_->dispatch(inputs_[presenter_feed_], feed.focus(), {.presented = presented});
  const StepClock clock;
  checked(feed.bridge().present());
  StepTime interop = feed.interop_time();
  interop += clock.elapsed();
  render_ = inputs_[presenter_feed_].render_extent;
  frame_.interop_bytes = feed.bytes_in() + feed.bridge().traffic().bytes_out;
  if (!keep) return;
  StepTime whole = feed.draw_time();
  whole += interop;
  whole += time.step;
  const StepTime steps[kSteps] = {feed.draw_time(), interop, time.step, whole};
  for (std::size_t i = 0; i < kSteps; ++i) {
    frame_.ms[i].back().push_back(steps[i].ms);
    frame_.processor_ms[i].back().push_back(steps[i].processor_ms);
  }
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
