// SPDX-License-Identifier: MIT
// The common parts of the kernel tests: one device, frames on it with their reference twins, comparisons.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "../reference/passes.h"
#include "passes/pass.h"
#include "passes/tables.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx::testing {

using reference::Pixel;

// The first one, opened once; with the profile that QUINCUNX_TEST_PROFILE names ("16x8x4": group width and height,
// pixels of an item). Ends the program where there is none, or no such profile.
const Device& device();
const Device::Impl& impl();

// The value that `format` holds for `value`.
double stored_value(PixelFormat format, double value);
std::size_t channel_count(PixelFormat format);
std::vector<unsigned char> encode(PixelFormat format, const std::vector<Pixel>& pixels);
std::vector<Pixel> decode(PixelFormat format, const std::vector<unsigned char>& bytes);

template <typename Element>
std::vector<unsigned char> bytes_of(const std::vector<Element>& elements) {
  const auto* first = reinterpret_cast<const unsigned char*>(elements.data());
  return {first, first + elements.size() * sizeof(Element)};
}

// Names the variants of a suite, and appends "_sample" to those that stand for all: the first of each storage, or of
// each value of `kind`. Other devices, GPU profiles and memory checkers run samples only (CMakeLists.txt), so the
// variant that has most of the kernel comes first.
template <typename Variant, typename Name, typename Kind>
auto sample_names(const std::vector<Variant>& variants, Name name, Kind kind) {
  std::set<std::string> kinds;
  std::vector<std::string> names;
  for (const Variant& variant : variants)
    names.push_back(name(variant) + (kinds.insert(kind(variant)).second ? "_sample" : ""));
  return [names](const auto& instance) { return names.at(instance.index); };
}

template <typename Variant, typename Name>
auto sample_names(const std::vector<Variant>& variants, Name name) {
  return sample_names(variants, name, [](const Variant& variant) -> std::string {
    if constexpr (requires { variant.storage; })
      return variant.storage == Storage::kImage ? "image" : "buffer";
    return "buffer";
  });
}

// Owns the images of a test. Buffers have an offset, a pitch and rows beyond what is used; `outside` fills
// what lies around the rectangle. A tight image ends with its rectangle, so that a memory checker sees a read
// beyond it.
class Rig {
 public:
  ImageView image(PixelFormat format, Storage storage, Extent used, const std::vector<Pixel>& pixels,
                  double outside, bool tight = false);
  ImageView output(PixelFormat format, Extent extent, Storage storage = Storage::kBuffer);  // filled with -7
  std::vector<unsigned char> bytes(const ImageView& view, Extent extent) const;
  std::vector<Pixel> pixels(const ImageView& view, Extent extent) const;

  Counter counter();  // zeroed
  std::int64_t count(Counter counter) const;

 private:
  std::vector<Image> images_;
  std::vector<cl::Buffer> buffers_;
};

enum class Pattern { kImpulse, kConstant, kRamp, kNoise, kExtremes, kNonFinite };
const std::vector<Pattern>& all_patterns();
// Returns the patterns that a picture of this size is tested with at scale number `scale`: all of them for samples, but
// for the largest pictures and all other variants one, another at each scale, because the reference is slow.
std::vector<Pattern> patterns_for(Extent output, std::size_t scale);
// Returns the sizes of pictures that a variant is tested with; `largest` is one of a sample's only. The other variants
// differ from it in how texels are read and written, and pixels beyond 64 columns are no others to them.
std::vector<Extent> sizes_for(Extent largest);
std::vector<Pixel> pattern_pixels(Pattern pattern, Extent extent, unsigned seed);
const char* name_of(Pattern pattern);

struct FrameFormats {
  Storage storage = Storage::kBuffer;
  PixelFormat colour = PixelFormat::kRGBA16F;
  PixelFormat velocity = PixelFormat::kRG16F;
  bool with_velocity = false;
  bool with_depth = false;
  bool with_reactive = false;
};

struct FrameSpec {
  Extent render;
  Vec2 jitter = {};
  Pattern colour = Pattern::kNoise;
  Pattern velocity = Pattern::kNoise;
  unsigned seed = 1;
  double outside = 0;
  bool tight = false;
  double speed = .02;  // by which the velocity pattern is multiplied
};

// A frame for a pass, stored in its formats, and the same frame for its reference.
struct TestFrame {
  FrameInputs inputs;
  reference::Frame reference;
};

TestFrame make_frame(Rig& rig, const FrameFormats& formats, const FrameSpec& spec);
TestFrame make_frame(Rig& rig, const FrameFormats& formats, const FrameSpec& spec,
                     const std::vector<Pixel>& colour);

// Values that lie where nothing may be read.
inline constexpr double kPoisons[] = {std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity(), 1e30};

// Expects the same result of run() whatever lies outside of the spec's frames, where they fill their images, and twice.
// The spec has `outside` and `tight`, as FrameSpec; run() reads it anew each time.
template <typename Spec, typename Run>
void expect_same_whatever_is_outside(Spec& spec, const Run& run) {
  const auto clean = run();
  for (const double poison : kPoisons) {
    spec.outside = poison;
    EXPECT_EQ(clean, run()) << "poison " << poison;
  }
  spec.outside = 0;
  spec.tight = true;
  EXPECT_EQ(clean, run()) << "tight";
  EXPECT_EQ(clean, run()) << "twice";
}

// The rendered extent at a scale: at least one pixel.
Extent scaled(Extent output, double scale_x, double scale_y);

// Every channel within bound(pixel index) of the reference, and all finite. The errors go to the error table,
// in last places of `stored`, the format of the result.
void expect_close(const reference::Picture& expected, const std::vector<Pixel>& actual,
                  const std::function<double(std::size_t)>& bound, const std::string& what,
                  PixelFormat stored = PixelFormat::kRGBA32F);

bool holds_non_finite(PixelFormat format);

// How far a colour of this magnitude may be from what a format stores for it: in RGBA8, which ends at 1, half a code at
// the bright end, where sRGB is steepest.
double input_rounding(PixelFormat format, double magnitude);

// Returns the error that rounding to a half adds: half a step of 2^-10 of the value, or of a denormal. In an image it
// is a whole step, because OpenCL lets a device round towards zero there (1.2, 8.3.2).
double output_rounding(PixelFormat format, double magnitude, Storage storage = Storage::kBuffer);

// The same of a velocity, which is rounded to a float where it is no half.
double velocity_rounding(PixelFormat format, Storage storage, double magnitude);

}  // namespace quincunx::testing
