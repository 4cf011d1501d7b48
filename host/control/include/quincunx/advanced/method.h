// SPDX-License-Identifier: MIT
// Method: the ways to make the picture from the frames, their forms, and what each is called.
//
// The names stand here and nowhere else: command lines, files, reports and benchmarks take them from all_variants(),
// parse_variant() and name_of(). All functions are safe to call from any thread; text that they do not return by value
// lives for ever.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>

#include "quincunx/advanced/export.h"
#include "quincunx/status.h"

namespace quincunx {

// How the picture is made from the frames. All are aware of the jitter. Above scale 1 (more samples than
// pixels) the filters widen with the ratio, so that nothing between output pixels is skipped; point and noise
// skip.
enum class Method {
  kPoint,        // nearest sample
  kBilinear,     // four samples
  kBSpline,      // 16 samples, cubic B-spline: smooth, never rings (Sigg and Hadwiger 2005)
  kCatmullRom,   // 16 samples, cubic: sharp
  kMitchell,     // 16 samples, cubic with B = C = 1/3: between smooth and sharp (Mitchell and Netravali 1988)
  kLanczos2,     // 16 samples, windowed sinc, for comparison (Duchon 1979)
  kLanczos3,     // 36 samples, windowed sinc: sharper, and rings further (Duchon 1979)
  kNoise,        // nearest sample with film grain, the more the lower the scale (Binks 2012)
  kNoiseOffset,  // one of bilinear's four samples, at random by their weights (Binks 2012)
  kQuincunx,     // this frame and the previous one on the five-of-a-die pattern
  kTemporal,     // all frames so far, accumulated where the surfaces are: needs jitter() of frame.h
};

// A filter that is applied to rows and columns in turn.
struct SeparableFilter {
  int radius = 0;                        // samples, up to scale 1; the weight is 0 from there on
  double (*weight)(double d) = nullptr;  // at a distance d >= 0, in samples; need not be normalised
  bool rings = false;                    // has negative lobes, so that FilterSettings::clamp_ringing counts

  friend bool operator==(const SeparableFilter&, const SeparableFilter&) = default;
};

struct MethodInfo {
  Method method;
  const char* name;             // "catmull-rom": lower case, no spaces, no colon
  const char* summary;          // what it does, in a few words
  SeparableFilter filter = {};  // the method's own, if it is nothing but a separable filter
};

// Every method once, in the order of Method, which is that of growing effort.
QUINCUNX_API std::span<const MethodInfo> methods();

// Whether the picture depends on earlier frames too: kQuincunx, kTemporal.
QUINCUNX_API bool uses_earlier_frames(Method method);

// How kQuincunx weighs the previous frame.
enum class TwoFrameForm : std::uint8_t {
  kMean,         // the plain mean of both frames
  kVelocity,     // f = 1/(1 + K(|v0|^2 + |v1|^2)), v in render pixels a frame (Binks 2012)
  kReprojected,  // read where its surfaces were, dropped where they were hidden; samples weighted by distance
};

// How kMean and kVelocity read the frames.
enum class Sampling : std::uint8_t {
  kPoint,     // the nearest sample
  kBilinear,  // four samples
};

// Effort of kTemporal. Each is the best picture found at its cost; docs/temporal.md has the figures.
enum class TemporalPreset : std::uint8_t { kFast, kBalanced, kQuality };

// Content of kTemporal's resolved picture.
enum class TemporalView : std::uint8_t {
  kPicture,
  kConfidence,  // a pixel's confidence over the largest that is kept: 1 is white
  kRejection,   // why history is rejected: red hidden, off screen or reactive; green a motion edge;
                // blue a change of light
  kPhase,       // where between texels history was read: red x, green y; blue: how far it moved
  // Views of the two layers of history that pixels have where surfaces move apart; without layers no plan is made.
  kLayers,    // red where there are two, green the near one's coverage, blue the far one's confidence
  kCoverage,  // the near layer's
  kNear,      // the near layer alone, premultiplied
  kFar,       // the picture without it
};

// A method with the settings that change its picture and its cost. `form` and `sampling` count for kQuincunx alone, and
// sampling not for kReprojected; `preset` counts for kTemporal alone. A field that does not count makes no difference.
struct MethodVariant {
  Method method = Method::kBilinear;
  TwoFrameForm form = TwoFrameForm::kVelocity;
  Sampling sampling = Sampling::kBilinear;
  TemporalPreset preset = TemporalPreset::kBalanced;

  // In the order of growing effort.
  QUINCUNX_API friend std::strong_ordering operator<=>(const MethodVariant& a, const MethodVariant& b);
  friend bool operator==(const MethodVariant& a, const MethodVariant& b) { return (a <=> b) == 0; }
};

struct VariantInfo {
  MethodVariant variant;
  std::string name;     // "bilinear", "quincunx:reprojected", "temporal:fast"
  std::string summary;  // what it does, in a few words
};

// Every variant that has a name of its own, once, in the order of growing effort.
QUINCUNX_API std::span<const VariantInfo> all_variants();

// The name in all_variants(); the method's where there is none: kMean of nearest samples.
QUINCUNX_API std::string name_of(const MethodVariant& variant);

// The variant of a name in all_variants(), or of a method's name, which stands for its default settings: "temporal" is
// "temporal:balanced". Errors: kInvalidArgument for another name; the message lists those of all_variants().
QUINCUNX_API Result<MethodVariant> parse_variant(const std::string& name);

enum class ToneMap { kClamp, kReinhard, kAces };

// Which pixels of the viewport a frame has.
enum class Shading : std::uint8_t {
  kFull,
  kCheckerboard,  // every other one: FrameInputs::parity says which
};

QUINCUNX_API const char* name_of(Method method);          // "quincunx"
QUINCUNX_API const char* name_of(TwoFrameForm form);      // "velocity"
QUINCUNX_API const char* name_of(Sampling sampling);      // "point"
QUINCUNX_API const char* name_of(TemporalPreset preset);  // "balanced"
QUINCUNX_API const char* name_of(TemporalView view);      // "confidence"
QUINCUNX_API const char* name_of(ToneMap tone_map);       // "aces"
QUINCUNX_API const char* name_of(Shading shading);        // "checkerboard"

}  // namespace quincunx
