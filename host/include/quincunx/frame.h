// SPDX-License-Identifier: MIT
// FrameInputs, FrameOutputs, FrameReport: one dispatch of the service.
//
// Plain structs; a zero means the default written beside the field. docs/inputs.md has the conventions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "quincunx/advanced/content_statistics.h"
#include "quincunx/advanced/export.h"
#include "quincunx/advanced/motion_check.h"
#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx {

// The camera's motion, for velocity from depth and to recognise surfaces. The matrix is column-major and takes (ndc.x,
// ndc.y, depth, 1) of this frame to homogeneous clip coordinates of the previous frame, both without jitter, in
// InputConventions::clip_space. Depth is the depth target's. The identity: the camera stands still, or its motion is
// unknown.
struct CameraMotion {
  std::array<float, 16> clip_to_previous_clip = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

// Returns the jitter of a frame for Method::kTemporal, in render pixels, within half a pixel. It repeats
// jitter_phases() places: those of the Halton sequence in bases 2 and 3, less their mean. Draw the frame with clip
// coordinates that are shifted by it (docs/inputs.md#jitter), and give it as FrameInputs::jitter. Without jitter, or
// with the same in all frames, many frames show no more detail than one: a still picture stays coarse, and its edges
// crawl when it moves. Pure; {0, 0} where an extent is empty.
[[nodiscard]] QUINCUNX_API Vec2 jitter(std::uint64_t frame_index, Extent render, Extent output);
// Returns ceil(8 output.area() / render.area()), at most 512: each output pixel then gets eight samples.
[[nodiscard]] QUINCUNX_API int jitter_phases(Extent render, Extent output);
// Returns the LOD bias of textures for frames with that jitter: log2(scale) - 1, with the geometric mean of both axes'
// scales (as AMD FidelityFX Super Resolution 2). Without it textures stay as soft as the render extent makes them.
[[nodiscard]] QUINCUNX_API float texture_lod_bias(Extent render, Extent output);

// One rendered frame. The images belong to the caller and stay unchanged until the work of this dispatch is
// done and, where ResolvePlan::keeps_previous_frame() is true, until the work of the *next* dispatch is done: the
// service reads the previous frame in place. So give frames n and n - 1 different memory; a ring of three lets the
// renderer run ahead.
struct FrameInputs {
  // RGBA16F or RGBA32F: linear, premultiplied. RGBA8: exposed, tone mapped and sRGB encoded by the renderer.
  ImageView colour = {};
  // The other images are read only where the plan says so.
  ImageView depth = {};       // R32F, by InputConventions
  ImageView velocity = {};    // RG16F or RG32F, by InputConventions
  ImageView reactive = {};    // R8, 0: trust history, 1: ignore it
  Extent render_extent = {};  // the viewport, within the images (placed: all of them); any size from 1x1
  // The picture's size in this frame, from settings.output.min_extent to output_extent; {0, 0}: the latter. History of
  // another size is resampled to it.
  Extent output_extent = {};
  // Render pixels: the sample of a pixel lies at its centre + jitter; each within [-1, 1].
  Vec2 jitter = {};
  Vec2 velocity_scale = {};  // factor from velocity to InputConventions::velocity_unit; {0, 0}: {1, 1}
  // Distances of depth's planes, where InputConventions::depth needs them: 0 < near_plane < far_plane.
  float near_plane = 0;
  float far_plane = 0;
  CameraMotion camera = {};
  // With settings.targets.particle_extent: particles that were drawn into a viewport of their own, with the frame's
  // camera and jitter, over transparent black, hidden by `particle_depth`. They are laid over `colour` and `reactive`.
  ImageView particle_colour = {};      // as colour; alpha: coverage
  ImageView particle_depth = {};       // R32F: the frame's depth resampled, of a surface that the pixel shows
  ImageView particle_reactive = {};    // R8
  Extent particle_render_extent = {};  // the particles' viewport; any size from 1x1
  // Factor of linear colour before the tone map: the present pass multiplies by it. It also tells `temporal`,
  // quincunx:reprojected and sharpening how bright the scene's unit of light is; they measure that if neither this nor
  // the image is given. 0: not given, 1 in the present pass. Not read with RGBA8.
  static constexpr float kLargestExposure = 1e6f;
  float exposure = 0;
  // R32F, 1x1, a buffer or an image: another factor of the exposure, made on the device. A value that is not positive
  // and finite counts as none.
  ImageView exposure_image = {};
  bool reset = false;  // a cut: nothing of the previous frame may be used
  // Shading::kCheckerboard: pixels (x, y) with (x + y) % 2 == parity are shaded, the others are not read; 0 or 1.
  int parity = 0;
  std::uint64_t frame_index = 0;  // the caller's number, echoed in the report
  // With settings.control.fades: another method's picture of this frame, in the format and extent of
  // FrameOutputs::linear, in another buffer. `fade_weight`, in [0, 1], is the weight of this frame's own picture in the
  // mix of both.
  ImageView fading_from = {};
  float fade_weight = 1;
};

// The images that get the finished picture, in settings.output_extent. At least one is needed.
struct FrameOutputs {
  ImageView linear = {};     // RGBA32F or RGBA16F, as settings.output.linear says: linear light, in a buffer
  ImageView presented = {};  // RGBA8: exposed, tone mapped, sRGB encoded
};

struct PassReport {
  const char* kernel = "";  // static string: "resolve_quincunx"
  double ms = -1;           // device time; -1: not known (yet)
  std::uint64_t bytes = 0;  // read and written in this frame, each texel counted once
  bool in_focus = false;    // a pass of the focus's region, which has passes of its own
};

// Returns "resolve_quincunx", of the focus's region "focus: resolve_quincunx".
QUINCUNX_API std::string name_of(const PassReport& pass);

// The passes of a frame in the order in which they ran. A value that allocates nothing.
class PassReports {
 public:
  static constexpr std::size_t max_size() { return kRoom; }

  // Adds a pass; ignores it where there are max_size().
  void push_back(const PassReport& pass) {
    if (size_ < max_size()) passes_[size_++] = pass;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const PassReport& operator[](std::size_t i) const { return passes_[i]; }
  PassReport& operator[](std::size_t i) { return passes_[i]; }
  const PassReport* begin() const { return passes_.data(); }
  const PassReport* end() const { return begin() + size_; }
  PassReport* begin() { return passes_.data(); }
  PassReport* end() { return begin() + size_; }

 private:
  static constexpr std::size_t kRoom = 72;  // the largest plan has 40 for the picture and 25 for its focus

  std::size_t size_ = 0;
  std::array<PassReport, kRoom> passes_;
};

struct [[nodiscard]] FrameReport {
  Status status;  // kInvalidArgument: nothing was enqueued; kDeviceFailure: outputs are not to be used
  std::uint64_t frame_index = 0;
  Extent render_extent = {};
  Extent output_extent = {};
  Vec2 ratio = {};             // render / output, recomputed from the integer viewport
  bool used_previous = false;  // history contributed (false on the first frame and after reset)
  PassReports passes = {};
  bool focused = false;  // a focus was laid over the picture
  // Output pixels that met NaN or Inf in their footprint, and such pixels of the focus; -1: not known yet.
  std::int64_t non_finite_pixels = -1;
  // Statistics of the picture's content, with settings.control.measures_content; empty until measured. Cuts are not
  // detected: the caller reports them. Light that moves without reactive values is seen by kTemporal alone.
  std::optional<ContentStatistics> content = {};
  MotionCheck motion =
      {};  // with settings.checks_motion, the verdict on velocity of the frames up to this one

  bool ok() const { return status.ok(); }
};

}  // namespace quincunx
