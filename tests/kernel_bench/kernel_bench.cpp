// SPDX-License-Identifier: MIT
// quincunx-kernel-bench: the time of each pass, and of the same work by other means, in units of a float4
// copy.
#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "bench/harness/event_times.h"
#include "clear_cases.h"
#include "kernel_cases.h"
#include "kernel_report.h"
#include "opencl.h"
#include "peers.h"
#include "quincunx_gl/egl_context.h"
#include "stage.h"
#include "tools/program/atomic_file.h"
#include "tools/program/command_line.h"
#include "tools/program/date.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

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
    add_oiio_peers(cases, stage.output(), scale);
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
  std::optional<gl::EglContext> context;
  if (options.peers) {
    Result<gl::EglContext> created = gl::EglContext::create();
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

void declare(tools::CommandLine& app, Options& options) {
  app.add_option("--device", options.device, "part of a device's name, its number, cpu or gpu");
  app.add_option_function<std::vector<std::string>>(
         "--output",
         [&options](const std::vector<std::string>& sizes) {
           options.outputs.clear();
           for (const std::string& size : sizes) {
             Extent extent;
             const std::string error = tools::parse_extent(size, extent);
             if (!error.empty()) throw tools::UsageError{"--output", error};
             options.outputs.push_back(extent);
           }
         },
         "output sizes, one or more (default: 1280x720)")
      .expected(1, 16);
  app.add_option("--scales", options.scales, "render scales").in_range(.01, 4.0);
  app.add_option("--rounds", options.rounds, "measured rounds").in_range(1, 100000);
  app.add_option("--filter", options.filters, "only cases whose name contains one of these");
  app.add_flag("!--no-peers", options.peers, "leave out C++, OpenImageIO and GL");
  app.add_flag("--clears", options.clears, "instead of the passes: full against partial clears");
  app.add_option("--json", options.json, "also write the figures to this file");
}

}  // namespace
}  // namespace quincunx::bench

int main(int argc, char** argv) {
  quincunx::bench::Options options;
  quincunx::tools::CommandLine app(
      "The time of each pass, and of the same work by other means, in units of a float4 copy",
      "quincunx-kernel-bench", "", "");
  quincunx::bench::declare(app, options);
  if (const std::optional<int> code = app.parse(argc, argv)) return *code;
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
