// SPDX-License-Identifier: MIT
// CaseRun: one scene at one scale: every frame is drawn once for each jitter and resolved by every method
// before the next is drawn. All frames of a case follow on each other: those that warm up, those whose errors
// are measured, those of the timed rounds. So no method ever loses its history.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_quality.h"
#include "bench/speed_error/contender.h"

namespace quincunx::bench {

// One thread, that of the GL context. `stage`, `plan` and `truth` outlive it.
class CaseRun {
 public:
  static std::unique_ptr<CaseRun> create(const scenes::FrameSource& stage, const BenchPlan& plan,
                                         const SceneTruth& truth, double scale);

  // The frames whose pictures are measured, and those that warm up everything before and after them. First.
  void run_quality(const scenes::FrameSource& stage);

  // A round whose times count.
  void run_timed();

  // Results, after both.
  std::vector<Row> rows(const std::string& scene) const;
  CopyRow copy_row(const std::string& scene) const;
  FrameRow frame_row(const std::string& scene) const;
  std::string interop() const;  // how frames pass, and why so

  // The last measured frame as method `index` made it.
  const tools::MeasuredPicture& picture(std::size_t index) const { return entries_[index]->tally.latest(); }

 private:
  struct Feed {
    int first_frame;  // first frame that its methods draw
    FrameFeed frames;
  };
  struct Entry {
    std::size_t feed;
    bool is_encoded;  // its pictures are exposed and tone mapped already
    Contender contender;
    QualityTally tally = {};
  };
  enum Step : std::size_t { kDraw, kInterop, kResolve, kWhole, kSteps };
  // The times of whole frames with the frame method.
  struct FrameRounds {
    Rounds ms[kSteps], processor_ms[kSteps];
    std::uint64_t interop_bytes = 0;
  };

  CaseRun(const scenes::FrameSource& stage, const BenchPlan& plan, const SceneTruth& truth, double scale);
  void open(const scenes::FrameSource& stage);
  void open_feed(const scenes::FrameSource& stage, const std::vector<std::size_t>& methods);

  bool has_begun(std::size_t feed, int frame) const { return frame >= feeds_[feed].first_frame; }
  void draw(int frame);
  void release(int frame);
  std::vector<float> resolve_and_read(Entry& entry);
  void measure_frame(int frame);
  void tally(std::size_t entry, std::size_t at, std::vector<float> picture);
  void measure_two_way(const scenes::FrameSource& stage);
  void time_frames(int count, bool keep);
  void time_frame(int frame, bool keep);
  void time_copy(bool keep);
  void time_whole_frame(bool keep);

  const BenchPlan& plan_;
  const SceneTruth& truth_;
  double scale_;
  Device device_;
  Extent render_;
  Image resolved_;
  std::optional<CopyKernel> copy_;  // there once opened
  std::vector<Feed> feeds_;
  std::vector<FrameInputs> inputs_;              // this frame's, one for each feed
  std::vector<std::unique_ptr<Entry>> entries_;  // in the order of the plan's methods
  std::unique_ptr<Contender> presenter_;         // the frame method with its present pass
  std::size_t presenter_feed_ = 0;
  Rounds copy_ms_, copy_processor_ms_;
  FrameRounds frame_;
  int next_frame_ = 0;
};

}  // namespace quincunx::bench
