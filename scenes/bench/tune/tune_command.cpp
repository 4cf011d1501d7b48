// SPDX-License-Identifier: MIT
#include "bench/tune/tune_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/bench_options.h"
#include "bench/speed_error/bench_machine.h"
#include "bench/tune/tune_choice.h"
#include "bench/tune/tune_stand.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const WorkShape& shape) {
  return {{"group", {shape.group_width, shape.group_height}}, {"pixels", shape.pixels_per_item}};
}

std::string copies_or_none(double copies) {
  return copies > 0 ? fmt::format("{:.2f}", copies) : "-";
}

// A figure that there may not be.
Json number_if_positive(double value) {
  return value > 0 ? Json(value) : Json();
}

using Stage = std::unique_ptr<scenes::FrameSource>;

Result<Stage> open_stage(const BenchOptions& options) {
  scenes::FrameSourceSettings settings;
  settings.scene = options.scenes.empty() ? "courtyard" : options.scenes.front();
  settings.seed = options.seed;
  settings.device = options.device;
  settings.interop = options.interop;
  settings.platform = options.platform;
  settings.sequence.output = options.output;
  settings.sequence.scale_path = scenes::ScalePath::fixed({1, 1}).value();
  return scenes::FrameSource::create(settings);
}

std::size_t largest_group(const Device& device) {
  std::size_t items = 1;
  clGetDeviceInfo(device.id(), CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof(items), &items, nullptr);
  return items;
}

class Tuner {
 public:
  Tuner(const scenes::FrameSource& stage, std::vector<TuneCase> cases, const TuneEffort& effort, bool quiet)
      : stage_(stage),
        effort_(effort),
        cases_(std::move(cases)),
        progress_("tuning", 2 * static_cast<std::int64_t>(cases_.size()),
                  quiet ? tools::Progress::Show::kNever : tools::Progress::Show::kOnTerminal) {}

  // Every case with each of the shapes, for all passes.
  Result<std::vector<ShapeTimes>> search(const std::vector<WorkShape>& shapes) {
    std::vector<DeviceProfile> profiles(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i)
      profiles[i].shape = shapes[i];
    return time_cases(profiles, effort_);
  }

  // Every case with the default shape and with what was chosen, in twice as many frames.
  Result<std::vector<ShapeTimes>> compare(const WorkShape& plain, const DeviceProfile& chosen) {
    DeviceProfile profile;
    profile.shape = plain;
    TuneEffort effort = effort_;
    effort.frames *= 2;
    return time_cases({profile, chosen}, effort);
  }

  double copy_ms() const { return *std::min_element(copy_ms_.begin(), copy_ms_.end()); }

 private:
  Result<std::vector<ShapeTimes>> time_cases(const std::vector<DeviceProfile>& profiles,
                                             const TuneEffort& effort) {
    std::vector<ShapeTimes> all;
    copy_ms_.clear();
    for (const TuneCase& what : cases_) {
      progress_.update(done_++, what.name);
      auto times = time_case(stage_, what, effort, profiles);
      if (!times.ok()) return times.status();
      copy_ms_.insert(copy_ms_.end(), times->copy_ms.begin(), times->copy_ms.end());
      all.push_back(std::move(times->shapes));
    }
    return all;
  }

  const scenes::FrameSource& stage_;
  TuneEffort effort_;
  std::vector<TuneCase> cases_;
  tools::Progress progress_;
  std::int64_t done_ = 0;
  Samples copy_ms_;  // copies timed by the last time_cases()
};

// Least times with both shapes, in the case that ran a pass first.
std::vector<TunedPass> passes_of(const DeviceProfile& profile, const std::vector<ShapeTimes>& compared,
                                 double copy_ms) {
  const auto least = [copy_ms](const Samples& ms) {
    return *std::min_element(ms.begin(), ms.end()) / copy_ms;
  };
  std::vector<TunedPass> passes;
  for (const auto& [kernel, shape] : profile.passes) {
    for (const ShapeTimes& shapes : compared) {
      const auto before = shapes[0].find(kernel), after = shapes[1].find(kernel);
      if (before == shapes[0].end() || after == shapes[1].end()) continue;
      passes.push_back({kernel, shape, least(before->second), least(after->second)});
      break;
    }
  }
  return passes;
}

}  // namespace

std::string text_of(const WorkShape& shape) {
  const std::string group = fmt::format("{}x{}", shape.group_width, shape.group_height);
  if (shape.pixels_per_item == 0) return group + " items of a row";
  if (shape.pixels_per_item == 1) return group + " items of a block";
  return fmt::format("{} items of {} pixels", group, shape.pixels_per_item);
}

std::string text_of(const TuneResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out, "{}, {}, driver {}, {}\n{}x{}, load {:.1f} to {:.1f}, {:.0f} s, {}; a copy takes {:.3f} ms\n\n",
      result.machine.cl_device, result.machine.cl_platform, result.machine.cl_driver, result.date,
      result.output.width, result.output.height, result.machine.load_before, result.machine.load_after,
      result.seconds, result.clock, result.copy_ms);
  fmt::format_to(out, "{:<24}{:>9}{:>9}{:>8}  {}\n", "pass", "default", "tuned", "gain", "shape");
  for (const TunedPass& pass : result.passes) {
    const bool kept = pass.shape == result.default_shape;
    fmt::format_to(out, "{:<24}{:>9.2f}{:>9}{:>8}  {}\n", pass.kernel, pass.before,
                   kept ? "" : fmt::format("{:.2f}", pass.after),
                   kept ? "" : fmt::format("{:.0f} %", 100 * (1 - pass.after / pass.before)),
                   text_of(pass.shape));
  }
  fmt::format_to(out, "{:<50}  {}\n", "all others", text_of(result.profile.shape));
  if (!result.storages.empty()) {
    fmt::format_to(out, "\n{:<24}{:>9}{:>9}{:>15}\n", "whole frames", "buffers", "images", "float history");
  }
  for (const TunedStorage& storage : result.storages) {
    fmt::format_to(out, "{:<24}{:>9.2f}{:>9}{:>15}\n", storage.method, storage.buffers,
                   copies_or_none(storage.images), copies_or_none(storage.float_history));
  }
  fmt::format_to(out, "\nIn float4 copies of the output. The profile is used from now on: {}\n", result.file);
  return text;
}

std::string json_of(const TuneResult& result) {
  Json root = {{"version", result.version},
               {"command", result.command},
               {"date", result.date},
               {"output", {result.output.width, result.output.height}},
               {"clock", result.clock},
               {"copy_ms", result.copy_ms},
               {"seconds", result.seconds},
               {"machine", json_of(result.machine)},
               {"file", result.file},
               {"default_shape", json_of(result.default_shape)},
               {"shape_of_others", json_of(result.profile.shape)},
               {"passes", Json::array()},
               {"storages", Json::array()}};
  for (const TunedPass& pass : result.passes) {
    root["passes"].push_back({{"kernel", pass.kernel},
                              {"shape", json_of(pass.shape)},
                              {"default_copies", pass.before},
                              {"tuned_copies", pass.after}});
  }
  for (const TunedStorage& storage : result.storages) {
    root["storages"].push_back({{"method", storage.method},
                                {"buffers_copies", storage.buffers},
                                {"images_copies", number_if_positive(storage.images)},
                                {"float_history_copies", number_if_positive(storage.float_history)}});
  }
  return root.dump(1) + "\n";
}

std::string csv_of(const TuneResult& result) {
  std::string text = "kernel,group_width,group_height,pixels,default_copies,tuned_copies\n";
  for (const TunedPass& pass : result.passes) {
    text += fmt::format("{},{},{},{},{:g},{:g}\n", pass.kernel, pass.shape.group_width,
                        pass.shape.group_height, pass.shape.pixels_per_item, pass.before, pass.after);
  }
  return text;
}

Result<TuneResult> run_tune(const BenchOptions& options) {
  const StepClock clock;
  auto cases = tune_cases(options.tune.cases);
  if (!cases.ok()) return cases.status();
  auto stage = open_stage(options);
  if (!stage.ok()) return stage.status();
  const Device& device = stage.value()->device();
  if (!profile_path(device)) return keep_profile(device, {});
  TuneResult result{.version = QUINCUNX_VERSION,
                    .command = options.command_line,
                    .date = tools::date_now(),
                    .output = options.output,
                    .clock = name_of(pass_timer(device)),
                    .machine = {},
                    .default_shape = default_profile(device).shape,
                    .profile = {},
                    .file = profile_path(device)->string(),
                    .passes = {},
                    .storages = {}};
  describe_machine(*stage.value(), result.machine);
  result.machine.load_before = load_of_last_minute();
  const TuneEffort effort{.output = options.output, .frames = options.tune.frames, .fps = options.fps};
  Tuner tuner(*stage.value(), cases.value(), effort, options.quiet);
  const auto shapes = shapes_to_try(result.default_shape, largest_group(device));
  auto searched = tuner.search(shapes);
  if (!searched.ok()) return searched.status();
  result.profile = choose_profile(shapes, quotients_of(searched.value()));
  auto compared = tuner.compare(result.default_shape, result.profile);
  if (!compared.ok()) return compared.status();
  keep_what_gains(result.profile, result.default_shape, compared.value());
  result.copy_ms = tuner.copy_ms();
  result.passes = passes_of(result.profile, compared.value(), result.copy_ms);
  auto storages = time_storages(*stage.value(), cases.value(), effort, result.profile);
  if (!storages.ok()) return storages.status();
  result.storages = std::move(storages).value();
  result.profile.source = ProfileSource::kTuned;
  result.profile.date = result.date;
  result.profile.driver = device.info().driver;
  if (Status status = keep_profile(device, result.profile); !status.ok()) return status;
  result.machine.load_after = load_of_last_minute();
  result.seconds = clock.elapsed().ms / 1000;
  return result;
}

}  // namespace quincunx::bench
