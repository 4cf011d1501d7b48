// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/parts/parts_result.h"
#include "bench/speed_error/bench_machine.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastSaving = 0.01;  // of the first row's time: less is noise

Json json_of(const PartTimes& times) {
  return {{"ms", times.ms}, {"processor_ms", times.processor_ms}};
}

// JSON has no NaN.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

}  // namespace

PartChange change_of(const PartRow& row, const PartRow& base) {
  PartChange change{.saved_processor_ms = base.frame.processor_ms - row.frame.processor_ms,
                    .flip = row.flip - base.flip};
  const bool saves = change.saved_processor_ms > kLeastSaving * base.frame.processor_ms;
  change.flip_per_ms =
      saves ? change.flip / change.saved_processor_ms : std::numeric_limits<double>::quiet_NaN();
  return change;
}

std::string text_of(const PartsResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}, {} -> {}x{}, {}, {}, load {:.1f} to {:.1f}, {} frames of each\n\n", result.scene,
                 result.method, result.output.width, result.output.height, result.machine.cl_device,
                 result.machine.gl_renderer, result.machine.load_before, result.machine.load_after,
                 result.frames);
  fmt::format_to(out, "{:<12}{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}{:>9}{:>9}{:>10}{:>13}\n", "part", "scale",
                 "draw", "resolve", "frame", "draw", "resolve", "frame", "PSNR", "FLIP", "saves",
                 "FLIP a ms");
  for (const PartRow& row : result.rows) {
    const PartChange change = change_of(row, result.rows.front());
    const std::string exchange =
        std::isfinite(change.flip_per_ms) ? fmt::format("{:+.6f}", change.flip_per_ms) : "-";
    fmt::format_to(
        out, "{:<12}{:<10}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>8.2f}{:>9.2f}{:>9.4f}{:>10.2f}{:>13}\n",
        row.part, row.scale, row.draw.ms, row.resolve.ms, row.frame.ms, row.draw.processor_ms,
        row.resolve.processor_ms, row.frame.processor_ms, row.psnr, row.flip, change.saved_processor_ms,
        exchange);
  }
  text +=
      "\nms, medians: first by the host's clock, then of the processor, all threads; \"saves\" and \"FLIP a "
      "ms\" "
      "are\nof the latter, against the first row: the mean FLIP that a saved millisecond costs.\n";
  return text;
}

std::string json_of(const PartsResult& result) {
  Json root = {{"version", result.version}, {"command", result.command},
               {"date", result.date},       {"scene", result.scene},
               {"method", result.method},   {"output", {result.output.width, result.output.height}},
               {"frames", result.frames},   {"machine", json_of(result.machine)},
               {"rows", Json::array()}};
  for (const PartRow& row : result.rows) {
    const PartChange change = change_of(row, result.rows.front());
    root["rows"].push_back({{"part", row.part},
                            {"scale", row.scale},
                            {"render", {row.render.width, row.render.height}},
                            {"draw", json_of(row.draw)},
                            {"resolve", json_of(row.resolve)},
                            {"frame", json_of(row.frame)},
                            {"psnr", number_or_null(row.psnr)},
                            {"flip", row.flip},
                            {"saved_processor_ms", change.saved_processor_ms},
                            {"flip_per_ms", number_or_null(change.flip_per_ms)}});
  }
  return root.dump(1) + "\n";
}

std::string csv_of(const PartsResult& result) {
  std::string text =
      "part,scale,draw_ms,resolve_ms,frame_ms,draw_processor_ms,resolve_processor_ms,frame_processor_ms,psnr,"
      "flip\n";
  for (const PartRow& row : result.rows) {
    text += fmt::format("{},{},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g}\n", row.part, row.scale, row.draw.ms,
                        row.resolve.ms, row.frame.ms, row.draw.processor_ms, row.resolve.processor_ms,
                        row.frame.processor_ms, row.psnr, row.flip);
  }
  return text;
}

}  // namespace quincunx::bench
