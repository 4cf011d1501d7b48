// SPDX-License-Identifier: MIT
// What the scenes that are hard for history show, in pixels: that they are as hard as their reason says.
#include <algorithm>
#include <cmath>

#include "catalog/scene_catalog.h"
#include "render_fixture.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{240, 134};
constexpr double kFrame = 1.0 / 60;

class HardSceneTest : public RenderTest {
 protected:
  // Two frames that follow on each other.
  void draw_two(const std::string& name) {
    Renderer renderer = renderer_of(open_scene(name).value());
    before_ = draw(renderer, view_of_size(kSize, {}, 0, -kFrame), kSize);
    now_ = draw(renderer, view_of_size(kSize, {}, kFrame, 0), kSize);
  }

  // Part of all pixels.
  template <typename Condition>
  double part(const Condition& holds) const {
    int count = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x)
        count += holds(x, y) ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(kSize.area());
  }

  float brightest(int x, int y) const {
    const glm::vec3 c = now_.rgb(x, y);
    return std::max({c.r, c.g, c.b});
  }

  Picture before_;
  Picture now_;
};

TEST_F(HardSceneTest, StillStands) {
  draw_two("still");
  EXPECT_EQ(now_.colour, before_.colour);
  EXPECT_EQ(part([this](int x, int y) { return now_.v(x, y) != glm::vec2(0); }), 0);
}

// A shadow that comes or goes changes light by more than half, where nothing moves.
TEST_F(HardSceneTest, ShadowsChangeWhatStandsStill) {
  draw_two("shadows");
  const double changed = part([this](int x, int y) {
    const float then = before_.rgb(x, y).g;
    const float ratio = now_.rgb(x, y).g / std::max(then, 1e-6f);
    return now_.v(x, y) == glm::vec2(0) && before_.v(x, y) == glm::vec2(0) && (ratio > 2 || ratio < 0.5f);
  });
  EXPECT_GT(changed, 0.01);
  EXPECT_LT(changed, 0.1);
  EXPECT_GT(part([this](int x, int y) { return now_.v(x, y) != glm::vec2(0); }), 0.05) << "the vases turn";
}

TEST_F(HardSceneTest, SparklesAreFewSmallAndFarBrighterThanWhite) {
  draw_two("sparkles");
  const auto sparkles = [this](int x, int y) { return brightest(x, y) > 20; };
  const double bright = part(sparkles);
  EXPECT_GT(bright, 0.0002);
  EXPECT_LT(bright, 0.02);
  const double alone = part([&](int x, int y) {
    const bool inside = x > 0 && y > 0 && x + 1 < kSize.width && y + 1 < kSize.height;
    return inside && sparkles(x, y) && !sparkles(x - 1, y) && !sparkles(x + 1, y) && !sparkles(x, y - 1) &&
           !sparkles(x, y + 1);
  });
  EXPECT_GT(alone, 0.5 * bright) << "most are a pixel each";
  EXPECT_GT(part([this](int x, int y) { return brightest(x, y) > 200; }), 0.0001);
  EXPECT_GT(part([&](int x, int y) { return sparkles(x, y) && now_.v(x, y) != glm::vec2(0); }), 0.8 * bright);
}

}  // namespace
}  // namespace quincunx::scenes::testing
