// SPDX-License-Identifier: MIT
// The report of a session: what it did and what it cost.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "render_session.h"

namespace quincunx::scenes {
namespace {

const char* name_of_platform(gl::Platform platform) {
  return platform == gl::Platform::kDevice ? "device" : "surfaceless";
}

// Per kernel, in the order of first use.
std::vector<tools::PassStatistics> pass_statistics(const std::vector<FrameReport>& reports) {
  struct Samples {
    std::vector<double> ms;
    std::vector<std::uint64_t> bytes;
  };
  std::vector<std::string> order;
  std::map<std::string, Samples> samples;
  for (const FrameReport& report : reports) {
    for (int i = 0; i < report.pass_count; ++i) {
      const PassReport& pass = report.passes[i];
      if (!samples.contains(pass.kernel)) order.emplace_back(pass.kernel);
      samples[pass.kernel].ms.push_back(pass.ms);
      samples[pass.kernel].bytes.push_back(pass.bytes);
    }
  }
  std::vector<tools::PassStatistics> statistics;
  for (const std::string& kernel : order) {
    statistics.push_back(
        tools::statistics_of(kernel, "OpenCL event", samples[kernel].ms, samples[kernel].bytes));
  }
  return statistics;
}

void add_measured(tools::FrameRow& row, const FrameReport& report) {
  row.render = report.render;
  row.ratio = report.ratio;
  row.used_previous = report.used_previous;
  row.non_finite_pixels = report.non_finite_pixels;
  row.device_ms = 0;
  for (int i = 0; i < report.pass_count; ++i)
    row.device_ms += std::max(report.passes[i].ms, 0.0);
}

}  // namespace

tools::RunReport RenderSession::report() const {
  tools::RunReport report;
  report.program = "quincunx-render";
  report.version = QUINCUNX_VERSION;
  report.command_line = options_.command_line;
  report.scene = source_->scene().name;
  report.scene_summary = source_->scene().summary;
  report.seed = options_.seed;
  report.output = options_.output;
  report.target = source_->sequence().target();
  report.method = name_of(options_.resolve.method);
  report.settings = {
      {"scale", options_.scale_path.empty() ? options_.scale : options_.scale_path},
      {"jitter", name_of(jitter_for(options_))},
      {"velocity", name_of(plan().velocity)},
      {"tone map", name_of(options_.resolve.tone_map)},
      {"dither", options_.resolve.dither ? "on" : "off"},
      {"frames", fmt::format("{} at {} a second of scene time", options_.frames, options_.fps)},
      {"overlap",
       options_.overlap ? "GL draws the next frame while OpenCL works: pass times include that load" : "off"},
  };
  const gl::EglInfo& gl = source_->context().info();
  report.gl = {name_of_platform(gl.platform), gl.vendor, gl.renderer, gl.version};
  const DeviceInfo& cl = source_->device().info();
  report.cl = {cl.platform, cl.name, cl.driver, cl.version, cl.compute_units};
  report.interop = gl::name_of(source_->bridge().kind());
  report.interop_reason = source_->bridge().reason();
  report.passes = pass_statistics(reports_);
  report.steps = {
      tools::statistics_of("draw and submit", "host clock", draw_ms_),
      tools::statistics_of("wait for the frame", "host clock", acquire_ms_, bytes_in_),
      tools::statistics_of("present", "host clock", present_ms_, bytes_out_),
      tools::statistics_of("hand to files", "host clock", write_ms_),
  };
  report.frames = rows_;
  // Both are in frame order; a report that the ring dropped leaves its row unmeasured.
  auto measured = reports_.begin();
  for (tools::FrameRow& row : report.frames) {
    while (measured != reports_.end() && static_cast<std::int64_t>(measured->frame_index) < row.index)
      ++measured;
    if (measured == reports_.end()) break;
    if (static_cast<std::int64_t>(measured->frame_index) == row.index) add_measured(row, *measured);
  }
  report.left_out = plan().left_out;
  report.files = files_;
  report.wall_seconds = wall_seconds_;
  return report;
}

}  // namespace quincunx::scenes
