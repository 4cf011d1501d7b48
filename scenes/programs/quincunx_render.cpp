// SPDX-License-Identifier: MIT
// quincunx-render: draws a scene at a dynamic resolution and makes the picture from it.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>

#include "render_options.h"
#include "render_session.h"
#include "scene_catalog.h"
#include "tools/run_report.h"
#include "truth_run.h"

namespace quincunx::scenes {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

// The log goes to stderr: stdout is for what was asked for.
void set_up_log(const RenderOptions& options) {
  auto log = spdlog::stderr_color_mt("quincunx");
  log->set_pattern("%^%l:%$ %v");
  log->set_level(options.quiet            ? spdlog::level::err
                 : options.verbosity > 1  ? spdlog::level::trace
                 : options.verbosity == 1 ? spdlog::level::debug
                                          : spdlog::level::info);
  spdlog::set_default_logger(log);
}

int fail(const Status& status) {
  spdlog::error("{}", status.message());
  return status.code() == StatusCode::kInvalidArgument ? kUsage : kFailed;
}

int print_scenes() {
  for (const SceneEntry& entry : list_scenes()) {
    fmt::print("{:<12} {}\n{:<12} {}\n", entry.name, entry.summary, "", entry.reason);
  }
  return kDone;
}

int print_devices(const RenderOptions& options) {
  const std::vector<DeviceInfo> devices = Device::list();
  for (const DeviceInfo& device : devices) {
    fmt::print("OpenCL {}  {} ({}, {})\n          {} units, {:.1f} GiB{}{}\n", device.index, device.name,
               device.platform, device.driver, device.compute_units,
               static_cast<double>(device.global_memory_bytes) / (1 << 30), device.images ? ", images" : "",
               device.gl_sharing ? ", GL sharing advertised" : "");
  }
  if (devices.empty()) fmt::print("OpenCL    no device\n");
  auto context = gl::EglContext::create(options.platform);
  if (!context.ok()) {
    fmt::print("OpenGL    {}\n", context.status().message());
    return kDone;
  }
  fmt::print("OpenGL    {} ({})\n", context->info().renderer, context->info().version);
  return kDone;
}

int explain(const RenderOptions& options) {
  auto source = source_settings_for(options);
  if (!source.ok()) return fail(source.status());
  auto sequence = FrameSequence::create(source->sequence);
  if (!sequence.ok()) return fail(sequence.status());
  auto scene = open_scene(options.scene, options.seed);
  if (!scene.ok()) return fail(scene.status());
  ResolveSettings settings = resolve_settings_for(options);
  settings.output = sequence->output();
  settings.target = sequence->target();
  auto plan = plan_for(needs_of(scene.value()), settings);
  if (!plan.ok()) return fail(plan.status());
  fmt::print("Scene          {}: {}\n{}", scene->name, scene->summary, plan->explain());
  return kDone;
}

int render(const RenderOptions& options) {
  if (options.truth > 0) {
    const Status status = run_truth(options);
    return status.ok() ? kDone : fail(status);
  }
  auto session = RenderSession::create(options);
  if (!session.ok()) return fail(session.status());
  if (Status status = session.value()->run(); !status.ok()) return fail(status);
  const tools::RunReport report = session.value()->report();
  if (options.json) {
    fmt::print("{}\n", tools::to_json(report));
  } else if (!options.quiet) {
    fmt::print("{}", tools::to_text(report));
  }
  if (!options.report.empty()) {
    if (Status status = tools::write_report(options.report, report); !status.ok()) return fail(status);
  }
  return kDone;
}

int run(int argc, char** argv) {
  RenderOptions options;
  if (const auto exit_code = parse_command_line(argc, argv, options)) return *exit_code;
  set_up_log(options);
  if (options.list_scenes) return print_scenes();
  if (options.list_devices) return print_devices(options);
  if (options.explain) return explain(options);
  return render(options);
}

}  // namespace
}  // namespace quincunx::scenes

int main(int argc, char** argv) {
  try {
    return quincunx::scenes::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "quincunx-render: internal error: %s\n", error.what());
    return 1;
  }
}
