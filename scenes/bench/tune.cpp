// SPDX-License-Identifier: MIT
#include "bench/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "bench/bench_options.h"
#include "bench/speed_error/bench_run.h"
#include "bench/tune_stand.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

// Rows, parts of rows, and tiles of small items, wide and high.
constexpr WorkShape kShapes[] = {
    {.group_width = 1, .group_height = 4, .pixels_per_item = 0},
    {.group_width = 1, .group_height = 1, .pixels_per_item = 0},
    {.group_width = 1, .group_height = 16, .pixels_per_item = 0},
    {.group_width = 1, .group_height = 4, .pixels_per_item = 256},
    {.group_width = 8, .group_height = 8, .pixels_per_item = 1},
    {.group_width = 8, .group_height = 8, .pixels_per_item = 32},
    {.group_width = 16, .group_height = 8, .pixels_per_item = 1},
    {.group_width = 16, .group_height = 8, .pixels_per_item = 16},
    {.group_width = 32, .group_height = 4, .pixels_per_item = 1},
    {.group_width = 64, .group_height = 1, .pixels_per_item = 1},
    {.group_width = 64, .group_height = 4, .pixels_per_item = 1},
};

constexpr double kRefused = std::numeric_limits<double>::infinity();

Samples quotients(const Samples& times, const Samples& plain) {
  Samples all;
  for (std::size_t round = 0; round < std::min(times.size(), plain.size()); ++round)
    all.push_back(times[round] / plain[round]);
  return all;
}

std::string text_of(const WorkShape& shape) {
  const std::string group = fmt::format("{}x{}", shape.group_width, shape.group_height);
  if (shape.pixels_per_item == 0) return group + " items of a row";
  if (shape.pixels_per_item == 1) return group + " items of a block";
  return fmt::format("{} items of {} pixels", group, shape.pixels_per_item);
}

std::string copies_or_none(std::optional<double> copies) {
  return copies ? fmt::format("{:.2f}", *copies) : "-";
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
  std::vector<ShapeTimes> search(const std::vector<WorkShape>& shapes) {
    std::vector<DeviceProfile> profiles(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i)
      profiles[i].shape = shapes[i];
    return time_cases(profiles, effort_);
  }

  // Every case with the default shape and with what was chosen, in twice as many frames.
  std::vector<ShapeTimes> compare(const WorkShape& plain, const DeviceProfile& chosen) {
    DeviceProfile profile;
    profile.shape = plain;
    TuneEffort effort = effort_;
    effort.frames *= 2;
    return time_cases({profile, chosen}, effort);
  }

  double copy_ms() const { return *std::min_element(copy_ms_.begin(), copy_ms_.end()); }

 private:
  std::vector<ShapeTimes> time_cases(const std::vector<DeviceProfile>& profiles, const TuneEffort& effort) {
    std::vector<ShapeTimes> all;
    copy_ms_.clear();
    for (const TuneCase& what : cases_) {
      progress_.update(done_++, what.name);
      auto times = time_case(stage_, what, effort, profiles);
      copy_ms_.insert(copy_ms_.end(), times.copy_ms.begin(), times.copy_ms.end());
      all.push_back(std::move(times.shapes));
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

std::vector<WorkShape> shapes_to_try(const WorkShape& plain, std::size_t most_items) {
  std::vector<WorkShape> shapes = {plain};
  for (const WorkShape& shape : kShapes) {
    const auto items = static_cast<std::size_t>(shape.group_width * shape.group_height);
    if (shape != plain && items <= most_items) shapes.push_back(shape);
  }
  return shapes;
}

std::map<std::string, std::vector<double>> quotients_of(const std::vector<ShapeTimes>& cases) {
  std::map<std::string, std::vector<Samples>> pooled;  // a refused shape has too few
  std::map<std::string, std::size_t> complete;
  for (const ShapeTimes& shapes : cases) {
    for (const auto& [kernel, plain] : shapes.front()) {
      auto& all = pooled[kernel];
      all.resize(shapes.size());
      complete[kernel] += plain.size();
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        const auto times = shapes[i].find(kernel);
        if (times == shapes[i].end()) continue;
        const Samples more = quotients(times->second, plain);
        all[i].insert(all[i].end(), more.begin(), more.end());
      }
    }
  }
  std::map<std::string, std::vector<double>> result;
  for (const auto& [kernel, shapes] : pooled) {
    for (const Samples& samples : shapes) {
      const bool refused = samples.empty() || samples.size() < complete[kernel];
      result[kernel].push_back(refused ? kRefused : median_of(samples));
    }
  }
  return result;
}

DeviceProfile choose_profile(const std::vector<WorkShape>& shapes,
                             const std::map<std::string, std::vector<double>>& quotients) {
  const auto best = [](const std::vector<double>& of_shapes) {
    return static_cast<std::size_t>(std::min_element(of_shapes.begin(), of_shapes.end()) - of_shapes.begin());
  };
  DeviceProfile profile;
  std::vector<double> logarithms(shapes.size());
  for (const auto& [kernel, of_shapes] : quotients) {
    profile.passes[kernel] = shapes[best(of_shapes)];
    for (std::size_t i = 0; i < shapes.size(); ++i)
      logarithms[i] += std::log(of_shapes[i]);
  }
  const std::size_t at = best(logarithms);
  const double mean = std::exp(logarithms[at] / static_cast<double>(quotients.size()));
  profile.shape = mean <= 1 - kLeastGain ? shapes[at] : shapes.front();
  return profile;
}

void keep_what_gains(DeviceProfile& profile, const WorkShape& plain, const std::vector<ShapeTimes>& again) {
  for (const auto& [kernel, of_both] : quotients_of(again)) {
    if (!(of_both[1] <= 1 - kLeastGain)) profile.passes[kernel] = plain;
  }
}

std::string text_of(const TuneResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out, "{}, {}, driver {}, {}\n{}x{}, load {:.1f} to {:.1f}, {:.0f} s, {}; a copy takes {:.3f} ms\n\n",
      result.machine.cl_device, result.machine.cl_platform, result.machine.cl_driver, result.date,
      result.output[0], result.output[1], result.machine.load_before, result.machine.load_after,
      result.seconds, result.clock, result.copy_ms);
  fmt::format_to(out, "{:<24}{:>9}{:>9}{:>8}  {}\n", "pass", "default", "tuned", "gain", "shape");
  for (const TunedPass& pass : result.passes) {
    const bool kept = pass.shape == result.default_shape;
    fmt::format_to(out, "{:<24}{:>9.2f}{:>9}{:>8}  {}\n", pass.kernel, pass.default_copies,
                   kept ? "" : fmt::format("{:.2f}", pass.tuned_copies),
                   kept ? "" : fmt::format("{:.0f} %", 100 * (1 - pass.tuned_copies / pass.default_copies)),
                   text_of(pass.shape));
  }
  fmt::format_to(out, "{:<50}  {}\n", "all others", text_of(result.profile.shape));
  if (!result.storages.empty()) {
    fmt::format_to(out, "\n{:<24}{:>9}{:>9}{:>15}\n", "whole frames", "buffers", "images", "float history");
  }
  for (const TunedStorage& storage : result.storages) {
    fmt::format_to(out, "{:<24}{:>9.2f}{:>9}{:>15}\n", storage.method, storage.buffers_copies,
                   copies_or_none(storage.images_copies), copies_or_none(storage.float_history_copies));
  }
  fmt::format_to(out, "\nIn float4 copies of the output. The profile is used from now on: {}\n", result.file);
  return text;
}

std::string csv_of(const TuneResult& result) {
  std::string text = "kernel,group_width,group_height,pixels,default_copies,tuned_copies\n";
  for (const TunedPass& pass : result.passes) {
    text +=
        fmt::format("{},{},{},{},{:g},{:g}\n", pass.kernel, pass.shape.group_width, pass.shape.group_height,
                    pass.shape.pixels_per_item, pass.default_copies, pass.tuned_copies);
  }
  return text;
}

TuneResult run_tune(const BenchOptions& options) {
  const StepClock clock;
  auto cases = checked(tune_cases(options.tune.cases));
  scenes::SequenceSettings sequence;
  sequence.output = options.output;
  sequence.scale_path = scenes::ScalePath::fixed({1, 1}).value();
  auto stage = open_stage(options, options.scenes.empty() ? "courtyard" : options.scenes.front(), sequence);
  const Device& device = stage->device();
  if (!profile_path(device)) checked(keep_profile(device, {}));  // which says what is missing
  TuneResult result;
  static_cast<RunFacts&>(result) = facts_of(options, *stage);
  result.output = {options.output.width, options.output.height};
  result.clock = name_of(pass_timer(device));
  result.file = profile_path(device)->string();
  result.default_shape = default_profile(device).shape;
  const TuneEffort effort{.output = options.output, .frames = options.tune.frames, .fps = options.fps};
  Tuner tuner(*stage, cases, effort, options.quiet);
  const auto shapes = shapes_to_try(result.default_shape, largest_group(device));
  auto searched = tuner.search(shapes);
  result.profile = choose_profile(shapes, quotients_of(searched));
  auto compared = tuner.compare(result.default_shape, result.profile);
  keep_what_gains(result.profile, result.default_shape, compared);
  result.copy_ms = tuner.copy_ms();
  result.passes = passes_of(result.profile, compared, result.copy_ms);
  result.storages = time_storages(*stage, cases, effort, result.profile);
  result.profile.source = ProfileSource::kTuned;
  result.profile.date = result.date;
  result.profile.driver = device.info().driver;
  checked(keep_profile(device, result.profile));
  result.machine.load_after = load_of_last_minute();
  result.seconds = clock.elapsed().ms / 1000;
  return result;
}

}  // namespace quincunx::bench
