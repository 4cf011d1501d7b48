// SPDX-License-Identifier: MIT
// Image metrics: how far a picture is from the truth, in the terms of the field, and where it changes from one frame to
// the next as it should not.
//
// Pictures are linear light, scene referred. Each is prepared once as a MeasuredPicture and then compared as
// often as needed, so that one truth serves every method of a benchmark. Functions of two pictures expect one
// extent for both. All are pure and thread-safe.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "quincunx/image.h"

namespace quincunx::tools {

// One picture in the three forms that the metrics look at. Owns its values. NaN counts as 0, infinities as
// +-65504, as everywhere in Quincunx.
class MeasuredPicture {
 public:
  // `rgba`: extent.area() * 4 values, rows top-down, linear light; alpha is ignored. Extent at least 11x11.
  MeasuredPicture(Extent extent, std::span<const float> rgba);

  Extent extent() const { return extent_; }
  std::span<const float> linear() const { return linear_; }  // R G B
  std::span<const float> tone_mapped() const {
    return tone_mapped_;
  }                                                        // R G B, sRGB encoded max(c, 0)/(1 + c)
  std::span<const float> luma() const { return luma_; }    // Rec. 709 luma of tone_mapped()
  std::int64_t non_finite() const { return non_finite_; }  // pixels with a NaN or infinite colour

 private:
  Extent extent_;
  std::vector<float> linear_;
  std::vector<float> tone_mapped_;
  std::vector<float> luma_;
  std::int64_t non_finite_ = 0;
};

// Returns the picture of linear RGBA that is not exposed yet. Transparent pixels are laid over grey (0.18, after
// exposure), so that alpha counts.
MeasuredPicture measured(Extent extent, std::vector<float> rgba, float exposure);

// Peak signal-to-noise ratio, dB, of all colour values: linear ones clipped to [0, 1], or tone-mapped ones.
// Infinite for equal pictures.
double psnr_linear(const MeasuredPicture& picture, const MeasuredPicture& truth);
double psnr_tone_mapped(const MeasuredPicture& picture, const MeasuredPicture& truth);

// Mean structural similarity of luma, 1 for equal pictures. Gaussian windows of 11x11, sigma 1.5, wholly inside.
// Source: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", 2004.
double ssim(const MeasuredPicture& picture, const MeasuredPicture& truth);

// The 99th percentile of |picture - truth| over all tone-mapped colour values.
double error_p99(const MeasuredPicture& picture, const MeasuredPicture& truth);

// Relative mean squared error of linear colour: the mean of (c - t)^2 / (t^2 + 0.01). Bright and dark parts
// count alike, whatever the exposure.
// Source: Rousselle, Knaus, Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error Minimization",
// 2011.
double relative_error(const MeasuredPicture& picture, const MeasuredPicture& truth);

// The 16x16 pixels with the largest error: root mean square of their tone-mapped colour values. The upper
// left one is (x, y).
struct WorstWindow {
  int x = 0;
  int y = 0;
  double error = 0;
};
inline constexpr int kWindowSide = 16;  // less where the picture is smaller
WorstWindow worst_window(const MeasuredPicture& picture, const MeasuredPicture& truth);

// Mean |(picture - previous) - (truth - previous_truth)| of luma: change over time that the truth does not
// have.
double flicker(const MeasuredPicture& picture, const MeasuredPicture& previous, const MeasuredPicture& truth,
               const MeasuredPicture& previous_truth);

// All of the above that need one frame, with the mean of flip.h at its usual viewing distance.
struct PictureScores {
  double psnr_linear = 0;       // dB, infinite for equal pictures
  double psnr_tone_mapped = 0;  // dB
  double ssim = 0;
  double flip = 0;
  double error_p99 = 0;
  double relative_error = 0;
  WorstWindow worst_window;
  std::int64_t non_finite = 0;  // pixels of the picture with a NaN or infinite colour
};
PictureScores measure(const MeasuredPicture& picture, const MeasuredPicture& truth);

// For each pixel |(picture - previous) - (truth - previous_truth)| of luma, whose mean is flicker(). All of one extent.
std::vector<float> flicker_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                               const MeasuredPicture& truth, const MeasuredPicture& previous_truth);

// uv velocity of a frame (this position - previous position, +v down), rows top-down; as many as the extent's area.
struct MotionField {
  Extent extent;
  std::span<const Vec2> velocity;
};

// For each pixel |picture - previous| of luma, previous read (bilinear) where motion says that the pixel was; 0 where
// that is off screen. Trails and ghosts show, and whatever motion does not explain: what is uncovered, changes of
// light, edges that alias otherwise.
std::vector<float> ghost_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                             const MotionField& motion);

// ---- FLIP: the difference that an observer sees when two pictures are shown in turn, per pixel and in the mean.
//
// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", 2020 (LDR-FLIP).

// A screen of 3840 pixels on 0.7 m, seen from 0.7 m: the paper's choice.
inline constexpr double kFlipPixelsPerDegree = 67.02064327658225;

// `picture` and `truth`: extent.area() * 3 values in [0, 1], sRGB encoded R G B, rows top-down; both finite.
// Returns extent.area() values in [0, 1], 0 for equal pixels in equal neighbourhoods. Symmetric. Pure and
// thread-safe.
std::vector<float> flip_map(Extent extent, std::span<const float> picture, std::span<const float> truth,
                            double pixels_per_degree = kFlipPixelsPerDegree);

double flip_mean(std::span<const float> map);

}  // namespace quincunx::tools
