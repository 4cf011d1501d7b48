// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../reference/motion_blur.h"
#include "kernel_fixture.h"
#include "motion/blur_params.h"
#include "passes/pass_chain.h"

namespace quincunx {
namespace {

using testing::FrameFormats;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

// The mean of n <= 64 colours: n - 1 sums and one product, each within 2^-24 of what is at most n times the
// largest colour before the product.
constexpr double kMeanError = 64 * 0x1p-24;
constexpr double kDenormal = 0x1p-126;

using Velocity = std::function<Pixel(double u, double v)>;  // uv a frame at a place of the picture
using Depth = std::function<double(double u, double v)>;

struct BlurScene {
  const char* name;
  Velocity velocity;
  Depth depth;
};

bool in_front(double u, double v) {
  return std::hypot(u - 0.45, v - 0.5) < 0.22;
}

// `pixel`: one output pixel in uv.
std::vector<BlurScene> scenes(double pixel) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto far = [](double, double) { return 0.1; };
  const auto front = [](double u, double v) { return in_front(u, v) ? 0.5 : 0.1; };
  return {
      {"still", [](double, double) { return Pixel{}; }, far},
      {"hardly moving",
       [=](double, double) {
         return Pixel{1e-6 * pixel, .3 * pixel};
       },
       far},
      {"pan",
       [=](double, double) {
         return Pixel{6.3 * pixel, -2 * pixel};
       },
       far},
      {"object before still",
       [=](double u, double v) {
         return in_front(u, v) ? Pixel{9 * pixel, 4 * pixel} : Pixel{};
       },
       front},
      {"still before moving",
       [=](double u, double v) {
         return in_front(u, v) ? Pixel{} : Pixel{-11 * pixel, 0};
       },
       front},
      {"wheel",
       [=](double u, double v) {
         return Pixel{(v - .5) * 60 * pixel, (.5 - u) * 60 * pixel};
       },
       front},
      {"too fast",
       [=](double u, double v) {
         return in_front(u, v) ? Pixel{400 * pixel, 0} : Pixel{1e6 * pixel, 3};
       },
       front},
      {"not finite",
       [=](double u, double v) {
         return in_front(u, v) ? Pixel{nan, infinity} : Pixel{5 * pixel, -infinity};
       },
       [=](double u, double) { return u < .3   ? nan
                                      : u < .6 ? infinity
                                               : -1.0; }},
  };
}

struct Variant {
  Storage storage;
  PixelFormat velocity, resolved;
};

class MotionBlur : public ::testing::TestWithParam<Variant> {
 protected:
  MotionBlur() {
    settings_.targets.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    settings_.output.linear = GetParam().resolved;
    settings_.method = Method::kBilinear;
    settings_.output.present = false;
    settings_.blur.shutter = .5f;
  }

  struct Run {
    std::vector<unsigned char> bytes;
    std::vector<std::uint8_t> kinds;
  };

  // The frame's velocity and depth images, `outside` around them.
  TestFrame frame_of(Rig& rig, const BlurScene& scene, Extent render, Vec2 jitter, double outside,
                     bool tight = false) {
    TestFrame frame;
    reference::Frame& twin = frame.reference;
    twin.width = render.width;
    twin.height = render.height;
    twin.jitter_x = jitter.x;
    twin.jitter_y = jitter.y;
    std::vector<Pixel> velocity;
    std::vector<Pixel> depth;
    for (int y = 0; y < render.height; ++y) {
      for (int x = 0; x < render.width; ++x) {
        const double u = (x + .5) / render.width;
        const double v = (y + .5) / render.height;
        velocity.push_back(scene.velocity(u, v));
        depth.push_back({scene.depth(u, v)});
        twin.velocity.push_back({testing::stored_value(settings_.velocity, velocity.back()[0]),
                                 testing::stored_value(settings_.velocity, velocity.back()[1])});
        twin.depth.push_back(testing::stored_value(PixelFormat::kR32F, depth.back()[0]));
      }
    }
    frame.inputs.render_extent = render;
    frame.inputs.jitter = jitter;
    frame.inputs.velocity =
        rig.image(settings_.velocity, settings_.targets.storage, render, velocity, outside, tight);
    frame.inputs.depth =
        rig.image(PixelFormat::kR32F, settings_.targets.storage, render, depth, outside, tight);
    return frame;
  }

  Run run(Rig& rig, const TestFrame& frame, Extent output, const std::vector<Pixel>& resolved) {
    settings_.output_extent = output;
    settings_.target_extent = frame.inputs.render_extent;
    PassChain chain(testing::device(), PlanFacts({}, settings_));
    const ImageView source = rig.image(settings_.output.linear, Storage::kBuffer, output, resolved, 1e30);
    const ImageView view = rig.output(settings_.output.linear, output);
    PassFrame bound = chain.frame(frame.inputs, nullptr, {.linear = view}, rig.counter());
    bound[Resource::kResolved] = source;
    for (const char* kernel : {"motion_tiles", "motion_neighbours", "motion_blur"})
      PassChain::enqueue(*chain.find(kernel), bound, nullptr);
    return {rig.bytes(view, output), kinds_of(chain.newest(Resource::kTileBlurs))};
  }

  static std::vector<std::uint8_t> kinds_of(const ImageView& tiles) {
    std::vector<TileBlur> blurs(static_cast<std::size_t>(tiles.extent.area()));
    testing::impl().queue.enqueueReadBuffer(borrow<cl::Buffer>(tiles.memory), CL_TRUE, 0,
                                            blurs.size() * sizeof(TileBlur), blurs.data());
    std::vector<std::uint8_t> kinds;
    for (const TileBlur& blur : blurs)
      kinds.push_back(static_cast<std::uint8_t>(blur.kind));
    return kinds;
  }

  reference::BlurInput input_of(const TestFrame& frame, Extent output) const {
    const double units = settings_.blur.shutter * 64.0;
    return {.frame = &frame.reference,
            .scale = {static_cast<float>(units * output.width), static_cast<float>(units * output.height)},
            .output_width = output.width,
            .output_height = output.height,
            .most_samples = settings_.blur.samples};
  }

  std::vector<Pixel> picture(Extent output, unsigned seed) const {
    std::vector<Pixel> pixels = testing::pattern_pixels(testing::Pattern::kNoise, output, seed);
    for (Pixel& pixel : pixels) {
      for (double& value : pixel)
        value = testing::stored_value(settings_.output.linear, value);
    }
    return pixels;
  }

  void compare(const BlurScene& scene, Extent render, Extent output, Vec2 jitter) {
    Rig rig;
    const TestFrame frame = frame_of(rig, scene, render, jitter, 0);
    const std::vector<Pixel> resolved = picture(output, 7);
    const Run actual = run(rig, frame, output, resolved);
    const reference::BlurInput input = input_of(frame, output);
    const std::string what = fmt::format("{}, {}x{} -> {}x{}", scene.name, render.width, render.height,
                                         output.width, output.height);
    const std::vector<reference::BlurTile> tiles = reference::blur_tiles(input);
    ASSERT_EQ(actual.kinds.size(), tiles.size()) << what;
    for (std::size_t i = 0; i < tiles.size(); ++i)
      ASSERT_EQ(actual.kinds[i], tiles[i].kind) << what << ", tile " << i;
    const reference::Picture expected = reference::motion_blur(input, resolved);
    testing::expect_close(
        expected, testing::decode(settings_.output.linear, actual.bytes),
        [&](std::size_t i) {
          return kMeanError * expected.largest[i] + kDenormal +
                 testing::output_rounding(settings_.output.linear, expected.largest[i]);
        },
        what, settings_.output.linear);
  }

  ResolveSettings settings_;
};

TEST_P(MotionBlur, MatchesTheReferenceOnEveryMotionAndSize) {
  for (const Extent output : {Extent{1, 1}, Extent{7, 5}, Extent{64, 64}, Extent{257, 129}}) {
    for (const BlurScene& scene : scenes(1.0 / output.width)) {
      compare(scene, testing::scaled(output, .71, .5), output, {.25f, -.25f});
      if (HasFatalFailure()) return;
    }
  }
  const BlurScene wheel = scenes(1.0 / 64)[5];
  for (const Extent render : {Extent{1, 1}, Extent{2, 3}, Extent{3, 1}, Extent{4, 90}, Extent{128, 130}})
    compare(wheel, render, {64, 64}, {-.5f, .5f});
}

TEST_P(MotionBlur, MoreSamplesMatchToo) {
  for (const int samples : {4, 64}) {
    settings_.blur.samples = samples;
    compare(scenes(1.0 / 96)[3], {48, 30}, {96, 60}, {});
  }
}

// Under a memory checker this also shows that nothing beyond the viewport is read.
TEST_P(MotionBlur, ATightImageGivesTheSameBits) {
  const BlurScene wheel = scenes(1.0 / 16)[5];
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 2}}) {
    const std::vector<Pixel> resolved = picture({16, 9}, 3);
    Rig rig;
    const Run roomy = run(rig, frame_of(rig, wheel, render, {-.5f, .5f}, 0), {16, 9}, resolved);
    EXPECT_EQ(roomy.bytes,
              run(rig, frame_of(rig, wheel, render, {-.5f, .5f}, 0, true), {16, 9}, resolved).bytes);
  }
}

TEST_P(MotionBlur, PoisonOutsideTheViewportChangesNoBit) {
  const BlurScene wheel = scenes(1.0 / 70)[5];
  const std::vector<Pixel> resolved = picture({70, 45}, 3);
  Rig rig;
  const Run clean = run(rig, frame_of(rig, wheel, {33, 21}, {.25f, .25f}, 0), {70, 45}, resolved);
  for (const double poison : testing::kPoisons) {
    const Run poisoned = run(rig, frame_of(rig, wheel, {33, 21}, {.25f, .25f}, poison), {70, 45}, resolved);
    EXPECT_EQ(clean.bytes, poisoned.bytes) << poison;
  }
}

TEST_P(MotionBlur, StillPicturesAndStillObjectsKeepEveryBit) {
  const Extent output{96, 64};
  const std::vector<Pixel> resolved = picture(output, 5);
  Rig rig;
  const ImageView source = rig.image(settings_.output.linear, Storage::kBuffer, output, resolved, 0);
  const Run still = run(rig, frame_of(rig, scenes(1.0 / 96)[0], output, {}, 0), output, resolved);
  EXPECT_EQ(still.bytes, rig.bytes(source, output));
  // In front of a moving background: not a bit of halo. 2^-24 and more of a colour may go in the mean.
  const Run before = run(rig, frame_of(rig, scenes(1.0 / 96)[4], output, {}, 0), output, resolved);
  const std::vector<Pixel> pixels = testing::decode(settings_.output.linear, before.bytes);
  int inside = 0;
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      if (!in_front((x + .5) / output.width, (y + .5) / output.height)) continue;
      const auto i = static_cast<std::size_t>(y * output.width + x);
      for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_NEAR(pixels[i][c], resolved[i][c],
                    kMeanError * std::abs(resolved[i][c]) +
                        testing::output_rounding(settings_.output.linear, std::abs(resolved[i][c])))
            << x << ", " << y;
      }
      ++inside;
    }
  }
  EXPECT_GT(inside, 500);
}

TEST_P(MotionBlur, TwoRunsAgreeBitForBit) {
  Rig rig;
  const std::vector<Pixel> resolved = picture({100, 70}, 9);
  const TestFrame frame = frame_of(rig, scenes(1.0 / 100)[3], {71, 50}, {}, 0);
  EXPECT_EQ(run(rig, frame, {100, 70}, resolved).bytes, run(rig, frame, {100, 70}, resolved).bytes);
}

// An edge of an object that moves over a still background: what truth has is a ramp over exactly the streak.
TEST_P(MotionBlur, TheStreakEndsWhereTheShutterEnds) {
  constexpr int kSpeed = 16;  // output pixels while the shutter is open
  const Extent output{128, 8};
  settings_.blur.samples = 64;
  const auto object = [](double u, double) { return u >= .5; };
  const BlurScene scene{"edge",
                        [&](double u, double v) {
                          return object(u, v) ? Pixel{2.0 * kSpeed / output.width, 0} : Pixel{};
                        },
                        [&](double u, double v) { return object(u, v) ? .5 : .1; }};
  std::vector<Pixel> resolved;
  for (int i = 0; i < output.width * output.height; ++i)
    resolved.push_back(i % output.width >= 64 ? Pixel{1, 1, 1, 1} : Pixel{0, 0, 0, 1});
  Rig rig;
  const Run result = run(rig, frame_of(rig, scene, output, {}, 0), output, resolved);
  const std::vector<Pixel> pixels = testing::decode(settings_.output.linear, result.bytes);
  for (int x = 0; x < output.width; ++x) {
    double mean = 0;
    for (int y = 0; y < output.height; ++y)
      mean += pixels[static_cast<std::size_t>(y * output.width + x)][0] / output.height;
    // Behind the object lies its streak: the part of the time that it was over the pixel. The moments of 16
    // or more samples are jittered within their steps and places are whole pixels: one step and one pixel off
    // at most.
    const double truth = x >= 64 ? 1 : std::clamp((x + .5 - (64.0 - kSpeed)) / kSpeed, 0.0, 1.0);
    EXPECT_NEAR(mean, truth, 2.0 / kSpeed) << x;
  }
}

const std::vector<Variant> kVariants = {{Storage::kBuffer, PixelFormat::kRG16F, PixelFormat::kRGBA32F},
                                        {Storage::kBuffer, PixelFormat::kRG32F, PixelFormat::kRGBA32F},
                                        {Storage::kBuffer, PixelFormat::kRG16F, PixelFormat::kRGBA16F},
                                        {Storage::kImage, PixelFormat::kRG32F, PixelFormat::kRGBA32F}};
INSTANTIATE_TEST_SUITE_P(Variants, MotionBlur, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants, [](const Variant& v) {
                           return fmt::format("{}_{}_to_{}",
                                              v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.velocity), name_of(v.resolved));
                         }));

}  // namespace
}  // namespace quincunx
