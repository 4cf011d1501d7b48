// SPDX-License-Identifier: MIT
// quincunx-bench: speed against error of every method, at every scale, of every scene.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "bench/bench_options.h"
#include "bench/front/front_points.h"
#include "bench/speed_error/bench_compare.h"
#include "bench/speed_error/bench_findings.h"
#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/bench_run.h"
#include "tools/program/atomic_file.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

Status write_files(const std::string& folder, const BenchRun& run) {
  const auto write = [&folder](const char* name, const std::string& text) {
    return tools::write_text((std::filesystem::path(folder) / name).string(), text);
  };
  if (Status status = write("bench.json", to_tables(run.result)); !status.ok()) return status;
  if (Status status = write("bench.csv", to_csv(run.result)); !status.ok()) return status;
  if (Status status = write("bench.svg", plot_of(run.result)); !status.ok()) return status;
  return write("bench.html", page_of(run.result, run.gallery));
}

Result<BenchRun> results_for(const BenchOptions& options) {
  if (!options.from.empty()) {
    auto result = read_result(options.from);
    if (!result.ok()) return result.status();
    return BenchRun{std::move(result).value(), {}};
  }
  auto plan = plan_from(options);
  if (!plan.ok()) return plan.status();
  return run_bench(plan.value(), options);
}

void print_methods() {
  for (const BenchMethod& method : all_methods())
    fmt::print("{:<24} {}\n", method.name, method.summary);
}

int measure(const BenchOptions& options) {
  // Before minutes of work, so that a wrong name is no surprise at their end.
  std::optional<BenchResult> old;
  if (!options.compare.empty()) {
    auto read = read_result(options.compare);
    if (!read.ok()) return tools::fail(read.status());
    old = std::move(read).value();
  }
  auto run = results_for(options);
  if (!run.ok()) return tools::fail(run.status());
  if (!options.out.empty()) {
    if (Status status = write_files(options.out, run.value()); !status.ok()) return tools::fail(status);
  }
  if (options.json) {
    fmt::print("{}", to_json(run->result));
  } else if (!options.quiet) {
    fmt::print("{}", text_of(run->result));
    if (!options.out.empty()) fmt::print("\nThe page: {}/bench.html\n", options.out);
  }
  if (!old) return tools::kDone;
  const auto comparison = compare(*old, run->result);
  if (!comparison.ok()) return tools::fail(comparison.status());
  if (!options.quiet) fmt::print(options.json ? stderr : stdout, "\n{}", text_of(comparison.value()));
  return comparison->worse() ? tools::kFailed : tools::kDone;
}

int replay_traces(const BenchOptions& options) {
  const auto run = traces::run_traces(options.traces);
  if (!run.ok()) return tools::fail(run.status());
  if (!options.out.empty()) {
    if (Status status = traces::write_files(run.value(), options.out, options.command_line); !status.ok()) {
      return tools::fail(status);
    }
  }
  if (options.json) {
    fmt::print("{}", traces::json_of(run.value()));
  } else if (!options.quiet) {
    fmt::print("{}", traces::text_of(run.value()));
    if (!options.out.empty()) fmt::print("\nThe page: {}/traces.html\n", options.out);
  }
  return tools::kDone;
}

// Makes tables instead of the whole comparison: `measure` returns what text_of(), json_of() and csv_of() take; `name`
// is that of the files in --out.
template <typename Measure>
int tabulate(const BenchOptions& options, const std::string& name, const Measure& measure) {
  const auto result = measure(options);
  if (!result.ok()) return tools::fail(result.status());
  if (!options.out.empty()) {
    const std::string base = (std::filesystem::path(options.out) / name).string();
    Status status = tools::write_text(base + ".json", json_of(result.value()));
    if (status.ok()) status = tools::write_text(base + ".csv", csv_of(result.value()));
    if (!status.ok()) return tools::fail(status);
  }
  if (options.json) {
    fmt::print("{}", json_of(result.value()));
  } else if (!options.quiet) {
    fmt::print("{}", text_of(result.value()));
  }
  return tools::kDone;
}

int write_measured_front(const BenchOptions& options) {
  const auto front = measure_front(options);
  if (!front.ok()) return tools::fail(front.status());
  if (Status status = write_front(options, front.value()); !status.ok()) return tools::fail(status);
  if (options.json) {
    fmt::print("{}", front->to_json());
  } else if (!options.quiet) {
    fmt::print("{}", text_of(front.value()));
  }
  return tools::kDone;
}

int run(int argc, char** argv) {
  BenchOptions options;
  if (const auto exit_code = parse_command_line(argc, argv, options)) return *exit_code;
  tools::set_up_log(options.quiet, options.verbosity);
  // Some hundred services are made here; each would say how its frames pass.
  if (!options.quiet && options.verbosity == 0) spdlog::set_level(spdlog::level::warn);
  if (options.list_methods) {
    print_methods();
  } else if (options.list_scenes) {
    scenes::print_scenes();
  } else if (options.list_devices) {
    scenes::print_devices(options);
  } else if (options.traces.quality) {
    return tabulate(options, "quality",
                    [](const BenchOptions& all) { return traces::run_quality(all.traces); });
  } else if (options.traces.wanted) {
    return replay_traces(options);
  } else if (options.resize.wanted) {
    return tabulate(options, "resize", run_resize);
  } else if (options.parts_bench.wanted) {
    return tabulate(options, "parts", run_parts);
  } else if (options.tune.wanted) {
    return tabulate(options, "tune", run_tune);
  } else if (!options.front.file.empty()) {
    return write_measured_front(options);
  } else {
    return measure(options);
  }
  return tools::kDone;
}

}  // namespace
}  // namespace quincunx::bench

int main(int argc, char** argv) {
  return quincunx::tools::run_program("quincunx-bench", quincunx::bench::run, argc, argv);
}
