// SPDX-License-Identifier: MIT
#include "quincunx/method.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace quincunx {
namespace {

double tent(double d) {
  return std::max(1 - d, 0.0);
}

// Mitchell and Netravali, "Reconstruction Filters in Computer Graphics", 1988, recommend B = C = 1/3.
double cubic(double d, double b, double c) {
  if (d >= 2) return 0;
  if (d < 1) return (((12 - 9 * b - 6 * c) * d + (-18 + 12 * b + 6 * c)) * d * d + 6 - 2 * b) / 6;
  return (((-b - 6 * c) * d + (6 * b + 30 * c)) * d + (-12 * b - 48 * c)) * d / 6 + (8 * b + 24 * c) / 6;
}

// Sigg and Hadwiger, "Fast Third-Order Texture Filtering", 2005.
double b_spline(double d) {
  return cubic(d, 1, 0);
}

// Keys, "Cubic Convolution Interpolation for Digital Image Processing", 1981.
double catmull_rom(double d) {
  return cubic(d, 0, .5);
}

double mitchell(double d) {
  return cubic(d, 1. / 3, 1. / 3);
}

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return x == 0 ? 1 : std::sin(angle) / angle;
}

// Duchon, "Lanczos Filtering in One and Two Dimensions", 1979.
template <int Lobes>
double lanczos(double d) {
  return d < Lobes ? sinc(d) * sinc(d / Lobes) : 0;
}

// Every method. One that is a separable filter is complete with its row.
constexpr MethodInfo kMethods[] = {
    {Method::kPoint, "point", "the nearest sample"},
    {Method::kBilinear, "bilinear", "four samples", {1, tent}},
    {Method::kBSpline, "b-spline", "16 samples, cubic: smooth, never rings", {2, b_spline}},
    {Method::kCatmullRom, "catmull-rom", "16 samples, cubic: sharp", {2, catmull_rom, true}},
    {Method::kMitchell, "mitchell", "16 samples, cubic: between smooth and sharp", {2, mitchell, true}},
    {Method::kLanczos2, "lanczos2", "16 samples, windowed sinc", {2, lanczos<2>, true}},
    {Method::kLanczos3,
     "lanczos3",
     "36 samples, windowed sinc: sharper, rings further",
     {3, lanczos<3>, true}},
    {Method::kNoise, "noise", "the nearest sample with film grain"},
    {Method::kNoiseOffset, "noise-offset", "one of bilinear's samples, by chance"},
    {Method::kQuincunx, "quincunx", "both frames, the previous one less where anything moves"},
    {Method::kTemporal, "temporal", "all frames so far, where their surfaces are now"},
};

constexpr bool stand_in_order() {
  int next = 0;
  for (const MethodInfo& info : kMethods) {
    if (static_cast<int>(info.method) != next++) return false;
  }
  return next == static_cast<int>(Method::kTemporal) + 1;
}
static_assert(stand_in_order(), "every method once, in the order of Method");

}  // namespace

std::span<const MethodInfo> methods() {
  return kMethods;
}

bool uses_earlier_frames(Method method) {
  return method == Method::kQuincunx || method == Method::kTemporal;
}

const char* name_of(Method method) {
  const auto* const found = std::find_if(std::begin(kMethods), std::end(kMethods),
                                         [&](const MethodInfo& info) { return info.method == method; });
  return found != std::end(kMethods) ? found->name : "unknown";
}

const char* name_of(TwoFrameForm form) {
  switch (form) {
    case TwoFrameForm::kMean:
      return "mean";
    case TwoFrameForm::kVelocity:
      return "velocity";
    case TwoFrameForm::kReprojected:
      return "reprojected";
  }
  return "unknown";
}

const char* name_of(Sampling sampling) {
  return sampling == Sampling::kPoint ? "point" : "bilinear";
}

const char* name_of(TemporalPreset preset) {
  switch (preset) {
    case TemporalPreset::kFast:
      return "fast";
    case TemporalPreset::kBalanced:
      return "balanced";
    case TemporalPreset::kQuality:
      return "quality";
  }
  return "unknown";
}

const char* name_of(TemporalView view) {
  switch (view) {
    case TemporalView::kPicture:
      return "picture";
    case TemporalView::kConfidence:
      return "confidence";
    case TemporalView::kRejection:
      return "rejection";
    case TemporalView::kPhase:
      return "phase";
    case TemporalView::kLayers:
      return "layers";
    case TemporalView::kCoverage:
      return "coverage";
    case TemporalView::kNear:
      return "near";
    case TemporalView::kFar:
      return "far";
  }
  return "unknown";
}

const char* name_of(FarMotion motion) {
  switch (motion) {
    case FarMotion::kAsDrawn:
      return "drawn";
    case FarMotion::kCamera:
      return "camera";
    case FarMotion::kEvidence:
      return "evidence";
  }
  return "unknown";
}

const char* name_of(DrawnVelocity drawn) {
  return drawn == DrawnVelocity::kDilated ? "dilated" : "own";
}

const char* name_of(ToneMap tone_map) {
  switch (tone_map) {
    case ToneMap::kClamp:
      return "clamp";
    case ToneMap::kReinhard:
      return "reinhard";
    case ToneMap::kAces:
      return "aces";
  }
  return "unknown";
}

const char* name_of(Shading shading) {
  return shading == Shading::kCheckerboard ? "checkerboard" : "full";
}

}  // namespace quincunx
