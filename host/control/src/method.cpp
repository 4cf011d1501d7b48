// SPDX-License-Identifier: MIT
#include "quincunx/advanced/method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

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

bool form_counts(const MethodVariant& variant) {
  return variant.method == Method::kQuincunx;
}

bool sampling_counts(const MethodVariant& variant) {
  return form_counts(variant) && variant.form != TwoFrameForm::kReprojected;
}

bool preset_counts(const MethodVariant& variant) {
  return variant.method == Method::kTemporal;
}

auto effort_of(const MethodVariant& variant) {
  return std::tuple(variant.method, form_counts(variant) ? variant.form : TwoFrameForm{},
                    sampling_counts(variant) ? variant.sampling : Sampling{},
                    preset_counts(variant) ? variant.preset : TemporalPreset{});
}

// The variants of the methods that have several.
std::vector<VariantInfo> variants_of(const MethodInfo& info) {
  using Form = TwoFrameForm;
  using Preset = TemporalPreset;
  const auto two_frames = [&](Form form, Sampling sampling, const char* summary) {
    const char* ending = sampling == Sampling::kPoint ? name_of(sampling) : name_of(form);
    return VariantInfo{.variant = {.method = info.method, .form = form, .sampling = sampling},
                       .name = fmt::format("{}:{}", info.name, ending),
                       .summary = summary};
  };
  const auto temporal = [&](Preset preset, const char* summary) {
    return VariantInfo{.variant = {.method = info.method, .preset = preset},
                       .name = fmt::format("{}:{}", info.name, name_of(preset)),
                       .summary = summary};
  };
  if (info.method == Method::kQuincunx) {
    return {two_frames(Form::kMean, Sampling::kBilinear, "the plain mean of this frame and the previous one"),
            two_frames(Form::kVelocity, Sampling::kPoint, "quincunx:velocity of nearest samples"),
            two_frames(Form::kVelocity, Sampling::kBilinear, info.summary),
            two_frames(Form::kReprojected, Sampling::kBilinear,
                       "both frames, the previous one where its surfaces were")};
  }
  if (info.method == Method::kTemporal) {
    return {temporal(Preset::kFast, "all frames so far, the cheapest way"),
            temporal(Preset::kBalanced, info.summary),
            temporal(Preset::kQuality, "all frames so far, with all that helps")};
  }
  return {{.variant = {.method = info.method}, .name = info.name, .summary = info.summary}};
}

// Returns the name that stands at the value's place; an enumerator that was made up has none.
template <typename Enum, std::size_t N>
const char* name_in(const char* const (&names)[N], Enum value) {
  const auto place = static_cast<std::size_t>(value);
  return place < N ? names[place] : "unknown";
}

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

std::strong_ordering operator<=>(const MethodVariant& a, const MethodVariant& b) {
  return effort_of(a) <=> effort_of(b);
}

std::span<const VariantInfo> all_variants() {
  static const std::vector<VariantInfo> all = [] {
    std::vector<VariantInfo> variants;
    for (const MethodInfo& info : kMethods) {
      for (VariantInfo& variant : variants_of(info))
        variants.push_back(std::move(variant));
    }
    return variants;
  }();
  return all;
}

std::string name_of(const MethodVariant& variant) {
  for (const VariantInfo& info : all_variants()) {
    if (info.variant == variant) return info.name;
  }
  return name_of(variant.method);
}

Result<MethodVariant> parse_variant(const std::string& name) {
  std::string known;
  for (const VariantInfo& info : all_variants()) {
    if (info.name == name) return info.variant;
    known += (known.empty() ? "" : ", ") + info.name;
  }
  for (const MethodInfo& info : kMethods) {
    if (info.name == name) return MethodVariant{.method = info.method};
  }
  return Status::invalid(fmt::format("there is no method '{}'; there are {}", name, known));
}

const char* name_of(TwoFrameForm form) {
  return name_in({"mean", "velocity", "reprojected"}, form);
}

const char* name_of(Sampling sampling) {
  return name_in({"point", "bilinear"}, sampling);
}

const char* name_of(TemporalPreset preset) {
  return name_in({"fast", "balanced", "quality"}, preset);
}

const char* name_of(TemporalView view) {
  return name_in({"picture", "confidence", "rejection", "phase", "layers", "coverage", "near", "far"}, view);
}

const char* name_of(ToneMap tone_map) {
  return name_in({"clamp", "reinhard", "aces"}, tone_map);
}

const char* name_of(Shading shading) {
  return name_in({"full", "checkerboard"}, shading);
}

}  // namespace quincunx
