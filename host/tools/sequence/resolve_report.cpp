// SPDX-License-Identifier: MIT
#include "tools/sequence/resolve_report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/program/frame_pattern.h"
#include "tools/program/run_report.h"
#include "tools/sequence/resolve_advice.h"

namespace quincunx::tools {
namespace {

std::int64_t peak_memory_bytes() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;  // Linux counts in KiB
}

using Json = nlohmann::ordered_json;
using Frames = std::vector<std::int64_t>;

std::string counted(const Frames& frames) {
  if (frames.empty()) return "nothing";
  return fmt::format("{} frame{}: {}", frames.size(), frames.size() == 1 ? "" : "s",
                     frame_numbers_text(frames));
}

std::string size_text(Extent extent) {
  return fmt::format("{}x{}", extent.width, extent.height);
}

Frames read_frames(const SequenceScan& scan) {
  Frames frames;
  for (const ScannedFrame& frame : scan.frames)
    frames.push_back(frame.number);
  return frames;
}

std::vector<std::string> problems_of(const SequenceScan& scan) {
  std::vector<std::string> problems;
  for (const ScannedFrame& frame : scan.frames) {
    if (!frame.problem.empty()) problems.push_back(frame.problem);
  }
  return problems;
}

void add_files(std::string& text, const ResolveTask& task) {
  for (const ScannedFrame& frame : task.scan.frames) {
    if (!frame.problem.empty()) continue;
    text += fmt::format("  {} {}{} -> {}\n", task.input.expand(frame.number), size_text(frame.render),
                        frame.reset ? ", without history" : "",
                        !frame.wanted ? "history of the next"
                        : task.output ? task.output->path(frame.number)
                                      : "scores");
  }
}

}  // namespace

RunReport resolve_report(const ResolveOptions& options, const ResolveTask& task, const Device& device,
                         const SequenceOutcome& outcome, std::span<const ScoreRow> scores) {
  RunReport report;
  report.program = "quincunx-resolve";
  report.version = QUINCUNX_VERSION;
  report.command_line = options.command_line;
  report.output = task.format.output;
  report.target = task.plan.settings.target_extent;
  report.method = name_of(variant_of(task.plan.settings));
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
  report.passes = outcome.measured.passes(pass_timer(device));
  report.steps = {outcome.upload_ms.statistics("upload", "host clock"),
                  outcome.resolve_ms.statistics("upload to download", "host clock")};
  report.busy = outcome.busy;
  report.frames = outcome.rows;
  outcome.measured.fill(report.frames);
  report.scores.assign(scores.begin(), scores.end());
  report.left_out = task.plan.left_out;
  if (task.resolve.checks_motion && !outcome.measured.empty())
    report.settings.emplace_back("motion check", text_of(outcome.measured.motion()));
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

// Parts of quincunx-resolve --dry-run's text.

std::string summary_of(const SequenceScan& scan) {
  return fmt::format("at most {}, {} colour, {}, {}", size_text(scan.target()),
                     scan.half_colour() ? "half" : "float", scan.background() ? "opaque" : "with alpha",
                     scan.has_matrices() ? "camera known" : "camera not known");
}

std::string listing_text(const ResolveTask& task, const std::string& diagnosis, bool verbose) {
  const SequenceScan& scan = task.scan;
  const auto line = [](const char* what, const std::string& value) {
    return fmt::format("{:<9} {}\n", what, value);
  };
  std::string text = line("Input", task.input.text());
  text += line("", summary_of(task.format));
  text += line("Output", task.output ? task.output->pattern.text() : "none: frames are only scored");
  text +=
      line("", fmt::format("{}, {}{}", size_text(task.format.output), name_of(variant_of(task.plan.settings)),
                           task.method_reason.empty() ? "" : fmt::format(" ({})", task.method_reason)));
  if (const float noise = task.resolve.temporal.noise; noise > 0)
    text += line("", fmt::format("denoised as of {:.3g} samples a pixel", 1 / noise));
  if (!task.there.empty()) text += line("There", counted(task.there));
  text += line("Make", counted(scan.wanted()));
  if (!task.stale.empty())
    text += line("", fmt::format("{} (there, but not whole or made otherwise)", counted(task.stale)));
  text += line("Read", counted(read_frames(scan)));
  if (const Frames history = scan.history(); !history.empty())
    text += line("", fmt::format("{} (only as history)", counted(history)));
  if (scan.target() != Extent{}) text += line("", summary_of(scan));
  for (const std::string& warning : advice_on(task))
    text += line("Warning", warning);
  if (verbose) add_files(text, task);
  const std::vector<std::string> problems = problems_of(scan);
  text += line("Missing", problems.empty() ? "nothing" : counted(scan.bad()));
  for (const std::string& problem : problems)
    text += fmt::format("  {}\n", problem);
  if (!diagnosis.empty()) text += line("Diagnosis", diagnosis);
  return text;
}

std::string listing_json(const ResolveTask& task, const std::string& diagnosis) {
  const SequenceScan& scan = task.scan;
  const Extent target = scan.target();
  const Json json = {
      {"input", task.input.text()},
      {"format", summary_of(task.format)},
      {"output", task.output ? Json(task.output->pattern.text()) : Json(nullptr)},
      {"output_size", {task.format.output.width, task.format.output.height}},
      {"largest_render_size", {target.width, target.height}},
      {"opaque", scan.background()},
      {"camera_known", scan.has_matrices()},
      {"method", name_of(variant_of(task.plan.settings))},
      {"method_reason", task.method_reason},
      {"warnings", advice_on(task)},
      {"there", task.there},
      {"make", scan.wanted()},
      {"read", read_frames(scan)},
      {"history_only", scan.history()},
      {"bad", scan.bad()},
      {"problems", problems_of(scan)},
      {"diagnosis", diagnosis.empty() ? Json(nullptr) : Json(diagnosis)},
  };
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quincunx::tools
