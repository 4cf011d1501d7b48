// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tools/program/run_report.h"

namespace quincunx::tools {

namespace {

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

Json frames_json(const std::vector<FrameRow>& frames) {
  Json list = Json::array();
  for (const FrameRow& frame : frames) {
    list.push_back({{"index", frame.index},
                    {"seconds", frame.seconds},
                    {"render", size_json(frame.render)},
                    {"ratio", vector_json(frame.ratio)},
                    {"jitter", vector_json(frame.jitter)},
                    {"frame_ms", known(frame.frame_ms)},
                    {"device_ms", known(frame.device_ms)},
                    {"used_previous", frame.used_previous},
                    {"non_finite_pixels", known(frame.non_finite_pixels)}});
  }
  return list;
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
      {"frames", frames_json(report.frames)},
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
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quincunx::tools
