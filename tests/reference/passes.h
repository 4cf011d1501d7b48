// SPDX-License-Identifier: MIT
// velocity_from_depth, far_velocity, undilate_velocity, convert_inputs, resolve_quincunx, sharpen and present: the
// specification, in double precision.
#pragma once

#include <array>
#include <cstdint>

#include "scale.h"

namespace quincunx::reference {

struct CameraVelocity {
  std::array<double, 2> velocity;  // uv; NaN where depth is not finite, +-65504 at most
  double condition;  // for error bounds: the sums of magnitudes behind the previous position, over w
  double w_part;     // w of the previous position by its sum of magnitudes: small where terms cancel
};

// velocity_from_depth: at each texel of the viewport. A surface that was not in front of the previous camera
// (w <= 0) has a velocity of 65504 on both axes.
std::vector<CameraVelocity> velocity_from_depth(const Frame& frame);

struct CompletedVelocity : CameraVelocity {  // in the units of the drawn one; `condition` is in uv
  bool is_from_camera;
};

// far_velocity: the drawn velocity, and the camera's where a sample is infinitely far away and has none.
std::vector<CompletedVelocity> far_velocity(const Frame& frame);

// undilate_velocity: each sample's own velocity, from that of the nearest of its 3x3. D being the nearest depth of a
// sample's 3x3, a sample of another D than its own depth d gets the velocity of the sample k whose D(k) is closest to
// d, if that is d exactly or, where D exceeds d by more than d / 32, within d / 32. It is looked for among the eight
// neighbours; in the latter case then two away, and so on to 8, until there is one. Where there is none the camera
// gives the velocity if it is known, that is, not the identity. Of those as close the first counts, row by row.
std::vector<CompletedVelocity> undilate_velocity(const Frame& frame);

// convert_inputs: near / distance of a depth that is 1 at the near and 0 at the far plane, or with `forward` the other
// way round, or of a distance. The far plane may be infinite. Exactly the value at the far plane, and a distance that
// is infinite, no number or not above 0, give 0; a distance within the near plane gives 1.
double depth_between_planes(double depth, bool forward, double near_plane, double far_plane);
double depth_of_distance(double distance, double near_plane);
// Without `jitter`, by which it has moved a still surface; (0, 0) stays.
std::array<double, 2> unjittered(const std::array<double, 2>& velocity, const std::array<double, 2>& jitter);

enum class Weight { kMean, kVelocity };

// resolve_quincunx:
//   out = (c0 + f c1) / (1 + f), f = (1 - reactive0) (1 - reactive1) / (1 + K (|v0|^2 + |v1|^2))
// v in render pixels of its own frame; c0, c1 bilinear or, with `nearest`, of the nearest sample. f is 0 where c1
// or a velocity is not finite. Source: Binks, "Dynamic Resolution Rendering", 2012.
Picture resolve_quincunx(const Frame& current, const Frame& previous, Weight weight, bool nearest,
                         bool reactive, double k, int output_width, int output_height);

// sharpen: m the mean of a pixel's four neighbours, low and high the range of the five, S the sharpness,
//   out = clamp(c + S g (c - m), low, high), g = (1 + |c|) / (1 + max(-low, high))
// for red, green and blue each; alpha stays. `largest` is of all five. Neighbours are clamped to the edge.
// Source: the cross of Lottes, AMD FidelityFX Contrast Adaptive Sharpening, 2019.
Picture sharpen(const Picture& picture, double sharpness);

// cross_fade: other + weight (picture - other), of sanitised values; `largest` is of both.
Picture cross_fade(const Picture& picture, const Picture& other, double weight);

enum class Curve { kClamp, kReinhard, kAces };

// present: 255 * the sRGB encoding of exposed, tone-mapped colour, and 255 * alpha, before it is rounded. kAces:
// the fit of Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
Pixel present(const Pixel& resolved, Curve curve, double exposure);

// Returns the dither's offset at a pixel before its codes are truncated, in [0, 1).
double dither_offset(int x, int y);

}  // namespace quincunx::reference
