// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "../reference/number_formats.h"
#include "kernel_fixture.h"
#include "pass_rig.h"
#include "passes/pass_clear_region.h"

namespace quincunx {
namespace {

using testing::Pixel;
using testing::Rig;

constexpr std::array kFormats = {PixelFormat::kR8,     PixelFormat::kR32F,  PixelFormat::kRG16F,
                                 PixelFormat::kRG32F,  PixelFormat::kRGBA8, PixelFormat::kRGBA16F,
                                 PixelFormat::kRGBA32F};
constexpr float kValue[4] = {.25f, .7f, 1.0f, 1e-5f};

void check(PixelFormat format, Storage storage) {
  const PlanFacts facts({}, {});
  PassTables tables(testing::impl(), {{1, 1}, {1, 1}, {1, 1}});
  ClearRegionPass pass({testing::impl(), facts, tables},
                       clear_region_spec(storage, Resource::kColour, format));
  const PassFrame frame{.queue = testing::impl().queue, .tables = tables};
  for (const Extent cleared : {Extent{1, 1}, Extent{7, 5}, Extent{64, 64}, Extent{257, 129}}) {
    const std::string what = fmt::format("{} {}x{}", name_of(format), cleared.width, cleared.height);
    Rig rig;
    const std::vector<Pixel> before = pattern_pixels(testing::Pattern::kNoise, cleared, 3);
    const ImageView view = rig.image(format, storage, cleared, before, .5);
    const std::vector<Pixel> untouched = rig.pixels(view, view.extent);
    pass.clear(frame, view, cleared, kValue, nullptr);
    const std::vector<Pixel> after = rig.pixels(view, view.extent);
    for (int y = 0; y < view.extent.height; ++y) {
      for (int x = 0; x < view.extent.width; ++x) {
        const auto i = static_cast<std::size_t>(y * view.extent.width + x);
        const bool inside = x < cleared.width && y < cleared.height;
        for (std::size_t c = 0; c < testing::channel_count(format); ++c) {
          const double expected = testing::stored_value(format, static_cast<double>(kValue[c]));
          ASSERT_EQ(after[i][c], inside ? expected : untouched[i][c]) << what << " at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(ClearRegion, EveryFormatInABuffer_small) {
  for (const PixelFormat format : kFormats)
    check(format, Storage::kBuffer);
}

TEST(ClearRegion, EveryFormatInAnImage_small) {
  int checked = 0;
  for (const PixelFormat format : kFormats) {
    if (!testing::device().allocate({4, 4}, format, Storage::kImage).ok()) continue;  // this device has none
    check(format, Storage::kImage);
    ++checked;
  }
  EXPECT_GE(checked, 2);  // RGBA16F and RGBA32F exist everywhere
}

// Against the tests' own conversion: every half, the midpoint to the next, and the floats on both sides of
// it.
TEST(ClearRegion, HalvesRoundToNearestEven) {
  for (int i = 0; i < 0x7c00; ++i) {
    const auto half = static_cast<float>(reference::half_value(static_cast<std::uint16_t>(i)));
    const float next =
        i == 0x7bff ? 65536.0f : static_cast<float>(reference::half_value(static_cast<std::uint16_t>(i + 1)));
    const float middle = (half + next) / 2;
    for (const float value : {half, middle, std::nextafter(middle, 0.0f), std::nextafter(middle, 1e9f)}) {
      const float texel[4] = {value, -value, 0, 0};
      unsigned bits[4];
      encode_texel(PixelFormat::kRGBA16F, texel, bits);
      ASSERT_EQ(bits[0] & 0xffff, reference::half_bits(static_cast<double>(value))) << value;
      ASSERT_EQ(bits[0] >> 16, reference::half_bits(static_cast<double>(-value))) << -value;
    }
  }
}

}  // namespace
}  // namespace quincunx
