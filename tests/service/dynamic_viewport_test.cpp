// SPDX-License-Identifier: MIT
#include "quincunx/control/dynamic_viewport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace quincunx {
namespace {

DynamicViewport make(Extent output, float max_scale = 2, int step = 2, Extent floor = {8, 8}) {
  auto viewport = DynamicViewport::create(output, max_scale, step, floor);
  EXPECT_TRUE(viewport.ok()) << viewport.status().message();
  return viewport.value();
}

TEST(DynamicViewport, StartsAtTheOutput) {
  const DynamicViewport viewport = make({1280, 720});
  EXPECT_EQ(viewport.render(), (Extent{1280, 720}));
  EXPECT_EQ(viewport.ratio(), (Vec2{1, 1}));
  EXPECT_EQ(viewport.target(), (Extent{2560, 1440}));
  EXPECT_EQ(viewport.target_ratio(), (Vec2{0.5f, 0.5f}));
}

TEST(DynamicViewport, RatioIsRecomputedFromTheIntegerViewport) {
  DynamicViewport viewport = make({1280, 720});
  ASSERT_TRUE(viewport.set_scale(0.71f, 0.71f).ok());
  EXPECT_EQ(viewport.render(), (Extent{908, 512}));
  EXPECT_FLOAT_EQ(viewport.ratio().x, 908.0f / 1280);
  EXPECT_FLOAT_EQ(viewport.ratio().y, 512.0f / 720);
  EXPECT_NE(viewport.ratio().x, 0.71f);
}

TEST(DynamicViewport, ScaleOneIsExactlyTheOutputWhateverItsParity) {
  for (const Extent output : {Extent{1, 1}, {7, 5}, {257, 129}, {1280, 720}, {1279, 719}}) {
    DynamicViewport viewport = make(output);
    ASSERT_TRUE(viewport.set_scale(0.6f, 0.6f).ok());
    ASSERT_TRUE(viewport.set_scale(1, 1).ok());
    EXPECT_EQ(viewport.render(), output);
  }
}

// Every integer viewport from 1x1 to 64x64, and random large ones: kept as given, ratio exact in float.
TEST(DynamicViewport, EveryIntegerViewportIsKept) {
  DynamicViewport small = make({48, 40}, 2);
  for (int height = 1; height <= 64; ++height) {
    for (int width = 1; width <= 64; ++width) {
      ASSERT_TRUE(small.set_render({width, height}).ok());
      EXPECT_EQ(small.render(), (Extent{width, height}));
      EXPECT_EQ(small.ratio(), (Vec2{static_cast<float>(width) / 48, static_cast<float>(height) / 40}));
    }
  }
  std::mt19937 random(1);
  DynamicViewport large = make({8192, 4320}, 2);
  for (int i = 0; i < 1000; ++i) {
    const Extent render = {static_cast<int>(random() % 16384) + 1, static_cast<int>(random() % 8640) + 1};
    ASSERT_TRUE(large.set_render(render).ok());
    EXPECT_EQ(large.render(), render);
    EXPECT_FLOAT_EQ(large.target_ratio().x, static_cast<float>(render.width) / 16384);
  }
}

TEST(DynamicViewport, EveryScaleGivesTheNearestRungWithinBounds) {
  for (const Extent output : {Extent{64, 48}, {63, 47}, {1280, 720}, {9, 8}, {3, 2}}) {
    for (const int step : {1, 2, 8}) {
      DynamicViewport viewport = make(output, 2, step);
      for (int i = 1; i <= 250; ++i) {
        const float scale = static_cast<float>(i) * 0.01f;
        ASSERT_TRUE(viewport.set_scale(scale, scale).ok());
        const Extent render = viewport.render();
        EXPECT_GE(render.width, std::min(8, output.width));
        EXPECT_GE(render.height, std::min(8, output.height));
        EXPECT_LE(render.width, viewport.target().width);
        EXPECT_LE(render.height, viewport.target().height);
        EXPECT_EQ((render.width - output.width) % step, 0);
        EXPECT_EQ((render.height - output.height) % step, 0);
        const double wanted = static_cast<double>(output.width) * scale;
        const bool inside = wanted >= std::min(8, output.width) + step && wanted <= 2 * output.width - step;
        if (inside) {
          EXPECT_LE(std::abs(render.width - wanted), 0.5 * step + 1e-3) << scale;
        }
      }
    }
  }
}

TEST(DynamicViewport, AxesAreFree) {
  DynamicViewport viewport = make({1000, 1000});
  ASSERT_TRUE(viewport.set_scale(0.5f, 1.5f).ok());
  EXPECT_EQ(viewport.render(), (Extent{500, 1500}));
}

TEST(DynamicViewport, ExtremesAreClamped) {
  DynamicViewport viewport = make({1280, 720}, 1.5f);
  ASSERT_TRUE(viewport.set_scale(1e-30f, 1e30f).ok());
  EXPECT_EQ(viewport.render(), (Extent{8, 1080}));
}

TEST(DynamicViewport, BadScalesChangeNothing) {
  DynamicViewport viewport = make({1280, 720});
  ASSERT_TRUE(viewport.set_scale(0.5f, 0.5f).ok());
  for (const float bad :
       {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const Status status = viewport.set_scale(bad, 1);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("scale"), std::string::npos);
    EXPECT_EQ(viewport.render(), (Extent{640, 360}));
  }
  EXPECT_FALSE(viewport.set_render({0, 10}).ok());
  EXPECT_FALSE(viewport.set_render({2561, 10}).ok());
  EXPECT_EQ(viewport.render(), (Extent{640, 360}));
}

TEST(DynamicViewport, BadSettingsAreNamed) {
  const auto message = [](auto result) { return result.status().message(); };
  EXPECT_NE(message(DynamicViewport::create({0, 720})).find("output"), std::string::npos);
  EXPECT_NE(message(DynamicViewport::create({1280, 40000})).find("output"), std::string::npos);
  EXPECT_NE(message(DynamicViewport::create({1280, 720}, 2.5f)).find("max_scale"), std::string::npos);
  EXPECT_NE(message(DynamicViewport::create({1280, 720}, std::nanf(""))).find("max_scale"),
            std::string::npos);
  EXPECT_NE(message(DynamicViewport::create({1280, 720}, 1, 0)).find("step"), std::string::npos);
  EXPECT_NE(message(DynamicViewport::create({1280, 720}, 1, 2, {0, 8})).find("min_extent"),
            std::string::npos);
}

}  // namespace
}  // namespace quincunx
