// SPDX-License-Identifier: MIT
// The frames of quincunx-resolve --diagnose, and what it prints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/diagnose.h"
#include "tools/sequence/resolve_task.h"

namespace quincunx::tools {

// Frames to look at, and what the input says of them.
struct DiagnosedSequence {
  std::vector<DiagnosedFrame> frames = {};
  DiagnosedInput input = {};
};

// Reads the task's first frames, files or a recording's: those that tell enough, at most so many. Of a recording the
// camera is not looked at. Errors: kIoFailure, naming a file; kInvalidArgument for half shaded frames.
Result<DiagnosedSequence> read_for_diagnosis(const ResolveTask& task, std::size_t most = 16);

// Looks at them; what mends a recording is told in the terms of the library.
Diagnosis diagnose(const ResolveTask& task, const DiagnosedSequence& sequence);

// Returns a table for a person.
std::string diagnosis_text(std::span<const DiagnosedFrame> frames, const Diagnosis& diagnosis);

// Returns what a listing says, by the first frames: "nothing wrong in frames 1 to 5"; empty where looking at them takes
// more than a moment, or where they cannot be read.
std::string diagnosis_line(const ResolveTask& task);

// Returns JSON with the jitter that fits of every frame of the task, as --jitter takes it for a file; a frame whose
// jitter nobody told keeps its own.
std::string diagnosis_json(const ResolveTask& task, const Diagnosis& diagnosis);

// Returns one HTML file that needs nothing else. `input`: the frames' name; `json`: that of the diagnosis. Pictures of
// more than 960x540 are cropped about their middle. Errors: kInvalidArgument for maps that are no pictures.
Result<std::string> diagnosis_page(const std::string& input, const std::string& json,
                                   std::span<const FailureMap> maps);

// Writes BASE.txt, BASE.json and BASE.html, which shows where in the picture the input's word fails. Errors:
// kIoFailure.
Status write_diagnosis(const std::string& base, const ResolveTask& task, const DiagnosedSequence& sequence,
                       const Diagnosis& diagnosis);

}  // namespace quincunx::tools
