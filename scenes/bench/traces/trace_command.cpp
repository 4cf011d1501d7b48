// SPDX-License-Identifier: MIT
#include "bench/traces/trace_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "embedded_bench_files.h"
#include "tools/page/page_template.h"
#include "tools/program/atomic_file.h"
#include "tools/program/command_line.h"

namespace quincunx::traces {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDigits = 1000;  // thousandths are enough for a plot

// [frame, value, ...] where the value changes.
template <typename Value>
Json curve(std::size_t frames, Value value) {
  Json list = Json::array();
  double last = -1;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double now = std::round(value(frame) * kDigits) / kDigits;
    if (now == last) continue;
    list.push_back(frame);
    list.push_back(now);
    last = now;
  }
  return list;
}

Json drops(const std::vector<ReplayedFrame>& frames) {
  Json list = Json::array();
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    if (frames[frame].dropped == 0) continue;
    list.push_back(frame);
    list.push_back(frames[frame].dropped);
  }
  return list;
}

Json trace_json(const std::string& list, const LoadTrace& trace, const TraceSettings& settings) {
  const std::size_t count = trace.frames.size();
  Json json = {{"list", list}, {"name", trace.name}};
  json["load"] = curve(count, [&](std::size_t frame) { return trace.frames[frame].gpu(1); });
  json["cpu"] = curve(count, [&](std::size_t frame) { return trace.frames[frame].cpu; });
  json["curves"] = Json::array();
  const Display& display = settings.displays.front();
  for (const ControllerKind& kind : controller_kinds()) {
    const auto controller = kind.make(settings.ladder, display);
    const std::vector<ReplayedFrame> frames = replay(trace, display, *controller);
    if (json["curves"].empty()) {
      json["oracle"] = curve(count, [&](std::size_t frame) { return frames[frame].oracle_area; });
    }
    json["curves"].push_back({{"area", curve(count, [&](std::size_t frame) { return frames[frame].area; })},
                              {"dropped", drops(frames)}});
  }
  return json;
}

Result<LoadTrace> read_recorded(const std::string& path, const Recording& recording) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) return Status::io(path + " cannot be read");
  return recorded_trace(path, text.str(), recording);
}

std::vector<Display> displays_of(TraceOptions options) {
  if (options.every_display) {
    options.refresh_hz = {60, 30, 120};
    options.buffers = {3, 2};
    options.latencies = {1, 2, 3, 4};
  }
  std::vector<Display> displays;
  for (const int buffers : options.buffers) {
    for (const double hz : options.refresh_hz) {
      for (const int latency : options.latencies)
        displays.push_back({hz, buffers, latency});
    }
  }
  return displays;
}

void add_quality_options(tools::CommandLine& app, TraceOptions& options) {
  const auto quality =
      app.add_flag("--quality", options.quality,
                   "With --traces: a scripted picture and the passes of each method besides; the "
                   "quality controller, beside predictive with each method")
          .needs("--traces")
          .excludes("--recorded")
          .excludes("--every-display");
  app.add_option("--budgets", options.budgets,
                 "With --quality: multiples of the time that frames are written for (default: 1)")
      .in_range(0.1, 10.0)
      .delimiter(',')
      .needs(quality);
  app.add_flag("--untimed", options.untimed, "With --quality: the time of the passes is not known apart")
      .needs(quality);
}

}  // namespace

std::string page_of(const TraceRun& run, const std::string& command) {
  const TraceSettings& settings = run.settings;
  Json traces = Json::array();
  std::size_t longest = 0;
  for (const NamedTraces& list : settings.lists) {
    for (const LoadTrace& trace : list.make(settings.seeds.front())) {
      longest = std::max(longest, trace.frames.size());
      traces.push_back(trace_json(list.name, trace, settings));
    }
  }
  return tools::page_from_template({.files = bench::embedded_bench_files(),
                                    .title = "resolution controllers",
                                    .body = "traces.html",
                                    .scripts = {"elements.js", "sorted_table.js", "traces.js"}},
                                   {{"command", command},
                                    {"frames", longest},
                                    {"refresh_hz", settings.displays.front().refresh_hz},
                                    {"run", Json::parse(json_of(run))},
                                    {"traces", std::move(traces)}});
}

void add_trace_options(tools::CommandLine& app, TraceOptions& options) {
  const auto traces = app.add_flag(
      "--traces", options.wanted, "Instead: resolution controllers over load traces, on a simulated display");
  app.add_option("--hz", options.refresh_hz, "With --traces: refresh rates (default: 60)")
      .in_range(1.0, 1000.0)
      .delimiter(',')
      .needs(traces);
  app.add_option("--buffers", options.buffers, "With --traces: buffers of the swap chain (default: 3)")
      .in_range(2, 8)
      .delimiter(',')
      .needs(traces);
  app.add_option("--latency", options.latencies,
                 "With --traces: frames until a timer comes back (default: 1)")
      .in_range(1, 8)
      .delimiter(',')
      .needs(traces);
  app.add_flag("--every-display", options.every_display,
               "With --traces: 30, 60, 120 Hz; 2 and 3 buffers; timers 1 to 4 frames late")
      .needs(traces);
  app.add_option("--seeds", options.seeds, "With --traces: seeds of the scripted loads (default: 1,2,3)")
      .delimiter(',')
      .needs(traces);
  app.add_option("--recorded", options.recorded,
                 "With --traces: also replay these CSV files (columns gpu_ms, area_fraction, cpu_ms)")
      .needs(traces)
      .type_name("FILE");
  app.add_option("--recorded-target-ms", options.recording.target_ms,
                 "With --traces: target that recorded times are measured in")
      .needs(traces);
  app.add_option("--recorded-fixed-part", options.recording.fixed_part,
                 "With --traces: part of recorded costs that does not scale")
      .needs(traces);
  add_quality_options(app, options);
}

Result<TraceRun> run_traces(const TraceOptions& options) {
  TraceSettings settings{.displays = displays_of(options), .seeds = options.seeds};
  std::vector<LoadTrace> recorded;
  for (const std::string& path : options.recorded) {
    auto trace = read_recorded(path, options.recording);
    if (!trace.ok()) return trace.status();
    recorded.push_back(std::move(trace).value());
  }
  if (!recorded.empty()) {
    settings.lists.push_back({"recorded", [recorded](std::uint64_t) { return recorded; }});
  }
  return run_traces(settings);
}

Result<QualityRun> run_quality(const TraceOptions& options) {
  return run_quality(QualityRunSettings{.display = displays_of(options).front(),
                                        .seeds = options.seeds,
                                        .times_passes = !options.untimed,
                                        .budgets = options.budgets});
}

Status write_files(const TraceRun& run, const std::string& folder, const std::string& command) {
  const auto write = [&folder](const char* name, const std::string& text) {
    return tools::write_text((std::filesystem::path(folder) / name).string(), text);
  };
  if (Status status = write("traces.json", json_of(run)); !status.ok()) return status;
  if (Status status = write("traces.csv", csv_of(run)); !status.ok()) return status;
  return write("traces.html", page_of(run, command));
}

}  // namespace quincunx::traces
