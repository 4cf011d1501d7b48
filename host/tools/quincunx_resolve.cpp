// SPDX-License-Identifier: MIT
// quincunx-resolve: the resolve service over an EXR sequence of any renderer, without OpenGL.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <system_error>

#include "tools/image/image_reader.h"
#include "tools/page/page.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/program.h"
#include "tools/sequence/resolve_advice.h"
#include "tools/sequence/resolve_report.h"

#ifdef QUINCUNX_DIAGNOSE
#include "tools/diagnose/resolve_diagnosis.h"
#endif

namespace quincunx::tools {
namespace {

std::atomic<bool> stop_asked = false;

// Ctrl-C and the farm's TERM end the run after the frame at hand; a second signal ends it at once.
void stop_on_signals() {
  struct sigaction action = {};
  action.sa_handler = [](int) { stop_asked = true; };
  action.sa_flags = SA_RESETHAND;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

#ifdef QUINCUNX_DIAGNOSE
int print_diagnosis(const ResolveOptions& options, const ResolveTask& task) {
  constexpr int kFoundWrong = 3;
  if (const Status status = task.check(options.skip_bad_frames); !status.ok()) return fail(status);
  const auto sequence = read_for_diagnosis(task);
  if (!sequence.ok()) return fail(sequence.status());
  const Diagnosis diagnosis = diagnose(task, sequence.value());
  fmt::print("{}",
             options.json ? diagnosis_json(task, diagnosis) : diagnosis_text(sequence->frames, diagnosis));
  if (!options.report.empty()) {
    const Status status = write_diagnosis(options.report, task, sequence.value(), diagnosis);
    if (!status.ok()) return fail(status);
  }
  return diagnosis.wrong() ? kFoundWrong : kDone;
}
#else
std::string diagnosis_line(const ResolveTask&) {
  return {};
}
#endif

int print_listing(const ResolveOptions& options, const ResolveTask& task) {
  const Status status = task.check(options.skip_bad_frames);
  const bool listed = !task.scan.problem().ok();
  if (!status.ok() && !listed) return fail(status);
  const std::string diagnosis = diagnosis_line(task);
  fmt::print("{}", options.json ? listing_json(task, diagnosis)
                                : listing_text(task, diagnosis, options.verbosity > 0));
  return status.ok() ? kDone : kFailed;
}

// Tells what a careful user would want to know before the first frame.
void say_first(const ResolveOptions& options, const ResolveTask& task) {
  for (const ScannedFrame& frame : task.scan.frames) {
    if (!frame.problem.empty()) spdlog::warn("{}; it is skipped", frame.problem);
  }
  if (!task.stale.empty()) {
    spdlog::warn("{} frames are there, but not whole or made otherwise; they are made again: {}",
                 task.stale.size(), frame_numbers_text(task.stale));
  }
  if (!task.format.converted_from.empty()) {
    spdlog::info("colour is {}; it is made linear Rec. 709 (--input-colour takes another)",
                 task.format.converted_from);
  }
  if (task.format.camera != CameraSense{} && !options.sequence.camera)
    spdlog::info("worldToNDC is read as {} (--world-to-ndc takes another sense)",
                 text_of(task.format.camera));
  if (!task.method_reason.empty())
    spdlog::info("method {}: {} (--method takes another)", name_of(variant_of(task.plan.settings)),
                 task.method_reason);
  if (const float noise = task.resolve.temporal.noise; options.noise_by_frames && noise > 0)
    spdlog::info("frames are noisy: --noise {:.3g}", 1 / noise);
  if (options.noise_by_frames && task.resolve.temporal.noise == 0)
    spdlog::info("frames are clean, or do not tell their noise (--noise SPP does)");
  for (const std::string& warning : advice_on(task))
    spdlog::warn("{}", warning);
  if (options.recorded) {
    for (const std::string& difference : differences(options.resolve, options.recorded->settings))
      spdlog::info("not as it was recorded: {}", difference);
  }
  if (options.warm_up.value_or(0) > 0 && task.scan.frames.front().wanted) {
    spdlog::info("the sequence begins with frame {}: it has no history", task.scan.frames.front().number);
  }
  spdlog::debug("{}", summary_of(task.format));
}

Status write_reports(const ResolveOptions& options, const RunReport& report, const ReportPictures& pictures) {
  if (options.json) {
    fmt::print("{}\n", to_json(report));
  } else if (!options.quiet) {
    fmt::print("{}", to_text(report));
  }
  return options.report.empty() ? Status() : write_report(options.report, report, pictures);
}

Status resolve(const ResolveOptions& options, const ResolveTask& task) {
  const std::vector<std::int64_t> wanted = task.scan.wanted();
  std::unique_ptr<SequenceScores> scores;
  if (task.truth) {
    auto created = SequenceScores::create(*task.truth, task.format.output, wanted, !options.report.empty());
    if (!created.ok()) return created.status();
    scores = std::move(created).value();
  }
  auto device = Device::open(options.device);
  if (!device.ok()) return device.status();
  const std::string name = device->info().platform + " " + device->info().name;
  if (options.recorded && options.recorded->device != name)
    spdlog::info("recorded on '{}', resolved on '{}', which may round otherwise", options.recorded->device,
                 name);
  if (task.output) {
    if (Status status = task.output->prepare_folder(wanted); !status.ok()) return status;
  }
  auto resolver = SequenceResolver::create(device.value(), task.plan,
                                           {.input = task.input,
                                            .format = task.format,
                                            .scan = task.scan,
                                            .output = task.output,
                                            .exposure = options.exposure,
                                            .threads = options.threads,
                                            .skip_bad_frames = options.skip_bad_frames,
                                            .memory = options.memory,
                                            .scores = scores.get()});
  if (!resolver.ok()) return resolver.status();
  {
    using Show = Progress::Show;
    Progress progress("resolving", static_cast<std::int64_t>(task.scan.frames.size()),
                      options.quiet ? Show::kNever : Show::kOnTerminal);
    const auto tell = [&progress](std::int64_t done) { progress.update(done); };
    if (Status status = resolver.value()->run(tell, stop_asked); !status.ok()) return status;
  }
  const std::vector<ScoreRow> rows = scores ? scores->rows() : std::vector<ScoreRow>();
  return write_reports(options,
                       resolve_report(options, task, device.value(), resolver.value()->outcome(), rows),
                       scores ? scores->pictures() : ReportPictures());
}

std::string explanation_of(const ResolveTask& task) {
  if (task.format.two_way == 0) return task.plan.explain();
  return fmt::format(
      "Both ways      {} frames ahead; a second service goes backwards, as far as merge_histories\n{}",
      task.format.two_way, TwoWay::planned(task.plan).explain());
}

int run(int argc, char** argv) {
  ResolveOptions options;
  if (const auto exit_code = parse_command_line(argc, argv, options)) return *exit_code;
  set_up_log(options.quiet, options.verbosity);
  std::error_code error;
  if (std::filesystem::is_directory(options.input, error)) {
    if (Status status = take_recorded(options); !status.ok()) return fail(status);
    if (const auto exit_code = parse_command_line(argc, argv, options)) return *exit_code;
  }
  set_image_threads(options.threads);
  if (options.list_devices) {
    print_opencl_devices();
    return kDone;
  }
#ifndef QUINCUNX_DIAGNOSE
  if (options.diagnose) {
    return fail(
        Status::unsupported("this quincunx-resolve was built without --diagnose; configure with "
                            "-D QUINCUNX_DIAGNOSE=ON and build it again"));
  }
#endif
  auto task = prepare(options);
  if (!task.ok()) return fail(task.status());
  if (options.dry_run) return print_listing(options, task.value());
#ifdef QUINCUNX_DIAGNOSE
  if (options.diagnose) return print_diagnosis(options, task.value());
#endif
  if (Status status = task->check(options.skip_bad_frames); !status.ok()) return fail(status);
  if (options.explain) {
    fmt::print("{}{}", device_lines(Device::open(options.device)), explanation_of(task.value()));
    return kDone;
  }
  if (task->scan.frames.empty()) {
    spdlog::info("nothing to do: all {} frames are there", task->there.size());
    return kDone;
  }
  say_first(options, task.value());
  stop_on_signals();
  const Status status = resolve(options, task.value());
  return status.ok() ? kDone : fail(status);
}

}  // namespace
}  // namespace quincunx::tools

int main(int argc, char** argv) {
  return quincunx::tools::run_program("quincunx-resolve", quincunx::tools::run, argc, argv);
}
