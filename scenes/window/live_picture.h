// SPDX-License-Identifier: MIT
// LivePicture: frames drawn and resolved one after the other into textures of the current OpenGL context, by
// settings that may change between any two of them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "frames/method_resolves.h"
#include "frames/picture_options.h"
#include "frames/target_file.h"
#include "quincunx/control/front_file.h"
#include "quincunx/resolve_service.h"
#include "quincunx_gl/frame_timer.h"
#include "quincunx_gl/handle.h"
#include "window/window_settings.h"

namespace quincunx::scenes {

// The costs of one frame.
struct FrameTimes {
  double draw_ms = 0;  // OpenGL's work
  double cpu_ms = 0;   // the processor's, to prepare that
  FrameReport report;  // OpenCL's passes
};

class LivePicture {
 public:
  // Seed, exposure, devices, frame rate and what LookSettings leaves open come from `options`. An OpenGL
  // context is current, and stays longer than this object. Errors: of any part, as that part words them.
  static Result<std::unique_ptr<LivePicture>> create(const PictureOptions& options);

  // From the next draw() on. Makes anew what has to be; nothing where nothing has changed.
  Status configure(const LookSettings& look, const ResolutionSettings& resolution, Extent output);

  // The methods' errors and costs, where LookSettings::chooses_method; else null.
  const ErrorFront* front() const { return front_ ? &front_->front : nullptr; }

  // Returns the view of frame `index` by these settings. `chosen`: by a controller, for ResolutionMode::kController.
  // `choice`: of the method; where there is none, a frame has the one that was chosen last.
  FrameView view_of(std::int64_t index, Extent chosen, const std::optional<QualityChoice>& choice = {});

  enum class Keep : std::uint8_t { kNothing, kForFiles };

  // Sets the pointer's pixel of the picture, from the next draw() on.
  void point_at(Vec2 pixel) { source_->set_pointer(pixel); }

  // Draws frame `index` as `view`, then makes the picture from it and waits for that. `reset`: nothing of the
  // frames before may be used, as at a cut.
  Status draw(std::int64_t index, const FrameView& view, Keep keep = Keep::kNothing);
  Status resolve(bool reset = false);

  // The results of the last resolve(), until the next draw().
  GLuint picture() const { return source_->bridge().presented_texture(); }
  GLuint compared() const { return compared_.get(); }  // 0 where nothing is compared
  const std::uint8_t* pixels() { return source_->bridge().presented_pixels(); }
  const FrameTimes& times() const { return times_; }

  // The last frame's targets and resolved picture, as EXR files BASE_targets.exr and BASE_resolved.exr; it
  // must have been drawn with kForFiles.
  Status write(const std::string& base) const;

  Extent output() const { return source_->sequence().output(); }
  const ResolvePlan& plan() const { return resolves_->plan(); }
  // The last frame's; nothing where no controller chooses methods.
  const std::optional<QualityChoice>& choice() const { return choice_; }
  const FrameSource& source() const { return *source_; }

 private:
  LivePicture(const PictureOptions& options, gl::FrameTimer timer)
      : options_(options), timer_(std::move(timer)) {}

  PictureOptions options_for(const LookSettings& look, Extent output) const;
  Status open_source(const FrameSourceSettings& settings);
  Status open_services(const ResolveSettings& wanted);
  Status open_compared(const ResolvePlan& plan);
  Status dispatch(bool reset);
  Status bring_compared(const FrameView& view);
  void poll_timer();
  void collect_times();

  PictureOptions options_;
  gl::FrameTimer timer_;
  ScalePath sweep_;
  ScalePath random_;
  std::uint64_t timed_ = 0;  // frames that the timer was told of
  LookSettings look_;
  ResolutionSettings resolution_;
  std::unique_ptr<FrameSource> source_;
  std::optional<FrameSequence> sequence_;  // sequence of the views; its target is the source's
  std::optional<FoundFront> front_;
  std::optional<MethodResolves> resolves_;
  std::optional<QualityChoice> choice_;
  Image resolved_;  // made when the first file wants it

  std::optional<ResolveService> other_service_;
  Image other_image_;
  std::optional<PicturePresenter> truth_presenter_;
  gl::Texture compared_;

  FrameTimes times_;
  Keep keep_ = Keep::kNothing;
  std::optional<DrawnFrame> kept_;
};

}  // namespace quincunx::scenes
