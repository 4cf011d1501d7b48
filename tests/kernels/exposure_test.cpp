// SPDX-License-Identifier: MIT
// exposure against its reference.
#include <fmt/format.h>

#include <cmath>

#include "pass_rig.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;

struct ExposureVariant {
  Storage storage = Storage::kBuffer;
  PixelFormat colour = PixelFormat::kRGBA16F;
};

std::string name_of(const ExposureVariant& v) {
  return fmt::format("{}_{}", v.storage == Storage::kImage ? "image" : "buffer", quincunx::name_of(v.colour));
}

struct Given {
  float number = 0, image = 0;
};

class ExposureOfFrames : public ::testing::TestWithParam<ExposureVariant> {
 protected:
  // After a frame of the factor `before`, 0: none, that wanted another.
  Exposure run(const testing::FrameSpec& spec, const std::vector<Pixel>& colour, float before,
               Given given = {}, float wanted_before = 1e9f) {
    Rig rig;
    testing::TestFrame frame =
        make_frame(rig, {.storage = GetParam().storage, .colour = GetParam().colour}, spec, colour);
    frame_ = frame.reference;
    frame.inputs.exposure = given.number;
    const Storage storage = GetParam().storage;
    if (given.image != 0) {
      const double texel = static_cast<double>(given.image);
      frame.inputs.exposure_image = rig.image(PixelFormat::kR32F, storage, {1, 1}, {{texel, 0, 0, 0}}, 1e30);
    }
    const cl::Buffer previous = testing::to_device(std::vector<Exposure>{{before, 0, 0, wanted_before}});
    const cl::Buffer made = testing::to_device(std::vector<Exposure>(1));
    const ResolveSettings settings = {
        .method = Method::kTemporal, .colour = GetParam().colour, .targets = {.storage = storage}};
    PassRig pass({}, settings, "exposure");
    pass.run(
        frame.inputs, frame.inputs, {64, 64}, {},
        {{Resource::kPreviousExposure, {.memory = previous()}}, {Resource::kExposure, {.memory = made()}}});
    return testing::from_device<Exposure>(made, 1).front();
  }

  static std::vector<Pixel> pattern(Pattern pattern, Extent extent, double unit) {
    std::vector<Pixel> pixels = pattern_pixels(pattern, extent, 7);
    for (Pixel& pixel : pixels) {
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] *= unit;
    }
    return pixels;
  }

  reference::Frame frame_;  // of the last run
};

// Sums of 2^15 positive floats, one after another in rows, are off by less than 2^-16 of them; a logarithm that is
// linear between powers of two, as the kernel's is, by .09 octaves, which only a block that is held sees.
constexpr double kErrorMax = 0x1p-15;

TEST_P(ExposureOfFrames, MatchesTheReference) {
  const bool encoded = GetParam().colour == PixelFormat::kRGBA8;
  for (const Extent extent : {Extent{1, 1}, {7, 5}, {64, 64}, {257, 129}, {480, 270}}) {
    for (const Pattern drawn : testing::all_patterns()) {
      if (drawn == Pattern::kExtremes || drawn == Pattern::kImpulse) continue;  // blocks are held
      for (const float before : {0.f, 1.f, .3f, 0x1p-20f}) {
        const double unit = encoded ? 1 : .37;
        const float wanted = run({.render = extent}, pattern(drawn, extent, unit), 0).factor;
        const Exposure made = run({.render = extent}, pattern(drawn, extent, unit), before, {}, wanted);
        const double expected = reference::exposure_of(frame_, encoded ? 1 : 0, static_cast<double>(before),
                                                       static_cast<double>(wanted));
        const std::string what =
            fmt::format("{}x{} {} after {}", extent.width, extent.height, testing::name_of(drawn), before);
        ASSERT_NEAR(static_cast<double>(made.factor), expected, kErrorMax * expected) << what;
        EXPECT_FLOAT_EQ(made.inverse * made.factor, 1) << what;
        EXPECT_FLOAT_EQ(made.change, before > 0 ? made.factor / before : 1) << what;
      }
    }
  }
}

TEST_P(ExposureOfFrames, TheCallersFactorCounts) {
  if (GetParam().colour == PixelFormat::kRGBA8) return;  // it has gone through that already
  const std::vector<Pixel> colour = pattern(Pattern::kNoise, {9, 9}, 1);
  const auto factor = [&](Given given, float before, float wanted_before = 1e9f) {
    return run({.render = {9, 9}}, colour, before, given, wanted_before).factor;
  };
  EXPECT_EQ(factor({.number = 1}, 0), 1);
  EXPECT_EQ(factor({.number = 1, .image = .25f}, 0), .25f);
  EXPECT_EQ(factor({.image = 2}, 0), 2);
  EXPECT_EQ(factor({.number = 1, .image = -3}, 0), 1);
  EXPECT_EQ(factor({.number = 1}, 1.6f), 1.6f) << "less than 3/4 of a stop away";
  EXPECT_EQ(factor({.number = 1}, 1.75f, .5f), .875f) << "more than that";
  EXPECT_EQ(factor({.number = 1}, 1.75f, 1.75f), 1.75f) << "but not in the frame before";
  EXPECT_EQ(factor({.number = 1}, 1.75f, 9), 1.75f) << "or the other way";
  EXPECT_EQ(factor({.number = 4}, 1), 4);
}

TEST_P(ExposureOfFrames, ADarkFrameKeepsThatBefore) {
  const std::vector<Pixel> black(81, Pixel{0, 0, 0, 1});
  if (GetParam().colour == PixelFormat::kRGBA8) return;  // whose exposure is always 1
  EXPECT_EQ(run({.render = {9, 9}}, black, 0).factor, 1);
  EXPECT_EQ(run({.render = {9, 9}}, black, .3f).factor, .3f);
}

// A black frame with a lamp is as bright as the lamp; a sun in a dark frame leaves that some light.
TEST_P(ExposureOfFrames, LampsCount) {
  if (GetParam().colour != PixelFormat::kRGBA32F) return;
  std::vector<Pixel> colour(128 * 64, Pixel{0, 0, 0, 1});
  colour[700] = {50, 50, 50, 1};
  EXPECT_NEAR(run({.render = {128, 64}}, colour, 0).factor, .16f / 50, 1e-5f);
  for (Pixel& pixel : colour)
    pixel = {.01, .01, .01, 1};
  colour[700] = {1e6, 1e6, 1e6, 1};
  const float factor = run({.render = {128, 64}}, colour, 0).factor;
  EXPECT_GT(factor, 4);
  EXPECT_LT(factor, 16);
}

TEST_P(ExposureOfFrames, PoisonOutsideTheViewportChangesNoBit) {
  testing::FrameSpec spec = {.render = {33, 21}};
  const std::vector<Pixel> colour = pattern(Pattern::kNoise, spec.render, 1);
  testing::expect_same_whatever_is_outside(spec, [&] { return run(spec, colour, 0).factor; });
}

const std::vector<ExposureVariant> kVariants = {{},
                                                {.colour = PixelFormat::kRGBA32F},
                                                {.colour = PixelFormat::kRGBA8},
                                                {.storage = Storage::kImage},
                                                {.storage = Storage::kImage, .colour = PixelFormat::kRGBA8}};
INSTANTIATE_TEST_SUITE_P(Variants, ExposureOfFrames, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants,
                                               [](const ExposureVariant& v) { return name_of(v); }));

}  // namespace
}  // namespace quincunx
