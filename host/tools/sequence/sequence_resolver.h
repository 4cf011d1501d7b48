// SPDX-License-Identifier: MIT
// SequenceResolver: streams a sequence through the resolve service: files are read ahead, resolved and
// written at the same time, and what is in memory does not depend on how many frames there are.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_service.h"
#include "tools/program/run_report.h"
#include "tools/program/work_queue.h"
#include "tools/sequence/sequence_output.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {

// The resolving that is to be done, settled and checked.
struct SequenceJob {
  FramePattern input;
  SequenceFormat format;
  SequenceScan scan;
  std::optional<SequenceOutput> output;  // absent: frames are only scored
  float exposure = 0;                    // exposure of a PNG; 0: 1, or the recorded one
  int threads = 1;                       // that read, and that write, at least one of each
  bool skip_bad_frames = false;
  SequenceScores* scores = nullptr;  // not owned; null: none
};

// Outcome of a job.
struct SequenceOutcome {
  std::vector<std::int64_t> resolved;  // and written
  std::vector<std::int64_t> skipped;   // wanted, but bad
  std::vector<FrameRow> rows;          // one for each resolved frame
  std::vector<FrameReport> reports;    // one for each that was dispatched, as far as it is known
  std::vector<double> upload_ms, resolve_ms;
  std::vector<BusyTime> busy;
  std::vector<std::string> warnings;  // notes on what showed in the pixels
  double wall_seconds = 0;
};

class SequenceResolver {
 public:
  // `plan` is for the job's format and scan. Errors: of the device.
  static Result<std::unique_ptr<SequenceResolver>> create(const Device& device, const ResolvePlan& plan,
                                                          SequenceJob job);

  // Resolves and writes every wanted frame. `progress` is told how many frames are through. Where `stop` becomes true
  // the run ends after the frame at hand, as an error. However it ends, the files are whole.
  Status run(const std::function<void(std::int64_t)>& progress, const std::atomic<bool>& stop);

  const SequenceOutcome& outcome() const { return outcome_; }

 private:
  struct DeviceFrame {
    Image colour, velocity, depth, reactive;
  };

  // In host memory; what nobody wants is empty.
  struct Picture {
    SharedPixels linear;
    std::vector<std::uint8_t> presented;
  };

  SequenceResolver(const Device& device, ResolveService service, SequenceJob job);
  Status allocate();
  Status upload(const SequenceFrame& frame, const DeviceFrame& to) const;
  Result<FrameReport> dispatch(const SequenceFrame& frame, const ScannedFrame& scanned);
  Result<FrameReport> dispatch_recorded(const SequenceFrame& frame);
  Status camera_of(const SequenceFrame& frame, FrameInputs& inputs) const;
  Status resolve_frame(const ScannedFrame& scanned);
  Status download(Picture& picture) const;
  Status hand_over(const SequenceFrame& frame, Picture picture);
  Status finish();
  void collect_reports();
  bool presents() const { return job_.output && job_.output->pattern.format() == FileFormat::kPng; }

  Device device_;
  ResolveService service_;
  SequenceJob job_;
  std::array<DeviceFrame, 2> ring_;      // this frame and the one before
  std::array<UploadedFrame, 2> played_;  // the same, where they are recorded
  Image linear_;                         // the resolved picture, blurred where the plan blurs
  Image presented_;
  std::int64_t last_ = -1;  // the frame that was resolved before; -1: none
  std::optional<Matrix> last_world_to_ndc_;
  SequenceWatch watch_;
  std::int64_t count_ = 0;  // dispatched
  std::chrono::steady_clock::time_point last_delivery_;
  SequenceOutcome outcome_;
  WorkQueue writers_;
  std::unique_ptr<ReadAhead<SequenceFrame>> ahead_;
};

}  // namespace quincunx::tools
