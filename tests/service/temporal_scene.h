// SPDX-License-Identifier: MIT
// Small analytic sequences with exact velocity and truth, for the properties of kTemporal.
//
// A scene is a list of flat textured surfaces, nearest first; the last must cover the picture. Places are
// complex numbers: x + iy in output pixels, +y down. Time counts frames.
#pragma once

#include <algorithm>
#include <complex>
#include <functional>
#include <vector>

#include "service_fixture.h"

namespace quincunx::testing {

using Place = std::complex<double>;
using Texture = std::function<Pixel(Place)>;

struct Surface {
  enum class Shape { kPlane, kRectangle, kDisc };
  Shape shape = Shape::kPlane;
  Place half_size = {};   // kDisc: the real part is its radius
  Place centre = {};      // at time 0
  Place velocity = {};    // a frame
  Place turn = {1, 0};    // a frame: rotation and growth about the centre
  double distance = 10;   // in near planes
  bool reactive = false;  // drawn without velocity: that of what lies behind it, with reactive values
  // Drawn as many renderers draw a sky: infinitely far and with a velocity of 0, though it moves with the camera.
  bool is_sky = false;
  Texture texture = [](Place) { return Pixel{.5f, .5f, .5f, 1}; };
};

struct TemporalScene {
  Extent output = {160, 96};
  std::vector<Surface> surfaces;
  std::function<double(Place, int frame)> light;  // multiplies colour; none: 1
  float exposure = 0;                             // as FrameInputs has it

  Pixel colour_at(Place place, int frame) const;
  // The mean of 4x4 places in each output pixel.
  std::vector<Pixel> truth(int frame) const;
  // The camera's motion is that of the sky, if there is one.
  HostFrame render(int frame, Extent render, Vec2 jitter) const;
};

// Pattern of many frequencies, some above what a sample every two pixels can show: value noise of two sizes,
// times checks of `cell` output pixels.
Texture noise_texture(double cell, unsigned salt = 0);
Texture plain_texture(float red, float green, float blue);

// Wires of less than two output pixels, which slide over a wall that drifts the other way.
TemporalScene wires_before_a_wall();

// Place number `frame` of the Halton sequence of bases 2 and 3, from -.5 to .5; it repeats after `phases`.
Vec2 halton_jitter(int frame, int phases);
int halton_phases(Extent output, Extent render);  // 8 samples to each output pixel

// c / (1 + c), sRGB encoded.
double tone_of(float colour);

// The pixels that count in a comparison of two pictures; none: all.
using Mask = std::function<bool(int x, int y)>;
double squared_error(const std::vector<Pixel>& a, const std::vector<Pixel>& b, Extent output,
                     const Mask& mask = {});
double psnr(double squared_error);
double psnr(const std::vector<Pixel>& a, const std::vector<Pixel>& b);
// The largest difference of any channel, tone mapped.
double largest_difference(const std::vector<Pixel>& a, const std::vector<Pixel>& b, Extent output,
                          const Mask& mask = {});

// Runs a scene, a frame a call.
class TemporalRun {
 public:
  explicit TemporalRun(TemporalScene scene, ResolveSettings settings = {.method = Method::kTemporal},
                       SceneNeeds needs = {})
      : scene_(std::move(scene)), rig_(needs, settings, scene_.output, {320, 192}) {}

  std::vector<Pixel> next(Extent render = {80, 48}) {
    phases_ = std::max(phases_, halton_phases(scene_.output, render));
    const int frame = frame_++;
    return rig_.resolve(scene_.render(frame, render, halton_jitter(frame, phases_)));
  }
  // The frames before `end`, of which only the last is of interest.
  std::vector<Pixel> until(int end, Extent render = {80, 48}) {
    std::vector<Pixel> pixels;
    while (frame_ < end)
      pixels = next(render);
    return pixels;
  }
  std::vector<Pixel> truth() const { return scene_.truth(frame_ - 1); }
  int frame() const { return frame_; }
  void skip() { ++frame_; }  // a frame that the caller gave to the rig
  ServiceRig& rig() { return rig_; }
  TemporalScene& scene() { return scene_; }

 private:
  TemporalScene scene_;
  ServiceRig rig_;
  int frame_ = 0;
  int phases_ = 0;  // jitter phases at the lowest scale so far
};

}  // namespace quincunx::testing
