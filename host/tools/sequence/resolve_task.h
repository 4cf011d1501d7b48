// SPDX-License-Identifier: MIT
// ResolveTask: a command line of quincunx-resolve, looked at together with the files that are there: what is
// to be read, resolved and written, before anything of it is done.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "tools/image/image_io.h"
#include "tools/program/command_line.h"
#include "tools/record/recorded_settings.h"
#include "tools/sequence/sequence_histories.h"
#include "tools/sequence/sequence_input.h"
#include "tools/sequence/sequence_output.h"
#include "tools/sequence/sequence_scan.h"

namespace quincunx::tools {

// Options that the command line gives.
struct ResolveOptions {
  std::string input;        // pattern, or the folder of a recording
  std::string out;          // pattern; may be empty with --dry-run, --explain and --truth
  SequenceInput sequence;   // how the frames are to be understood, but for the jitter
  std::string jitter;       // as JitterSource::parse() takes it
  ResolveSettings resolve;  // sizes and formats follow from the frames
  // Those of a recording; `resolve` then has all that was said otherwise.
  std::optional<RecordedSettings> recorded;
  bool method_named = false;     // else it follows from the frames, too
  bool noise_by_frames = false;  // resolve.temporal.noise follows from them, as well
  ChannelType stored = ChannelType::kHalf;
  float exposure = 0;
  std::string truth;         // pattern; empty: none
  std::string truth_colour;  // its layer, as SequenceInput has it

  std::optional<std::vector<std::int64_t>> frames;  // absent: all there are
  std::optional<int> warm_up;                       // absent: what the method looks back
  bool resume = false;
  bool skip_bad_frames = false;
  std::uint64_t memory = kDefaultHistoryBytes;  // of histories, as SequenceJob has it

  bool dry_run = false;
  bool explain = false;
  bool diagnose = false;  // every channel is then read, whatever the method
  bool list_devices = false;
  int threads = 1;
  std::string device;
  std::string report;  // base name of .txt and .json; empty: none
  bool json = false;
  bool quiet = false;
  int verbosity = 0;

  std::string command_line;  // as typed, for the report
};

// Returns the table of options; they write into `options`, which holds the defaults and must outlive the parsing.
CommandLine command_line(ResolveOptions& options);

// Reads a command line. On --help, --version or an error it prints and gives the exit code instead.
std::optional<int> parse_command_line(int argc, char** argv, ResolveOptions& options);

struct ResolveTask {
  FramePattern input;
  SequenceFormat format = {};
  std::vector<std::int64_t> asked = {};  // for
  std::vector<std::int64_t> there = {};  // frames of `asked` that are there, by --resume
  std::vector<std::int64_t> stale = {};  // by --resume, too: there, but broken or made otherwise; made again
  SequenceScan scan = {};                // scan of the rest and their history
  ResolveSettings resolve = {};          // as asked for, with the method settled
  std::string method_reason = {};        // why this one; empty: it was asked for
  ResolvePlan plan = {};                 // for the largest frame
  std::optional<SequenceOutput> output = {};
  std::optional<TruthFiles> truth = {};

  // Whether the run can begin: a problem of the scan (unless bad frames may be skipped), of the names of the files, or
  // of the truth. Errors: as of SequenceScan::problem(), SequenceOutput::check_names() and SequenceScores::create().
  Status check(bool skip_bad_frames) const;
};

// Takes the settings of the recording in folder `options.input` for defaults, to parse the command line again. Errors:
// kIoFailure, as of read_settings().
Status take_recorded(ResolveOptions& options);

// Reads headers, and pixels only where noise follows from them; writes nothing. Errors: kInvalidArgument for what the
// command line should have said otherwise, kIoFailure where the first frame cannot be used.
Result<ResolveTask> prepare(const ResolveOptions& options);

}  // namespace quincunx::tools
