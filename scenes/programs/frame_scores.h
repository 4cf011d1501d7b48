// SPDX-License-Identifier: MIT
// FrameScores: the frames of a run of quincunx-render beside supersampled truth, drawn from the same scene.
#pragma once

#include <cstdint>
#include <vector>

#include "programs/frame_source.h"
#include "programs/render_options.h"
#include "tools/page/scored_frames.h"
#include "tools/program/work_queue.h"

namespace quincunx::scenes {

class FrameScores {
 public:
  // Of the frames 0 to options.frames - 1, with options.score^2 samples a pixel. Pictures are kept for a report.
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

}  // namespace quincunx::scenes
