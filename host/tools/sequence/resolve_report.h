// SPDX-License-Identifier: MIT
// The report of a run of quincunx-resolve.
#pragma once

#include <span>

#include "quincunx/device.h"
#include "tools/program/run_report.h"
#include "tools/sequence/resolve_task.h"
#include "tools/sequence/sequence_resolver.h"

namespace quincunx::tools {

RunReport resolve_report(const ResolveOptions& options, const ResolveTask& task, const Device& device,
                         const SequenceOutcome& outcome, std::span<const ScoreRow> scores);

}  // namespace quincunx::tools
