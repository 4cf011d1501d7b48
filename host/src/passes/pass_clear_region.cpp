// SPDX-License-Identifier: MIT
#include "passes/pass_clear_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "passes/pass.h"
#include "picture_params.h"
#include "plan/pass_spec.h"

namespace quincunx {
namespace {

// To nearest even; subnormals, infinities and NaN included. By hand: Imath's half would bring a library to the core.
unsigned half_bits(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const unsigned sign = (bits >> 16) & 0x8000u;
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return sign | 0x7e00u;
  if (magnitude >= 0x477ff000u) return sign | 0x7c00u;  // 65520 and above round to infinity
  if (magnitude < 0x38800000u) {                        // below 2^-14: steps of 2^-24
    const float steps = std::bit_cast<float>(magnitude) * 0x1p24f;
    return sign | static_cast<unsigned>(std::nearbyintf(steps));
  }
  const std::uint32_t rounded = magnitude + 0xfffu + ((magnitude >> 13) & 1u);
  return sign | ((rounded - 0x38000000u) >> 13);
}

// Returns the value of a half that is a number or infinite.
float half_value(unsigned bits) {
  const bool infinite = (bits & 0x7fffu) == 0x7c00u;
  const float magnitude = infinite ? std::numeric_limits<float>::infinity()
                          : (bits & 0x7c00u) == 0
                              ? static_cast<float>(bits & 0x3ffu) * 0x1p-24f
                              : std::bit_cast<float>(((bits & 0x7fffu) << 13) + 0x38000000u);
  return (bits & 0x8000u) != 0 ? -magnitude : magnitude;
}

unsigned unorm8(float value) {
  if (!(value > 0)) return 0;
  // In double: a float product may itself round up to the next half code.
  return static_cast<unsigned>(std::min(static_cast<double>(value), 1.0) * 255 + 0.5);
}

}  // namespace

void encode_texel(PixelFormat format, const float value[4], unsigned bits[4]) {
  std::fill_n(bits, 4, 0u);
  switch (format) {
    case PixelFormat::kNone:
      break;
    case PixelFormat::kR8:
      bits[0] = unorm8(value[0]);
      break;
    case PixelFormat::kRGBA8:
      bits[0] = unorm8(value[0]) | unorm8(value[1]) << 8 | unorm8(value[2]) << 16 | unorm8(value[3]) << 24;
      break;
    case PixelFormat::kRGBA16F:
      bits[1] = half_bits(value[2]) | half_bits(value[3]) << 16;
      [[fallthrough]];
    case PixelFormat::kRG16F:
      bits[0] = half_bits(value[0]) | half_bits(value[1]) << 16;
      break;
    case PixelFormat::kRGBA32F:
      bits[3] = std::bit_cast<unsigned>(value[3]);
      bits[2] = std::bit_cast<unsigned>(value[2]);
      [[fallthrough]];
    case PixelFormat::kRG32F:
      bits[1] = std::bit_cast<unsigned>(value[1]);
      [[fallthrough]];
    case PixelFormat::kR32F:
      bits[0] = std::bit_cast<unsigned>(value[0]);
      break;
  }
}

void stored_value(PixelFormat format, const float value[4], float stored[4]) {
  std::copy_n(value, 4, stored);
  if (format != PixelFormat::kRG16F && format != PixelFormat::kRGBA16F) return;
  for (int c = 0; c < 4; ++c) {
    if (!std::isnan(value[c])) stored[c] = half_value(half_bits(value[c]));
  }
}

void ClearRegionPass::clear(const PassFrame& frame, const ImageView& image, Extent render,
                            const float value[4], cl::Event* event) {
  ClearParams params{};
  params.width = render.width;
  params.height = render.height;
  params.columns_per_item = columns_per_item(shape(), render.width);
  params.output = layout_of(image);
  encode_texel(image.format, value, params.bits);
  stored_value(image.format, value, params.value);
  bind(frame, params, image);
  launch(frame, render, params.columns_per_item, event);
}

void ClearRegionPass::enqueue(const PassFrame& frame, cl::Event* event) {
  const float zero[4] = {};
  clear(frame, frame[spec().uses.front().resource], frame.inputs.render_extent, zero, event);
}

PassSpec clear_region_spec(Storage storage, Resource resource, PixelFormat format) {
  return {.kernel = "clear_region",
          .options = storage == Storage::kImage
                         ? "-D OUTPUT_STORAGE=IMAGE"
                         : fmt::format("-D OUTPUT_STORAGE=BUFFER -D TEXEL_BYTES={}", bytes_per_pixel(format)),
          .reason = "nothing covers every pixel: clear() is called before drawing",
          .uses = {{resource, Access::kWrite, Area::kViewport, format}},
          .make = make_pass<ClearRegionPass>,
          .frames = Frames::kOnRequest};
}

void plan_clear_region(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (facts.needs.background) {
    list.left_out.push_back({"clear_region", "the background covers every pixel of the viewport"});
    return;
  }
  if (!settings.targets.clear) {
    list.left_out.push_back({"clear_region", "the renderer clears its own targets"});
    return;
  }
  std::vector<PixelFormat> planned;
  const auto add = [&](Resource resource, PixelFormat format) {
    for (const PixelFormat other : planned) {
      if (settings.targets.storage == Storage::kImage || bytes_per_pixel(other) == bytes_per_pixel(format))
        return;
    }
    planned.push_back(format);
    list.passes.push_back(clear_region_spec(settings.targets.storage, resource, format));
  };
  add(Resource::kColour, settings.colour);
  if (facts.velocity == VelocitySource::kTarget) add(Resource::kVelocity, settings.velocity);
  if (facts.reads_reactive()) add(Resource::kReactive, PixelFormat::kR8);
}

}  // namespace quincunx
