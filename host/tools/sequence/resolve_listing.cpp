// SPDX-License-Identifier: MIT
// What quincunx-resolve --dry-run prints.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/program/method_names.h"
#include "tools/sequence/frame_numbers.h"
#include "tools/sequence/resolve_advice.h"

namespace quincunx::tools {
namespace {

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

std::string summary_of(const SequenceScan& scan) {
  return fmt::format("at most {}, {} colour, {}, {}", size_text(scan.target()),
                     scan.half_colour() ? "half" : "float", scan.background() ? "opaque" : "with alpha",
                     scan.has_matrices() ? "camera known" : "camera not known");
}

std::string listing_text(const ResolveTask& task, bool verbose) {
  const SequenceScan& scan = task.scan;
  const auto line = [](const char* what, const std::string& value) {
    return fmt::format("{:<9} {}\n", what, value);
  };
  std::string text = line("Input", task.input.text());
  text += line("", summary_of(task.format));
  text += line("Output", task.output ? task.output->pattern.text() : "none: frames are only scored");
  text += line("", fmt::format("{}, {}{}", size_text(task.format.output), method_name(task.plan.settings),
                               task.method_reason.empty() ? "" : fmt::format(" ({})", task.method_reason)));
  if (!task.there.empty()) text += line("There", counted(task.there));
  text += line("Make", counted(scan.wanted()));
  if (!task.stale.empty())
    text += line("", fmt::format("{} (there, but made otherwise)", counted(task.stale)));
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
  return text;
}

std::string listing_json(const ResolveTask& task) {
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
      {"method", method_name(task.plan.settings)},
      {"method_reason", task.method_reason},
      {"warnings", advice_on(task)},
      {"there", task.there},
      {"make", scan.wanted()},
      {"read", read_frames(scan)},
      {"history_only", scan.history()},
      {"bad", scan.bad()},
      {"problems", problems_of(scan)},
  };
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quincunx::tools
