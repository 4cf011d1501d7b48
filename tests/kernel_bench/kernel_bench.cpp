// SPDX-License-Identifier: MIT
// The kernel benchmark: its options, its run, and what it says of it: a table to read and JSON to keep.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/measuring.h"
#include "device/opencl.h"
#include "kernel_cases.h"
#include "peers.h"
#include "quincunx/device.h"
#include "quincunx_gl/context.h"
#include "stage.h"
#include "tools/program/atomic_file.h"
#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

struct Run {
  DeviceInfo device;
  std::string opengl;   // renderer and version; empty: no peers of it
  std::string date;     // UTC, "2026-11-21 14:03"
  std::string command;  // as it was typed
  int rounds = 0;
  struct Size {
    Extent output;
    std::vector<Figures> figures;  // the first is the copy
  };
  std::vector<Size> sizes;
};

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

struct Options {
  std::string device;
  std::vector<std::string> filters;
  std::string json;
  std::vector<Extent> outputs = {{1280, 720}};
  std::vector<double> scales = {0.5, 0.71, 1.0};
  int rounds = 40;
  int warm_rounds = 5;
  bool peers = true;
  bool clears = false;
};

void keep_named(std::vector<Case>& cases, const std::vector<std::string>& filters) {
  if (filters.empty()) return;
  const auto kept = [&](const Case& one) {
    return std::any_of(filters.begin(), filters.end(),
                       [&](const std::string& filter) { return one.name.find(filter) != std::string::npos; });
  };
  std::erase_if(cases, [&](const Case& one) { return !kept(one); });
}

void add_passes(std::vector<Case>& cases, Stage& stage, bool opengl, const Options& options) {
  for (const double scale : options.scales)
    add_scaled_cases(cases, stage, scale);
  add_output_cases(cases, stage);
  if (!options.peers) return;
  for (const double scale : options.scales) {
    add_cpp_peers(cases, stage.output(), scale);
#ifdef QUINCUNX_OIIO_PEERS
    add_oiio_peers(cases, stage.output(), scale);
#endif
    if (opengl) add_gl_peers(cases, stage.output(), scale);
  }
}

Run::Size run_size(const Device& device, bool opengl, Extent output, const Options& options) {
  Stage stage(device, output);
  std::vector<Case> cases;
  if (options.clears) {
    add_clear_cases(cases, stage, opengl);
  } else {
    add_passes(cases, stage, opengl, options);
  }
  keep_named(cases, options.filters);
  if (cases.empty()) throw std::runtime_error("no case has a name that contains what --filter asks for");
  std::vector<Case> all;
  stage.add_copy(all);
  all.insert(all.end(), cases.begin(), cases.end());
  return {output, run_interleaved(all, options.warm_rounds, options.rounds)};
}

int run(const Options& options, const std::string& command) {
  const Result<Device> device = Device::open(options.device);
  if (!device.ok()) return tools::fail(device.status());
  if (Status status = check_event_times(device.value()); !status.ok()) return tools::fail(status);
  std::optional<gl::Context> context;
  if (options.peers) {
    Result<gl::Context> created = gl::Context::create();
    if (created.ok()) {
      context = std::move(created).value();
    } else {
      fmt::print(stderr, "without the peers that need GL: {}\n", created.status().message());
    }
  }
  Run figures{.device = device.value().info(),
              .opengl = context ? context->info().renderer + " | " + context->info().version : "",
              .date = tools::date_now(),
              .command = command,
              .rounds = options.rounds,
              .sizes = {}};
  for (const Extent output : options.outputs)
    figures.sizes.push_back(run_size(device.value(), context.has_value(), output, options));
  fmt::print("{}", text_of(figures));
  if (options.json.empty()) return tools::kDone;
  const Status status = tools::write_text(options.json, json_of(figures));
  return status.ok() ? tools::kDone : tools::fail(status);
}

tools::CommandLine command_line(Options& options) {
  tools::CommandLine line(
      "The time of each pass, and of the same work by other means, in units of a float4 copy",
      "quincunx-kernel-bench", "", "");
  tools::Setting sizes = tools::text("WxH,...", [&options, first = true](const std::string& size) mutable {
    if (std::exchange(first, false)) options.outputs.clear();
    return tools::parse_extent(size, options.outputs.emplace_back());
  });
  sizes.list = true;
  line.group("Options");
  line.add("--device", tools::text(options.device, "DEVICE"),
           "part of a device's name, its number, cpu or gpu");
  line.add("--output", sizes, "output sizes (default: 1280x720)");
  line.add("--scales", tools::number(options.scales, {.least = .01, .most = 4}, "S,..."), "render scales");
  line.add("--rounds", tools::number(options.rounds, {.least = 1, .most = 100000}), "measured rounds");
  line.add("--filter", tools::text(options.filters, "TEXT,..."),
           "only cases whose name contains one of these");
  line.add("--no-peers", tools::flag(options.peers, false), "leave out C++, OpenImageIO and GL");
  line.add("--clears", tools::flag(options.clears), "instead of the passes: full against partial clears");
  line.add("--json", tools::text(options.json, "FILE"), "also write the figures to this file").writes();
  return line;
}

}  // namespace

// quincunx-kernel-bench: the time of each pass, and of the same work by other means, in units of a float4
// copy.

}  // namespace quincunx::bench

int main(int argc, char** argv) {
  quincunx::bench::Options options;
  if (const std::optional<int> code = quincunx::bench::command_line(options).parse(argc, argv)) return *code;
  try {
    return quincunx::bench::run(options,
                                quincunx::tools::command_line_text("quincunx-kernel-bench", argc, argv));
  } catch (const cl::Error& error) {
    fmt::print(stderr, "{} failed: {}\n", error.what(), quincunx::error_name(error.err()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  return 1;
}
