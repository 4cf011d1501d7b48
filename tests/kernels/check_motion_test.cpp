// SPDX-License-Identifier: MIT
#include "../reference/check_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "error_table.h"
#include "kernel_fixture.h"
#include "pass_rig.h"
#include "passes/pass_measure.h"
#include "picture_params.h"

namespace quincunx {
namespace {

using testing::PassRig;
using testing::Pattern;
using testing::Rig;
using testing::TestFrame;

struct Variant {
  Storage storage;
  PixelFormat colour;
  PixelFormat velocity;
};

class CheckMotion : public ::testing::TestWithParam<Variant> {
 protected:
  CheckMotion() {
    settings_.method = Method::kQuincunx;
    settings_.targets.storage = GetParam().storage;
    settings_.colour = GetParam().colour;
    settings_.velocity = GetParam().velocity;
    settings_.checks_motion = true;
    pass_ = std::make_unique<PassRig>(SceneNeeds{}, settings_, "check_motion");
  }

  struct Pair {
    TestFrame now, before;
  };

  Pair pair(Rig& rig, Extent render, Extent previous, Pattern colour, Pattern velocity, unsigned seed,
            double outside = 0, bool tight = false) const {
    const testing::FrameFormats formats = {.storage = settings_.targets.storage,
                                           .colour = settings_.colour,
                                           .velocity = settings_.velocity,
                                           .with_velocity = true};
    const auto frame = [&](Extent extent, Vec2 jitter, unsigned own) {
      return make_frame(rig, formats,
                        {.render = extent,
                         .jitter = jitter,
                         .colour = colour,
                         .velocity = velocity,
                         .seed = own,
                         .outside = outside,
                         .tight = tight,
                         .speed = .06});
    };
    return {frame(render, {.21f, -.17f}, seed), frame(previous, {-.11f, .37f}, seed + 50)};
  }

  MotionSums run(const Pair& pair) {
    const cl::Buffer sums(testing::impl().context, CL_MEM_READ_WRITE, sizeof(MotionSums));
    MotionSums counted = {};
    testing::impl().queue.enqueueWriteBuffer(sums, CL_TRUE, 0, sizeof(counted), &counted);
    pass_->run(pair.now.inputs, pair.before.inputs, {200, 120}, {},
               {{Resource::kMotionSums, {.memory = sums(), .extent = {1, 1}}}});
    testing::impl().queue.enqueueReadBuffer(sums, CL_TRUE, 0, sizeof(counted), &counted);
    return counted;
  }

  // Whether every decision is certain; then samples are counted exactly, and each cell rounds its errors once.
  bool compare(const Pair& pair, const std::string& what) {
    const reference::Frame& frame = pair.now.reference;
    std::array<std::array<double, kMotionReadings>, 2> errors = {}, allowed = {};
    std::array<unsigned, 2> samples = {};
    for (int y = 0; y * 32 < frame.height; ++y) {
      for (int x = 0; x * 32 < frame.width; ++x) {
        const auto expected = reference::expected_of([&]<typename Real>(Real) {
          return reference::check_motion<Real>(frame, pair.before.reference, x, y);
        });
        if (expected.undecided) return false;
        for (std::size_t axis = 0; axis < 2; ++axis) {
          samples[axis] += static_cast<unsigned>(expected.value[axis].samples);
          for (std::size_t i = 0; i < kMotionReadings; ++i) {
            errors[axis][i] += expected.value[axis].errors[i] * double{kMotionUnits};
            allowed[axis][i] += .5 + 1e-4 + expected.bound[axis].errors[i].error * double{kMotionUnits};
          }
        }
      }
    }
    const MotionSums actual = run(pair);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const MotionAxisSums& sums = axis == 0 ? actual.x : actual.y;
      EXPECT_EQ(sums.samples, samples[axis]) << what << ", axis " << axis;
      for (std::size_t i = 0; i < kMotionReadings; ++i) {
        EXPECT_NEAR(sums.errors[i], errors[axis][i], allowed[axis][i])
            << what << ", axis " << axis << ", reading " << i;
        testing::record_error({.error = std::abs(sums.errors[i] - errors[axis][i]),
                               .bound = allowed[axis][i],
                               .largest = errors[axis][i]});
      }
    }
    return true;
  }

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
};

TEST_P(CheckMotion, MatchesTheReference) {
  unsigned seed = 0;
  int decided = 0;
  for (const Extent render : {Extent{1, 1}, {7, 5}, {64, 64}, {101, 61}}) {
    for (const Pattern colour : testing::all_patterns()) {
      for (const Pattern velocity : {Pattern::kNoise, Pattern::kConstant, Pattern::kNonFinite}) {
        Rig rig;
        const Extent previous = {render.width + 2, std::max(render.height - 1, 1)};
        const std::string what = fmt::format("{}x{}, {} moved by {}", render.width, render.height,
                                             testing::name_of(colour), testing::name_of(velocity));
        decided += compare(pair(rig, render, previous, colour, velocity, ++seed), what) ? 1 : 0;
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GE(decided, 3 * static_cast<int>(seed) / 4) << "of " << seed;
}

TEST_P(CheckMotion, PoisonOutsideTheViewportAndTightImagesChangeNoBit) {
  struct {
    double outside = 0;
    bool tight = false;
  } spec;
  for (const Extent render : {Extent{7, 5}, {33, 21}}) {
    testing::expect_same_whatever_is_outside(spec, [&] {
      Rig rig;
      const MotionSums sums =
          run(pair(rig, render, render, Pattern::kNoise, Pattern::kNoise, 9, spec.outside, spec.tight));
      std::array<unsigned, sizeof(sums) / sizeof(unsigned)> all;
      std::memcpy(all.data(), &sums, sizeof(sums));
      return all;
    });
  }
}

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const PixelFormat colour : {PixelFormat::kRGBA16F, PixelFormat::kRGBA32F, PixelFormat::kRGBA8}) {
    for (const PixelFormat velocity : {PixelFormat::kRG16F, PixelFormat::kRG32F})
      all.push_back({Storage::kBuffer, colour, velocity});
    if (colour != PixelFormat::kRGBA32F) all.push_back({Storage::kImage, colour, PixelFormat::kRG16F});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, CheckMotion, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(), [](const Variant& v) {
                           return fmt::format("{}_{}_{}", v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.colour), name_of(v.velocity));
                         }));

// What sums over frames say.
using Errors = std::array<unsigned, kMotionReadings>;

MotionAxisSums axis_of(unsigned samples, const Errors& errors) {
  MotionAxisSums sums = {.samples = samples, .errors = {}};
  std::copy(errors.begin(), errors.end(), sums.errors);
  return sums;
}

MotionSums sums_of(const Errors& errors, unsigned samples_x = 100, unsigned samples_y = 100) {
  return {axis_of(samples_x, errors), axis_of(samples_y, errors)};
}

MotionCheck after(int frames, const MotionSums& sums) {
  MotionWatch watch;
  for (int i = 0; i < frames; ++i)
    watch.add(sums);
  return watch.check();
}

TEST(MotionWatch, NamesTheSignThatForetellsBetter) {
  EXPECT_EQ(after(8, sums_of({100, 9000, 9000, 9000})).verdict, MotionVerdict::kRight);
  EXPECT_EQ(after(8, sums_of({9000, 100, 9000, 9000})).verdict, MotionVerdict::kSignOfX);
  EXPECT_EQ(after(8, sums_of({9000, 9000, 100, 9000})).verdict, MotionVerdict::kSignOfY);
  EXPECT_EQ(after(8, sums_of({9000, 5000, 5000, 100})).verdict, MotionVerdict::kDirection);
  EXPECT_EQ(text_of(after(8, sums_of({50000, 60000, 500, 60000}, 1000, 1000))),
            "velocity.y seems to point the other way: 19.8 dB better");
}

TEST(MotionWatch, SaysNothingOfAnAxisAlongWhichNothingMoves) {
  EXPECT_EQ(after(8, sums_of({100, 9000, 100, 9000}, 100, 31)).verdict, MotionVerdict::kRightX);
  EXPECT_EQ(after(8, sums_of({9000, 100, 9000, 100}, 100, 31)).verdict, MotionVerdict::kSignOfX);
  EXPECT_EQ(after(8, sums_of({100, 100, 9000, 9000}, 31, 100)).verdict, MotionVerdict::kRightY);
  EXPECT_EQ(after(8, sums_of({9000, 9000, 100, 100}, 31, 100)).verdict, MotionVerdict::kSignOfY);
  EXPECT_EQ(after(80, sums_of({9000, 9000, 9000, 100}, 31, 31)).verdict, MotionVerdict::kUnknown);
  EXPECT_EQ(after(80, {}).verdict, MotionVerdict::kUnknown) << "still";
  EXPECT_EQ(text_of({}), "cannot tell");
}

TEST(MotionWatch, WantsEightFramesThatAgree) {
  const MotionSums wrong = sums_of({9000, 9000, 100, 9000}, 0), right = sums_of({100, 9000, 9000, 9000}, 0);
  EXPECT_EQ(after(7, wrong).verdict, MotionVerdict::kUnknown);
  EXPECT_EQ(after(80, sums_of({5000, 5000, 4000, 5000})).verdict, MotionVerdict::kUnknown) << "1 dB";
  MotionWatch watch;
  for (int i = 0; i < 8; ++i)
    watch.add(i == 3 ? right : wrong);
  EXPECT_EQ(watch.check().verdict, MotionVerdict::kUnknown) << "one frame of eight says otherwise";
  for (int i = 0; i < 4; ++i)
    watch.add(wrong);
  EXPECT_EQ(watch.check().verdict, MotionVerdict::kSignOfY) << "it is eight frames ago";
  for (int i = 0; i < 8; ++i)
    watch.add(right);
  EXPECT_EQ(watch.check().verdict, MotionVerdict::kRightY) << "it was mended";
}

}  // namespace
}  // namespace quincunx
