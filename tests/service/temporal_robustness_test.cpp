// SPDX-License-Identifier: MIT
// Pictures of kTemporal from inputs that are bad, missing or strange.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Mask;
using testing::Pixel;
using testing::Place;
using testing::ServiceRig;
using testing::TemporalRun;
using testing::TemporalScene;
using testing::Texture;
using Pixels = std::vector<Pixel>;

constexpr Extent kOutput{160, 96};
constexpr Extent kHalf{80, 48};
constexpr ResolveSettings kBilinear{.method = Method::kBilinear};

TemporalScene moving_scene(Place velocity, Extent output = kOutput) {
  TemporalScene scene;
  scene.output = output;
  scene.surfaces = {{.centre = {80, 48}, .velocity = velocity, .texture = testing::noise_texture(9)}};
  return scene;
}

// Sets a block of samples of one input.
struct Poison {
  const char* name;
  void (*spoil)(HostFrame& frame);
};

bool in_block(int x, int y) {
  return x >= 30 && x < 38 && y >= 20 && y < 26;
}

template <typename T>
void spoil(std::function<T(int, int)>& input, T value) {
  input = [before = input, value](int x, int y) { return in_block(x, y) ? value : before(x, y); };
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

const Poison kPoisons[] = {
    {"colour NaN",
     [](HostFrame& f) {
       spoil(f.colour, Pixel{kNan, kNan, kNan, kNan});
     }},
    {"colour Inf",
     [](HostFrame& f) {
       spoil(f.colour, Pixel{kInf, .1f, -kInf, 1});
     }},
    {"colour 65504",
     [](HostFrame& f) {
       spoil(f.colour, Pixel{65504, 65504, 65504, 1});
     }},
    {"velocity NaN",
     [](HostFrame& f) {
       spoil(f.velocity, Vec2{kNan, kNan});
     }},
    {"velocity Inf",
     [](HostFrame& f) {
       spoil(f.velocity, Vec2{kInf, -kInf});
     }},
    {"velocity 65504",
     [](HostFrame& f) {
       spoil(f.velocity, Vec2{65504, -65504});
     }},
    {"depth NaN", [](HostFrame& f) { spoil(f.depth, kNan); }},
    {"depth Inf", [](HostFrame& f) { spoil(f.depth, kInf); }},
    {"depth 65504", [](HostFrame& f) { spoil(f.depth, 65504.f); }},
    {"reactive 255", [](HostFrame& f) { spoil(f.reactive, std::uint8_t{255}); }},
};

// The frame after a bad one is as good there as a frame alone, and no frame has a value that is not finite.
TEST(TemporalRobustness, BadSamplesLeaveWithinOneFrame) {
  const Mask near = [](int x, int y) { return x >= 52 && x < 84 && y >= 32 && y < 60; };
  for (const Place velocity : {Place(), Place(1.3, .4)}) {
    for (const Poison& poison : kPoisons) {
      const TemporalScene scene = moving_scene(velocity);
      TemporalRun run(scene), single(scene, kBilinear);
      run.until(12), single.until(13);
      HostFrame bad = scene.render(12, kHalf, testing::halton_jitter(12, 32));
      poison.spoil(bad);
      for (const Pixel& pixel : run.rig().resolve(bad)) {
        for (const float value : pixel)
          ASSERT_TRUE(std::isfinite(value)) << poison.name;
      }
      run.skip();
      const Pixels after = run.next(), alone = single.next(), truth = run.truth();
      const double own = testing::psnr(testing::squared_error(after, truth, kOutput, near));
      const double bilinear = testing::psnr(testing::squared_error(alone, truth, kOutput, near));
      RecordProperty(poison.name, std::to_string(own - bilinear));
      EXPECT_GE(own, bilinear) << poison.name << ", velocity " << velocity;
    }
  }
}

// Runs a plain surface whose very first frame has a block of `value`.
TemporalRun after_bad_start(Place turn, float value) {
  TemporalScene scene = moving_scene({.4, .1});
  scene.surfaces[0].turn = turn;
  scene.surfaces[0].texture = testing::plain_texture(.7f, .2f, .1f);
  TemporalRun run(scene);
  HostFrame bad = scene.render(0, kHalf, testing::halton_jitter(0, 32));
  spoil(bad.colour, Pixel{value, value, value, 1});
  run.rig().resolve(bad), run.skip();
  return run;
}

// Nothing is left of samples that are no light, whether history is copied or resampled.
TEST(TemporalRobustness, InvalidSamplesWithoutHistoryLeaveAtOnce) {
  for (const Place turn : {Place(1), std::polar(1., .01)}) {
    for (const float value : {-kInf, kNan}) {
      TemporalRun run = after_bad_start(turn, value);
      EXPECT_LE(testing::largest_difference(run.next(), run.truth(), kOutput), 1. / 255)
          << value << ", " << turn;
    }
  }
}

// The brightest light there is goes as light of 100 does, in half a dozen frames; measured: .042 at most.
TEST(TemporalRobustness, TheBrightestLightOfAFirstFrameFades) {
  for (const Place turn : {Place(1), std::polar(1., .01)}) {
    for (const float value : {kInf, 65504.f}) {
      TemporalRun run = after_bad_start(turn, value);
      for (int frame = 1; frame < 11; ++frame)
        run.next();
      EXPECT_LE(testing::largest_difference(run.next(), run.truth(), kOutput), .05) << value << ", " << turn;
    }
  }
}

Texture smooth_texture() {
  return [](Place place) {
    const auto wave = static_cast<float>(.2 * std::sin(place.real() / 9) * std::cos(place.imag() / 7));
    return Pixel{.4f + wave, .3f - wave, .25f, 1};
  };
}

struct Fault {
  TemporalPreset preset;
  Place velocity, turn;  // velocity and turn of the surface
};

const Fault kFaults[] = {{TemporalPreset::kBalanced, {}, 1},
                         {TemporalPreset::kBalanced, {1.3, .4}, 1},
                         {TemporalPreset::kBalanced, {1.3, .4}, std::polar(1., .01)},
                         {TemporalPreset::kFast, {1.3, .4}, std::polar(1., .01)},
                         {TemporalPreset::kQuality, {}, std::polar(1., .01)}};

TemporalScene scene_of(const Fault& fault) {
  TemporalScene scene = moving_scene(fault.velocity);
  scene.surfaces[0].texture = smooth_texture();
  scene.surfaces[0].turn = fault.turn;
  scene.exposure = 1;  // exposed light is light as it is: a block of 5 is far too bright
  return scene;
}

HostFrame with_block(const TemporalScene& scene, int frame, float value) {
  HostFrame bad = scene.render(frame, kHalf, testing::halton_jitter(frame, 32));
  spoil(bad.colour, Pixel{value, value, value, 1});
  return bad;
}

// A block of samples of one frame, far too bright or negative, is not seen in that frame, nor in the next.
TEST(TemporalRobustness, AFaultyBlockLeavesNothing) {
  for (const Fault& fault : kFaults) {
    const ResolveSettings settings{.method = Method::kTemporal, .temporal = {.preset = fault.preset}};
    for (const float value : {50.f, 5.f, -5.f}) {
      const TemporalScene scene = scene_of(fault);
      TemporalRun run(scene, settings), clean(scene, settings);
      run.until(20), clean.until(20);
      const Pixels bad = run.rig().resolve(with_block(scene, 20, value));
      run.skip();
      const std::string what = fmt::format("{} {} at {}, turning {}", name_of(fault.preset), value,
                                           fault.velocity.real(), fault.turn.imag());
      EXPECT_LE(testing::largest_difference(bad, clean.next(), kOutput), 1. / 255) << what;
      EXPECT_LE(testing::largest_difference(run.next(), clean.next(), kOutput), 1. / 255) << what;
    }
  }
}

// A block that stays is there in its fourth frame, within a tenth of black to white.
TEST(TemporalRobustness, ABrightBlockThatStaysIsSeen) {
  const Mask within = [](int x, int y) { return x >= 64 && x < 72 && y >= 44 && y < 48; };
  for (const Fault& fault : kFaults) {
    const ResolveSettings settings{.method = Method::kTemporal, .temporal = {.preset = fault.preset}};
    const TemporalScene scene = scene_of(fault);
    TemporalRun run(scene, settings);
    run.until(20);
    Pixels pixels;
    for (int frame = 20; frame < 24; ++frame)
      pixels = run.rig().resolve(with_block(scene, frame, 50));
    const Pixels lamp(pixels.size(), Pixel{50, 50, 50, 1});
    EXPECT_LE(testing::largest_difference(pixels, lamp, kOutput, within), .1)
        << name_of(fault.preset) << " at " << fault.velocity.real() << ", turning " << fault.turn.imag();
  }
}

void set_velocity(HostFrame& frame, float value) {
  frame.velocity = [value](int, int) { return Vec2{value, value}; };
}

void negate_velocity(HostFrame& frame) {
  frame.velocity = [before = frame.velocity](int x, int y) {
    const Vec2 velocity = before(x, y);
    return Vec2{-velocity.x, -velocity.y};
  };
}

struct WrongVelocity {
  const char* name;
  SceneNeeds needs;
  void (*change)(HostFrame& frame);
};

const WrongVelocity kWrongVelocities[] = {
    {"missing", {.moving_objects = false, .camera_motion = false}, [](HostFrame&) {}},
    {"zero", {}, [](HostFrame& f) { set_velocity(f, 0); }},
    {"negated", {}, negate_velocity},
    {"NaN", {}, [](HostFrame& f) { set_velocity(f, kNan); }},
};

// Sum over the frames from the ninth on.
double error_of(ServiceRig& rig, const TemporalScene& scene, const std::vector<Pixels>& truths,
                void (*change)(HostFrame& frame)) {
  double sum = 0;
  for (int i = 0; i < static_cast<int>(truths.size()); ++i) {
    HostFrame frame = scene.render(i, kHalf, testing::halton_jitter(i, 32));
    change(frame);
    const Pixels pixels = rig.resolve(frame);
    if (i >= 8) sum += testing::squared_error(pixels, truths[static_cast<std::size_t>(i)], kOutput);
  }
  return sum;
}

// Where the velocity of everything is wrong, or there is none although everything moves, the picture may be
// worse than that of one frame alone: its squared error is at most 1.3 times as large (1.1 dB), and 1.7 times (2.3 dB)
// in slow motion whose velocity is finite. To hold that to 1.3, too, what history foretells would have to
// count as another picture where it is 5 % worse than what the neighbours do, and then fine textures count as one: a
// history that is right is that bad there.
TEST(TemporalRobustness, WrongVelocityCostsAtMost70PercentOfBilinearsError) {
  for (const Place velocity : {Place(.4, .1), Place(1.3, .4), Place(6.2, -2.3)}) {
    const TemporalScene scene = moving_scene(velocity);
    std::vector<Pixels> truths;
    for (int i = 0; i < 24; ++i)
      truths.push_back(i < 8 ? Pixels{} : scene.truth(i));
    ServiceRig single({}, kBilinear, kOutput, kHalf);
    const double bilinear = error_of(single, scene, truths, [](HostFrame&) {});
    for (const TemporalPreset preset : {TemporalPreset::kBalanced, TemporalPreset::kFast}) {
      for (const WrongVelocity& wrong : kWrongVelocities) {
        ServiceRig rig(wrong.needs, {.method = Method::kTemporal, .temporal = {.preset = preset}}, kOutput,
                       kHalf);
        const double own = error_of(rig, scene, truths, wrong.change);
        const std::string what =
            fmt::format("{}, {}, {:.1f} pixels a frame", wrong.name,
                        preset == TemporalPreset::kFast ? "fast" : "balanced", std::abs(velocity));
        RecordProperty(what, fmt::format("{:.3f}", own / bilinear));
        const bool is_slow = std::abs(velocity) < 2 && std::string_view(wrong.name) != "NaN";
        EXPECT_LE(own, (is_slow ? 1.7 : 1.3) * bilinear) << what;
      }
    }
  }
}

int drift_frames() {
  const char* text = std::getenv("QUINCUNX_DRIFT_FRAMES");
  return text != nullptr ? std::atoi(text) : 600;
}

// After a long run a plain picture still has its colour, and a textured one is as good as after a short run.
TEST(TemporalRobustness, NothingDrifts) {
  constexpr Extent kSmall{32, 20};
  // Until nothing is left of what the first frame shows: 64 / .37 and 40 / .21 frames; and with the runs a
  // multiple of 100 frames apart, so that their texels lie alike: .37 and .21 of a pixel repeat then.
  constexpr int kWarm = 268, kWindow = 32;
  const int frames = std::max(drift_frames(), kWarm + kWindow);
  for (const PixelFormat format : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    const ResolveSettings settings{.method = Method::kTemporal, .temporal = {.history = format}};
    TemporalScene scene = moving_scene({.37, -.21}, {64, 40});
    TemporalRun old(scene, settings), young(scene, settings);
    scene.surfaces[0].texture = testing::plain_texture(.7f, .2f, 3);
    TemporalRun plain(scene, settings);
    while (young.frame() < frames - kWindow - kWarm)
      young.skip();
    old.until(frames - kWindow, kSmall), young.until(frames - kWindow, kSmall);
    double of_old = 0, of_young = 0;
    for (int i = 0; i < kWindow; ++i) {
      const Pixels one = old.next(kSmall), other = young.next(kSmall), truth = old.truth();
      of_old += testing::squared_error(one, truth, scene.output);
      of_young += testing::squared_error(other, truth, scene.output);
    }
    EXPECT_GE(testing::psnr(of_old), testing::psnr(of_young) - .05) << name_of(format);
    const Pixels last = plain.until(frames, kSmall);
    EXPECT_LE(testing::largest_difference(last, plain.truth(), scene.output), 1. / 1024) << name_of(format);
  }
}

// After 20 frames.
void expect_no_worse_than_bilinear(Extent output, std::array<double, 2> scale, Place velocity) {
  const Extent render{static_cast<int>(std::lround(output.width * scale[0])),
                      static_cast<int>(std::lround(output.height * scale[1]))};
  const TemporalScene scene = moving_scene(velocity, output);
  TemporalRun run(scene), single(scene, kBilinear);
  const Pixels pixels = run.until(20, render), alone = single.until(20, render), truth = run.truth();
  EXPECT_GE(testing::psnr(pixels, truth), testing::psnr(alone, truth))
      << render.width << "x" << render.height << " of " << output.width << "x" << output.height
      << ", velocity " << velocity;
}

TEST(TemporalRobustness, StillAtAnyScaleIsNoWorseThanBilinear) {
  for (const Extent output : {Extent{160, 96}, Extent{97, 61}, Extent{33, 17}}) {
    for (const std::array<double, 2> scale : {std::array{.33, .33},
                                              {.33, .8},
                                              {.5, .5},
                                              {.71, .45},
                                              {1., 1.},
                                              {1., .5},
                                              {1.4, 1.7},
                                              {2., 2.},
                                              {2., .6}})
      expect_no_worse_than_bilinear(output, scale, {});
  }
}

TEST(TemporalRobustness, MovingAtLowScalesIsNoWorseThanBilinear) {
  for (const Extent output : {Extent{160, 96}, Extent{97, 61}}) {
    for (const std::array<double, 2> scale : {std::array{.33, .33}, {.33, .8}, {.5, .5}})
      expect_no_worse_than_bilinear(output, scale, {.7, -.4});
  }
}

// From the smallest viewports on, a plain picture is itself.
TEST(TemporalRobustness, TinyViewportsKeepColour) {
  for (const Extent output : {Extent{4, 4}, Extent{7, 5}, Extent{33, 17}}) {
    TemporalScene scene = moving_scene({.3, .2}, output);
    scene.surfaces[0].texture = testing::plain_texture(.7f, .2f, 3);
    TemporalRun run(scene);
    const Pixels truth = scene.truth(0);
    for (int i = 0; i < 24; ++i) {
      const Extent render{1 + i * 5 % 9, 1 + i * 7 % 8};
      EXPECT_LE(testing::largest_difference(run.next(render), truth, output), 1. / 1024)
          << render.width << "x" << render.height;
    }
    for (int i = 0; i < 4; ++i)
      EXPECT_LE(testing::largest_difference(run.next({4, 4}), truth, output), 1. / 1024);
  }
}

TEST(TemporalRobustness, HalfHistoryIsAsGood) {
  for (const Place velocity : {Place(), Place(.7, -.4)}) {
    const TemporalScene scene = moving_scene(velocity);
    TemporalRun whole(scene),
        half(scene, {.method = Method::kTemporal, .temporal = {.history = PixelFormat::kRGBA16F}});
    whole.until(48), half.until(48);
    double of_float = 0, of_half = 0;
    for (int i = 0; i < 16; ++i) {
      const Pixels one = whole.next(), other = half.next(), truth = whole.truth();
      of_float += testing::squared_error(one, truth, kOutput),
          of_half += testing::squared_error(other, truth, kOutput);
    }
    EXPECT_GE(testing::psnr(of_half), testing::psnr(of_float) - .05) << velocity;
  }
}

// Cuts that nobody announces, and fine textures, which only look like one.

constexpr TemporalPreset kPresets[] = {TemporalPreset::kFast, TemporalPreset::kBalanced,
                                       TemporalPreset::kQuality};

ResolveSettings preset(TemporalPreset one) {
  return {.method = Method::kTemporal, .temporal = {.preset = one}};
}

TemporalScene drifting(Texture texture) {
  TemporalScene scene;
  scene.surfaces = {{.velocity = {.37, .21}, .texture = std::move(texture)}};
  return scene;
}

bool is_odd(double cells) {
  return std::fmod(std::floor(cells) + 4096, 2) != 0;
}

Pixel black_or_white(bool is_white) {
  const float light = is_white ? .8f : .1f;
  return {light, light, light, 1};
}

// `size` output pixels wide.
Texture stripes(double size) {
  return [size](Place place) { return black_or_white(is_odd(place.real() / size)); };
}
Texture checks(double size) {
  return [size](Place place) {
    return black_or_white(is_odd(place.real() / size) != is_odd(place.imag() / size));
  };
}

double next_error(TemporalRun& run) {
  const std::vector<Pixel> shown = run.next();
  return testing::squared_error(shown, run.truth(), run.scene().output);
}

class FineTexture : public ::testing::TestWithParam<std::pair<const char*, Texture>> {};

// Finer than the samples, which lie two pixels apart. A history of one frame then foretells samples worse than their
// neighbours do. If that counted as a cut history would never grow. Stripes of 1.6 pixels once had .41 of bilinear's
// error for it, checks of 1.3 had .7. Noise times checks as wide as the samples are apart had 2.5, because of the
// samples that judge history all showed white fields, or all black ones.
TEST_P(FineTexture, IsNoCutAndNoChangeOfLight) {
  for (const TemporalPreset one : kPresets) {
    TemporalRun run(drifting(GetParam().second), preset(one));
    TemporalRun bilinear(run.scene(), {.method = Method::kBilinear});
    run.until(16), bilinear.until(16);
    double own = 0, single = 0;
    for (int i = 0; i < 8; ++i)
      own += next_error(run), single += next_error(bilinear);
    EXPECT_LT(own, .35 * single) << static_cast<int>(one);
  }
}

INSTANTIATE_TEST_SUITE_P(TemporalCut, FineTexture,
                         ::testing::Values(std::pair{"stripes", stripes(1.6)},
                                           std::pair{"checks", checks(1.3)},
                                           std::pair{"checks_like_the_samples", testing::noise_texture(2)}),
                         [](const auto& instance) { return instance.param.first; });

// The first frame after a cut is a little worse than a first frame of all, as it is smoothed where little is known;
// with history that nobody rejects its error is five times as large.
TEST(TemporalCut, AnotherPictureLeavesNothingOfTheOldOne) {
  for (const TemporalPreset one : kPresets) {
    TemporalRun run(drifting(testing::noise_texture(9)), preset(one));
    run.until(16);
    run.scene() = drifting(testing::noise_texture(7, 5));
    TemporalRun fresh(run.scene(), preset(one));
    while (fresh.frame() < run.frame())
      fresh.skip();
    EXPECT_LT(next_error(run), 1.5 * next_error(fresh)) << static_cast<int>(one);
  }
}

}  // namespace

}  // namespace quincunx
