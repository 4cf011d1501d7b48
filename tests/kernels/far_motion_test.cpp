// SPDX-License-Identifier: MIT
// far_surroundings, far_fit, far_match, and far_velocity with what they found.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "../reference/far_motion.h"
#include "error_table.h"
#include "kernel_fixture.h"
#include "motion/velocity_params.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using reference::Bounded;
using testing::FrameSpec;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

struct Variant {
  Storage storage;
  PixelFormat velocity;
  PixelFormat colour;
};

constexpr Extent kOutput = {200, 120};
constexpr Extent kRenders[] = {{1, 1}, {2, 3}, {7, 5}, {64, 64}, {101, 61}};
// A turn with some roll, and a step forward.
constexpr std::array<float, 9> kModel = {.01f, .008f, -.004f, -.006f, .003f, .001f, .05f, -.02f, .3f};

class FarMotionPasses : public ::testing::TestWithParam<Variant> {
 protected:
  FarMotionPasses() {
    settings_.targets.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    settings_.colour = GetParam().colour;
    settings_.conventions.sky_motion = SkyMotion::kEvidence;
  }

  struct Inputs {
    FrameInputs current, previous;
    reference::FarInputs reference;
    std::vector<Pixel> depth, velocity;
  };

  // Noise of which two thirds of the samples are far and without motion.
  Inputs inputs(Rig& rig, Extent render, Extent previous, unsigned seed, double outside = 0,
                bool tight = false) const {
    const testing::FrameFormats formats = {.storage = settings_.targets.storage,
                                           .colour = settings_.colour,
                                           .velocity = settings_.velocity,
                                           .with_velocity = true,
                                           .with_depth = true};
    Inputs in;
    const auto make = [&](Extent extent, Vec2 jitter, unsigned own, FrameInputs& inputs,
                          reference::Frame& frame) {
      TestFrame made = make_frame(rig, formats,
                                  {.render = extent,
                                   .jitter = jitter,
                                   .velocity = own % 3 == 0 ? Pattern::kNonFinite : Pattern::kNoise,
                                   .seed = own,
                                   .outside = outside,
                                   .tight = tight});
      std::vector<Pixel> velocity, depth;
      for (std::size_t i = 0; i < made.reference.depth.size(); ++i) {
        if (i % 3 != 0) made.reference.depth[i] = 0;
        if (i % 3 != 0) made.reference.velocity[i] = {0, 0};
        depth.push_back({made.reference.depth[i], 0, 0, 0});
        velocity.push_back({made.reference.velocity[i][0], made.reference.velocity[i][1], 0, 0});
      }
      inputs = made.inputs;
      frame = made.reference;
      inputs.depth = rig.image(PixelFormat::kR32F, settings_.targets.storage, extent, depth, outside, tight);
      inputs.velocity =
          rig.image(settings_.velocity, settings_.targets.storage, extent, velocity, outside, tight);
    };
    make(render, {.21f, -.17f}, seed, in.current, in.reference.frame);
    make(previous, {-.11f, .37f}, seed + 50, in.previous, in.reference.previous);
    in.reference.output_width = kOutput.width;
    in.reference.output_height = kOutput.height;
    std::copy(kModel.begin(), kModel.end(), in.reference.model.begin());
    in.reference.is_known = seed % 2 == 0;
    return in;
  }

  template <typename Element>
  static ImageView records(const cl::Buffer& buffer, std::size_t count) {
    return {.memory = buffer(), .extent = {static_cast<int>(count), 1}};
  }

  template <typename Element>
  static cl::Buffer upload(const std::vector<Element>& elements) {
    cl::Buffer buffer(testing::impl().context, CL_MEM_READ_WRITE, elements.size() * sizeof(Element));
    testing::impl().queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, elements.size() * sizeof(Element),
                                             elements.data());
    return buffer;
  }

  template <typename Element>
  static std::vector<Element> download(const cl::Buffer& buffer, std::size_t count) {
    std::vector<Element> elements(count);
    testing::impl().queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(Element), elements.data());
    return elements;
  }

  static FarModel model(bool is_known) {
    FarModel made = {};
    std::copy(kModel.begin(), kModel.end(), made.p);
    made.is_known = is_known ? 1 : 0;
    return made;
  }

  static Extent cells_of(const Inputs& in) {
    return extent_of(Area::kFarCells, {in.current.render_extent, in.previous.render_extent, kOutput});
  }

  std::vector<FarSums> run_surroundings(const Inputs& in) {
    const auto cells = static_cast<std::size_t>(cells_of(in).area());
    const cl::Buffer before = upload(std::vector{model(in.reference.is_known)});
    const cl::Buffer sums = upload(std::vector<FarSums>(cells));
    PassRig pass(SceneNeeds{}, settings_, "far_surroundings");
    pass.run(in.current, in.previous, kOutput, {},
             {{Resource::kPreviousFarMotion, records<FarModel>(before, 1)},
              {Resource::kFarSums, records<FarSums>(sums, cells)}});
    return download<FarSums>(sums, cells);
  }

  FarModel run_fit(const FarSums& total) {
    const cl::Buffer sums = upload(std::vector{total});
    const cl::Buffer motion = upload(std::vector<FarModel>(1));
    const cl::Buffer before =
        upload(std::vector{FarModel{.p = {}, .is_known = 0, .still = 100, .moved = 50}});
    const cl::Buffer match = upload(std::vector{FarMatch{7, 11}});
    PassRig pass(SceneNeeds{}, settings_, "far_fit");
    FrameInputs frame;
    frame.render_extent = {1, 1};
    pass.run(frame, frame, kOutput, {},
             {{Resource::kFarSums, records<FarSums>(sums, 1)},
              {Resource::kPreviousFarMotion, records<FarModel>(before, 1)},
              {Resource::kFarMatch, records<FarMatch>(match, 1)},
              {Resource::kFarMotion, records<FarModel>(motion, 1)}});
    return download<FarModel>(motion, 1).front();
  }

  FarMatch run_match(const Inputs& in) {
    const cl::Buffer motion = upload(std::vector{model(true)});
    const cl::Buffer match = upload(std::vector<FarMatch>(1));
    PassRig pass(SceneNeeds{}, settings_, "far_match");
    pass.run(in.current, in.previous, kOutput, {},
             {{Resource::kFarMotion, records<FarModel>(motion, 1)},
              {Resource::kFarMatch, records<FarMatch>(match, 1)}});
    return download<FarMatch>(match, 1).front();
  }

  std::vector<unsigned char> run_velocity(Rig& rig, const Inputs& in, FarMatch found, bool is_known,
                                          bool tight = false) {
    const cl::Buffer motion = upload(std::vector{model(is_known)});
    const cl::Buffer match = upload(std::vector{found});
    const std::vector<Pixel> before(static_cast<std::size_t>(in.current.render_extent.area()),
                                    Pixel{-7, -7, -7, -7});
    const ImageView view =
        rig.image(settings_.velocity, settings_.targets.storage, in.current.render_extent, before, -7, tight);
    PassRig pass(SceneNeeds{}, settings_, "far_velocity");
    pass.run(in.current, in.previous, kOutput, {},
             {{Resource::kFarMotion, records<FarModel>(motion, 1)},
              {Resource::kFarMatch, records<FarMatch>(match, 1)},
              {Resource::kVelocity, view}});
    return rig.bytes(view, in.current.render_extent);
  }

  void expect_near(double expected, const Bounded& bound, double actual, const std::string& what) {
    ASSERT_TRUE(std::isfinite(actual)) << what;
    ASSERT_NEAR(expected, actual, bound.error) << what;
    testing::record_error(
        {.error = std::abs(expected - actual), .bound = bound.error, .largest = std::abs(expected)});
  }

  ResolveSettings settings_;
};

TEST_P(FarMotionPasses, SurroundingsMatchTheReference) {
  unsigned seed = 0;
  int decided = 0;
  for (const Extent render : kRenders) {
    for (int i = 0; i < 4; ++i) {
      Rig rig;
      const Inputs in = inputs(rig, render, render, ++seed);
      const auto actual = run_surroundings(in);
      const Extent cells = cells_of(in);
      for (std::size_t cell = 0; cell < actual.size(); ++cell) {
        const int x = static_cast<int>(cell) % cells.width, y = static_cast<int>(cell) / cells.width;
        const auto expected = reference::expected_of(
            [&]<typename Real>(Real) { return reference::far_surroundings<Real>(in.reference, x, y); });
        if (expected.undecided) continue;
        ++decided;
        std::size_t next = 0;
        for (std::size_t row = 0; row < kFarTerms; ++row) {
          const std::string what = fmt::format("seed {} cell {} row {}", seed, cell, row);
          for (std::size_t column = 0; column <= row; ++column) {
            expect_near(expected.value.products[row][column], expected.bound.products[row][column],
                        static_cast<double>(actual[cell].products[next++]), what);
            if (HasFatalFailure()) return;
          }
          expect_near(expected.value.velocities[row], expected.bound.velocities[row],
                      static_cast<double>(actual[cell].velocities[row]), what);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
  EXPECT_GT(decided, 30);
}

// The equations of a known motion. What is found is compared by how it moves the picture's corners: single parameters
// may be exchanged for others.
TEST_P(FarMotionPasses, TheFitFindsAMotionThatIsThere) {
  reference::FarSums<double> sums;
  const auto model = kModel;
  for (int i = 0; i < 4000; ++i) {
    const double x = ((i * 37) % 100 - 49.5) / 60, y = ((i * 61) % 97 - 48) / 97.,
                 z = .001 * ((i * 13) % 29 + 1);
    const double tx[] = {1, x * x, 0, x * y, -y, x, z, 0, z * x},
                 ty[] = {0, x * y, 1, y * y, x, y, 0, z, z * y};
    double vx = 0, vy = 0;
    for (std::size_t t = 0; t < kFarTerms; ++t)
      vx += static_cast<double>(model[t]) * tx[t], vy += static_cast<double>(model[t]) * ty[t];
    for (std::size_t row = 0; row < kFarTerms; ++row) {
      for (std::size_t column = 0; column <= row; ++column)
        sums.products[row][column] += (tx[row] * tx[column] + ty[row] * ty[column]) / z;
      sums.velocities[row] += (tx[row] * vx + ty[row] * vy) / z;
    }
  }
  FarSums total = {};
  std::size_t next = 0;
  for (std::size_t row = 0; row < kFarTerms; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      total.products[next] = static_cast<float>(sums.products[row][column]);
      sums.products[row][column] = static_cast<double>(total.products[next++]);
    }
    total.velocities[row] = static_cast<float>(sums.velocities[row]);
    sums.velocities[row] = static_cast<double>(total.velocities[row]);
  }
  const FarModel actual = run_fit(total);
  const auto expected =
      reference::expected_of([&]<typename Real>(Real) { return reference::far_fit<Real>(sums); });
  EXPECT_EQ(actual.is_known, 1);
  EXPECT_FALSE(expected.undecided);
  for (std::size_t i = 0; i < kFarTerms; ++i)
    expect_near(expected.value[i], expected.bound[i], static_cast<double>(actual.p[i]),
                fmt::format("p{}", i));
  for (const double x : {-.8, 0., .8}) {
    for (const double y : {-.5, .5}) {
      const auto at = [&](auto p) {
        return std::array{static_cast<double>(p[0]) + static_cast<double>(p[1]) * x * x +
                              static_cast<double>(p[3]) * x * y - static_cast<double>(p[4]) * y +
                              static_cast<double>(p[5]) * x,
                          static_cast<double>(p[2]) + static_cast<double>(p[1]) * x * y +
                              static_cast<double>(p[3]) * y * y + static_cast<double>(p[4]) * x +
                              static_cast<double>(p[5]) * y};
      };
      // A tenth of a pixel of 1080.
      EXPECT_NEAR(at(actual.p)[0], at(model)[0], .1 / 1080) << x << ", " << y;
      EXPECT_NEAR(at(actual.p)[1], at(model)[1], .1 / 1080) << x << ", " << y;
    }
  }
}

TEST_P(FarMotionPasses, WithoutSurroundingsNothingIsKnown) {
  const FarModel found = run_fit({});
  EXPECT_EQ(found.is_known, 0);
  EXPECT_NEAR(found.still, .9 * 100 + 7, 1e-5) << "what the frames before said counts on";
  EXPECT_NEAR(found.moved, .9 * 50 + 11, 1e-5);
  for (const float p : found.p)
    EXPECT_EQ(p, 0);
}

TEST_P(FarMotionPasses, TheMatchIsThatOfTheReference) {
  unsigned seed = 0;
  int decided = 0;
  for (const Extent render : kRenders) {
    for (int i = 0; i < 4; ++i) {
      Rig rig;
      const Inputs in = inputs(rig, render, {render.width + 2, std::max(render.height - 1, 1)}, ++seed);
      const FarMatch actual = run_match(in);
      const Extent cells = cells_of(in);
      const double units = std::min(1024., (1 << 30) / (256. * static_cast<double>(cells.area())));
      double still = 0, moved = 0, allowed = 0;
      bool undecided = false;
      for (int cell = 0; cell < cells.area(); ++cell) {
        const auto expected = reference::expected_of([&]<typename Real>(Real) {
          return reference::far_match<Real>(in.reference, cell % cells.width, cell / cells.width);
        });
        undecided = undecided || expected.undecided;
        still += expected.value[0] * units, moved += expected.value[1] * units;
        // Cut to an integer.
        allowed += 1 + units * std::max(expected.bound[0].error, expected.bound[1].error);
      }
      if (undecided) continue;
      ++decided;
      ASSERT_NEAR(actual.still, still, allowed) << seed;
      ASSERT_NEAR(actual.moved, moved, allowed) << seed;
    }
  }
  EXPECT_GT(decided, 10);
}

TEST_P(FarMotionPasses, TheVelocityIsThatOfTheModel) {
  Rig rig;
  const Inputs in = inputs(rig, {101, 61}, {101, 61}, 1);
  const auto actual = testing::decode(settings_.velocity, run_velocity(rig, in, {10, 10}, true));
  for (int y = 0; y < 61; ++y) {
    for (int x = 0; x < 101; ++x) {
      const std::size_t i = reference::index_of(101, x, y);
      const auto& drawn = in.reference.frame.velocity[i];
      const auto expected = reference::expected_of(
          [&]<typename Real>(Real) { return reference::modelled_far_velocity<Real>(in.reference, x, y); });
      for (std::size_t c = 0; c < 2; ++c) {
        if (!reference::is_far_and_still(in.reference.frame, x, y)) {
          ASSERT_TRUE(actual[i][c] == drawn[c] || (std::isnan(actual[i][c]) && std::isnan(drawn[c]))) << i;
          continue;
        }
        const double rounding = testing::velocity_rounding(settings_.velocity, settings_.targets.storage,
                                                           std::abs(expected.value[c]));
        ASSERT_NEAR(actual[i][c], expected.value[c], expected.bound[c].error + rounding) << i;
      }
    }
  }
}

// Where standing still explains the colours better, or nothing is known, what was drawn stays.
TEST_P(FarMotionPasses, AgainstTheEvidenceNothingMoves) {
  Rig rig;
  const Inputs in = inputs(rig, {33, 17}, {33, 17}, 1);
  const auto moved = run_velocity(rig, in, {94, 100}, true);
  const auto still = run_velocity(rig, in, {92, 100}, true);
  EXPECT_NE(moved, still);
  EXPECT_EQ(still, run_velocity(rig, in, {100, 100}, false));
  const auto values = testing::decode(settings_.velocity, still);
  for (std::size_t i = 1; i < values.size(); i += 3)
    EXPECT_EQ(values[i][0], 0) << i;
}

TEST_P(FarMotionPasses, PoisonOutsideTheViewportChangesNoBit) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {45, 23}}) {
    const auto bytes = [&](double outside, bool tight) {
      Rig rig;
      const Inputs in = inputs(rig, render, {render.height, render.width}, 2, outside, tight);
      const auto sums = run_surroundings(in);
      const FarMatch match = run_match(in);
      auto all = run_velocity(rig, in, {1, 1}, true, tight);
      const auto add = [&all](const void* from, std::size_t count) {
        const auto* first = static_cast<const unsigned char*>(from);
        all.insert(all.end(), first, first + count);
      };
      add(sums.data(), sums.size() * sizeof(FarSums));
      add(&match, sizeof(match));
      return all;
    };
    const auto clean = bytes(0, false);
    for (const double poison : testing::kPoisons)
      EXPECT_EQ(clean, bytes(poison, false)) << render.width << "x" << render.height;
    EXPECT_EQ(clean, bytes(0, true)) << render.width << "x" << render.height << ", tight";
    EXPECT_EQ(clean, bytes(0, true)) << render.width << "x" << render.height << ", twice";
  }
}

const std::vector<Variant> kVariants = {{Storage::kBuffer, PixelFormat::kRG16F, PixelFormat::kRGBA16F},
                                        {Storage::kBuffer, PixelFormat::kRG32F, PixelFormat::kRGBA32F},
                                        {Storage::kBuffer, PixelFormat::kRG16F, PixelFormat::kRGBA8},
                                        {Storage::kImage, PixelFormat::kRG16F, PixelFormat::kRGBA16F},
                                        {Storage::kImage, PixelFormat::kRG16F, PixelFormat::kRGBA8}};
INSTANTIATE_TEST_SUITE_P(Variants, FarMotionPasses, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants, [](const Variant& v) {
                           return fmt::format("{}_{}_{}", v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.velocity), name_of(v.colour));
                         }));

}  // namespace
}  // namespace quincunx
