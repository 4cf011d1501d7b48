// SPDX-License-Identifier: MIT
// FramePacing: at which extent the next frame is drawn, when it may begin, and which refreshes were missed.
//
// The logic between a renderer, a display and a resolution controller, without any of them: the caller gives
// all times, in milliseconds of one clock of its own. The display shows one finished frame at each refresh,
// in order, from `buffers` buffers; it refreshes every 1 / target_fps seconds from the moment when frame 0 is
// finished. A real display with its own refreshes is near enough, as long as it refreshes as often.
//
//   FramePacing& pacing = ...;                       frames are 0, 1, 2 ... in order
//   wait until pacing.free_at();
//   const std::uint64_t frame = pacing.begin(now, pacing.next().value_or(chosen otherwise));
//   draw, resolve, present;
//   pacing.finish(frame, now);
//   pacing.observe(frame, pacing.busy_ms(frame));    or a time measured by the device, whenever it comes
//
// The next frame may begin before this one is finished. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "quincunx/control/quality_controller.h"
#include "quincunx/frame.h"
#include "quincunx/status.h"
#include "tools/program/pacing_report.h"

namespace quincunx::scenes {

enum class ControllerKind : std::uint8_t { kPredictive, kProportional, kMinimumOfN, kQuality, kFixed };

const char* name_of(ControllerKind kind);  // "predictive", "proportional", "minimum-of-n", "quality", "fixed"

struct PacingSettings {
  ControllerKind controller = ControllerKind::kPredictive;
  LadderSettings ladder = {};
  double target_fps = 60;
  int buffers = 3;      // in [2, 8]
  double headroom = 0;  // part of the refresh interval that frames shall leave free, in [0, 0.5]
  std::optional<CostTable> calibration = std::nullopt;  // this and the next two: for kPredictive and kQuality
  CpuBound cpu_bound = CpuBound::kHold;
  BlurAware blur_aware = {};
  ErrorFront front = ErrorFront::built_in();  // for kQuality: what its methods err and cost
};

// The costs of a finished frame, and its content.
struct FrameCosts {
  double gpu_ms = 0;
  double resolve_ms = 0;                          // share of gpu_ms that the passes take; 0: not known
  std::optional<ContentStatistics> content = {};  // nothing: not known
};

class FramePacing {
 public:
  // Errors: kInvalidArgument for a rate that is not positive and finite or below one frame a minute, for
  // buffers or headroom outside their range, and what the controller says of the rest.
  static Result<FramePacing> create(const PacingSettings& settings);

  // Without a display and a controller: frames begin whenever the caller likes, and are shown as they are finished.
  static FramePacing free_running(Extent output);

  bool has_display() const { return refresh_ms_ > 0; }

  // The extent of the frame that begins next; nothing where the controller is kFixed and the caller chooses.
  std::optional<Extent> next() const;
  // How that frame is resolved; nothing unless the controller is kQuality.
  std::optional<QualityChoice> choice() const;
  // Null where the controller is kFixed.
  const ResolutionController* controller() const { return controller_.get(); }

  // The time from which on the next frame has a buffer: when the display has left one. Long ago where there
  // always was one. Nothing where that depends on a frame that is not finished yet: finish it first.
  std::optional<double> free_at() const;

  // Work on the next frame starts, which is resolved as choice() says. Returns its number. blur_px: see FrameTiming.
  // detail: for the report only.
  std::uint64_t begin(double now_ms, Extent render, double blur_px = 0, int detail = 0);

  // Its picture is complete. Frames finish in order; cpu_ms 0: not known.
  void finish(std::uint64_t frame, double now_ms, double cpu_ms = 0);

  // The time of a finished frame: from its begin(), or from when the frame before it was finished if that was later,
  // to its own finish(). With one frame after the other, what it cost; with two under way, what it added.
  double busy_ms(std::uint64_t frame) const;

  // Tells the controller what a finished frame cost. Late times and lost ones do no harm; a frame that is not
  // finished, or a time that is none, changes nothing.
  void observe(std::uint64_t frame, const FrameCosts& costs);
  void observe(std::uint64_t frame, double gpu_ms) { observe(frame, FrameCosts{gpu_ms}); }

  // Every finished frame so far. `measured_by` and `reasons` are the caller's to fill in.
  const tools::PacingRun& run() const { return run_; }
  // Why the present pair: of a controller that chooses the method; else empty.
  std::string reasons() const;

 private:
  struct Controllers {
    std::unique_ptr<ResolutionController> controller;  // null: kFixed
    QualityController* quality = nullptr;              // the same, where it is one
  };
  static Result<Controllers> make_controller(const PacingSettings& settings);
  FramePacing(const PacingSettings& settings, double refresh_ms, Controllers controllers);
  void note_method(std::uint64_t frame, const QualityChoice& choice);

  struct Begun {
    double begin_ms = 0;
    Extent render = {};
    double blur_px = 0;
    int detail = 0;
    std::optional<QualityChoice> choice;
  };

  std::unique_ptr<ResolutionController> controller_;
  QualityController* quality_;
  std::optional<MethodVariant> method_;  // method of the frame begun last
  double refresh_ms_;                    // 0: there is no display
  double origin_ms_ = 0;                 // the caller's time of the first refresh
  std::vector<Begun> under_way_;         // begun and not finished, oldest first
  tools::PacingRun run_;
};

// Returns how long the streaks of motion blur are that the camera's own motion draws, for begin(): the mean over points
// spread over the picture, each 2, 8 and 32 metres away and standing still, in pixels of `output`. `shutter`: part of
// the frame's time that it is open. Pure. What moves by itself is not seen.
double camera_streak_px(const CameraMotion& motion, float near_plane, Extent output, float shutter);

}  // namespace quincunx::scenes
