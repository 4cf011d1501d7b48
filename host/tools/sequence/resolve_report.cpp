// SPDX-License-Identifier: MIT
#include "tools/sequence/resolve_report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "tools/program/method_names.h"
#include "tools/program/pass_statistics.h"
#include "tools/sequence/frame_numbers.h"
#include "tools/sequence/resolve_advice.h"

namespace quincunx::tools {
namespace {

std::int64_t peak_memory_bytes() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;  // Linux counts in KiB
}

}  // namespace

RunReport resolve_report(const ResolveOptions& options, const ResolveTask& task, const Device& device,
                         const SequenceOutcome& outcome, std::span<const ScoreRow> scores) {
  RunReport report;
  report.program = "quincunx-resolve";
  report.version = QUINCUNX_VERSION;
  report.command_line = options.command_line;
  report.output = task.format.output;
  report.target = task.plan.settings.target;
  report.method = method_name(task.plan.settings);
  report.settings = {{"input", task.input.text()},
                     {"read as", summary_of(task.format)},
                     {"frames", frame_numbers_text(outcome.resolved)},
                     {"threads", fmt::format("{}", options.threads)}};
  if (!outcome.resolved.empty()) report.settings.emplace_back("frames are", summary_of(task.scan));
  if (!task.method_reason.empty()) report.settings.emplace_back("method chosen", task.method_reason);
  if (!task.there.empty()) report.settings.emplace_back("there", frame_numbers_text(task.there));
  if (!outcome.skipped.empty()) report.settings.emplace_back("skipped", frame_numbers_text(outcome.skipped));
  const DeviceInfo& cl = device.info();
  report.cl = {cl.platform, cl.name, cl.driver, cl.version, cl.compute_units};
  report.passes = pass_statistics(outcome.reports, pass_timer(device));
  report.steps = {statistics_of("upload", "host clock", outcome.upload_ms),
                  statistics_of("upload to download", "host clock", outcome.resolve_ms)};
  report.busy = outcome.busy;
  report.frames = outcome.rows;
  add_measured(report.frames, outcome.reports);
  report.scores.assign(scores.begin(), scores.end());
  report.left_out = task.plan.left_out;
  report.warnings = advice_on(task);
  report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  if (task.output && !outcome.resolved.empty()) {
    report.files = {task.output->path(outcome.resolved.front())};
    if (outcome.resolved.size() > 1) report.files.push_back(task.output->path(outcome.resolved.back()));
  }
  report.wall_seconds = outcome.wall_seconds;
  report.peak_memory_bytes = peak_memory_bytes();
  return report;
}

}  // namespace quincunx::tools
