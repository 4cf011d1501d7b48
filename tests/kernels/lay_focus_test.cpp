// SPDX-License-Identifier: MIT
#include "../reference/lay_focus.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using reference::FocusPlace;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;

// In units of u = 2^-24 and M, the largest of both pictures' values. The distance is exact, its product with the
// rounded rate off by 2 u of at most 1, which the curve's slope of at most 1.5 makes 3 u; the curve itself takes three
// roundings of at most u each, a mask's quotient and product 6 u more (a division may be off by 2.5 last places): 12 u
// of the weight, of a difference of at most 2 M. 1 - w, two products and a sum add 4 u.
double error_bound(double largest) {
  return 28 * 0x1p-24 * largest + 4 * 0x1p-126;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Extent kOutput = {97, 61};

struct Variant {
  PixelFormat format;
  bool mask;
};

struct Placed {
  const char* name;
  Extent region;
  FocusPlace place;
};

const Placed kPlaces[] = {
    {"one pixel", {1, 1}, {.x = 5, .y = 7}},
    {"in the middle", {40, 31}, {.x = 21, .y = 13}},
    {"a guard all around", {40, 31}, {.x = 21, .y = 13, .rectangles = {{25, 17, 32, 23}}, .feather = 4}},
    {"at the picture's corner", {33, 29}, {.x = 0, .y = 0, .rectangles = {{0, 0, 29, 25}}}},
    {"at the far corner", {33, 29}, {.x = 64, .y = 32, .rectangles = {{70, 40, 27, 21}}, .feather = 3.3}},
    {"all of it", kOutput, {.feather = 5}},
    {"a thin one", {64, 1}, {.x = 3, .y = 60, .feather = .5}},
    {"several that overlap",
     {60, 50},
     {.x = 11,
      .y = 5,
      .rectangles = {{13, 7, 20, 20}, {25, 15, 30, 12}, {61, 45, 9, 9}, {11, 54, 1, 1}},
      .feather = 7}},
};

class LayFocus : public ::testing::TestWithParam<Variant> {
 protected:
  PixelFormat format() const { return GetParam().format; }

  // Returns a mask with every weight, 0 and 1 among them.
  static std::vector<double> mask_of(Extent region) {
    std::vector<double> mask;
    for (int i = 0; i < region.area(); ++i)
      mask.push_back(i % 5 == 0 ? 1 : i % 7 == 0 ? 0 : (i * 37 % 256) / 255.0);
    return mask;
  }

  std::vector<unsigned char> run(const std::vector<Pixel>& picture, const std::vector<Pixel>& focus,
                                 const Placed& placed, double outside = 1e30, bool tight = false) {
    Rig rig;
    PassRig pass({},
                 {.output_extent = kOutput,
                  .output = {.linear = format()},
                  .focus = {.extent = placed.region, .mask = GetParam().mask}},
                 "lay_focus");
    const ImageView under = rig.image(format(), Storage::kBuffer, kOutput, picture, outside, tight);
    const ImageView over = rig.image(format(), Storage::kBuffer, placed.region, focus, outside, tight);
    std::vector<Pixel> mask;
    for (const double value : placed.place.mask)
      mask.push_back({value, 0, 0, 0});
    FocusInputs inputs{
        .x = placed.place.x, .y = placed.place.y, .feather = static_cast<float>(placed.place.feather)};
    for (const FocusPlace::Rectangle& where : placed.place.rectangles)
      inputs.rectangles[static_cast<std::size_t>(inputs.rectangle_count++)] = {where.x, where.y, where.width,
                                                                               where.height};
    pass.set_focus(&inputs);
    const ImageView masked =
        mask.empty() ? over : rig.image(PixelFormat::kR8, Storage::kBuffer, placed.region, mask, 1, tight);
    pass.run({}, {}, kOutput, {},
             {{Resource::kFocus, over}, {Resource::kFocusMask, masked}, {Resource::kResolved, under}});
    return rig.bytes(under, kOutput);
  }

  Placed with_mask(const Placed& placed) const {
    Placed with = placed;
    if (GetParam().mask) with.place.mask = mask_of(placed.region);
    with.place.feather = static_cast<double>(static_cast<float>(with.place.feather));
    return with;
  }

  reference::Picture stored(const std::vector<Pixel>& pixels, Extent extent) const {
    reference::Picture picture{extent.width, extent.height, pixels, {}, 0};
    for (Pixel& pixel : picture.pixels) {
      for (double& value : pixel)
        value = testing::stored_value(format(), value);
    }
    return picture;
  }
};

TEST_P(LayFocus, MatchesTheReferenceOnEveryPatternAndPlace) {
  for (const Placed& each : kPlaces) {
    const Placed placed = with_mask(each);
    for (const Pattern pattern : testing::all_patterns()) {
      if (pattern == Pattern::kNonFinite) continue;  // what is copied stays as it is, and so is not finite
      const std::vector<Pixel> picture = testing::pattern_pixels(Pattern::kNoise, kOutput, 3);
      const std::vector<Pixel> focus = testing::pattern_pixels(pattern, placed.region, 8);
      reference::Picture expected =
          reference::lay_focus(stored(picture, kOutput), stored(focus, placed.region), placed.place);
      testing::expect_close(
          expected, testing::decode(format(), run(picture, focus, placed)),
          [&](std::size_t i) {
            return error_bound(expected.largest[i]) + testing::output_rounding(format(), expected.largest[i]);
          },
          fmt::format("LayFocus {} {}{}", testing::name_of(pattern), placed.name,
                      GetParam().mask ? ", masked" : ""),
          format());
      if (HasFatalFailure()) return;
    }
  }
}

// Where the weight is 0 no bit changes, whatever lies in the focus; where it is 1 every bit is the focus's.
TEST_P(LayFocus, OutsideIsThePictureAndTheMiddleIsTheFocus) {
  const std::size_t pixel_bytes = bytes_per_pixel(format());
  for (const Placed& each : kPlaces) {
    const Placed placed = with_mask(each);
    const std::vector<Pixel> picture = testing::pattern_pixels(Pattern::kNonFinite, kOutput, 3);
    const std::vector<Pixel> focus = testing::pattern_pixels(Pattern::kExtremes, placed.region, 8);
    const std::vector<unsigned char> before = testing::encode(format(), picture);
    const std::vector<unsigned char> over = testing::encode(format(), focus);
    const std::vector<unsigned char> after = run(picture, focus, placed);
    const reference::Picture size{kOutput.width, kOutput.height, {}, {}, 0};
    const reference::Picture region{placed.region.width, placed.region.height, {}, {}, 0};
    int untouched = 0;
    int whole = 0;
    for (int y = 0; y < kOutput.height; ++y) {
      for (int x = 0; x < kOutput.width; ++x) {
        const double weight = reference::focus_weight(size, region, placed.place, x, y);
        if (weight > 0 && weight < 1) continue;
        const std::size_t at = reference::index_of(kOutput.width, x, y) * pixel_bytes;
        const std::size_t from =
            weight == 0 ? at
                        : reference::index_of(placed.region.width, x - placed.place.x, y - placed.place.y) *
                              pixel_bytes;
        const std::vector<unsigned char>& expected = weight == 0 ? before : over;
        ASSERT_EQ(std::memcmp(after.data() + at, expected.data() + from, pixel_bytes), 0)
            << placed.name << " at " << x << ", " << y << " of weight " << weight;
        (weight == 0 ? untouched : whole) += 1;
      }
    }
    EXPECT_GT(untouched + whole, 0) << placed.name;
    if (std::string(placed.name) == "in the middle") {
      EXPECT_GT(whole, 50);
      EXPECT_GE(untouched, kOutput.area() - placed.region.area());
    }
  }
}

// A value that is not finite does not reach its neighbours: it counts as its stand-in, in its own pixel alone.
TEST_P(LayFocus, ANonFinitePixelCountsAsItsStandIn) {
  const Placed placed = {"feathered", {24, 24}, {.x = 10, .y = 10, .feather = 6, .mask = {}}};
  const Placed with = with_mask(placed);
  const std::vector<Pixel> picture = testing::pattern_pixels(Pattern::kNoise, kOutput, 3);
  const std::vector<Pixel> focus = testing::pattern_pixels(Pattern::kNoise, placed.region, 8);
  const std::size_t under = reference::index_of(kOutput.width, 12, 20);
  const std::size_t over = reference::index_of(24, 2, 12);  // has a weight between 0 and 1
  for (const auto& [bad, stand_in] : {std::pair{kNan, 0.0}, {kInfinity, 65504.0}, {-kInfinity, -65504.0}}) {
    for (const bool in_focus : {false, true}) {
      std::vector<Pixel> spoilt = in_focus ? focus : picture;
      std::vector<Pixel> stood = spoilt;
      spoilt[in_focus ? over : under] = {bad, bad, bad, bad};
      stood[in_focus ? over : under] = {stand_in, stand_in, stand_in, stand_in};
      EXPECT_EQ(run(in_focus ? picture : spoilt, in_focus ? spoilt : focus, with),
                run(in_focus ? picture : stood, in_focus ? stood : focus, with))
          << bad;
    }
  }
}

TEST_P(LayFocus, PoisonOutsideBothChangesNoBit) {
  for (const Placed& each : kPlaces) {
    const Placed placed = with_mask(each);
    const std::vector<Pixel> picture = testing::pattern_pixels(Pattern::kNoise, kOutput, 3);
    const std::vector<Pixel> focus = testing::pattern_pixels(Pattern::kNoise, placed.region, 8);
    const std::vector<unsigned char> clean = run(picture, focus, placed, 0);
    for (const double poison : testing::kPoisons)
      EXPECT_EQ(clean, run(picture, focus, placed, poison)) << placed.name;
  }
}

// Under a memory checker this also shows that nothing beyond the images is touched.
TEST_P(LayFocus, TightImagesGiveTheSameBits) {
  for (const Placed& each : kPlaces) {
    const Placed placed = with_mask(each);
    const std::vector<Pixel> picture = testing::pattern_pixels(Pattern::kNoise, kOutput, 3);
    const std::vector<Pixel> focus = testing::pattern_pixels(Pattern::kNoise, placed.region, 8);
    EXPECT_EQ(run(picture, focus, placed, 0), run(picture, focus, placed, 0, true)) << placed.name;
  }
}

TEST_P(LayFocus, TwoRunsAgreeBitForBit) {
  const Placed placed = with_mask(kPlaces[7]);
  const std::vector<Pixel> picture = testing::pattern_pixels(Pattern::kExtremes, kOutput, 3);
  const std::vector<Pixel> focus = testing::pattern_pixels(Pattern::kExtremes, placed.region, 8);
  EXPECT_EQ(run(picture, focus, placed), run(picture, focus, placed));
}

const std::vector<Variant> kVariants = {{PixelFormat::kRGBA32F, true},
                                        {PixelFormat::kRGBA16F, true},
                                        {PixelFormat::kRGBA32F, false},
                                        {PixelFormat::kRGBA16F, false}};
INSTANTIATE_TEST_SUITE_P(Variants, LayFocus, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants, [](const Variant& v) {
                           return std::string(name_of(v.format)) + (v.mask ? "_mask" : "");
                         }));

}  // namespace
}  // namespace quincunx
