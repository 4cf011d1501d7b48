// SPDX-License-Identifier: MIT
// The temporal upscaler over several frames: what must hold whatever is in them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "passes/pass_chain.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

constexpr double kRounding = 0x1p-24;
constexpr Vec2 kJitters[] = {{.25f, -.25f}, {-.125f, .375f}, {.4375f, .0625f}, {-.4f, -.3f}};

ResolveSettings settings_for(Extent output, PixelFormat history = PixelFormat::kRGBA32F) {
  ResolveSettings settings{.method = Method::kTemporal,
                           .output_extent = output,
                           .target_extent = {2 * output.width, 2 * output.height},
                           .output = {.present = false}};
  settings.temporal.history = history;
  return settings;
}

std::vector<Pixel> constant(Extent extent, const Pixel& pixel) {
  return std::vector<Pixel>(static_cast<std::size_t>(extent.area()), pixel);
}

class Sequence {
 public:
  explicit Sequence(const ResolveSettings& settings)
      : settings_(settings),
        chain_(testing::device(), PlanFacts({.transparents = false, .background = false}, settings)) {}

  // A frame of this colour; velocity is `speed` times noise.
  void run(Extent render, const std::vector<Pixel>& colour, double speed) {
    const unsigned i = count_++;
    TestFrame now = make_frame(
        rig_, {.colour = settings_.colour, .with_velocity = true, .with_depth = true},
        {.render = render, .jitter = kJitters[i % std::size(kJitters)], .seed = i, .speed = speed}, colour);
    // One surface, which hides nothing.
    now.inputs.depth =
        rig_.image(PixelFormat::kR32F, Storage::kBuffer, render, constant(render, {1, 0, 0, 0}), 0);
    const ImageView view = rig_.output(settings_.output.linear, settings_.output_extent);
    const Counter counter = rig_.counter();
    FrameReport report;
    chain_.run(chain_.frame(now.inputs, count_ == 1 ? nullptr : &before_, {.linear = view}, counter),
               {.linear = view}, report, nullptr);
    before_ = now.inputs;
    shown = rig_.pixels(view, settings_.output_extent);
    history_bytes = rig_.bytes(chain_.newest(Resource::kHistory), settings_.output_extent);
    history = testing::decode(settings_.temporal.history, history_bytes);
    non_finite = rig_.count(counter);
  }

  std::vector<Pixel> shown, history;
  std::vector<unsigned char> history_bytes;
  std::int64_t non_finite = 0;

 private:
  Rig rig_;
  ResolveSettings settings_;
  PassChain chain_;
  FrameInputs before_;
  unsigned count_ = 0;
};

// All weights mix equal values. A cubic of 16 products, a box in tone space, a Gaussian of nine and the
// sample round less than 128 times in all; what went before is kept but for a part of each frame.
TEST(TemporalPass, AConstantPictureStaysConstantUnderAnyMotion) {
  constexpr int kFrames = 12;
  for (const double speed : {0.0, .002, .02, .5}) {
    Sequence sequence(settings_for({67, 41}));
    for (int i = 0; i < kFrames; ++i) {
      const Extent render{30 + i, 23};
      sequence.run(render, constant(render, {.25, .75, .125, 1}), speed);
      for (std::size_t p = 0; p < sequence.shown.size(); ++p) {
        const double allowed = 128 * (i + 1) * kRounding;
        ASSERT_NEAR(sequence.shown[p][0], .25, allowed) << speed << " frame " << i << " pixel " << p;
        ASSERT_NEAR(sequence.shown[p][1], .75, allowed) << speed << " frame " << i << " pixel " << p;
        ASSERT_NEAR(sequence.shown[p][2], .125, allowed) << speed << " frame " << i << " pixel " << p;
        ASSERT_NEAR(sequence.shown[p][3], 1, allowed);
        ASSERT_LE(sequence.history[p][3], 32);
      }
    }
  }
}

// A frame of nothing but NaN adds nothing: where nothing moves history is what it was, bit for bit.
TEST(TemporalPass, HistoryThatStandsStillIsCopied) {
  for (const PixelFormat format : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    for (const Extent output : {Extent{64, 64}, Extent{7, 5}, Extent{257, 129}}) {
      Sequence sequence(settings_for(output, format));
      const Extent render = testing::scaled(output, .6, .7);
      std::vector<Pixel> colour = pattern_pixels(Pattern::kNoise, render, 4);
      for (Pixel& pixel : colour) {
        for (double& value : pixel)
          value = std::abs(value);
      }
      for (int i = 0; i < 4; ++i)
        sequence.run(render, colour, 0);
      const auto before = sequence.history_bytes;
      sequence.run(render, constant(render, Pixel{std::nan(""), 0, 0, 1}), 0);
      EXPECT_TRUE(before == sequence.history_bytes) << output.width << "x" << output.height;
      EXPECT_EQ(sequence.non_finite, output.area());
    }
  }
}

// Nor is anything larger than what was light ever seen, or what is less than none.
TEST(TemporalPass, WhatIsNoLightNeverReachesHistory) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double spoilt[] = {std::nan(""), -kInfinity, -1e30, std::nan("")};
  for (const PixelFormat format : {PixelFormat::kRGBA16F, PixelFormat::kRGBA32F}) {
    const Extent render{39, 20};
    ResolveSettings settings = settings_for({64, 33});
    settings.colour = format;
    Sequence sequence(settings);
    for (unsigned i = 0; i < 8; ++i) {
      std::vector<Pixel> colour = pattern_pixels(Pattern::kNoise, render, i);
      for (std::size_t p = 0; p < colour.size(); ++p) {
        for (double& value : colour[p])
          value = std::abs(value);
        if ((p * 7 + i) % 11 == 0) colour[p][p % 4] = spoilt[p % std::size(spoilt)];
      }
      sequence.run(render, colour, i % 2 == 0 ? .02 : 0);
      for (const auto& pixels : {sequence.history, sequence.shown}) {
        for (const Pixel& pixel : pixels) {
          for (std::size_t c = 0; c < 3; ++c) {
            // The light may seem to have changed, four times at most.
            ASSERT_GE(pixel[c], 0) << "frame " << i;
            ASSERT_LE(pixel[c], 4 * 3) << "frame " << i;
          }
        }
      }
    }
    EXPECT_GT(sequence.non_finite, 0);
  }
}

// From tile offsets 0 every frame takes .37 px from the left, and whole texels once it is nearer to the next.
TEST(TemporalStill, OffsetsFollowAPan) {
  const testing::TemporalStages stages({});
  Rig rig;
  testing::StageInputs in =
      stages.inputs(rig, {.output = {64, 64}, .render = {32, 40}, .previous = {32, 40}, .seed = 2});
  const double move = -.37 * 32 / 64;
  in.reference.reprojections.assign(32 * 40, {.x = move, .trust = 1});
  in.reprojection =
      rig.image(PixelFormat::kRGBA32F, Storage::kBuffer, {32, 40}, constant({32, 40}, {move, 0, 1, 0}), 0);
  in.reference.before.assign(64, {});
  const double expected[] = {.37, -.26, .11, .48, -.15, .22, -.41};
  const int steps[] = {0, 1, 0, 0, 1, 0, 1};
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    const auto made = stages.run_tiles(in).tiles;
    for (std::size_t t = 0; t < made.size(); ++t) {
      ASSERT_EQ(made[t].is_rigid, 1) << "frame " << i << " tile " << t;
      ASSERT_EQ(made[t].step_x, steps[i]);
      ASSERT_EQ(made[t].step_y, 0);
      // A move is rounded twice and its sum once, every frame.
      ASSERT_NEAR(static_cast<double>(made[t].phase_x), expected[i],
                  static_cast<double>(4 * (i + 1)) * kRounding);
      in.reference.before[t] = testing::to_reference(made[t]);
    }
  }
}

// Without history a pixel is a Gaussian of the frame, of confidence .15, which the nearest sample moves by
// its weight as if .85 more were known.
TEST(TemporalStill, AFrameAloneIsAGaussianAndItsNearestSample) {
  const testing::TemporalStages stages({.colour = PixelFormat::kRGBA32F});
  Rig rig;
  const Extent output{24, 16};
  testing::StageInputs in = stages.inputs(
      rig, {.output = output, .render = {11, 9}, .previous = {11, 9}, .colour = Pattern::kNoise, .seed = 2});
  // Below 2 no sample counts less for being bright.
  std::vector<Pixel> colour = pattern_pixels(Pattern::kNoise, {11, 9}, 3);
  for (Pixel& pixel : colour) {
    for (double& value : pixel)
      value = testing::stored_value(PixelFormat::kRGBA32F, std::abs(value) / 2);
  }
  in.frame.colour = rig.image(PixelFormat::kRGBA32F, Storage::kBuffer, {11, 9}, colour, 0);
  in.reference.history.assign(static_cast<std::size_t>(output.area()), {});
  reference::Tile moving;  // free tiles: the reach does not narrow
  const std::vector<reference::Tile> tiles(in.reference.before.size(), moving);
  in.reference.before = tiles;
  const auto actual = stages.run_resolve(rig, in, tiles).pixels;
  const auto place = [](int x, int size, int samples, double jitter) {
    return (x + .5) * samples / size - .5 - jitter;
  };
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const double u = place(x, output.width, 11, in.reference.frame.jitter_x);
      const double v = place(y, output.height, 9, in.reference.frame.jitter_y);
      const int column = static_cast<int>(std::clamp(std::lround(u), 0l, 10l));
      const int row = static_cast<int>(std::clamp(std::lround(v), 0l, 8l));
      double sum = 0, weights = 0;
      for (int i = 0; i < 9; ++i) {
        const int sx = column + i % 3 - 1, sy = row + i / 3 - 1;
        const double t = ((sx - u) * (sx - u) + (sy - v) * (sy - v)) * 2.5;
        const double weight = std::pow(std::max(1 - t / 8, 0.0), 8);
        sum +=
            weight * colour[static_cast<std::size_t>(std::clamp(sy, 0, 8) * 11 + std::clamp(sx, 0, 10))][1];
        weights += weight;
      }
      const double dx = (u - column) * output.width / 11, dy = (v - row) * output.height / 9;
      const double near = std::max(1 - (dx * dx + dy * dy) / (1.05 * 1.05), 0.0);
      const double nearest = colour[static_cast<std::size_t>(row * 11 + column)][1];
      const double smooth = sum / weights;
      const double expected = smooth + (nearest - smooth) * near * near / (.15 + .85 + near * near);
      const auto i = static_cast<std::size_t>(y * output.width + x);
      // Weights of eighth power of places that round by 2^-24 of 2, times 9 in a mean of values below 2.
      const double allowed = 9 * 8 * 4 * 2 * kRounding;
      ASSERT_NEAR(actual[i][1], expected, allowed) << x << ", " << y;
      ASSERT_NEAR(actual[i][3], .15 + near * near, allowed) << x << ", " << y;
    }
  }
}

// Left of its middle the frame is red and moves, right of it it is green and stands.
testing::StageInputs two_surfaces(Rig& rig, const testing::TemporalStages& stages, double speed,
                                  double trust) {
  constexpr Extent kRender{12, 8};
  testing::StageInputs in = stages.inputs(rig, {.output = {24, 16}, .render = kRender, .previous = kRender});
  std::vector<Pixel> colour, moves;
  in.reference.reprojections.clear();
  for (int i = 0; i < static_cast<int>(kRender.area()); ++i) {
    const bool left = i % kRender.width < kRender.width / 2;
    colour.push_back(left ? Pixel{1, 0, 0, 1} : Pixel{0, 1, 0, 1});
    moves.push_back({left ? speed / 2 : 0, 0, trust, 0});
  }
  in.frame.colour = rig.image(PixelFormat::kRGBA16F, Storage::kBuffer, kRender, colour, 0);
  in.reprojection = rig.image(PixelFormat::kRGBA32F, Storage::kBuffer, kRender, moves, 0);
  in.reference.before.assign(in.reference.before.size(), {});
  return in;
}

// A fresh pixel takes next to nothing from samples that move otherwise, and what a Gaussian has from all others.
TEST(TemporalStill, AFreshPixelShowsOneSurface) {
  const testing::TemporalStages stages({});
  Rig rig;
  double largest[2] = {};
  for (const bool apart : {false, true}) {
    testing::StageInputs in = two_surfaces(rig, stages, apart ? 3 : .01, 1);
    in.reference.history.assign(in.reference.history.size(), {});
    for (const Pixel& pixel : stages.run_resolve(rig, in, in.reference.before).pixels) {
      EXPECT_NEAR(pixel[0] + pixel[1], 1, 32 * kRounding);
      largest[apart ? 1 : 0] = std::max(largest[apart ? 1 : 0], std::min(pixel[0], pixel[1]));
    }
  }
  // Three of the nine samples are the other surface's, and nearer than the own three of the far side.
  EXPECT_GT(largest[0], .05);
  // Each of those counts 2^-10 of what it did, of a sum that is more than half of what it was.
  EXPECT_LT(largest[1], largest[0] / 0x1p9);
}

// Without trust the pixel is as without history, whatever history holds and however sure it is.
TEST(TemporalStill, WithoutTrustNothingOfHistoryIsLeft) {
  const testing::TemporalStages stages({});
  Rig rig;
  testing::StageInputs in = two_surfaces(rig, stages, 3, 0);
  const auto with = stages.run_resolve(rig, in, in.reference.before).pixels;
  in.reference.history.assign(in.reference.history.size(), {});
  const auto without = stages.run_resolve(rig, in, in.reference.before).pixels;
  for (std::size_t i = 0; i < with.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      // The replacement of history is added to it as a difference: of values below 4, once each.
      EXPECT_NEAR(with[i][c], without[i][c], 2 * 4 * kRounding) << i << " " << c;
    }
  }
}

}  // namespace
}  // namespace quincunx
