// SPDX-License-Identifier: MIT
#include "bench/traces/trace_command.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "embedded_bench_files.h"
#include "tools/page/page.h"
#include "tools/program/atomic_file.h"

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
  const auto text = tools::read_text(path);
  if (!text.ok()) return text.status();
  return recorded_trace(path, text.value(), recording);
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
  return tools::make_page({.title = "resolution controllers",
                           .script = tools::text_of(bench::embedded_bench_files(), "traces.js"),
                           .beside = "traces.csv"},
                          {{"command", command},
                           {"frames", longest},
                           {"refresh_hz", settings.displays.front().refresh_hz},
                           {"run", Json::parse(json_of(run))},
                           {"traces", std::move(traces)}});
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

}  // namespace quincunx::traces
