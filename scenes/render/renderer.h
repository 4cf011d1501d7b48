// SPDX-License-Identifier: MIT
// Renderer: draws a Scene with OpenGL 4.5 or OpenGL ES 3.1 into the viewport of render targets.
//
// One geometry pass writes colour, depth and velocity; then sky, then transparents (colour and reactive
// only), then the scene's faults (colour only). Reversed infinite depth, rows top-down, jitter through the
// projection. Uses the current GL context; one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "quincunx/advanced/method.h"
#include "quincunx/frame.h"
#include "quincunx/status.h"
#include "quincunx_gl/frame_timer.h"
#include "quincunx_gl/render_targets.h"
#include "render/view_math.h"
#include "scene.h"

namespace quincunx::scenes {

inline constexpr float kLeastPartScale = 0.0625f;  // per axis

// Targets and timers of the parts of a frame that have a resolution of their own. They are the caller's; a part whose
// timer is null is not timed.
struct FrameParts {
  std::uint64_t frame = 0;  // its number, for the timers
  // Times what moves in the shadow map: a frame that also draws what stands still is like no other.
  gl::PartTimer* shadow_timer = nullptr;
  // The targets of FrameView::particles: linear colour (alpha: coverage), reactive values if the frame's
  // targets have them, and depth of the surfaces behind.
  const gl::RenderTargets* particles = nullptr;
  gl::PartTimer* particle_timer = nullptr;
};

// How targets that hold encoded colour (RGBA8) show the scene's light; others ignore it.
struct Display {
  float exposure = 1;  // multiplies light before the curve; > 0
  ToneMap tone_map = ToneMap::kAces;
};

struct FrameView {
  Extent render = {};           // viewport
  Vec2 jitter = {};             // render pixels: samples lie at pixel centre + jitter
  double seconds = 0;           // scene time of this frame
  double previous_seconds = 0;  // scene time of the previous frame: velocity = this position - that one
  // Width / height of the picture; 0: the viewport's. A viewport is rounded to pixels, so frames of one picture at
  // several resolutions show the same only with the picture's own aspect.
  float aspect = 0;
  float lod_bias = 0;  // bias for every texture
  // The pixels with (x + y) % 2 of this are drawn, 0 or 1, into targets that have a checkerboard; absent: all pixels.
  std::optional<int> parity = {};
  // Less work where detail may go; both 0: all of it.
  float least_size = 0;   // surfaces that span less than this part of the picture's height are left out
  double shadow_age = 0;  // seconds for which the drawn shadows of what moves may stay
  // Side of the part of the shadow map that is drawn and read, of the whole: in [kLeastPartScale, 1].
  float shadow_scale = 1;
  // The viewport that particles are drawn into, at most `render`; 0x0: they are drawn with everything else.
  Extent particles = {};
  Display display = {};
  // The part of the picture that is drawn, and that which was drawn before, to which velocity is relative.
  ViewWindow window = {};
  ViewWindow previous_window = {};
};

struct TruthSettings;

class Renderer {
 public:
  // Uploads the scene. Errors: kInvalidArgument for a scene that does not hold together (indices, sizes),
  // kDeviceFailure with the shader log.
  static Result<Renderer> create(const Scene& scene);

  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  // Draws one frame; clears what it must first. Velocity and reactive values are written where the targets
  // have them. Particles that have a viewport of their own are drawn last, hidden by the frame's depth, over
  // transparent black; FrameParts::particles is needed then. Their order among transparent surfaces is lost.
  Status draw(const gl::RenderTargets& targets, const FrameView& view, const FrameParts& parts = {});

  // For velocity from depth: from this frame's clip space to the previous frame's, jitter excluded.
  CameraMotion camera_motion(const FrameView& view) const;

 private:
  friend Result<std::vector<float>> render_truth(Renderer& renderer, const TruthSettings& settings,
                                                 double seconds);

  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx::scenes
