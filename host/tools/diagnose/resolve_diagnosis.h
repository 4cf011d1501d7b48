// SPDX-License-Identifier: MIT
// The frames of quincunx-resolve --diagnose, and what it prints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/diagnose.h"
#include "tools/sequence/resolve_task.h"

namespace quincunx::tools {

DiagnosedInput diagnosed_input(const ResolveTask& task);

// Reads the first frames of the task, as many as tell enough. Errors: kIoFailure, naming a file.
Result<std::vector<DiagnosedFrame>> read_for_diagnosis(const ResolveTask& task);

// Returns a table for a person.
std::string diagnosis_text(std::span<const DiagnosedFrame> frames, const Diagnosis& diagnosis);

// Returns JSON with the jitter that fits of every frame of the task, as --jitter takes it for a file; a frame whose
// jitter nobody told keeps its own.
std::string diagnosis_json(const ResolveTask& task, const Diagnosis& diagnosis);

}  // namespace quincunx::tools
