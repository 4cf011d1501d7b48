// SPDX-License-Identifier: MIT
// What reproject finds for the temporal upscaler: edges of motion, and reactive values around each sample.
#include <cmath>
#include <random>

#include "pass_chain.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using testing::FrameFormats;
using testing::FrameSpec;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

constexpr double kRounding = 0x1p-24;

ResolveSettings settings_for(Extent output) {
  return {.method = Method::kTemporal, .output = output, .target = output, .present = false};
}

// Runs the upscaler on a frame and gives what reproject found; null: there is no previous frame.
std::vector<Pixel> reproject(Rig& rig, PassChain& chain, const FrameInputs& now, const FrameInputs* before) {
  FrameReport report;
  chain.run(chain.frame(now, before, {}, rig.counter()), {}, report, nullptr);
  return rig.pixels(chain.newest(Resource::kReprojection), now.render);
}

TEST(TemporalReproject, ContrastMatchesTheReference) {
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const PixelFormat velocity : {PixelFormat::kRG16F, PixelFormat::kRG32F}) {
      unsigned seed = 0;
      for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{5, 7}, Extent{90, 33}}) {
        ResolveSettings settings = settings_for({129, 65});
        settings.storage = storage;
        settings.velocity = velocity;
        Rig rig;
        const FrameFormats formats{
            .storage = storage, .velocity = velocity, .with_velocity = true, .with_depth = true};
        const FrameSpec spec{.render = render,
                             .jitter = {.25f, .25f},
                             .velocity = seed % 2 == 0 ? Pattern::kNonFinite : Pattern::kNoise,
                             .seed = ++seed,
                             .outside = std::nan("")};
        const TestFrame now = make_frame(rig, formats, spec);
        PassChain chain(testing::device(), PlanFacts({.transparents = false}, settings));
        const std::vector<Pixel> moves = reproject(rig, chain, now.inputs, nullptr);
        const auto expected =
            reference::reproject(now.reference, now.reference, {.output_width = 129, .output_height = 65});
        for (std::size_t i = 0; i < moves.size(); ++i) {
          if (std::isnan(expected[i].trust)) continue;
          // Of each axis the difference, the scale and a product; two squares, their sum, a root of 3 last
          // places.
          ASSERT_NEAR(moves[i][3], expected[i].contrast, 24 * kRounding * expected[i].contrast + 0x1p-62)
              << i;
        }
      }
    }
  }
}

// An edge of motion in the first frame is known to the second, with a minus, and to no third.
TEST(TemporalReproject, ContrastOfThePreviousFrameIsNotFedOn) {
  const Extent render{12, 8};
  Rig rig;
  const auto frame = [&](double speed) {
    TestFrame made = make_frame(rig, {.with_velocity = true, .with_depth = true}, {.render = render});
    std::vector<Pixel> velocity;
    for (int i = 0; i < static_cast<int>(render.area()); ++i)
      velocity.push_back({i % render.width < 6 ? speed : 0, 0, 0, 0});
    made.inputs.velocity = rig.image(PixelFormat::kRG16F, Storage::kBuffer, render, velocity, 0);
    made.inputs.velocity_scale = {1, 1};
    return made;
  };
  PassChain chain(testing::device(), PlanFacts({.transparents = false}, settings_for({24, 16})));
  TestFrame before = frame(.0625);  // 1.5 output pixels
  bool is_first = true;
  const double expected[] = {1.5, -1.5, 0, 0};
  for (const double contrast : expected) {
    const TestFrame now = frame(contrast > 0 ? .0625 : 0);
    const std::vector<Pixel> moves = reproject(rig, chain, now.inputs, is_first ? nullptr : &before.inputs);
    is_first = false;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const std::size_t x = i % 12;
      EXPECT_EQ(moves[i][3], x == 5 || x == 6 ? contrast : 0) << i;
    }
    before = now;
  }
}

// One texel in 24, so that it matters how far around they are looked for.
void scatter_reactive(Rig& rig, TestFrame& frame, Storage storage, const FrameSpec& spec) {
  std::mt19937 random(spec.seed);
  std::vector<Pixel> reactive(static_cast<std::size_t>(spec.render.area()), Pixel{});
  for (std::size_t i = 0; i < reactive.size(); ++i) {
    if (random() % 24 == 0) reactive[i][0] = static_cast<double>(random() % 256) / 255;
    frame.reference.reactive[i] = reactive[i][0];
  }
  frame.inputs.reactive = rig.image(PixelFormat::kR8, storage, spec.render, reactive, spec.outside);
}

TEST(TemporalReproject, AnEarlierEdgeAndReactiveValuesAroundTakeTrust) {
  std::int64_t decided = 0, compared = 0, gone = 0, earlier = 0, dimmed = 0;
  unsigned seed = 40;
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{5, 7}, Extent{90, 33}}) {
      ResolveSettings settings = settings_for({129, 65});
      settings.storage = storage;
      Rig rig;
      const FrameFormats formats{
          .storage = storage, .with_velocity = true, .with_depth = true, .with_reactive = true};
      FrameSpec spec{.render = render, .velocity = Pattern::kNoise, .seed = ++seed, .outside = std::nan("")};
      TestFrame before = make_frame(rig, formats, spec);
      scatter_reactive(rig, before, storage, spec);
      spec.seed = ++seed;
      TestFrame now = make_frame(rig, formats, spec);
      scatter_reactive(rig, now, storage, spec);
      for (TestFrame* frame : {&before, &now}) {
        frame->inputs.velocity_scale = {.05f, .05f};
        frame->reference.velocity_scale = {.05f, .05f};
      }
      PassChain chain(testing::device(), PlanFacts({}, settings));
      reference::ReprojectOptions options{.reactive = true, .output_width = 129, .output_height = 65};
      for (const Pixel& move : reproject(rig, chain, before.inputs, nullptr))
        options.contrast_before.push_back(move[3]);
      const std::vector<Pixel> moves = reproject(rig, chain, now.inputs, &before.inputs);
      const auto expected = reference::reproject(now.reference, before.reference, options);
      options.reactive = false;
      const auto opaque = reference::reproject(now.reference, before.reference, options);
      for (std::size_t i = 0; i < moves.size(); ++i) {
        ++compared;
        if (expected[i].undecided) continue;
        ++decided;
        gone += expected[i].trust == 0 ? 1 : 0;
        dimmed += expected[i].trust > 0 && expected[i].trust < opaque[i].trust ? 1 : 0;
        // The place rounds by 8 * 2^-24 of the largest coordinate, and enters once on each axis; of the rest
        // each factor rounds a few times.
        const double allowed = (16 * expected[i].reach + 64) * kRounding;
        ASSERT_NEAR(moves[i][2], expected[i].trust, allowed) << render.width << " " << i;
        earlier += expected[i].contrast < 0 ? 1 : 0;
        // Of this frame it rounds as above, that of the previous one is copied.
        ASSERT_NEAR(moves[i][3], expected[i].contrast, 24 * kRounding * std::abs(expected[i].contrast))
            << render.width << " " << i;
      }
    }
  }
  EXPECT_GT(decided, compared * 3 / 4);
  EXPECT_GT(gone, 0);
  EXPECT_GT(earlier, 0);
  EXPECT_GT(dimmed, compared / 8);
}

}  // namespace
}  // namespace quincunx
