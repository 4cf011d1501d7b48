// SPDX-License-Identifier: MIT
// What reproject finds for the temporal upscaler: motion edges, and reactive values around each sample.
#include <cmath>
#include <random>

#include "expected.h"
#include "pass_moves.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using testing::FrameFormats;
using testing::FrameSpec;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

ResolvePlan plan_for_test(Extent output) {
  ResolvePlan plan;
  plan.settings = {.method = Method::kTemporal, .output = output, .target = output};
  plan.velocity = VelocitySource::kTarget;
  return plan;
}

TEST(TemporalMoves, MotionEdgesMatchTheReference) {
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const PixelFormat velocity : {PixelFormat::kRG16F, PixelFormat::kRG32F}) {
      unsigned seed = 0;
      for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{5, 7}, Extent{90, 33}}) {
        ResolvePlan plan = plan_for_test({129, 65});
        plan.settings.storage = storage;
        plan.settings.velocity = velocity;
        Rig rig;
        const FrameFormats formats{
            .storage = storage, .velocity = velocity, .with_velocity = true, .with_depth = true};
        const FrameSpec spec{.render = render,
                             .jitter = {.25f, .25f},
                             .velocity = seed % 2 == 0 ? Pattern::kNonFinite : Pattern::kNoise,
                             .seed = ++seed,
                             .outside = std::nan("")};
        const TestFrame now = make_frame(rig, formats, spec);
        MovePass pass(testing::impl(), plan);
        pass.forget(testing::impl().queue);
        pass.enqueue(testing::impl().queue, now.inputs, now.inputs, nullptr);
        const std::vector<Pixel> moves = rig.pixels(pass.view(), render);
        const auto expected = testing::expected_reprojections(now.reference, now.reference,
                                                              {.output_width = 129, .output_height = 65});
        for (std::size_t i = 0; i < moves.size(); ++i) {
          if (std::isnan(expected[i].value.trust)) continue;
          ASSERT_NEAR(moves[i][3], expected[i].value.motion_edge, expected[i].bound.motion_edge.error) << i;
        }
      }
    }
  }
}

// A motion edge of the first frame is known to the second, with a minus, and to no third.
TEST(TemporalMoves, AMotionEdgeOfThePreviousFrameIsNotFedOn) {
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
  const cl::CommandQueue& queue = testing::impl().queue;
  MovePass pass(testing::impl(), plan_for_test({24, 16}));
  pass.forget(queue);
  TestFrame before = frame(.0625);  // 1.5 output pixels
  const double expected[] = {1.5, -1.5, 0, 0};
  for (const double motion_edge : expected) {
    const TestFrame now = frame(motion_edge > 0 ? .0625 : 0);
    pass.enqueue(queue, now.inputs, before.inputs, nullptr);
    const std::vector<Pixel> moves = rig.pixels(pass.view(), render);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const std::size_t x = i % 12;
      EXPECT_EQ(moves[i][3], x == 5 || x == 6 ? motion_edge : 0) << i;
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

TEST(TemporalMoves, AnEarlierMotionEdgeAndReactiveValuesAroundTakeTrust) {
  std::int64_t decided = 0, compared = 0, gone = 0, earlier = 0, dimmed = 0;
  unsigned seed = 40;
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{5, 7}, Extent{90, 33}}) {
      ResolvePlan plan = plan_for_test({129, 65});
      plan.settings.storage = storage;
      plan.reads_reactive = true;
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
      MovePass pass(testing::impl(), plan);
      const cl::CommandQueue& queue = testing::impl().queue;
      pass.forget(queue);
      pass.enqueue(queue, before.inputs, before.inputs, nullptr);
      reference::ReprojectOptions options{.reactive = true, .output_width = 129, .output_height = 65};
      for (const Pixel& move : rig.pixels(pass.view(), render))
        options.motion_edges_before.push_back(move[3]);
      pass.enqueue(queue, now.inputs, before.inputs, nullptr);
      const std::vector<Pixel> moves = rig.pixels(pass.view(), render);
      const auto expected = testing::expected_reprojections(now.reference, before.reference, options);
      options.reactive = false;
      const auto opaque = testing::expected_reprojections(now.reference, before.reference, options);
      for (std::size_t i = 0; i < moves.size(); ++i) {
        const auto& [value, bound, undecided] = expected[i];
        ++compared;
        if (undecided) continue;
        ++decided;
        gone += value.trust == 0 ? 1 : 0;
        dimmed += value.trust > 0 && value.trust < opaque[i].value.trust ? 1 : 0;
        ASSERT_NEAR(moves[i][2], value.trust, bound.trust.error) << render.width << " " << i;
        earlier += value.motion_edge < 0 ? 1 : 0;
        ASSERT_NEAR(moves[i][3], value.motion_edge, bound.motion_edge.error) << render.width << " " << i;
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
