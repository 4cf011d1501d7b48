// SPDX-License-Identifier: MIT
#include "quincunx/method.h"

#include <algorithm>
#include <iterator>

namespace quincunx {
namespace {

constexpr MethodInfo kMethods[] = {
    {Method::kPoint, "point", "the nearest sample"},
    {Method::kBilinear, "bilinear", "four samples"},
    {Method::kBSpline, "b-spline", "16 samples, cubic: smooth, never rings"},
    {Method::kCatmullRom, "catmull-rom", "16 samples, cubic: sharp"},
    {Method::kLanczos2, "lanczos2", "16 samples, windowed sinc"},
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
    case TemporalView::kOffset:
      return "offset";
  }
  return "unknown";
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

}  // namespace quincunx
