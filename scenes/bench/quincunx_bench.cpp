// SPDX-License-Identifier: MIT
// quincunx-bench: speed against error of every method, at every scale, of every scene.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <type_traits>

#include "bench/bench_options.h"
#include "bench/front.h"
#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_compare.h"
#include "bench/speed_error/bench_findings.h"
#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/bench_run.h"
#include "tools/program/atomic_file.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

void write_files(const std::string& folder, const BenchRun& run) {
  const auto write = [&folder](const char* name, const std::string& text) {
    checked(tools::write_text((std::filesystem::path(folder) / name).string(), text));
  };
  write("bench.json", to_tables(run.result));
  write("bench.csv", to_csv(run.result));
  write("bench.svg", plot_of(run.result));
  write("bench.html", page_of(run.result, run.gallery));
}

BenchRun results_for(const BenchOptions& options) {
  if (!options.from.empty()) return {checked(read_result(options.from)), {}};
  return run_bench(checked(plan_from(options)), options);
}

void print_methods() {
  for (const BenchMethod& method : all_methods())
    fmt::print("{:<24} {}\n", method.name, method.summary);
}

int measure(const BenchOptions& options) {
  // Before minutes of work, so that a wrong name is no surprise at their end.
  std::optional<BenchResult> old;
  if (!options.compare.empty()) old = checked(read_result(options.compare));
  const BenchRun run = results_for(options);
  if (!options.out.empty()) write_files(options.out, run);
  if (options.json) {
    fmt::print("{}", to_json(run.result));
  } else if (!options.quiet) {
    fmt::print("{}", text_of(run.result));
    if (!options.out.empty()) fmt::print("\nThe page: {}/bench.html\n", options.out);
  }
  if (!old) return tools::kDone;
  const Comparison comparison = checked(compare(*old, run.result));
  if (!options.quiet) fmt::print(options.json ? stderr : stdout, "\n{}", text_of(comparison));
  return comparison.worse() ? tools::kFailed : tools::kDone;
}

// Makes tables instead of the whole comparison: `measure` returns what text_of(), json_of() and csv_of() take; `name`
// is that of the files in --out. page(result), if given, is written there, too.
template <typename Measure, typename Page = std::nullptr_t>
int tabulate(const BenchOptions& options, const std::string& name, const Measure& measure,
             const Page& page = {}) {
  const auto result = measure(options);
  const std::string base = (std::filesystem::path(options.out) / name).string();
  constexpr bool kHasPage = !std::is_same_v<Page, std::nullptr_t>;
  if (!options.out.empty()) {
    checked(tools::write_text(base + ".json", json_of(result)));
    checked(tools::write_text(base + ".csv", csv_of(result)));
    if constexpr (kHasPage) checked(tools::write_text(base + ".html", page(result)));
  }
  if (options.json) {
    fmt::print("{}", json_of(result));
  } else if (!options.quiet) {
    fmt::print("{}", text_of(result));
    if (kHasPage && !options.out.empty()) fmt::print("\nThe page: {}.html\n", base);
  }
  return tools::kDone;
}

int write_measured_front(const BenchOptions& options) {
  const ErrorFront front = measure_front(options);
  write_front(options, front);
  if (options.json) {
    fmt::print("{}", front.to_json());
  } else if (!options.quiet) {
    fmt::print("{}", text_of(front));
  }
  return tools::kDone;
}

int run_command(int argc, char** argv) {
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
                    [](const BenchOptions& all) { return checked(traces::run_quality(all.traces)); });
  } else if (options.traces.wanted) {
    return tabulate(
        options, "traces", [](const BenchOptions& all) { return checked(traces::run_traces(all.traces)); },
        [&options](const traces::TraceRun& run) { return traces::page_of(run, options.command_line); });
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

int run(int argc, char** argv) {
  try {
    return run_command(argc, argv);
  } catch (const Failure& failure) {
    return tools::fail(failure.status);
  }
}

}  // namespace
}  // namespace quincunx::bench

int main(int argc, char** argv) {
  return quincunx::tools::run_program("quincunx-bench", quincunx::bench::run, argc, argv);
}
