// SPDX-License-Identifier: MIT
#include "render/truth.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render_fixture.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{64, 36};

// A tilted white bar on black: edges at all sub-pixel places.
Scene bar_scene(Motion motion) {
  Scene scene;
  scene.materials = {unlit({1, 1, 1, 1})};
  scene.meshes = {plate({0.4f, 0.9f}, 0)};
  scene.instances.push_back(
      {0, glm::rotate(glm::translate(glm::mat4(1), glm::vec3(0, 0, -3)), 0.3f, glm::vec3(0, 0, 1)),
       std::move(motion)});
  scene.sky.background = Background::kPlain;
  scene.sky.zenith = glm::vec3(0);
  scene.camera = fixed_camera({0, 0, 0}, {0, 0, -1});
  return scene;
}

std::vector<float> truth_of(Renderer& renderer, int samples, double shutter = 0, double seconds = 0) {
  TruthSettings settings;
  settings.output = kSize;
  settings.samples = samples;
  settings.shutter_seconds = shutter;
  Result<std::vector<float>> truth = render_truth(renderer, settings, seconds);
  EXPECT_TRUE(truth.ok()) << truth.status().message();
  return truth.ok() ? truth.value() : std::vector<float>();
}

double difference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    differences.push_back(a[i] - b[i]);
  return rms(differences);
}

using TruthTest = RenderTest;

TEST_F(TruthTest, IsTheMeanOfJitteredFrames) {
  constexpr int kSide = 3;
  Renderer renderer = renderer_of(bar_scene({}));
  const std::vector<float> truth = truth_of(renderer, kSide);
  std::vector<double> mean(truth.size());
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const auto place = [](int k) { return (static_cast<float>(k) + 0.5f) / kSide - 0.5f; };
      FrameView view = view_of_size(kSize, {place(i), place(j)});
      view.lod_bias = -std::log2(static_cast<float>(kSide));
      const Picture picture = draw(renderer, view, kSize);
      for (std::size_t k = 0; k < mean.size(); ++k)
        mean[k] += static_cast<double>(picture.colour[k]) / (kSide * kSide);
    }
  }
  ASSERT_EQ(truth.size(), static_cast<std::size_t>(kSize.area()) * 4);
  for (std::size_t k = 0; k < mean.size(); ++k)
    ASSERT_NEAR(truth[k], mean[k], 1e-6);  // nine sums in float
}

TEST_F(TruthTest, Converges) {
  Renderer renderer = renderer_of(bar_scene({}));
  const std::vector<float> one = truth_of(renderer, 1), two = truth_of(renderer, 2),
                           four = truth_of(renderer, 4), eight = truth_of(renderer, 8);
  EXPECT_LT(difference(four, two), 0.7 * difference(two, one));
  EXPECT_LT(difference(eight, four), 0.7 * difference(four, two));
  EXPECT_GT(difference(eight, four), 0.0);
}

TEST_F(TruthTest, KeepsTheBarsArea) {
  // The bar covers focal^2 / (aspect * 3^2) * (.4 * .9) of the viewport's half extents.
  Renderer renderer = renderer_of(bar_scene({}));
  const std::vector<float> truth = truth_of(renderer, 8);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); i += 4)
    sum += truth[i];
  const double focal = 1 / std::tan(0.5), aspect = static_cast<double>(kSize.width) / kSize.height;
  const double expected = static_cast<double>(kSize.area()) * focal * focal / aspect / 9 * 0.4 * 0.9;
  EXPECT_NEAR(sum / expected, 1, 0.002);
}

TEST_F(TruthTest, ShutterSpreadsAMovingBarAlongItsWay) {
  constexpr double kSpeed = 2, kShutter = 0.5;  // metres a second to the right, open until time 0
  const auto upright = [=](double t) {
    return glm::translate(glm::mat4(1), glm::vec3(static_cast<float>(kSpeed * (t + kShutter / 2)), 0, -3));
  };
  Renderer renderer = renderer_of(bar_scene(upright));
  const std::vector<float> truth = truth_of(renderer, 8, kShutter);
  // On the middle row: the bar's box, .8 m wide, convolved with its way of 1 m: a trapezoid about the centre.
  const double focal = 1 / std::tan(0.5), aspect = static_cast<double>(kSize.width) / kSize.height;
  const double metres_per_pixel = 2 / (kSize.width * focal / aspect / 3);
  for (int x = 0; x < kSize.width; ++x) {
    const double from_centre = (x + 0.5 - kSize.width / 2.0) * metres_per_pixel;
    const double way = kSpeed * kShutter, half = 0.4;
    const double inside = std::min(from_centre + half, way / 2) - std::max(from_centre - half, -way / 2);
    const double expected = std::clamp(inside / way, 0.0, 1.0);
    const std::size_t i = (static_cast<std::size_t>(kSize.height / 2) * kSize.width + x) * 4;
    // 64 samples in place and time: an edge is off by a few of them, and by the pixel's own width at the
    // corners.
    ASSERT_NEAR(truth[i], expected, 4.0 / 64) << "column " << x;
  }
}

TEST_F(TruthTest, StillSceneDoesNotFeelTheShutterAndCallsAgree) {
  Renderer renderer = renderer_of(bar_scene({}));
  const std::vector<float> sharp = truth_of(renderer, 4), open = truth_of(renderer, 4, 0.5),
                           again = truth_of(renderer, 4);
  EXPECT_EQ(sharp, open);
  EXPECT_EQ(sharp, again);
}

TEST_F(TruthTest, AWindowIsThatPartOfThePicture) {
  Renderer renderer = renderer_of(bar_scene({}));
  const std::vector<float> whole = truth_of(renderer, 4);
  constexpr int kX = 20, kY = 9;
  constexpr Extent kPart = {24, 18};
  const glm::dvec2 picture(kSize.width, kSize.height);
  const auto part =
      render_truth(renderer,
                   {.output = kPart,
                    .samples = 4,
                    .window = {glm::dvec2(kX, kY) / picture, glm::dvec2(kPart.width, kPart.height) / picture},
                    .aspect = static_cast<float>(kSize.width) / kSize.height},
                   0);
  ASSERT_TRUE(part.ok()) << part.status().message();
  int edges = 0;
  for (int y = 0; y < kPart.height; ++y) {
    for (int x = 0; x < kPart.width; ++x) {
      const float expected = whole[static_cast<std::size_t>((y + kY) * kSize.width + x + kX) * 4];
      edges += expected > 0 && expected < 1;
      // Rounded otherwise, at most one of 16 samples on an edge changes sides.
      EXPECT_NEAR(part.value()[static_cast<std::size_t>(y * kPart.width + x) * 4], expected, 1.001 / 16)
          << x << ", " << y;
    }
  }
  EXPECT_GT(edges, 10) << "a part with nothing in it shows nothing";
}

TEST_F(TruthTest, BadSettingsAreRefusedByName) {
  Renderer renderer = renderer_of(bar_scene({}));
  const auto code_of = [&](TruthSettings settings) {
    return render_truth(renderer, settings, 0).status().code();
  };
  EXPECT_EQ(code_of({.output = {0, 4}}), StatusCode::kInvalidArgument);
  EXPECT_EQ(code_of({.output = kSize, .samples = 0}), StatusCode::kInvalidArgument);
  EXPECT_EQ(code_of({.output = kSize, .shutter_seconds = -1}), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace quincunx::scenes::testing
