// SPDX-License-Identifier: MIT
// The report of a session: what it did and what it cost.
#include <fmt/format.h>

#include "session/render_session.h"
#include "tools/program/run_report.h"

namespace quincunx::scenes {
namespace {

std::string scale_text(const RenderOptions& options) {
  const PacingOptions& pacing = options.pacing;
  if (pacing.controls()) {
    return fmt::format("{} controller, {} to {}", name_of(pacing.controller), pacing.min_scale,
                       pacing.max_scale);
  }
  return options.scale_path.empty() ? options.scale : options.scale_path;
}

std::string focus_text(const PictureOptions& options, const FocusSettings& focus) {
  if (options.focus.empty()) return "none";
  return fmt::format("{}: {}x{} pixels at scale {}", options.focus, focus.extent.width, focus.extent.height,
                     options.focus_scale);
}

std::string dual_text(const std::string& dual) {
  return dual.empty() ? "always the display's" : "dynamic: " + dual;
}

std::string targets_text(Targets targets, const gl::Bridge::Memory& memory) {
  constexpr double kMebi = 1 << 20;
  return fmt::format("{}: {:.1f} MiB of OpenGL's, {:.1f} MiB of OpenCL's", name_of(targets),
                     static_cast<double>(memory.gl_bytes) / kMebi,
                     static_cast<double>(memory.opencl_bytes) / kMebi);
}

}  // namespace

std::string RenderSession::overlap_text() const {
  if (!options_.overlap || !loop_->overlaps()) return "off";
  if (times_by_waiting()) return "off: the host's clock times each OpenCL pass";
  return "GL draws the next frame while OpenCL works: pass times include that load";
}

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
  report.method = front_ ? "chosen by frame" : name_of(variant_of(options_.resolve));
  report.settings = {
      {"scale", scale_text(options_)},
      {"parts", source_->parts().summary()},
      {"output's resolution", dual_text(options_.dual)},
      {"jitter", front_ ? "that of the method" : name_of(jitter_for(options_))},
      {"velocity", name_of(plan().velocity)},
      {"colour", name_of(options_.resolve.colour)},
      {"tone map", name_of(options_.resolve.output.tone_map)},
      {"targets", targets_text(plan().settings.targets.placement, source_->memory())},
      {"focus", focus_text(options_, plan().settings.focus)},
      {"dither", options_.resolve.output.dither ? "on" : "off"},
      {"frames", fmt::format("{} at {} a second of scene time", options_.frames, options_.fps)},
      {"overlap", overlap_text()},
  };
  const gl::ContextInfo& gl = source_->context().info();
  report.gl = {gl::name_of(gl.platform), gl.vendor, gl.renderer, gl.version};
  const DeviceInfo& cl = source_->device().info();
  report.cl = {cl.platform, cl.name, cl.driver, cl.version, cl.compute_units};
  report.interop = gl::name_of(source_->bridge().kind());
  report.interop_reason = source_->bridge().reason();
  report.passes = measured_.passes(pass_timer(source_->device()));
  report.steps = {
      tools::statistics_of("draw and submit", "host clock", draw_ms_),
      tools::statistics_of("wait for the frame", "host clock", acquire_ms_, bytes_in_),
      tools::statistics_of("present", "host clock", present_ms_, bytes_out_),
      tools::statistics_of("hand to files", "host clock", write_ms_),
  };
  report.frames = rows_;
  measured_.fill(report.frames);
  if (options_.resolve.checks_motion && !measured_.empty())
    report.settings.emplace_back("motion check", text_of(measured_.motion()));
  if (front_) report.settings.push_back({"error front", front_->explanation});
  if (loop_->pacing().has_display()) {
    report.pacing = {loop_->run()};
    if (!options_.pacing.controls()) report.pacing.front().controller += " " + scale_text(options_);
  }
  if (scores_) {
    report.scores = scores_->rows();
    report.settings.push_back(
        {"scores",
         fmt::format("against {0}x{0} samples a pixel, drawn between the frames; what measures them "
                     "makes the passes slower",
                     options_.score)});
  }
  report.left_out = plan().left_out;
  report.files = files_;
  report.wall_seconds = wall_seconds_;
  return report;
}

tools::ReportPictures RenderSession::pictures() const {
  return scores_ ? scores_->pictures() : tools::ReportPictures();
}

}  // namespace quincunx::scenes
