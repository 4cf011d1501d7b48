// SPDX-License-Identifier: MIT
#include "bench/traces/trace_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/page/bench_files.h"
#include "tools/page/page_template.h"

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

}  // namespace quincunx::traces
