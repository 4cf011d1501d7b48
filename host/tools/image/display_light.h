// SPDX-License-Identifier: MIT
// Light as files and the screen have it: colour spaces of files, sRGB, and the tone curves of the present pass, in host
// memory. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/advanced/method.h"
#include "tools/image/image_reader.h"

namespace quincunx::tools {

// Linear light of an sRGB encoded value, both in [0, 1] (IEC 61966-2-1).
float linear_of_srgb(float encoded);
float srgb_of_linear(float light);  // the other way; light is clamped

// Returns the light that a renderer stores in RGBA8 colour, before it is encoded: each colour times `exposure` through
// the curve, in [0, 1]; NaN counts as 0. `rgba`: four values a pixel; alpha stays.
std::vector<float> display_light(std::span<const float> rgba, ToneMap tone_map, float exposure);

// Takes display_light() with ToneMap::kReinhard and exposure 1 back, up to 65504. Alpha stays.
std::vector<float> light_before_reinhard(std::span<const float> rgba);

// Primaries and white of the library's light: those of Rec. 709.
inline constexpr Chromaticities kRec709 = {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};

// How colour of a file becomes light as the library has it: linear, Rec. 709, multiplied by alpha. A value; pure.
class InputColour {
 public:
  // `named`: a colour space, whatever the file says; empty: as its attributes or its format have it. Names are ours
  // (ACEScg, ACES2065-1, lin_rec2020, lin_p3d65, KodakLog) or OpenImageIO's, with its configuration (OCIO). Errors:
  // kInvalidArgument for another name (kIoFailure where the file says it), which lists those that are near.
  static Result<InputColour> of(const std::string& path, const ImagePart& part,
                                const std::string& named = {});

  // Whether nothing is to be done.
  bool is_light() const { return !curve_ && !matrix_ && !straight_ && !has_gain(); }
  // Whether the file's user should hear its name.
  bool is_news() const { return !is_light() || !unapplied_.empty(); }
  std::string name() const;

  void apply(std::span<float> rgba) const;

 private:
  bool has_gain() const { return gain_ != ImagePart().gain; }

  std::string name_;
  std::string unapplied_;  // what the file says of its colours beside the name
  ColourCurve curve_;
  std::array<float, 3> gain_ = ImagePart().gain;  // after the curve
  std::optional<std::array<float, 9>> matrix_;    // row by row; after the gain
  bool straight_ = false;
};

}  // namespace quincunx::tools
