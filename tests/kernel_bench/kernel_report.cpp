// SPDX-License-Identifier: MIT
#include "kernel_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

double gigabytes_per_second(const Figures& figures) {
  return static_cast<double>(figures.what.bytes) / figures.ms.median * 1e-6;
}

double rounded(double value) {
  return std::stod(fmt::format("{:.4g}", value));
}

Json json_of(const Timing& timing) {
  return {
      {"median", rounded(timing.median)}, {"p95", rounded(timing.p95)}, {"minimum", rounded(timing.minimum)}};
}

Json json_of(const Figures& figures, const Figures& copy) {
  const Case& what = figures.what;
  return {{"name", what.name},
          {"scale", what.scale},
          {"wanted", what.wanted > 0 ? Json(what.wanted) : Json(nullptr)},
          {"ms", json_of(figures.ms)},
          {"processor_ms", json_of(figures.processor_ms)},
          {"ratio", rounded(figures.ms.median / copy.ms.median)},
          {"processor_ratio", rounded(figures.processor_ms.median / copy.processor_ms.median)},
          {"bytes", what.bytes},
          {"gigabytes_per_second", rounded(gigabytes_per_second(figures))}};
}

std::string text_of(const Run::Size& size) {
  const Figures& copy = size.figures.front();
  std::string text = fmt::format("\n{}x{}\n{:<40} {:>8} {:>8} {:>8} {:>6} {:>8} {:>6} {:>6} {:>6}\n",
                                 size.output.width, size.output.height, "case", "median", "p95", "min",
                                 "ratio", "cpu ms", "ratio", "wanted", "GB/s");
  for (const Figures& one : size.figures) {
    const std::string wanted = one.what.wanted > 0 ? fmt::format("{:.2f}", one.what.wanted) : "";
    text += fmt::format(
        "{:<40} {:>8.3f} {:>8.3f} {:>8.3f} {:>6.2f} {:>8.3f} {:>6.2f} {:>6} {:>6.1f}\n", one.what.name,
        one.ms.median, one.ms.p95, one.ms.minimum, one.ms.median / copy.ms.median, one.processor_ms.median,
        one.processor_ms.median / copy.processor_ms.median, wanted, gigabytes_per_second(one));
  }
  return text;
}

}  // namespace

std::string text_of(const Run& run) {
  std::string text = fmt::format("{} | {} {}\n", run.device.name, run.device.platform, run.device.driver);
  if (!run.opengl.empty()) text += fmt::format("{}\n", run.opengl);
  text += fmt::format("{}, {}, {} rounds; ms; ratio = median / median of the float4 copy\n", run.date,
                      run.command, run.rounds);
  for (const Run::Size& size : run.sizes)
    text += text_of(size);
  return text;
}

std::string json_of(const Run& run) {
  Json sizes = Json::array();
  for (const Run::Size& size : run.sizes) {
    Json cases = Json::array();
    for (const Figures& one : size.figures)
      cases.push_back(json_of(one, size.figures.front()));
    sizes.push_back({{"output", {size.output.width, size.output.height}}, {"cases", std::move(cases)}});
  }
  const Json root = {{"device", run.device.name},
                     {"platform", run.device.platform},
                     {"driver", run.device.driver},
                     {"opengl", run.opengl.empty() ? Json(nullptr) : Json(run.opengl)},
                     {"date", run.date},
                     {"command", run.command},
                     {"rounds", run.rounds},
                     {"sizes", std::move(sizes)}};
  return root.dump(2) + "\n";
}

}  // namespace quincunx::bench
