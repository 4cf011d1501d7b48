// SPDX-License-Identifier: MIT
// The findings of reproject for the temporal upscaler: motion edges, and reactive values around each sample.
#include <cmath>
#include <random>

#include "expected.h"
#include "passes/pass_chain.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using testing::FrameFormats;
using testing::FrameSpec;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

// With one layer: where there are two, layer_split goes on with what reproject wrote.
ResolveSettings settings_for(Extent output) {
  ResolveSettings settings{.method = Method::kTemporal,
                           .output_extent = output,
                           .target_extent = output,
                           .output = {.present = false}};
  settings.temporal.preset = TemporalPreset::kFast;
  return settings;
}

// Runs the upscaler on a frame and gives what reproject found; null: there is no previous frame.
std::vector<Pixel> reproject(Rig& rig, PassChain& chain, const FrameInputs& now, const FrameInputs* before) {
  FrameReport report;
  chain.run(chain.frame(now, before, {}, rig.counter()), {}, report, nullptr);
  return rig.pixels(chain.newest(Resource::kReprojection), now.render_extent);
}

TEST(TemporalReproject, MotionEdgesMatchTheReference) {
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const PixelFormat velocity : {PixelFormat::kRG16F, PixelFormat::kRG32F}) {
      unsigned seed = 0;
      for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{5, 7}, Extent{90, 33}}) {
        ResolveSettings settings = settings_for({129, 65});
        settings.targets.storage = storage;
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
        const std::vector<Pixel> reprojections = reproject(rig, chain, now.inputs, nullptr);
        const auto expected = testing::expected_reprojections(now.reference, now.reference,
                                                              {.output_width = 129, .output_height = 65});
        for (std::size_t i = 0; i < reprojections.size(); ++i) {
          if (std::isinf(expected[i].bound.motion_edge.error)) continue;
          ASSERT_NEAR(reprojections[i][3], expected[i].value.motion_edge, expected[i].bound.motion_edge.error)
              << i;
        }
      }
    }
  }
}

// A motion edge of the first frame is known to the second, with a minus, and to no third.
TEST(TemporalReproject, AMotionEdgeOfThePreviousFrameIsNotFedOn) {
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
  for (const double motion_edge : expected) {
    const TestFrame now = frame(motion_edge > 0 ? .0625 : 0);
    const std::vector<Pixel> reprojections =
        reproject(rig, chain, now.inputs, is_first ? nullptr : &before.inputs);
    is_first = false;
    for (std::size_t i = 0; i < reprojections.size(); ++i) {
      const std::size_t x = i % 12;
      EXPECT_EQ(reprojections[i][3], x == 5 || x == 6 ? motion_edge : 0) << i;
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

TEST(TemporalReproject, AnEarlierMotionEdgeAndReactiveValuesAroundTakeTrust) {
  std::int64_t decided = 0, compared = 0, gone = 0, earlier = 0, dimmed = 0;
  unsigned seed = 40;
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{5, 7}, Extent{90, 33}}) {
      ResolveSettings settings = settings_for({129, 65});
      settings.targets.storage = storage;
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
      PassChain chain(testing::device(), PlanFacts({.transparents = true}, settings));
      reference::ReprojectOptions options{.reactive = true, .output_width = 129, .output_height = 65};
      for (const Pixel& pixel : reproject(rig, chain, before.inputs, nullptr))
        options.motion_edges_before.push_back(pixel[3]);
      const std::vector<Pixel> reprojections = reproject(rig, chain, now.inputs, &before.inputs);
      const auto expected = testing::expected_reprojections(now.reference, before.reference, options);
      options.reactive = false;
      const auto opaque = testing::expected_reprojections(now.reference, before.reference, options);
      for (std::size_t i = 0; i < reprojections.size(); ++i) {
        const auto& [value, bound, undecided] = expected[i];
        ++compared;
        if (undecided) continue;
        ++decided;
        gone += value.trust == 0 ? 1 : 0;
        dimmed += value.trust > 0 && value.trust < opaque[i].value.trust ? 1 : 0;
        ASSERT_NEAR(reprojections[i][2], value.trust, bound.trust.error) << render.width << " " << i;
        earlier += value.motion_edge < 0 ? 1 : 0;
        ASSERT_NEAR(reprojections[i][3], value.motion_edge, bound.motion_edge.error)
            << render.width << " " << i;
      }
    }
  }
  EXPECT_GT(decided, compared * 3 / 4);
  EXPECT_GT(gone, 0);
  EXPECT_GT(earlier, 0);
  EXPECT_GT(dimmed, compared / 8);
}

// A wall that the camera leaves by 4 % of its distance a frame: too much for the test of depths, unless the camera's
// matrix tells of it. Walking towards it makes the test no harder.
TEST(TemporalReproject, HistoryOutlivesACameraThatWalksBackwards) {
  constexpr Extent kRender{24, 12};
  const ResolveSettings settings = settings_for({48, 24});
  const auto trust_of_wall = [&](float last_row_depth, float last_row_one, double depth_before) {
    Rig rig;
    const auto count = static_cast<std::size_t>(kRender.area());
    TestFrame before = make_frame(rig, {.with_velocity = true, .with_depth = true}, {.render = kRender});
    const auto depth = [&](double value) {
      return rig.image(PixelFormat::kR32F, Storage::kBuffer, kRender,
                       std::vector<Pixel>(count, {value, 0, 0, 1}), 0);
    };
    before.inputs.velocity =
        rig.image(PixelFormat::kRG16F, Storage::kBuffer, kRender, std::vector<Pixel>(count, {0, 0, 0, 1}), 0);
    before.inputs.depth = depth(depth_before);
    FrameInputs now = before.inputs;
    now.depth = depth(.1);
    now.camera.clip_to_previous_clip[11] = last_row_depth;
    now.camera.clip_to_previous_clip[15] = last_row_one;
    PassChain chain(testing::device(), PlanFacts({.transparents = false}, settings));
    reproject(rig, chain, before.inputs, nullptr);
    return reproject(rig, chain, now, &before.inputs)[7 * kRender.width + 11][2];
  };
  EXPECT_EQ(trust_of_wall(0, 1, .1 / .96), 0) << "no camera is known";
  EXPECT_EQ(trust_of_wall(-.4f, 1, .1 / .96), 1);
  EXPECT_EQ(trust_of_wall(-.4f, 1, .1 / .9), 0) << "that is another surface";
  EXPECT_EQ(trust_of_wall(.4f, 1, .1), 1) << "what moves along with the camera";
}

// What reproject alone finds for each sample: layer_split lowers open trust afterwards.
struct OpenReprojection {
  std::vector<float> trust;
  std::vector<Pixel> reprojections;
};

OpenReprojection open_reprojection(Rig& rig, PassChain& chain, const FrameInputs& now,
                                   const FrameInputs& before) {
  const PassFrame frame = chain.frame(now, &before, {}, rig.counter());
  PassChain::enqueue(*chain.find("reproject"), frame, nullptr);
  std::vector<float> trust(static_cast<std::size_t>(now.render_extent.area()));
  const ImageView view = frame[Resource::kOpenTrust];
  clEnqueueReadBuffer(testing::impl().queue(), view.memory, CL_TRUE, view.offset,
                      trust.size() * sizeof(float), trust.data(), 0, nullptr, nullptr);
  return {trust, rig.pixels(frame[Resource::kReprojection], now.render_extent)};
}

// It is trust without a look at depths and motion edges, and a number where nothing is known of the sample. Its sign
// tells of motion edges.
TEST(TemporalReproject, OpenTrustMatchesTheReference) {
  constexpr double kLayerMotionMin = static_cast<double>(.05f);  // px
  std::int64_t decided = 0, compared = 0, unknown = 0, hidden = 0, dimmed = 0, edges = 0;
  unsigned seed = 60;
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const PixelFormat velocity : {PixelFormat::kRG16F, PixelFormat::kRG32F}) {
      for (const bool transparents : {false, true}) {
        for (const Extent render : {Extent{1, 1}, Extent{1, 6}, Extent{9, 1}, Extent{5, 7}, Extent{90, 33}}) {
          ResolveSettings settings = settings_for({129, 65});
          settings.temporal.preset = TemporalPreset::kBalanced;
          settings.targets.storage = storage;
          settings.velocity = velocity;
          Rig rig;
          const FrameFormats formats{.storage = storage,
                                     .velocity = velocity,
                                     .with_velocity = true,
                                     .with_depth = true,
                                     .with_reactive = transparents};
          FrameSpec spec{.render = {render.width + 2, std::max(render.height - 1, 1)},
                         .jitter = {-.15f, .35f},
                         .seed = ++seed,
                         .outside = std::nan("")};
          TestFrame before = make_frame(rig, formats, spec);
          if (transparents) scatter_reactive(rig, before, storage, spec);
          spec.render = render;
          spec.jitter = {.21f, -.17f};
          spec.velocity = Pattern::kNonFinite;
          spec.seed = ++seed;
          TestFrame now = make_frame(rig, formats, spec);
          if (transparents) scatter_reactive(rig, now, storage, spec);
          PassChain chain(testing::device(), PlanFacts({.transparents = transparents}, settings));
          const auto [actual, reprojections] = open_reprojection(rig, chain, now.inputs, before.inputs);
          const auto expected = testing::expected_reprojections(
              now.reference, before.reference,
              {.reactive = transparents, .output_width = 129, .output_height = 65});
          for (std::size_t i = 0; i < actual.size(); ++i) {
            const auto& [value, bound, undecided] = expected[i];
            ++compared;
            if (undecided) continue;
            ++decided;
            const std::string what = std::to_string(render.width) + " " + std::to_string(i);
            testing::expect_near(value.open_trust, bound.open_trust, static_cast<double>(std::abs(actual[i])),
                                 what);
            if (HasFatalFailure()) return;
            const bool has_edge = std::abs(reprojections[i][3]) > kLayerMotionMin;
            edges += has_edge ? 1 : 0;
            ASSERT_EQ(std::signbit(actual[i]), has_edge) << what;
            unknown += std::isnan(value.trust) ? 1 : 0;
            hidden += value.trust == 0 && value.open_trust > 0 ? 1 : 0;
            dimmed += value.open_trust > 0 && value.open_trust < 1 ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_GT(decided, compared * 3 / 4);
  EXPECT_GT(unknown, compared / 64);
  EXPECT_GT(hidden, compared / 128);
  EXPECT_GT(dimmed, compared / 8);
  EXPECT_GT(edges, compared / 8);
}

}  // namespace
}  // namespace quincunx
