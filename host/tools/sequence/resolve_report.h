// SPDX-License-Identifier: MIT
// Texts of quincunx-resolve: the list of --dry-run, and the report of a run.
#pragma once

#include <span>

#include "quincunx/device.h"
#include "tools/program/run_report.h"
#include "tools/sequence/resolve_task.h"
#include "tools/sequence/sequence_resolver.h"

namespace quincunx::tools {

// Returns the text of --dry-run: for a person, listing every file where `verbose`, or JSON.
// `diagnosis`: what diagnosis_line() says, which may be nothing.
std::string listing_text(const ResolveTask& task, const std::string& diagnosis, bool verbose);
std::string listing_json(const ResolveTask& task, const std::string& diagnosis);

// Describes the good frames, of which there must be one: "at most 454x255, half colour, with alpha, camera known".
std::string summary_of(const SequenceScan& scan);

RunReport resolve_report(const ResolveOptions& options, const ResolveTask& task, const Device& device,
                         const SequenceOutcome& outcome, std::span<const ScoreRow> scores);

}  // namespace quincunx::tools
