// SPDX-License-Identifier: MIT
// Files made of a frame: its render targets as one EXR of the exchange format (docs/inputs.md), linear pictures as EXR,
// or brought to 8 bits as a screen shows them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "quincunx/device.h"
#include "quincunx/resolve_service.h"
#include "quincunx/status.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::scenes {

struct TargetFile {
  DrawnFrame frame;  // drawn with its targets kept
  gl::TargetPixels relative_to_next =
      {};  // the same with velocity = this position - the next one; may be empty
  Camera camera;
  Extent output;
  double fps = 60;
  bool linear_depth = true;  // Z is the distance along the view axis; else reversed device depth, untouched
};

// One value a pixel of the viewport, as the file has them; empty for targets that were not drawn.
std::vector<float> colour_of(const gl::TargetPixels& pixels);   // RGBA, linear
std::vector<float> depth_of(const TargetFile& file);            // Z
std::vector<Vec2> velocity_of(const gl::TargetPixels& pixels);  // uv, as drawn
std::vector<Vec2> backward_motion(const gl::TargetPixels& pixels);
std::vector<float> reactive_mask(const TargetFile& file);

// Gives each pixel the velocity of the nearest of its 3x3, as other renderers write it.
void dilate_velocity(gl::TargetPixels& pixels);

// R G B A and reactive.mask half, Z, backward.u/.v and forward.u/.v float, render extent. Errors: kIoFailure.
Status write_targets(const std::string& path, const TargetFile& file);

// Returns an image of RGBA floats, tightly packed; waits for what writes it.
Result<std::vector<float>> download_rgba(Device device, const ImageView& image, Extent extent);

// Brings linear pictures from host memory to 8 bits with the same present pass as every frame. One extent, one
// exposure. Not thread-safe; blocks.
class PicturePresenter {
 public:
  // `exposure` > 0 multiplies linear colour.
  static Result<PicturePresenter> create(const Device& device, Extent extent, ToneMap tone_map, bool dither,
                                         float exposure);

  // Linear RGBA, tightly packed, to RGBA8: tone mapped, sRGB encoded.
  Result<std::vector<std::uint8_t>> present(const std::vector<float>& rgba);

 private:
  PicturePresenter(const Device& device, ResolveService service, Image linear, Image encoded, float exposure)
      : device_(device),
        service_(std::move(service)),
        linear_(std::move(linear)),
        encoded_(std::move(encoded)),
        exposure_(exposure) {}

  Device device_;
  ResolveService service_;
  Image linear_;
  Image encoded_;
  float exposure_;
};

}  // namespace quincunx::scenes
