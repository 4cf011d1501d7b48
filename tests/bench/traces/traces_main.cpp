// SPDX-License-Identifier: MIT
// quincunx-traces: every resolution controller over scripted and recorded loads, on a simulated display.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "tools/atomic_file.h"
#include "tools/program.h"
#include "traces/recorded_trace.h"
#include "traces/trace_run.h"

namespace quincunx::traces {
namespace {

struct Options {
  std::vector<double> refresh_hz = {60};
  std::vector<int> buffers = {3};
  std::vector<int> latencies = {1};
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  std::vector<std::string> recorded;
  Recording recording;
  bool every_display = false;
  std::string json;
  std::string csv;
};

Result<LoadTrace> read_recorded(const std::string& path, const Recording& recording) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) return Status::io(path + " cannot be read");
  return recorded_trace(path, text.str(), recording);
}

int run(Options options) {
  if (options.every_display) {
    options.refresh_hz = {30, 60, 120};
    options.buffers = {3, 2};
    options.latencies = {1, 2, 3, 4};
  }
  TraceSettings settings{.displays = {}, .seeds = options.seeds};
  for (const int buffers : options.buffers) {
    for (const double hz : options.refresh_hz) {
      for (const int latency : options.latencies)
        settings.displays.push_back({hz, buffers, latency});
    }
  }
  if (!options.recorded.empty()) {
    std::vector<LoadTrace> traces;
    for (const std::string& path : options.recorded) {
      const Result<LoadTrace> trace = read_recorded(path, options.recording);
      if (!trace.ok()) return tools::fail(trace.status());
      traces.push_back(trace.value());
    }
    settings.lists.push_back({"recorded", [traces](std::uint64_t) { return traces; }});
  }
  const TraceRun result = run_traces(settings);
  fmt::print("{}", text_of(result));
  if (!options.json.empty()) {
    if (const Status status = tools::write_text(options.json, json_of(result)); !status.ok())
      return tools::fail(status);
  }
  if (!options.csv.empty()) {
    if (const Status status = tools::write_text(options.csv, csv_of(result)); !status.ok())
      return tools::fail(status);
  }
  return tools::kDone;
}

void declare(CLI::App& app, Options& options) {
  app.add_option("--hz", options.refresh_hz, "refresh rates")->check(CLI::Range(1.0, 1000.0));
  app.add_option("--buffers", options.buffers, "buffers of the swap chain")->check(CLI::Range(2, 8));
  app.add_option("--latency", options.latencies, "frames until a timer comes back")->check(CLI::Range(1, 8));
  app.add_flag("--every-display", options.every_display,
               "30, 60, 120 Hz; 2 and 3 buffers; timers 1 to 4 frames late");
  app.add_option("--seeds", options.seeds, "seeds of the scripted loads (default: 1 2 3)");
  app.add_option("--recorded", options.recorded,
                 "also replay these CSV files (columns gpu_ms, area_fraction, cpu_ms)");
  app.add_option("--recorded-target-ms", options.recording.target_ms,
                 "target that recorded times are measured in");
  app.add_option("--recorded-fixed-part", options.recording.fixed_part,
                 "part of recorded costs that does not scale");
  app.add_option("--json", options.json, "also write the figures to this file");
  app.add_option("--csv", options.csv, "also write one line per controller, display and trace to this file");
}

}  // namespace
}  // namespace quincunx::traces

int main(int argc, char** argv) {
  quincunx::traces::Options options;
  CLI::App app("Resolution controllers over scripted and recorded loads, on a simulated display");
  quincunx::traces::declare(app, options);
  CLI11_PARSE(app, argc, argv);
  quincunx::tools::set_up_log(false, 0);
  try {
    return quincunx::traces::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  return quincunx::tools::kFailed;
}
