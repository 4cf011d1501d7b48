// SPDX-License-Identifier: MIT
#include "../reference/measure_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <random>

#include "kernel_fixture.h"
#include "pass_rig.h"
#include "passes/pass_measure.h"
#include "picture_params.h"
#include "temporal/tile.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

constexpr double kSpeedUnits = 16;

struct Variant {
  Storage storage;
  PixelFormat velocity;
  bool reactive;
  bool judged = false;
};

class MeasureContent : public ::testing::TestWithParam<Variant> {
 protected:
  MeasureContent() {
    settings_.targets.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    settings_.control.measures_content = true;
    settings_.method = GetParam().judged ? Method::kTemporal : Method::kBilinear;
    pass_ = std::make_unique<PassRig>(SceneNeeds{.transparents = GetParam().reactive}, settings_,
                                      "measure_content");
  }

  static std::size_t temporal_tiles(Extent output) {
    const int tiles_x = (output.width + kTemporalTile - 1) / kTemporalTile;
    const int tiles_y = (output.height + kTemporalTile - 1) / kTemporalTile;
    return static_cast<std::size_t>(tiles_x * tiles_y);
  }

  // Those of the judge, seeded: 1 in some tiles, less in all others. Empty: nobody judges.
  std::vector<double> confirmations(Extent output, unsigned seed) const {
    if (!GetParam().judged) return {};
    std::mt19937 random(seed);
    std::vector<double> all(temporal_tiles(output));
    for (double& confirmation : all) {
      const unsigned value = random() % 32;
      confirmation = value < 2 ? 1 : value / 32.0;
    }
    return all;
  }

  testing::FrameFormats formats() const {
    return {.storage = settings_.targets.storage,
            .velocity = settings_.velocity,
            .with_velocity = true,
            .with_depth = true,
            .with_reactive = true};
  }

  // `confirmations`: one for each tile; empty: 0.
  ContentSums run(const FrameInputs& inputs, Extent output, const std::vector<double>& confirmations = {}) {
    const cl::Buffer sums(testing::impl().context, CL_MEM_READ_WRITE, sizeof(ContentSums));
    const ImageView view = {.memory = sums(), .extent = {1, 1}};
    std::vector<TileLight> tiles(temporal_tiles(output));
    for (std::size_t i = 0; i < confirmations.size(); ++i)
      tiles[i].confirmation = static_cast<float>(confirmations[i]);
    const cl::Buffer light(testing::impl().context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                           tiles.size() * sizeof(TileLight), tiles.data());
    const ImageView judged = {.memory = light(), .extent = {static_cast<int>(tiles.size()), 1}};
    pass_->run(inputs, {}, output, {}, {{Resource::kContentSums, view}, {Resource::kTileLight, judged}});
    ContentSums counted;
    testing::impl().queue.enqueueReadBuffer(sums, CL_TRUE, 0, sizeof(counted), &counted);
    return counted;
  }

  // Counts are exact where no decision is close, speed is rounded once a tile.
  void compare(const TestFrame& frame, Extent output, const std::string& what) {
    const std::vector<double> confirmed = confirmations(output, static_cast<unsigned>(output.area()));
    const ContentSums sums = run(frame.inputs, output, confirmed);
    const reference::ContentCounts expected = reference::measure_content(
        frame.reference, output.width, output.height, GetParam().reactive, confirmed);
    ASSERT_GT(expected.margin, 1) << what << ": a decision is too close to tell; choose another seed";
    EXPECT_EQ(sums.moving, expected.moving) << what;
    EXPECT_EQ(sums.apart, expected.apart) << what;
    EXPECT_EQ(sums.thin, expected.thin) << what;
    EXPECT_EQ(sums.light, expected.light) << what;
    EXPECT_EQ(sums.zoom, expected.zoom) << what;
    EXPECT_EQ(sums.judged, expected.judged) << what;
    EXPECT_NEAR(sums.speed / kSpeedUnits, expected.speed,
                .5 / kSpeedUnits * static_cast<double>(expected.tiles) + expected.speed * 0x1p-17)
        << what;
  }

  // A frame of uv velocities and depths by hand.
  TestFrame frame_of(Rig& rig, Extent render,
                     const std::function<Pixel(int, int)>& velocity_and_depth) const {
    TestFrame frame = make_frame(rig, formats(), {.render = render});
    std::vector<Pixel> velocity, depth, reactive(static_cast<std::size_t>(render.area()));
    for (int y = 0; y < render.height; ++y) {
      for (int x = 0; x < render.width; ++x) {
        const Pixel pixel = velocity_and_depth(x, y);
        velocity.push_back({pixel[0], pixel[1], 0, 0});
        depth.push_back({pixel[2], 0, 0, 0});
      }
    }
    frame.inputs.velocity = rig.image(settings_.velocity, settings_.targets.storage, render, velocity, 0);
    frame.inputs.depth = rig.image(PixelFormat::kR32F, settings_.targets.storage, render, depth, 0);
    frame.inputs.reactive = rig.image(PixelFormat::kR8, settings_.targets.storage, render, reactive, 0);
    return frame;
  }

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
};

TEST_P(MeasureContent, MatchesTheReference) {
  unsigned seed = 20;
  for (const Extent output : {Extent{1, 1}, {7, 5}, {64, 64}, {257, 129}}) {
    for (const Vec2 scale : {Vec2{1, 1}, {.5f, .7f}, {.31f, 1.2f}}) {
      const Extent render =
          testing::scaled(output, static_cast<double>(scale.x), static_cast<double>(scale.y));
      for (const Pattern pattern : {Pattern::kConstant, Pattern::kImpulse, Pattern::kNoise}) {
        for (const double speed : {.0217, .00231}) {
          Rig rig;
          const TestFrame frame = make_frame(
              rig, formats(), {.render = render, .velocity = pattern, .seed = ++seed, .speed = speed});
          compare(frame, output,
                  fmt::format("{} {}x{} of {}x{}", testing::name_of(pattern), render.width, render.height,
                              output.width, output.height));
          if (HasFailure()) return;
        }
      }
    }
  }
}

// By hand, at 4 tiles of 32 pixels: a still picture, a pan, a zoom, a box that moves before a wall, wires before it.
TEST_P(MeasureContent, TellsWhatThePictureDoes) {
  const Extent output{64, 64};
  Rig rig;
  const auto measure = [&](const std::function<Pixel(int, int)>& velocity_and_depth) {
    return statistics_of(run(frame_of(rig, output, velocity_and_depth).inputs, output), output);
  };
  const double pixel = 1.0 / 64;
  const ContentStatistics still = measure([](int, int) { return Pixel{0, 0, .1, 0}; });
  EXPECT_EQ(still.moving + still.apart + still.thin + still.light + still.zoom, 0);

  const ContentStatistics pan = measure([&](int, int) { return Pixel{2 * pixel, 0, .1, 0}; });
  EXPECT_EQ(pan.moving, 1);
  EXPECT_NEAR(pan.speed_px, 2, 1e-2);
  EXPECT_EQ(pan.apart + pan.thin + pan.zoom, 0);

  const ContentStatistics zoom = measure([&](int x, int y) {
    return Pixel{(x - 31.5) * .02 * pixel, (y - 31.5) * .02 * pixel, .1, 0};
  });
  EXPECT_EQ(zoom.zoom, zoom.moving);
  EXPECT_GT(zoom.zoom, .4);

  const ContentStatistics box = measure([&](int x, int y) {
    const bool inside = x >= 8 && x < 24 && y >= 8 && y < 24;
    return Pixel{inside ? 2 * pixel : 0, 0, inside ? .2 : .1, 0};
  });
  EXPECT_EQ(box.apart, .25) << "one tile of four";
  EXPECT_EQ(box.thin, 0);

  const ContentStatistics wires = measure([&](int x, int) {
    const bool wire = x % 16 == 6 || x % 16 == 7;
    return Pixel{wire ? 2 * pixel : 0, 0, wire ? .2 : .1, 0};
  });
  EXPECT_EQ(wires.thin, 1);
}

TEST_P(MeasureContent, NonFiniteInputsGiveSharesWithinTheirRange) {
  Rig rig;
  const Extent output{100, 70};
  const TestFrame frame =
      make_frame(rig, formats(), {.render = output, .velocity = Pattern::kNonFinite, .seed = 3});
  EXPECT_TRUE(check(statistics_of(run(frame.inputs, output), output)).ok());
}

TEST_P(MeasureContent, PoisonOutsideTheViewportAndTightImagesChangeNoBit) {
  for (const Extent render : {Extent{1, 1}, {5, 3}, {33, 21}}) {
    const auto counted = [&](double outside, bool tight) {
      Rig rig;
      const TestFrame frame =
          make_frame(rig, formats(), {.render = render, .seed = 9, .outside = outside, .tight = tight});
      const ContentSums sums = run(frame.inputs, {48, 40});
      return std::array<unsigned, 6>{sums.moving, sums.speed, sums.apart, sums.thin, sums.light, sums.zoom};
    };
    const auto clean = counted(0, false);
    EXPECT_EQ(clean, counted(std::numeric_limits<double>::quiet_NaN(), false));
    EXPECT_EQ(clean, counted(std::numeric_limits<double>::infinity(), false));
    EXPECT_EQ(clean, counted(0, true));
  }
}

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const bool reactive : {true, false}) {
    all.push_back({Storage::kBuffer, PixelFormat::kRG16F, reactive, true});
    all.push_back({Storage::kBuffer, PixelFormat::kRG16F, reactive});
    all.push_back({Storage::kBuffer, PixelFormat::kRG32F, reactive});
    all.push_back({Storage::kImage, PixelFormat::kRG16F, reactive});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, MeasureContent, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(), [](const Variant& v) {
                           return fmt::format("{}_{}{}{}", v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.velocity), v.reactive ? "_reactive" : "",
                                              v.judged ? "_judged" : "");
                         }));

}  // namespace
}  // namespace quincunx
