// SPDX-License-Identifier: MIT
// SequenceResolver: streams a sequence through the resolve service: files are read ahead, resolved and written at the
// same time. Pixels in memory do not depend on how many frames there are; a frame's row of the report stays.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_service.h"
#include "src/passes/two_way.h"
#include "tools/program/run_report.h"
#include "tools/program/work_queue.h"
#include "tools/sequence/sequence_histories.h"
#include "tools/sequence/sequence_output.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {

// The resolving that is to be done, settled and checked.
struct SequenceJob {
  FramePattern input;
  SequenceFormat format;
  SequenceScan scan;
  std::optional<SequenceOutput> output;  // absent: frames are only scored
  float exposure = 0;                    // of all frames; 0: each frame's own
  int threads = 1;                       // that read, and that write, at least one of each
  bool skip_bad_frames = false;
  std::uint64_t memory = kDefaultHistoryBytes;  // limit of histories that are kept
  SequenceScores* scores = nullptr;             // not owned; null: none
};

// Outcome of a job.
struct SequenceOutcome {
  std::vector<std::int64_t> resolved;  // and written
  std::vector<std::int64_t> skipped;   // wanted, but bad
  std::vector<FrameRow> rows;          // one for each resolved frame
  MeasuredFrames measured;             // of all that were dispatched, as far as it is known
  Samples upload_ms, resolve_ms;
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
  using DeviceFrame = PerPlane<Image>;

  // In host memory; what nobody wants is empty.
  struct Picture {
    SharedPixels linear;
    std::vector<std::uint8_t> presented;
  };

  // Frames one after another, forwards or backwards.
  struct Stream {
    ResolveService service;
    std::optional<ResolveService> albedo = {};  // where albedo is read: has it for its colour
    std::array<DeviceFrame, 2> ring = {};       // this frame and the one before
    std::array<UploadedFrame, 2> played = {};   // the same, where they are recorded
    std::int64_t last = -1;                     // the frame that was resolved before; -1: none
    std::optional<Matrix> last_world_to_ndc = {};
    std::int64_t count = 0;  // dispatched
  };

  // A frame that was resolved forwards and is not shown yet. Its history is among `histories_`, that of its albedo
  // under ~index.
  struct KeptFrame {
    SequenceFrame frame;  // without images, but velocity where scores ask for it
    FrameInputs inputs;   // without images
    FrameReport report;
  };

  // One file read, and added to a stream.
  struct Step {
    std::size_t frame;
    bool backward = false;
  };

  struct Place {
    std::size_t frame = 0;   // the next one forwards
    std::size_t window = 0;  // not shown yet
    std::size_t steps = 0;   // done
  };

  SequenceResolver(const Device& device, ResolveService service, SequenceJob job);
  Status allocate(Stream& stream) const;
  Status allocate();
  Status upload(const SequenceFrame& frame, const DeviceFrame& to) const;
  Result<FrameInputs> inputs_of(Stream& stream, const SequenceFrame& frame, const ScannedFrame& scanned);
  Result<FrameReport> dispatch(const SequenceFrame& frame, const ScannedFrame& scanned);
  Result<FrameReport> dispatch_recorded(const SequenceFrame& frame);
  Status camera_of(const Stream& stream, const SequenceFrame& frame, FrameInputs& inputs) const;
  Result<SequenceFrame*> take(const ScannedFrame& scanned, bool backward);
  Status resolve_frame(const ScannedFrame& scanned);
  Status add_forward(std::size_t index);
  Status add_albedo(Stream& stream, FrameInputs inputs, std::size_t index, bool merges, bool keeps);
  Status add_backward(std::size_t index, const TwoWayWindow& window);
  void turn_motion(SequenceFrame& frame, const ScannedFrame& scanned);
  Status show(std::size_t index);
  Status deliver(const SequenceFrame& frame, const ScannedFrame& scanned, const FrameReport& report);
  Status download(Picture& picture) const;
  Status hand_over(const SequenceFrame& frame, Picture picture);
  Status finish();
  void collect_reports();
  Status show_window(const TwoWayWindow& window);
  // The steps that are left.
  std::vector<Step> steps_of(const std::vector<TwoWayWindow>& windows) const;
  // Does them; false: as far as one whose frame, forwards, turned out bad. That is no longer among the good ones, and
  // the windows are others.
  Result<bool> run_steps(const std::function<void(std::int64_t)>& progress, const std::atomic<bool>& stop);
  bool presents() const { return job_.output && job_.output->presents(); }

  Device device_;
  Stream forward_;
  std::optional<Stream> backward_;  // where the job looks ahead
  SequenceJob job_;
  std::vector<ScannedFrame> good_;
  std::size_t scanned_ = 0;  // frames, good or bad
  Place place_;
  std::map<std::size_t, KeptFrame> kept_;
  SequenceHistories histories_;
  MotionSamples later_;  // of the frame that was read before, backwards, where its motion is turned
  Image linear_;         // the resolved picture, blurred where the plan blurs
  Image presented_;
  Image albedo_;  // of the picture, where it is read
  SequenceWatch watch_;
  std::chrono::steady_clock::time_point last_delivery_;
  SequenceOutcome outcome_;
  bool has_clipped_ = false;  // light, in a file
  WorkQueue writers_;
  std::unique_ptr<ReadAhead<SequenceFrame>> ahead_;
};

}  // namespace quincunx::tools
