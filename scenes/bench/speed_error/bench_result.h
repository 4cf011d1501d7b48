// SPDX-License-Identifier: MIT
// BenchResult: everything that one run of quincunx-bench found out, as plain data, JSON and CSV.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/records.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"

namespace quincunx::bench {

// The version of the JSON. Format 1 had no tables, and `uncovered` for `disoccluded`; it is still read. A reader
// refuses others.
inline constexpr int kResultFormat = 2;

// Repeated measurements of one quantity. `low` to `high` holds the true median with 95 % confidence as far as
// the spread between rounds tells.
struct Spread {
  double median = 0;
  double p95 = 0;  // nearest rank
  double low = 0;
  double high = 0;

  friend bool operator==(const Spread&, const Spread&) = default;
};
QUINCUNX_FIELDS(Spread, median, p95, low, high)

// The kinds of content on which methods fail differently. Each pixel is in the first one that holds. docs/bench.md
// defines each.
enum class Region : std::uint8_t {
  kThin,         // something thinner than four pixels
  kBehindThin,   // what is within four pixels of something thin that stands before it
  kDisoccluded,  // what was hidden within the last two frames
  kEdge,         // within two pixels of where two motions meet
  kRest,
};
inline constexpr std::size_t kRegions = 5;
inline constexpr double kHighestRegionPsnr = 100;  // dB: stands for no error at all

// A figure for each region; absent where it has no pixel, and in results from before there were regions.
using RegionFigures = std::array<std::optional<double>, kRegions>;

// Fields that are named for what they are of, with the region behind it: "psnr_thin".
template <typename Io, SameAs<RegionFigures> Figures>
void region_fields(Io& io, const std::string& prefix, Figures& figures) {
  constexpr std::array<const char*, kRegions> kNames = {"thin", "behind_thin", "disoccluded", "edge", "rest"};
  for (std::size_t i = 0; i < kRegions; ++i)
    io((prefix + kNames[i]).c_str(), figures[i]);
}

// Errors against supersampled truth over the measured frames. Colours are exposed as the scene asks; "tone
// mapped" is max(c, 0) / (1 + c), sRGB encoded. docs/bench.md defines each.
struct Quality {
  double psnr = std::numeric_limits<double>::infinity();         // dB, tone mapped, of the mean squared error
  double psnr_linear = std::numeric_limits<double>::infinity();  // dB, linear light clipped to [0, 1]
  double ssim = 1;
  double flip = 0;
  double error_p99 = 0;
  double relative_error = 0;
  double worst_window = 0;  // largest RMS error of any 16x16 pixels of any frame, tone mapped
  int worst_frame = 0;
  int worst_x = 0;  // upper left pixel
  int worst_y = 0;
  std::optional<double> flicker;       // absent where one frame was measured
  std::optional<double> ghosting;      // RMS error of what was disoccluded; absent where nothing was
  RegionFigures region_psnr;           // dB, as psnr
  std::optional<double> psnr_focus;    // dB, of the pixels in focus; absent where there is none
  std::optional<double> psnr_outside;  // dB, over all other pixels
  std::int64_t non_finite = 0;         // pixels, all frames

  friend bool operator==(const Quality&, const Quality&) = default;
};
template <typename Io, SameAs<Quality> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(psnr, psnr_linear, ssim, flip, error_p99, relative_error, worst_window, worst_frame,
                      worst_x, worst_y, flicker, ghosting)
  region_fields(io, "psnr_", value.region_psnr);
  QUINCUNX_EACH_FIELD(psnr_focus, psnr_outside, non_finite)
}

// The cost of the resolve passes of one frame, without the present pass.
struct Speed {
  Spread ms;                        // OpenCL events
  std::optional<double> least_ms;   // the least of the rounds' medians; absent in older results
  Spread processor_ms;              // processor time of this process, all threads
  Spread ratio;                     // ms / that of the float4 copy, by round; p95 is that of rounds
  Spread processor_ratio;           // processor_ms / that of the copy
  std::uint64_t bytes = 0;          // read and written in a frame, each texel once
  double gigabytes_per_second = 0;  // bytes / ms
  std::string kernels;              // in order, joined by " + "

  friend bool operator==(const Speed&, const Speed&) = default;
};
QUINCUNX_FIELDS(Speed, ms, least_ms, processor_ms, ratio, processor_ratio, bytes, gigabytes_per_second,
                kernels)

struct Row {
  std::string scene;
  double scale = 1;
  std::string method;
  Extent render;
  Quality quality;
  Speed speed;
  std::vector<std::string> front;  // errors by name for which no other method is both faster and better

  friend bool operator==(const Row&, const Row&) = default;
};
QUINCUNX_FIELDS(Row, scene, scale, method, render, quality, speed, front)

// The float4 copy of the output's size, measured among the methods of each scene and scale.
struct CopyRow {
  std::string scene;
  double scale = 1;
  Spread ms;
  Spread processor_ms;
  double gigabytes_per_second = 0;

  friend bool operator==(const CopyRow&, const CopyRow&) = default;
};
QUINCUNX_FIELDS(CopyRow, scene, scale, ms, processor_ms, gigabytes_per_second)

// A whole frame with one method, nothing overlapped.
struct FrameRow {
  std::string scene;
  double scale = 1;
  std::string method;
  Extent render;
  Spread draw_ms;     // host clock, until OpenGL has drawn
  Spread interop_ms;  // to OpenCL and the picture back
  Spread resolve_ms;  // all OpenCL passes, present among them
  Spread frame_ms;    // the three together
  Spread draw_processor_ms;
  Spread interop_processor_ms;
  Spread resolve_processor_ms;
  Spread frame_processor_ms;
  std::uint64_t interop_bytes = 0;

  friend bool operator==(const FrameRow&, const FrameRow&) = default;
};
QUINCUNX_FIELDS(FrameRow, scene, scale, method, render, draw_ms, interop_ms, resolve_ms, frame_ms,
                draw_processor_ms, interop_processor_ms, resolve_processor_ms, frame_processor_ms,
                interop_bytes)

struct SceneRow {
  std::string name;
  std::string summary;
  std::string reason;
  std::optional<double> truth_flicker;  // mean change of the truth's own luma from frame to frame
  double disoccluded = 0;               // part of the pixels that was disoccluded in the last two frames
  RegionFigures region_part;            // shares of the pixels

  friend bool operator==(const SceneRow&, const SceneRow&) = default;
};
template <typename Io, SameAs<SceneRow> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(name, summary, reason, truth_flicker, disoccluded)
  region_fields(io, "part_", value.region_part);
}

struct MethodRow {
  std::string name;
  std::string summary;
  std::string jitter;
  double lod_bias = 0;  // at scale 1

  friend bool operator==(const MethodRow&, const MethodRow&) = default;
};
QUINCUNX_FIELDS(MethodRow, name, summary, jitter, lod_bias)

struct Machine {
  std::string processor;
  int processors = 0;  // logical
  double memory_gib = 0;
  std::string system;
  std::string cl_device;
  std::string cl_platform;
  std::string cl_driver;
  std::string cl_version;
  bool cl_on_processor = false;  // then processor time is the steadier clock
  std::string gl_renderer;
  std::string gl_version;
  std::string interop;
  double load_before = 0;  // mean load over the last minute
  double load_after = 0;

  friend bool operator==(const Machine&, const Machine&) = default;
};
QUINCUNX_FIELDS(Machine, processor, processors, memory_gib, system, cl_device, cl_platform, cl_driver,
                cl_version, cl_on_processor, gl_renderer, gl_version, interop, load_before, load_after)

// What the smaller results say of their run.
struct RunFacts {
  std::string version;
  std::string command;
  std::string date;  // UTC, "2026-11-21 14:03"
  Machine machine;
};

struct Conditions {
  Extent output;
  int frames = 0;   // whose errors are measured, and of each timed round
  int warm_up = 0;  // frames before both
  // Before those that are measured, of methods that accumulate; absent in results of before there were any.
  std::optional<int> history_warm_up;
  int rounds = 0;
  int truth_samples = 0;  // along each side of a pixel
  std::uint64_t seed = 0;
  double fps = 0;
  double start = 0;                        // scene time of the first frame, seconds
  std::optional<std::string> focus = {};   // as --focus has it; absent where there is none
  std::optional<double> focus_scale = {};  // render scale of its region
  std::optional<int> noise = {};           // samples a pixel of noisy frames; absent where they are not

  friend bool operator==(const Conditions&, const Conditions&) = default;
};
QUINCUNX_FIELDS(Conditions, output, frames, warm_up, history_warm_up, rounds, truth_samples, seed, fps, start,
                focus, focus_scale, noise)

struct BenchResult {
  std::string version;
  std::string command;
  std::string date;  // UTC, "2026-11-21 14:03"
  double wall_seconds = 0;
  Machine machine;
  Conditions conditions;
  std::vector<SceneRow> scenes;
  std::vector<MethodRow> methods;
  std::vector<CopyRow> copies;
  std::vector<Row> rows;
  std::vector<FrameRow> frames;

  friend bool operator==(const BenchResult&, const BenchResult&) = default;
};
QUINCUNX_FIELDS(BenchResult, version, command, date, wall_seconds, machine, conditions, scenes, methods,
                copies, rows, frames)

// Both hold the same, numbers to 6 significant digits: for programs that read it, nested objects; and to be kept, a
// line for each row of each list.
std::string to_json(const BenchResult& result);
std::string to_tables(const BenchResult& result);

// Read either form. Errors: kInvalidArgument, naming `path`, for anything but a result of this program.
Result<BenchResult> from_json(const std::string& text, const std::string& path);
Result<BenchResult> read_result(const std::string& path);  // errors also: kIoFailure

// One line a row, the copy's figures and the conditions left out; the first line names the columns.
std::string to_csv(const BenchResult& result);

// The clock that holds on this device: processor time where OpenCL runs on the processor (a busy machine
// stretches event times but not that), event time elsewhere.
const Spread& cost_of(const Machine& machine, const Row& row);  // in copies
const char* cost_clock(const Machine& machine);                 // "processor time"

}  // namespace quincunx::bench
