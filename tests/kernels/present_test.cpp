// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "../reference/number_formats.h"
#include "error_table.h"
#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::PassRig;
using testing::Pixel;
using testing::Rig;

// The error that present.cl promises before rounding: 0.0016 from its logarithm and its rounding, 0.0015 from its
// power, and below 0.0005 from float rounding of the tone curve and the steps after it.
constexpr double kCodeError = 0.004;

struct Variant {
  ToneMap tone_map;
  bool dither;
  PixelFormat resolved;
  Storage storage;
};

class Present : public ::testing::TestWithParam<Variant> {
 protected:
  std::vector<unsigned char> present(Rig& rig, const std::vector<Pixel>& pixels, Extent extent,
                                     float exposure, std::int64_t* non_finite = nullptr) {
    const ResolveSettings settings{
        .output_extent = extent,
        .targets = {.storage = GetParam().storage},
        .output = {
            .linear = GetParam().resolved, .tone_map = GetParam().tone_map, .dither = GetParam().dither}};
    PassRig pass({}, settings, "present");
    const double poison = std::nan("");
    const ImageView source = rig.image(settings.output.linear, Storage::kBuffer, extent, pixels, poison);
    const ImageView view = rig.output(PixelFormat::kRGBA8, extent, settings.targets.storage);
    const Counter counter = rig.counter();
    FrameInputs inputs;
    inputs.exposure = exposure;
    pass.run(inputs, {}, extent, counter, {{Resource::kResolved, source}, {Resource::kPresented, view}});
    const std::int64_t count = rig.count(counter);
    if (non_finite != nullptr) *non_finite = count;
    return rig.bytes(view, extent);
  }

  reference::Curve curve() const {
    switch (GetParam().tone_map) {
      case ToneMap::kClamp:
        return reference::Curve::kClamp;
      case ToneMap::kReinhard:
        return reference::Curve::kReinhard;
      case ToneMap::kAces:
        return reference::Curve::kAces;
    }
    return reference::Curve::kClamp;
  }

  // Every code is the reference's, but for values within kCodeError of where rounding changes.
  void compare(const std::vector<Pixel>& pixels, Extent extent, float exposure) {
    Rig rig;
    const std::vector<unsigned char> codes = present(rig, pixels, extent, exposure);
    const double factor = exposure == 0 ? 1 : static_cast<double>(exposure);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      Pixel stored = pixels[i];
      for (double& value : stored)
        value = testing::stored_value(GetParam().resolved, value);
      const Pixel expected = reference::present(stored, curve(), factor);
      const int x = static_cast<int>(i) % extent.width;
      const int y = static_cast<int>(i) / extent.width;
      for (std::size_t c = 0; c < 4; ++c) {
        const double offset = c < 3 && GetParam().dither ? reference::dither_offset(x, y) : 0.5;
        const int code = codes[i * 4 + c];
        const int lowest = static_cast<int>(std::floor(expected[c] + offset - kCodeError));
        const int highest = static_cast<int>(std::floor(expected[c] + offset + kCodeError));
        // How far beyond where rounding changes the value before rounding lies whose code differs.
        const double wanted = std::clamp(expected[c] + offset, 0.0, std::nextafter(256.0, 0.0));
        const double beyond = std::max({0.0, wanted - code - 1, code - wanted});
        if (c < 3) testing::record_error({beyond, kCodeError, 1, PixelFormat::kRGBA8});
        ASSERT_GE(code, std::max(lowest, 0)) << stored[c] << " at " << x << ", " << y << " channel " << c;
        ASSERT_LE(code, std::min(highest, 255)) << stored[c] << " at " << x << ", " << y << " channel " << c;
      }
    }
  }
};

TEST_P(Present, EveryHalf) {
  std::vector<Pixel> pixels;
  for (int bits = 0; bits < 65536; ++bits) {
    const double value = reference::half_value(static_cast<std::uint16_t>(bits));
    pixels.push_back({value, -value, value * 0.5, value});
  }
  compare(pixels, {256, 256}, 1);
}

TEST_P(Present, SizesAndExposures) {
  unsigned seed = 0;
  for (const Extent extent : {Extent{1, 1}, Extent{7, 5}, Extent{64, 64}, Extent{257, 129}}) {
    for (const float exposure : {0.0f, 0.37f, 8.0f}) {
      std::mt19937 random(++seed);
      std::uniform_real_distribution<double> exponent(-14, 4);
      std::vector<Pixel> pixels(static_cast<std::size_t>(extent.area()));
      for (Pixel& pixel : pixels) {
        for (double& value : pixel)
          value = std::exp2(exponent(random));
      }
      compare(pixels, extent, exposure);
    }
  }
}

TEST_P(Present, CountsNonFinitePixelsAndKeepsToItsExtent_small) {
  for (const Extent extent : {Extent{1, 1}, Extent{6, 3}, Extent{67, 9}}) {
    std::vector<Pixel> pixels(static_cast<std::size_t>(extent.area()), Pixel{.2, .2, .2, 1});
    pixels.front() = {std::nan(""), std::numeric_limits<double>::infinity(), 1,
                      -std::numeric_limits<double>::infinity()};
    pixels.back() = pixels.front();
    Rig rig;
    std::int64_t non_finite = 0;
    const std::vector<unsigned char> codes = present(rig, pixels, extent, 1, &non_finite);
    EXPECT_EQ(non_finite, extent.area() == 1 ? 1 : 2);
    EXPECT_EQ(codes[0], 0);
    EXPECT_GE(codes[1], 254);  // 65504, tone mapped
    EXPECT_EQ(codes[3], 0);
  }
}

// A row with one is made in another way than one without.
TEST_P(Present, ANonFinitePixelChangesNoOther) {
  const Extent extent{67, 3};
  std::vector<Pixel> pixels = testing::pattern_pixels(testing::Pattern::kNoise, extent, 9);
  Rig rig;
  const std::vector<unsigned char> without = present(rig, pixels, extent, 0.7f);
  constexpr std::size_t kBad = 67 + 20;
  pixels[kBad] = {std::nan(""), 1, 1, 1};
  const std::vector<unsigned char> with = present(rig, pixels, extent, 0.7f);
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (i / 4 == kBad) continue;
    ASSERT_EQ(with[i], without[i]) << "pixel " << i / 4;
  }
}

TEST_P(Present, WholeCodesKeepTheirValueUnderDither) {
  if (GetParam().tone_map != ToneMap::kClamp || GetParam().resolved != PixelFormat::kRGBA32F) return;
  for (const double end : {0.0, 1.0}) {
    Rig rig;
    const std::vector<Pixel> pixels(64 * 64, Pixel{end, end, end, 1});
    const std::vector<unsigned char> codes = present(rig, pixels, {64, 64}, 1);
    int different = 0;
    for (std::size_t i = 0; i < codes.size(); ++i)
      different += i % 4 < 3 && codes[i] != 255 * end ? 1 : 0;
    // Within kCodeError of the step, one pixel in 1 / kCodeError may round down.
    EXPECT_LE(different, static_cast<int>(static_cast<double>(codes.size()) * kCodeError) + 1);
  }
}

TEST_P(Present, DitherKeepsTheMeanAndShowsNoTile) {
  if (!GetParam().dither || GetParam().tone_map != ToneMap::kClamp) return;
  Rig rig;
  const Extent extent{256, 128};
  const Pixel grey = {.0305, .0305, .0305, 1};
  const std::vector<unsigned char> codes =
      present(rig, std::vector<Pixel>(static_cast<std::size_t>(extent.area()), grey), extent, 1);
  Pixel stored = grey;
  for (double& value : stored)
    value = testing::stored_value(GetParam().resolved, value);
  const double expected = reference::present(stored, reference::Curve::kClamp, 1)[0];
  double sum = 0;
  for (std::size_t i = 0; i < codes.size(); i += 4)
    sum += codes[i];
  // A low-discrepancy pattern: far better than the 0.5 / sqrt(32768) = .003 of independent noise.
  EXPECT_NEAR(sum / static_cast<double>(extent.area()), expected, 0.003 + kCodeError);
  for (const int shift : {4, 8, 16, 32, 64}) {
    int same = 0;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x + shift < extent.width; ++x) {
        const auto i = static_cast<std::size_t>(y * extent.width + x) * 4;
        same += codes[i] == codes[i + static_cast<std::size_t>(shift) * 4] ? 1 : 0;
      }
    }
    EXPECT_LT(same, extent.height * (extent.width - shift))
        << "the pattern repeats every " << shift << " pixels";
  }
}

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
    for (const bool dither : {true, false}) {
      for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
        for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
          all.push_back({tone_map, dither, resolved, storage});
        }
      }
    }
  }
  return all;
}

std::string storage_of(const Variant& v) {
  return v.storage == Storage::kImage ? "image" : "buffer";
}

INSTANTIATE_TEST_SUITE_P(Variants, Present, ::testing::ValuesIn(variants()),
                         testing::sample_names(
                             variants(),
                             [](const Variant& v) {
                               return fmt::format("{}{}_{}_to_{}", name_of(v.tone_map),
                                                  v.dither ? "_dither" : "", name_of(v.resolved),
                                                  storage_of(v));
                             },
                             [](const Variant& v) { return name_of(v.tone_map) + storage_of(v); }));

}  // namespace
}  // namespace quincunx
