// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "kernel_fixture.h"
#include "pass_scale.h"

namespace quincunx {
namespace {

using testing::FrameFormats;
using testing::FrameSpec;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

// Two weights rounded to 2^-24 (each off by 2^-25 at most) and six float operations, each within 2^-24 of the
// largest tap: below 8 * 2^-24 of it. The point filter is exact. The absolute part lets a device flush
// denormals.
constexpr double kBilinearError = 8 * 0x1p-24;
constexpr double kDenormal = 0x1p-126;

struct Variant {
  Method method;
  Storage storage;
  PixelFormat colour;
  PixelFormat resolved;
};

class Scale : public ::testing::TestWithParam<Variant> {
 protected:
  Scale()
      : settings_{.storage = GetParam().storage},
        formats_{.storage = GetParam().storage, .colour = GetParam().colour} {
    settings_.colour = GetParam().colour;
    settings_.resolved = GetParam().resolved;
    pass_ = std::make_unique<ScalePass>(testing::impl(), GetParam().method, settings_);
  }

  struct Run {
    std::vector<unsigned char> bytes;
    std::vector<Pixel> pixels;
    std::int64_t non_finite = 0;
  };

  Run run(Rig& rig, const TestFrame& frame, Extent output) {
    AxisTables tables(testing::impl(), output);
    const ImageView view = rig.output(settings_.resolved, output);
    const Counter counter = rig.counter();
    pass_->enqueue(testing::impl().queue, tables, frame.inputs, view, counter, nullptr);
    Run result{rig.bytes(view, output), {}, 0};
    result.pixels = testing::decode(settings_.resolved, result.bytes);
    result.non_finite = rig.count(counter);
    // What lies around the output stays as it was.
    const std::vector<Pixel> all = rig.pixels(view, view.extent);
    for (int y = 0; y < view.extent.height; ++y) {
      for (int x = 0; x < view.extent.width; ++x) {
        if (x < output.width && y < output.height) continue;
        EXPECT_EQ(all[static_cast<std::size_t>(y * view.extent.width + x)][0], -7) << x << ", " << y;
      }
    }
    return result;
  }

  void compare(const FrameSpec& spec, Extent output) {
    Rig rig;
    const TestFrame frame = make_frame(rig, formats_, spec);
    const Run actual = run(rig, frame, output);
    const bool point = GetParam().method == Method::kPoint;
    const reference::Picture expected =
        point ? reference::scale_point(frame.reference, output.width, output.height)
              : reference::scale_bilinear(frame.reference, output.width, output.height);
    const auto bound = [&](std::size_t i) {
      return (point ? 0 : kBilinearError * expected.largest[i]) + kDenormal +
             testing::output_rounding(settings_.resolved, expected.largest[i]);
    };
    const std::string what =
        fmt::format("{}x{} -> {}x{}, jitter {}, {}, {}", spec.render.width, spec.render.height, output.width,
                    output.height, spec.jitter.x, spec.jitter.y, name_of(spec.colour));
    testing::expect_close(expected, actual.pixels, bound, what, settings_.resolved);
    EXPECT_EQ(actual.non_finite, expected.non_finite) << what;
  }

  ResolveSettings settings_;
  FrameFormats formats_;
  std::unique_ptr<ScalePass> pass_;
};

TEST_P(Scale, MatchesTheReferenceAtEverySizeScaleAndInput) {
  const double scales[][2] = {{.05, .1}, {.5, .71}, {.71, .5}, {1, 1}, {1.37, .83}, {2, 1.9}};
  const Vec2 jitters[] = {{0, 0}, {.25f, .25f}, {-.25f, .4f}, {-.5f, -1.f}};
  unsigned seed = 0;
  for (const Extent output : {Extent{1, 1}, Extent{7, 5}, Extent{64, 64}, Extent{257, 129}}) {
    for (const auto& scale : scales) {
      for (const Pattern pattern : testing::all_patterns()) {
        // The widest pictures take one jitter each: the reference is slow.
        const Vec2 jitter = jitters[++seed % std::size(jitters)];
        compare({.render = testing::scaled(output, scale[0], scale[1]),
                 .jitter = jitter,
                 .colour = pattern,
                 .seed = seed},
                output);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(Scale, IsTheIdentityAtScaleOneWithoutJitter) {
  for (const Pattern pattern : {Pattern::kNoise, Pattern::kExtremes}) {
    Rig rig;
    const Extent extent{67, 33};
    const TestFrame frame = make_frame(rig, formats_, {.render = extent, .colour = pattern, .seed = 5});
    std::vector<Pixel> expected = frame.reference.colour;
    for (Pixel& pixel : expected) {
      for (double& value : pixel)
        value = testing::stored_value(settings_.resolved, value);
    }
    EXPECT_EQ(run(rig, frame, extent).pixels, expected);
  }
}

TEST_P(Scale, PoisonOutsideTheViewportChangesNoBit) {
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    Rig rig;
    FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}, .seed = 3};
    const Run clean = run(rig, make_frame(rig, formats_, spec), {64, 33});
    for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
      spec.outside = poison;
      const Run poisoned = run(rig, make_frame(rig, formats_, spec), {64, 33});
      EXPECT_EQ(clean.bytes, poisoned.bytes) << render.width << "x" << render.height << ", poison " << poison;
      EXPECT_EQ(poisoned.non_finite, 0);
    }
  }
}

// Under a memory checker this also shows that nothing beyond the viewport is read.
TEST_P(Scale, ATightImageGivesTheSameBits) {
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{2, 2}, Extent{13, 7}}) {
    Rig rig;
    FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}, .seed = 3};
    const Run roomy = run(rig, make_frame(rig, formats_, spec), {16, 9});
    spec.tight = true;
    EXPECT_EQ(roomy.bytes, run(rig, make_frame(rig, formats_, spec), {16, 9}).bytes);
  }
}

TEST_P(Scale, ANonFiniteTexelChangesItsFootprintOnly) {
  const Extent output{90, 40};
  const Extent render = testing::scaled(output, .71, .71);
  const std::vector<Pixel> clean = pattern_pixels(Pattern::kNoise, render, 9);
  std::vector<Pixel> spoilt = clean;
  spoilt[static_cast<std::size_t>(12 * render.width + 20)] = {std::nan(""), 1, 1, 1};
  spoilt[static_cast<std::size_t>(20 * render.width + 40)] = {1, -std::numeric_limits<double>::infinity(), 1,
                                                              1};
  const FrameSpec spec{.render = render, .jitter = {.25f, .25f}};
  Rig rig;
  const TestFrame spoilt_frame = make_frame(rig, formats_, spec, spoilt);
  const Run before = run(rig, make_frame(rig, formats_, spec, clean), output);
  const Run after = run(rig, spoilt_frame, output);
  std::int64_t touched = 0;
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const bool inside =
          GetParam().method == Method::kPoint
              ? sample_nearest(spoilt_frame.reference, x, y, output.width, output.height).non_finite
              : sample_bilinear(spoilt_frame.reference, x, y, output.width, output.height).non_finite;
      touched += inside ? 1 : 0;
      if (inside) continue;
      const auto i = static_cast<std::size_t>(y * output.width + x);
      EXPECT_EQ(before.pixels[i], after.pixels[i]) << x << ", " << y;
    }
  }
  EXPECT_GT(touched, 0);
  EXPECT_EQ(after.non_finite, touched);
}

TEST_P(Scale, TwoRunsAgreeBitForBit) {
  Rig rig;
  const FrameSpec spec{.render = {183, 92}, .jitter = {.25f, -.25f}, .colour = Pattern::kNonFinite};
  const TestFrame frame = make_frame(rig, formats_, spec);
  EXPECT_EQ(run(rig, frame, {257, 129}).bytes, run(rig, frame, {257, 129}).bytes);
}

// Bilinear filtering reproduces a linear picture: sampled at jittered places it must come back in place.
TEST_P(Scale, JitterIsTakenBack) {
  if (GetParam().method == Method::kPoint) return;
  const Extent output{128, 64};
  for (const double scale : {.5, .71, 1.0, 1.37}) {
    for (const float jitter : {-.25f, .25f, .5f}) {
      const Extent render = testing::scaled(output, scale, scale);
      std::vector<Pixel> colour;
      for (int y = 0; y < render.height; ++y) {
        for (int x = 0; x < render.width; ++x) {
          const double px = (x + .5 + static_cast<double>(jitter)) / render.width;
          const double py = (y + .5 + static_cast<double>(jitter)) / render.height;
          colour.push_back({px, py, px + py, 1});
        }
      }
      Rig rig;
      const Run actual =
          run(rig, make_frame(rig, formats_, {.render = render, .jitter = {jitter, jitter}}, colour), output);
      // Half inputs round values up to 2 by 2^-11; so may a half output.
      constexpr double kHalfRounding = 2 * 0x1p-11 + 2 * 0x1p-11;
      const int margin = 4;
      for (int y = margin; y < output.height - margin; ++y) {
        for (int x = margin; x < output.width - margin; ++x) {
          const Pixel& pixel = actual.pixels[static_cast<std::size_t>(y * output.width + x)];
          ASSERT_NEAR(pixel[0], (x + .5) / output.width, kHalfRounding)
              << "scale " << scale << " jitter " << jitter;
          ASSERT_NEAR(pixel[1], (y + .5) / output.height, kHalfRounding)
              << "scale " << scale << " jitter " << jitter;
        }
      }
    }
  }
}

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const Method method : {Method::kPoint, Method::kBilinear}) {
    for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
      for (const PixelFormat colour : {PixelFormat::kRGBA16F, PixelFormat::kRGBA32F}) {
        for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
          all.push_back({method, storage, colour, resolved});
        }
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, Scale, ::testing::ValuesIn(variants()), [](const auto& instance) {
  const Variant& v = instance.param;
  return fmt::format("{}_{}_{}_to_{}", name_of(v.method), v.storage == Storage::kImage ? "image" : "buffer",
                     name_of(v.colour), name_of(v.resolved));
});

}  // namespace
}  // namespace quincunx
