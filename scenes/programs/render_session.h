// SPDX-License-Identifier: MIT
// RenderSession: one run of quincunx-render: scene, GL, bridge, service, and the loop that drives them.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frame_writer.h"
#include "quincunx/resolve_service.h"
#include "quincunx_gl/bridge.h"
#include "render_options.h"
#include "renderer.h"
#include "scene.h"
#include "tools/contact_sheet.h"
#include "tools/frame_pattern.h"
#include "tools/run_report.h"

namespace quincunx::scenes {

class RenderSession {
 public:
  // Opens everything the options ask for. Errors: of any part, as that part words them.
  static Result<std::unique_ptr<RenderSession>> create(const RenderOptions& options);

  ~RenderSession();
  RenderSession(const RenderSession&) = delete;
  RenderSession& operator=(const RenderSession&) = delete;

  const ResolvePlan& plan() const { return service_->plan(); }

  Status run();  // draws, resolves and writes every frame

  tools::RunReport report() const;  // complete after run()

 private:
  struct DrawnFrame;

  explicit RenderSession(const RenderOptions& options);
  Status open_scene_and_context();
  Status open_service();
  Status check_outputs();

  void begin_contact_sheet();
  Status run_frame(std::int64_t index);
  Status draw(std::int64_t index);
  Status dispatch(std::int64_t index);
  Status deliver(std::int64_t index);
  Status write_frame(std::int64_t index);
  Status write_exr_frame(std::int64_t index);
  Result<std::vector<float>> download_resolved() const;
  void collect_reports();
  bool wants_resolved() const;

  RenderOptions options_;
  Scene scene_;
  std::optional<gl::EglContext> context_;
  std::optional<Device> device_;
  std::optional<FrameSequence> sequence_;
  std::optional<Renderer> renderer_;
  std::unique_ptr<gl::Bridge> bridge_;
  std::optional<ResolveService> service_;
  Image resolved_;  // only where an EXR is wanted
  std::optional<tools::FramePattern> pattern_;
  std::optional<tools::ContactSheet> sheet_;
  std::vector<int> sheet_frames_;
  FrameWriter writer_;

  std::deque<DrawnFrame> drawn_;  // drawn, not yet delivered
  std::chrono::steady_clock::time_point last_delivery_;
  std::vector<FrameReport> reports_;
  std::vector<tools::FrameRow> rows_;
  std::vector<double> draw_ms_, acquire_ms_, present_ms_, write_ms_;
  std::vector<std::uint64_t> bytes_in_, bytes_out_;
  std::vector<std::string> files_;
  double wall_seconds_ = 0;
};

}  // namespace quincunx::scenes
