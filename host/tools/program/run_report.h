// SPDX-License-Identifier: MIT
// RunReport: what a run did and what it cost, as one page of text and as JSON (and to look at: page/page.h).
//
// Plain data that a program fills; an empty string or a negative number means "not known" and is left out of
// the text and null in the JSON. No device is needed to make one.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/advanced/pass_timer.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"
#include "tools/program/pacing_report.h"

namespace quincunx::tools {

// Times of one pass or one step over a run.
struct PassStatistics {
  std::string name;   // "resolve_quincunx", "GL draw"
  std::string clock;  // how it was timed: "OpenCL event", "host clock", "not timed"
  int count = 0;      // samples that were known
  double median_ms = -1;
  double p95_ms = -1;
  double min_ms = -1;
  std::int64_t bytes = -1;  // read and written in one frame, median over the run
};

// Negative and non-finite samples count as not known. The median of an even count is the mean of the middle
// two; p95 is the nearest rank: the smallest sample that at least 95 % do not exceed. `bytes` may be empty.
PassStatistics statistics_of(std::string name, std::string clock, std::span<const double> samples_ms,
                             std::span<const std::uint64_t> bytes = {});

struct FrameRow {
  std::int64_t index = 0;
  double seconds = 0;     // scene time
  Extent render = {};     // the viewport
  Vec2 ratio = {};        // render / output: the true ratio
  Vec2 jitter = {};       // render pixels
  double frame_ms = -1;   // host clock, from one frame's start to the next's, files included
  double device_ms = -1;  // sum of the OpenCL passes
  bool used_previous = false;
  std::int64_t non_finite_pixels = -1;
};

// A frame against its truth; the terms of image_metrics.h.
struct ScoreRow {
  std::int64_t index = 0;
  double psnr_linear = 0;  // dB, infinite for equal pictures
  double psnr_tone_mapped = 0;
  double ssim = 0;
  double flip = 0;
  double error_p99 = 0;
  double flicker = -1;  // against the frame before; -1: that one has no truth
  // FLIP of a paced run at each further refresh that showed the frame, against the truth of that refresh's time.
  std::vector<double> repeated_flip = {};
};

// The mean of each column over the rows that know it; -1 for a flicker that none knows.
ScoreRow mean_of(std::span<const ScoreRow> rows);

// Error of a display: the mean FLIP over its refreshes, frames that were shown again included.
struct ShownError {
  std::int64_t refreshes = 0;
  double flip = 0;
};
ShownError shown_error(std::span<const ScoreRow> rows);

// How long the threads of one kind of work were at it, summed over them.
struct BusyTime {
  std::string what;  // "reading"
  double seconds = 0;
};

struct RunReport {
  std::string program;  // "quincunx-render"
  std::string version;  // "0.1.0"
  std::string command_line;
  std::string scene;
  std::string scene_summary;
  std::optional<std::uint64_t> seed;
  Extent output;
  Extent target;
  std::string method;
  std::vector<std::pair<std::string, std::string>> settings;  // further ones in the order to print

  struct Gl {
    std::string platform;  // "surfaceless"
    std::string vendor;
    std::string renderer;
    std::string version;
  } gl;
  struct Cl {
    std::string platform;
    std::string device;
    std::string driver;
    std::string version;
    int compute_units = -1;
  } cl;
  std::string interop;         // "copy", "gl"
  std::string interop_reason;  // one sentence

  std::vector<PassStatistics> passes;  // on the OpenCL device
  std::vector<PassStatistics> steps;   // around them: GL draw, hand over, present, file writing
  std::vector<FrameRow> frames;
  std::vector<PacingRun> pacing;      // this run against a display, then those it is compared with; or none
  std::vector<BusyTime> busy;         // kinds of work that overlap
  std::vector<ScoreRow> scores;       // where there is a truth
  std::vector<LeftOut> left_out;      // parts that the plan leaves out
  std::vector<std::string> warnings;  // sentences: what the picture suffers from, and what would be better
  std::vector<std::string> files;     // what was written, for the reader
  double wall_seconds = -1;
  std::int64_t peak_memory_bytes = -1;  // peak of the process
};

// About 60 lines of at most 100 columns, whatever the number of frames: a graph of the ratio and at most 12
// frames stand for all of them.
std::string to_text(const RunReport& report);

// Everything, each frame on its own row of "frames".
std::string to_json(const RunReport& report);

// Samples of a quantity, one a frame. Of a run of more than some thousand frames every second one is kept, then every
// fourth and so on: as many as a median needs, in memory that does not grow.
class Samples {
 public:
  void add(double ms, std::uint64_t bytes = 0);  // 0: not known
  double total_ms() const { return total_ms_; }  // of all
  // As statistics_of(), of those that are kept.
  PassStatistics statistics(std::string name, std::string clock) const;

 private:
  std::uint64_t seen_ = 0, step_ = 1;
  double total_ms_ = 0;
  std::vector<double> ms_;
  std::vector<std::uint64_t> bytes_;
};

// What a run keeps of the service's reports, which come in frame order: 72 bytes of each frame, and samples.
class MeasuredFrames {
 public:
  void add(const FrameReport& report);
  bool empty() const { return rows_.empty(); }

  // Each kernel in the order of first use, timed by `timer`. A kernel of which no time is known is "not timed".
  std::vector<PassStatistics> passes(PassTimer timer) const;

  // Fills in what the service measured; a frame has an OpenCL time where all its passes have one. Rows are in frame
  // order; those without a report stay as they are.
  void fill(std::span<FrameRow> rows) const;

  // The worst that was said of motion.
  const MotionCheck& motion() const { return motion_; }

 private:
  std::vector<FrameRow> rows_;
  std::vector<std::pair<std::string, Samples>> passes_;
  MotionCheck motion_;
};

}  // namespace quincunx::tools
