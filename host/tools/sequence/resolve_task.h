// SPDX-License-Identifier: MIT
// ResolveTask: a command line of quincunx-resolve, looked at together with the files that are there: what is
// to be read, resolved and written, before anything of it is done.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/sequence/resolve_options.h"
#include "tools/sequence/sequence_output.h"
#include "tools/sequence/sequence_scan.h"
#include "tools/sequence/sequence_scores.h"

namespace quincunx::tools {

struct ResolveTask {
  FramePattern input;
  SequenceFormat format = {};
  std::vector<std::int64_t> asked = {};  // for
  std::vector<std::int64_t> there = {};  // of them, by --resume
  std::vector<std::int64_t> stale = {};  // by --resume, too: there, but made otherwise; made again
  SequenceScan scan = {};                // of the rest and their history
  ResolveSettings resolve = {};          // as asked for, with the method settled
  std::string method_reason = {};        // why this one; empty: it was asked for
  ResolvePlan plan = {};                 // for the largest frame
  std::optional<SequenceOutput> output = {};
  std::optional<TruthFiles> truth = {};

  // Whether the run can begin: a problem of the scan (unless bad frames may be skipped) or of the names of
  // the files. Errors: as of SequenceScan::problem() and SequenceOutput::check_names().
  Status check(bool skip_bad_frames) const;
};

// Reads headers, no pixels, and writes nothing. Errors: kInvalidArgument for what the command line should
// have said otherwise, kIoFailure where the first frame cannot be used.
Result<ResolveTask> prepare(const ResolveOptions& options);

// What the good frames are, of which there must be one: "at most 454x255, half colour, with alpha, camera known".
std::string summary_of(const SequenceScan& scan);

// What --dry-run prints: text for a person, listing every file where `verbose`, or JSON.
std::string listing_text(const ResolveTask& task, bool verbose);
std::string listing_json(const ResolveTask& task);

}  // namespace quincunx::tools
