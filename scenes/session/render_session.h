// SPDX-License-Identifier: MIT
// RenderSession: one run of quincunx-render: frames, service, and the loop that drives them.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "frames/method_resolves.h"
#include "frames/part_scales.h"
#include "quincunx/control/front_file.h"
#include "quincunx/resolve_service.h"
#include "session/paced_loop.h"
#include "session/render_options.h"
#include "tools/image/contact_sheet.h"
#include "tools/page/scored_frames.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/run_report.h"
#include "tools/program/work_queue.h"

namespace quincunx::scenes {

// The frames of a run beside supersampled truth, drawn from the same scene.
class FrameScores {
 public:
  // Scores the frames 0 to options.frames - 1, with options.score^2 samples a pixel. Pictures are kept for a report.
  explicit FrameScores(const RenderOptions& options);

  // Draws the truth of a frame, and of those whose pictures are kept the motion, as the run itself may have drawn none;
  // measures on a thread of its own. In ascending order, on the thread of the GL context. `resolved`: linear RGBA of
  // the output's extent. `repeats`: for how many further refreshes of 1/fps the frame before was shown; it is measured
  // against the truth of each. Errors: of Renderer::draw, and of an earlier frame.
  Status add(FrameSource& source, std::int64_t index, const FrameView& view, std::vector<float> resolved,
             int repeats = 0);
  Status finish();

  const std::vector<tools::ScoreRow>& rows() const { return scored_.rows(); }   // after finish()
  const tools::ReportPictures& pictures() const { return scored_.pictures(); }  // after finish()

 private:
  Status add_repeat(FrameSource& source, double seconds);
  Result<std::vector<float>> truth_at(FrameSource& source, double seconds) const;
  // Exposed and, where colour is of 8 bits and was so before it was resolved, tone mapped.
  tools::MeasuredPicture measured_truth(std::vector<float> truth, float exposure) const;
  Result<std::vector<Vec2>> motion_of(Renderer& renderer,
                                      FrameView view) const;  // uv, of the output's extent

  RenderOptions options_;
  tools::ScoredFrames scored_;
  tools::WorkQueue queue_{1, 1};  // last: its thread uses the rest
};

class RenderSession {
 public:
  // Opens everything the options ask for. Errors: of any part, as that part words them.
  static Result<std::unique_ptr<RenderSession>> create(const RenderOptions& options);

  // Another run of the same frames, paced, at one scale, on the same devices; writes no files.
  Result<std::unique_ptr<RenderSession>> at_fixed_scale(float scale) const;

  ~RenderSession();
  RenderSession(const RenderSession&) = delete;
  RenderSession& operator=(const RenderSession&) = delete;

  const ResolvePlan& plan() const { return resolves_->plan(); }

  Status run();  // draws, resolves and writes every frame

  tools::RunReport report() const;         // complete after run()
  tools::ReportPictures pictures() const;  // with --score and --report; after run()

 private:
  explicit RenderSession(const RenderOptions& options);
  Status open(std::unique_ptr<FrameSource> source);
  Status open_resolves();
  Status open_pacing();
  Status check_outputs();

  void begin_contact_sheet();
  Status run_frame(std::int64_t index);
  Status draw(std::int64_t index);
  FrameView begin_frame(std::int64_t index);
  bool draws_ahead() const;
  // Writing and scoring a frame is no part of a paced run: the display waits.
  bool stops_clock() const;
  Status finish_files();
  // Each pass is waited for and timed by the host's clock: not in a paced run, whose frames that would slow.
  bool times_by_waiting() const;
  std::string overlap_text() const;  // for the report
  Status dispatch();
  Status deliver(std::int64_t index);
  Status write_frame(std::int64_t index);
  Status write_exr_frame(std::int64_t index);
  Status score_frame();
  // Says once that a file's halves do not hold all light.
  void note_clipping(std::int64_t index, const std::string& path, std::span<const float> rgba);
  Result<std::vector<float>> download_resolved() const;
  void collect_reports();
  bool wants_resolved() const;

  RenderOptions options_;
  std::unique_ptr<FrameSource> source_;
  std::optional<FoundFront> front_;  // where the controller chooses the method
  std::optional<MethodResolves> resolves_;
  std::optional<PacedLoop> loop_;  // once open; without a display where no rate is asked for
  std::deque<std::optional<QualityChoice>> choices_;  // for frames drawn but not dispatched
  std::optional<FrameDetail> detail_;
  std::optional<FrameScores> scores_;
  Image resolved_;  // only where an EXR or a score is wanted
  std::optional<tools::FramePattern> pattern_;
  std::optional<tools::ContactSheet> sheet_;
  std::vector<int> sheet_frames_;
  tools::WorkQueue writer_;

  std::chrono::steady_clock::time_point last_delivery_;
  tools::MeasuredFrames measured_;
  std::vector<tools::FrameRow> rows_;
  std::vector<double> draw_ms_, acquire_ms_, present_ms_, write_ms_;
  std::vector<std::uint64_t> bytes_in_, bytes_out_;
  std::vector<std::string> files_;
  double wall_seconds_ = 0;
  bool has_clipped_ = false;  // light, in a file
};

}  // namespace quincunx::scenes
