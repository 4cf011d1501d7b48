// SPDX-License-Identifier: MIT
#include "tools/program/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <string_view>

#include "tools/program/pacing_report.h"

namespace quincunx::tools {
namespace {

constexpr int kRowsShown = 12;
constexpr int kLabelWidth = 12;

void add_heading(std::string& text, const std::string& heading) {
  text += fmt::format("\n{}\n", heading);
}

void add_line(std::string& text, const std::string& label, const std::string& value) {
  if (!value.empty()) text += fmt::format("  {:<{}} {}\n", label, kLabelWidth, value);
}

std::string size_text(Extent extent) {
  return fmt::format("{}x{}", extent.width, extent.height);
}

std::string joined(std::initializer_list<std::string> parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (!text.empty()) text += ", ";
    text += part;
  }
  return text;
}

std::string ms_text(double ms) {
  return ms >= 0 ? fmt::format("{:.3f}", ms) : "-";
}

std::string bytes_text(std::int64_t bytes) {
  return bytes >= 0 ? fmt::format("{:.2f} MB", static_cast<double>(bytes) / 1e6) : "-";
}

void add_run(std::string& text, const RunReport& report) {
  add_line(text, "scene",
           report.scene_summary.empty() ? report.scene
                                        : fmt::format("{}: {}", report.scene, report.scene_summary));
  add_line(text, "method", report.method);
  add_line(text, "output",
           fmt::format("{}, inside targets of {}", size_text(report.output), size_text(report.target)));
  if (report.seed) add_line(text, "seed", fmt::format("{}", *report.seed));
  for (const auto& [name, value] : report.settings)
    add_line(text, name, value);
  add_line(text, "command", report.command_line);
  if (report.wall_seconds >= 0 && !report.frames.empty()) {
    add_line(
        text, "took",
        fmt::format("{:.1f} s for {} frames: {:.1f} a second, files included", report.wall_seconds,
                    report.frames.size(), static_cast<double>(report.frames.size()) / report.wall_seconds));
  }
}

void add_devices(std::string& text, const RunReport& report) {
  add_heading(text, "Devices");
  add_line(text, "OpenGL", joined({report.gl.renderer, report.gl.version}));
  add_line(text, "EGL", report.gl.platform);
  const std::string units =
      report.cl.compute_units > 0 ? fmt::format("{} compute units", report.cl.compute_units) : "";
  add_line(text, "OpenCL", joined({report.cl.device, units}));
  add_line(text, "driver", joined({report.cl.platform, report.cl.version, report.cl.driver}));
  add_line(text, "interop",
           report.interop_reason.empty() ? report.interop
                                         : fmt::format("{}: {}", report.interop, report.interop_reason));
}

void add_statistics(std::string& text, const std::string& heading, const std::vector<PassStatistics>& rows) {
  if (rows.empty()) return;
  text += fmt::format("\n{:<26} {:>9} {:>9} {:>9} {:>12}  {}\n", heading, "median ms", "p95 ms", "min ms",
                      "bytes/frame", "timed by");
  for (const PassStatistics& row : rows) {
    text += fmt::format("  {:<24} {:>9} {:>9} {:>9} {:>12}  {}\n", row.name, ms_text(row.median_ms),
                        ms_text(row.p95_ms), ms_text(row.min_ms), bytes_text(row.bytes), row.clock);
  }
}

void add_frames(std::string& text, const std::vector<FrameRow>& frames) {
  if (frames.empty()) return;
  add_heading(text, fmt::format("Viewport and true ratio ({} frames)", frames.size()));
  std::vector<double> ratios;
  for (const FrameRow& frame : frames)
    ratios.push_back(frame.ratio.x);
  text += ratio_graph(ratios);
  const int total = static_cast<int>(frames.size());
  const int shown = std::min(total, kRowsShown);
  text += fmt::format("  {:>6} {:>11} {:>8} {:>8} {:>10} {:>10} {:>8} {:>11}\n", "frame", "viewport",
                      "ratio x", "ratio y", "frame ms", "OpenCL ms", "history", "non-finite");
  for (int i = 0; i < shown; ++i) {
    const FrameRow& frame = frames[shown == 1 ? 0 : static_cast<std::int64_t>(i) * (total - 1) / (shown - 1)];
    text += fmt::format("  {:>6} {:>11} {:>8.4f} {:>8.4f} {:>10} {:>10} {:>8} {:>11}\n", frame.index,
                        size_text(frame.render), frame.ratio.x, frame.ratio.y, ms_text(frame.frame_ms),
                        ms_text(frame.device_ms), frame.used_previous ? "used" : "-",
                        frame.non_finite_pixels >= 0 ? fmt::format("{}", frame.non_finite_pixels) : "-");
  }
}

void add_busy(std::string& text, const RunReport& report) {
  if (report.busy.empty() || report.wall_seconds < 0) return;
  double sum = 0;
  std::string parts;
  for (const BusyTime& time : report.busy) {
    parts += fmt::format("{}{} {:.2f} s", parts.empty() ? "" : ", ", time.what, time.seconds);
    sum += time.seconds;
  }
  add_heading(text, "Overlap");
  add_line(text, "busy", parts);
  add_line(text, "together", fmt::format("{:.2f} s of work in {:.2f} s", sum, report.wall_seconds));
}

void add_score(std::string& text, const std::string& label, const ScoreRow& row) {
  text += fmt::format("  {:>6} {:>9.2f} {:>9.2f} {:>7.4f} {:>7.4f} {:>8} {:>7.3f}\n", label, row.psnr_linear,
                      row.psnr_tone_mapped, row.ssim, row.flip,
                      row.flicker >= 0 ? fmt::format("{:.4f}", row.flicker) : "-", row.error_p99);
}

void add_scores(std::string& text, const std::vector<ScoreRow>& rows) {
  if (rows.empty()) return;
  add_heading(text, fmt::format("Against the truth ({} frames)", rows.size()));
  text += fmt::format("  {:>6} {:>9} {:>9} {:>7} {:>7} {:>8} {:>7}\n", "frame", "PSNR-lin", "PSNR-tm", "SSIM",
                      "FLIP", "flicker", "p99-tm");
  const std::size_t shown = std::min<std::size_t>(rows.size(), kRowsShown);
  for (std::size_t i = 0; i < shown; ++i) {
    const ScoreRow& row = rows[shown == 1 ? 0 : i * (rows.size() - 1) / (shown - 1)];
    add_score(text, fmt::format("{}", row.index), row);
  }
  add_score(text, "mean", mean_of(rows));
  const auto frames = static_cast<std::int64_t>(rows.size());
  const ShownError error = shown_error(rows);
  if (error.refreshes > frames) {
    add_line(text, "as shown",
             fmt::format("mean FLIP {:.4f} over {} refreshes, {} of which repeat a frame", error.flip,
                         error.refreshes, error.refreshes - frames));
  }
}

void add_list(std::string& text, const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  add_heading(text, heading);
  for (const std::string& line : lines)
    text += fmt::format("  {}\n", line);
}

// Sentences, each from a line's beginning, broken at spaces.
void add_sentences(std::string& text, const std::string& heading, const std::vector<std::string>& sentences) {
  constexpr std::size_t kColumns = 96;
  std::vector<std::string> lines;
  for (std::string rest : sentences) {
    std::string indent;
    while (indent.size() + rest.size() > kColumns) {
      const std::size_t space = rest.rfind(' ', kColumns - indent.size());
      if (space == std::string::npos) break;
      lines.push_back(indent + rest.substr(0, space));
      rest.erase(0, space + 1);
      indent = "  ";
    }
    lines.push_back(indent + rest);
  }
  add_list(text, heading, lines);
}

void add_report(FrameRow& row, const FrameReport& report) {
  row.render = report.render_extent;
  row.ratio = report.ratio;
  row.used_previous = report.used_previous;
  row.non_finite_pixels = report.non_finite_pixels;
  const PassReports& passes = report.passes;
  if (std::any_of(passes.begin(), passes.end(), [](const PassReport& pass) { return pass.ms < 0; })) return;
  row.device_ms = 0;
  for (const PassReport& pass : passes)
    row.device_ms += pass.ms;
}

using Json = nlohmann::ordered_json;

template <typename Number>
Json known(Number value) {
  return value >= 0 ? Json(value) : Json(nullptr);
}

Json known(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json size_json(Extent extent) {
  return Json::array({extent.width, extent.height});
}

Json vector_json(Vec2 vector) {
  return Json::array({vector.x, vector.y});
}

Json statistics_json(const std::vector<PassStatistics>& rows) {
  Json list = Json::array();
  for (const PassStatistics& row : rows) {
    list.push_back({{"name", row.name},
                    {"clock", row.clock},
                    {"count", row.count},
                    {"median_ms", known(row.median_ms)},
                    {"p95_ms", known(row.p95_ms)},
                    {"min_ms", known(row.min_ms)},
                    {"bytes", known(row.bytes)}});
  }
  return list;
}

// A frame a line, without a tree of all of them in memory.
std::string frames_text(const std::vector<FrameRow>& frames) {
  std::string text = "[";
  for (const FrameRow& frame : frames) {
    const Json row = {{"index", frame.index},
                      {"seconds", frame.seconds},
                      {"render", size_json(frame.render)},
                      {"ratio", vector_json(frame.ratio)},
                      {"jitter", vector_json(frame.jitter)},
                      {"frame_ms", known(frame.frame_ms)},
                      {"device_ms", known(frame.device_ms)},
                      {"used_previous", frame.used_previous},
                      {"non_finite_pixels", known(frame.non_finite_pixels)}};
    text += (&frame == &frames.front() ? "\n  " : ",\n  ") + row.dump();
  }
  return text + "]";
}

Json summary_json(const PacingRun& run) {
  const PacingSummary summary = summary_of(run);
  return {{"achieved_fps", summary.achieved_fps},
          {"dropped", summary.dropped},
          {"dropped_at_start", summary.dropped_at_start},
          {"mean_busy_ms", summary.mean_busy_ms},
          {"median_busy_ms", summary.median_busy_ms},
          {"p95_busy_ms", summary.p95_busy_ms},
          {"over_target", summary.over_target},
          {"mean_area", summary.mean_area},
          {"least_area", summary.least_area},
          {"largest_area", summary.largest_area},
          {"changes_per_second", summary.changes_per_second},
          {"method_changes_per_second", summary.method_changes_per_second}};
}

Json content_json(const std::optional<ContentStatistics>& content) {
  if (!content) return nullptr;
  return {{"moving", content->moving}, {"speed_px", content->speed_px}, {"apart", content->apart},
          {"thin", content->thin},     {"light", content->light},       {"zoom", content->zoom},
          {"cut", content->cut},       {"judged", content->judged}};
}

Json pacing_json(const PacingRun& run) {
  Json frames = Json::array();
  for (const PacedFrame& frame : run.frames) {
    frames.push_back({{"index", frame.index},
                      {"render", size_json(frame.render)},
                      {"start_ms", frame.start_ms},
                      {"finished_ms", frame.finished_ms},
                      {"shown_ms", frame.shown_ms},
                      {"busy_ms", frame.busy_ms},
                      {"cpu_ms", frame.cpu_ms > 0 ? Json(frame.cpu_ms) : Json(nullptr)},
                      {"blur_px", frame.blur_px},
                      {"detail", frame.detail},
                      {"queued", frame.queued},
                      {"missed", frame.missed},
                      {"method", known(frame.method)},
                      {"fading_from", known(frame.fading_from)},
                      {"weight", frame.weight},
                      {"resolve_ms", frame.resolve_ms > 0 ? Json(frame.resolve_ms) : Json(nullptr)},
                      {"content", content_json(frame.content)}});
  }
  Json changes = Json::array();
  for (const MethodChange& change : run.method_changes) {
    changes.push_back(
        {{"frame", change.frame}, {"from", change.from}, {"to", change.to}, {"why", change.why}});
  }
  return {{"controller", run.controller},  {"measured_by", known(run.measured_by)},
          {"target_fps", run.target_fps},  {"buffers", run.buffers},
          {"summary", summary_json(run)},  {"method_changes", changes},
          {"reasons", known(run.reasons)}, {"frames", frames}};
}

Json score_json(const ScoreRow& row) {
  return {{"psnr_linear", row.psnr_linear},
          {"psnr_tone_mapped", row.psnr_tone_mapped},
          {"ssim", row.ssim},
          {"flip", row.flip},
          {"error_p99", row.error_p99},
          {"flicker", known(row.flicker)}};
}

Json scores_json(const std::vector<ScoreRow>& rows) {
  Json frames = Json::array();
  for (const ScoreRow& row : rows) {
    Json json = {{"index", row.index}};
    json.update(score_json(row));
    json["repeated_flip"] = row.repeated_flip;
    frames.push_back(std::move(json));
  }
  const ShownError shown = shown_error(rows);
  return {{"mean", rows.empty() ? Json(nullptr) : score_json(mean_of(rows))},
          {"shown", {{"refreshes", shown.refreshes}, {"flip", shown.flip}}},
          {"frames", frames}};
}

}  // namespace

ScoreRow mean_of(std::span<const ScoreRow> rows) {
  ScoreRow mean;
  double flicker = 0;
  int with_flicker = 0;
  for (const ScoreRow& row : rows) {
    mean.psnr_linear += row.psnr_linear;
    mean.psnr_tone_mapped += row.psnr_tone_mapped;
    mean.ssim += row.ssim;
    mean.flip += row.flip;
    mean.error_p99 += row.error_p99;
    flicker += std::max(row.flicker, 0.0);
    with_flicker += row.flicker >= 0 ? 1 : 0;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  for (double* value : {&mean.psnr_linear, &mean.psnr_tone_mapped, &mean.ssim, &mean.flip, &mean.error_p99}) {
    *value /= count;
  }
  if (with_flicker > 0) mean.flicker = flicker / with_flicker;
  return mean;
}

ShownError shown_error(std::span<const ScoreRow> rows) {
  ShownError shown;
  for (const ScoreRow& row : rows) {
    shown.refreshes += 1 + static_cast<std::int64_t>(row.repeated_flip.size());
    shown.flip += std::accumulate(row.repeated_flip.begin(), row.repeated_flip.end(), row.flip);
  }
  shown.flip /= static_cast<double>(std::max<std::int64_t>(shown.refreshes, 1));
  return shown;
}

PassStatistics statistics_of(std::string name, std::string clock, std::span<const double> samples_ms,
                             std::span<const std::uint64_t> bytes) {
  PassStatistics result;
  result.name = std::move(name);
  result.clock = std::move(clock);
  std::vector<double> known;
  std::copy_if(samples_ms.begin(), samples_ms.end(), std::back_inserter(known),
               [](double ms) { return std::isfinite(ms) && ms >= 0; });
  std::sort(known.begin(), known.end());
  result.count = static_cast<int>(known.size());
  if (!known.empty()) {
    const std::size_t n = known.size();
    result.median_ms = (known[(n - 1) / 2] + known[n / 2]) / 2;
    result.p95_ms = known[(95 * n + 99) / 100 - 1];
    result.min_ms = known.front();
  }
  if (!bytes.empty()) {
    std::vector<std::uint64_t> sorted(bytes.begin(), bytes.end());
    std::sort(sorted.begin(), sorted.end());
    result.bytes = static_cast<std::int64_t>(sorted[(sorted.size() - 1) / 2]);
  }
  return result;
}

std::string to_text(const RunReport& report) {
  std::string text = fmt::format("{} {}: run report\n\n", report.program, report.version);
  add_run(text, report);
  add_sentences(text, "Warnings", report.warnings);
  add_devices(text, report);
  add_statistics(text, "OpenCL passes", report.passes);
  add_statistics(text, "Around them", report.steps);
  add_busy(text, report);
  text += pacing_text(report.pacing);
  add_frames(text, report.frames);
  add_scores(text, report.scores);
  if (!report.left_out.empty()) {
    add_heading(text, "Left out, because this scene does not need it");
    for (const LeftOut& item : report.left_out)
      text += fmt::format("  {}: {}\n", item.what, item.why);
  }
  add_list(text, "Files", report.files);
  return text;
}

void Samples::add(double ms, std::uint64_t bytes) {
  constexpr std::size_t kMost = 8192;
  total_ms_ += ms;
  if (seen_++ % step_ != 0) return;
  if (ms_.size() == kMost) {
    for (std::size_t i = 0; i < kMost / 2; ++i)
      ms_[i] = ms_[2 * i], bytes_[i] = bytes_[2 * i];
    ms_.resize(kMost / 2), bytes_.resize(kMost / 2);
    step_ *= 2;
  }
  ms_.push_back(ms), bytes_.push_back(bytes);
}

PassStatistics Samples::statistics(std::string name, std::string clock) const {
  std::span<const std::uint64_t> bytes = bytes_;
  if (std::none_of(bytes.begin(), bytes.end(), [](std::uint64_t count) { return count > 0; })) bytes = {};
  return statistics_of(std::move(name), std::move(clock), ms_, bytes);
}

void MeasuredFrames::add(const FrameReport& report) {
  for (const PassReport& pass : report.passes) {
    const std::string name = name_of(pass);
    auto found =
        std::find_if(passes_.begin(), passes_.end(), [&](const auto& one) { return one.first == name; });
    if (found == passes_.end()) found = passes_.insert(found, {name, {}});
    found->second.add(pass.ms, pass.bytes);
  }
  motion_ = rows_.empty() || motion_.verdict < report.motion.verdict ? report.motion : motion_;
  // A frame that goes both ways has several reports, of which the first is the one forwards.
  const auto index = static_cast<std::int64_t>(report.frame_index);
  if (!rows_.empty() && index <= rows_.back().index) return;
  add_report(rows_.emplace_back(FrameRow{.index = index}), report);
}

std::vector<PassStatistics> MeasuredFrames::passes(PassTimer timer) const {
  std::vector<PassStatistics> statistics;
  for (const auto& [kernel, samples] : passes_) {
    statistics.push_back(samples.statistics(kernel, name_of(timer)));
    if (statistics.back().count == 0) statistics.back().clock = name_of(PassTimer::kNone);
  }
  return statistics;
}

void MeasuredFrames::fill(std::span<FrameRow> rows) const {
  auto measured = rows_.begin();
  for (FrameRow& row : rows) {
    while (measured != rows_.end() && measured->index < row.index)
      ++measured;
    if (measured == rows_.end()) return;
    if (measured->index != row.index) continue;
    row.render = measured->render;
    row.ratio = measured->ratio;
    row.used_previous = measured->used_previous;
    row.non_finite_pixels = measured->non_finite_pixels;
    row.device_ms = measured->device_ms;
  }
}

std::string to_json(const RunReport& report) {
  Json settings = Json::object();
  for (const auto& [name, value] : report.settings)
    settings[name] = value;
  Json busy = Json::object();
  for (const BusyTime& time : report.busy)
    busy[time.what] = time.seconds;
  Json pacing = Json::array();
  for (const PacingRun& run : report.pacing)
    pacing.push_back(pacing_json(run));
  Json left_out = Json::array();
  for (const LeftOut& item : report.left_out)
    left_out.push_back({{"what", item.what}, {"why", item.why}});
  const Json json = {
      {"program", report.program},
      {"version", report.version},
      {"command_line", known(report.command_line)},
      {"scene", known(report.scene)},
      {"scene_summary", known(report.scene_summary)},
      {"seed", report.seed ? Json(*report.seed) : Json(nullptr)},
      {"output", size_json(report.output)},
      {"target", size_json(report.target)},
      {"method", report.method},
      {"settings", settings},
      {"gl",
       {{"platform", known(report.gl.platform)},
        {"vendor", known(report.gl.vendor)},
        {"renderer", known(report.gl.renderer)},
        {"version", known(report.gl.version)}}},
      {"cl",
       {{"platform", known(report.cl.platform)},
        {"device", known(report.cl.device)},
        {"driver", known(report.cl.driver)},
        {"version", known(report.cl.version)},
        {"compute_units", known(report.cl.compute_units)}}},
      {"interop", known(report.interop)},
      {"interop_reason", known(report.interop_reason)},
      {"passes", statistics_json(report.passes)},
      {"steps", statistics_json(report.steps)},
      {"frames", nullptr},
      {"pacing", pacing},
      {"busy_seconds", busy},
      {"scores", scores_json(report.scores)},
      {"left_out", left_out},
      {"warnings", report.warnings},
      {"files", report.files},
      {"wall_seconds", known(report.wall_seconds)},
      {"peak_memory_bytes", known(report.peak_memory_bytes)},
  };
  // Text that is not UTF-8 (a file name, say) must not stop a report.
  std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  constexpr std::string_view kFrames = "\n \"frames\": null";  // within a text a new line is escaped
  text.replace(text.find(kFrames) + kFrames.size() - 4, 4, frames_text(report.frames));
  return text;
}

}  // namespace quincunx::tools
