// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/speed_error/bench_machine.h"
#include "bench/tune/tune_result.h"

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
Json number_or_null(double value) {
  return value > 0 ? Json(value) : Json();
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
                                {"images_copies", number_or_null(storage.images)},
                                {"float_history_copies", number_or_null(storage.float_history)}});
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

}  // namespace quincunx::bench
