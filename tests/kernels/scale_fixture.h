// SPDX-License-Identifier: MIT
// One variant of a single-frame filter, run by its pass and by its reference.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel_fixture.h"
#include "passes/pass_chain.h"

namespace quincunx::testing {

// Half a last place of a float, relative.
constexpr double kRounding = 0x1p-24;

// Two weights rounded to 2^-24 (each off by 2^-25 at most) and six float operations, each within 2^-24 of the
// largest tap: below 8 * 2^-24 of it.
constexpr double kBilinearError = 8 * kRounding;

// The largest sum of the magnitudes of a filter's weights, which is that half-way between two texels: 1.25 for
// Catmull-Rom and Lanczos-2, 1.55 for Lanczos-3, and nowhere more than this (FilterTable.WeightsSumToOne holds that).
constexpr double largest_weight_sum(Method method) {
  return method == Method::kLanczos3 ? 1.56 : 1.3;
}

// A filter of N taps on an axis rounds N weights, N products and N - 1 sums, each by 2^-24 of what stands
// there: (N + 1) L times the largest tap, L being the sum of the weights' magnitudes. The other axis scales
// that by its own L and adds its own: (N + M + 2) L^2. The clamp to the range of samples adds nothing.
constexpr double filter_error(Method method, int taps_x, int taps_y) {
  const double sum = largest_weight_sum(method);
  return (taps_x + taps_y + 2) * sum * sum * kRounding;
}

// 1 + amplitude * n <= 2 takes five roundings (the amplitude, n, their product, the sum, the product with the
// sample), each below 2^-24 of twice the sample.
constexpr double kGrainError = 10 * kRounding;

// A device may flush denormals: each product and each sum, all below the smallest normal number.
constexpr double kDenormal = 0x1p-126;

struct ScaleVariant {
  Method method;
  Storage storage = Storage::kBuffer;
  PixelFormat colour = PixelFormat::kRGBA16F;
  PixelFormat resolved = PixelFormat::kRGBA32F;
  bool clamp_ringing = true;
};

// "catmull_rom_unclamped_buffer_RGBA16F_to_RGBA32F"
std::string name_of(const ScaleVariant& variant);

bool takes_one_sample(Method method);
bool rings(Method method);  // has negative weights

class ScaleRig {
 public:
  explicit ScaleRig(const ScaleVariant& variant);

  struct Run {
    std::vector<unsigned char> bytes;
    std::vector<Pixel> pixels;
    std::int64_t non_finite = 0;
  };

  TestFrame frame(Rig& rig, const FrameSpec& spec) const { return make_frame(rig, formats_, spec); }
  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::vector<Pixel>& colour) const {
    return make_frame(rig, formats_, spec, colour);
  }

  // Also checks that what lies around the output stays as it was.
  Run run(Rig& rig, const TestFrame& frame, Extent output);

  // Returns the reference for run(); the frame must outlive it.
  reference::Sampler sampler(const TestFrame& frame, Extent output) const;

  // Runs both and compares them.
  void compare(const FrameSpec& spec, Extent output, const std::vector<Pixel>& colour);
  void compare(const FrameSpec& spec, Extent output) {
    compare(spec, output, pattern_pixels(spec.colour, spec.render, spec.seed));
  }

  const ScaleVariant& variant() const { return variant_; }

 private:
  PassChain& chain_for(Extent output, Extent render);
  double relative_error(Extent render, Extent output) const;

  ScaleVariant variant_;
  ResolveSettings settings_;
  FrameFormats formats_;
  std::unique_ptr<PassChain> chain_;
};

}  // namespace quincunx::testing
