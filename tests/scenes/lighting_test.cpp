// SPDX-License-Identifier: MIT
// Light, shadows, cut-outs, and that cutting meshes changes no picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <random>

#include "render/scene_layout.h"
#include "render_fixture.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{96, 54};

glm::mat4 at(float x, float y, float z) {
  return glm::translate(glm::mat4(1), glm::vec3(x, y, z));
}
glm::mat4 lying(const glm::mat4& place) {
  return glm::rotate(place, -1.5707963f, glm::vec3(1, 0, 0));
}

// A white floor seen from straight above, under a sun at the zenith; no sky light.
Scene floor_scene() {
  Scene scene;
  Material white;
  white.base_colour = {1, 1, 1, 1};
  scene.materials = {white};
  scene.meshes = {plate({4, 4}, 0, 48), plate({0.5f, 0.5f}, 0)};
  scene.instances.push_back({0, lying(glm::mat4(1)), {}});
  scene.sky.zenith = scene.sky.horizon = scene.sky.ground = glm::vec3(0);
  scene.sun.direction = {0, -1, 0};
  scene.sun.irradiance = glm::vec3(3.14159265f);
  scene.camera = [](double) {
    Camera camera;
    camera.world_from_camera = lying(at(0, 5, 0));  // looks along -y, up is -z
    camera.vertical_fov = 0.8f;
    return camera;
  };
  return scene;
}

class LightingTest : public RenderTest {
 protected:
  static Picture picture_of(const Scene& scene) {
    Renderer renderer = renderer_of(scene);
    return draw(renderer, view_of_size(kSize), kSize);
  }
};

TEST_F(LightingTest, SunlightOnARoughWhiteFloorIsNearOne) {
  // Lambert: irradiance pi on albedo 1 gives radiance 1. The specular lobe of a fully rough surface adds at
  // most F0 a^2 / (2 d^2 (1 + l.v)(r + .5)) = .04 / (2 * 2 * 1.5) = .007.
  const Picture picture = picture_of(floor_scene());
  const glm::vec3 centre = picture.rgb(kSize.width / 2, kSize.height / 2);
  EXPECT_GT(centre.g, 0.999f);
  EXPECT_LT(centre.g, 1.01f);
}

// A plate is its own mirror image.
TEST_F(LightingTest, AMirroredInstanceIsLitLikeItsTwin) {
  Scene scene = floor_scene();
  scene.instances = {{1, at(-1, 0, 0), {}}, {1, glm::scale(at(1, 0, 0), glm::vec3(-1, 1, 1)), {}}};
  scene.sun.direction = {0, -0.6f, -0.8f};
  scene.sun.casts_shadows = false;
  scene.camera = fixed_camera({0, 0, 4}, {0, 0, 0}, 0.8f);
  const Picture picture = picture_of(scene);
  int lit = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width / 2; ++x) {
      const float own = picture.rgb(x, y).g;
      EXPECT_NEAR(picture.rgb(kSize.width - 1 - x, y).g, own, 1e-3f) << x << ", " << y;
      lit += own > 0.7f ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 50);
}

// Lifted off the shadow map along the normal that is seen, the back is not in its own shadow.
TEST_F(LightingTest, TheBackOfADoubleSidedSurfaceIsLitLikeItsFront) {
  Scene scene = floor_scene();
  scene.materials[0].double_sided = true;
  scene.sun.direction = {0.3f, -0.5f, -0.8f};
  scene.camera = fixed_camera({0, 0, 2}, {0, 0, 0}, 0.8f);
  scene.instances = {{1, glm::mat4(1), {}}};
  const Picture front = picture_of(scene);
  scene.instances[0].transform = glm::rotate(glm::mat4(1), 3.14159265f, glm::vec3(0, 1, 0));
  const Picture back = picture_of(scene);
  int lit = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      EXPECT_NEAR(back.rgb(x, y).g, front.rgb(x, y).g, 0.01f) << x << ", " << y;
      lit += front.rgb(x, y).g > 0.5f ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 500);
}

TEST_F(LightingTest, ShadowLiesUnderItsCasterAndFollowsIt) {
  Scene scene = floor_scene();
  scene.instances.push_back(
      {1, glm::mat4(1), [](double t) { return lying(at(static_cast<float>(t), 1, 0)); }});
  scene.camera = [](double) {  // from the side, so that the caster does not hide its shadow
    Camera camera;
    camera.world_from_camera = look_from({0, 4, 6}, {0, 0, 0});
    camera.vertical_fov = 0.8f;
    return camera;
  };
  const auto darkest_column = [](const Picture& picture) {
    constexpr float kInShadow = 0.5f;
    const int y = kSize.height / 2;  // the row of the world's centre line
    float sum = 0, count = 0;
    for (int x = 0; x < kSize.width; ++x) {
      const bool floor = picture.depth[picture.index(x, y)] > 0;
      if (floor && picture.rgb(x, y).g < kInShadow) sum += static_cast<float>(x), ++count;
    }
    return count > 3 ? static_cast<int>(sum / count) : -1;
  };
  const auto column_of = [](float world_x) {
    const double focal = 1 / std::tan(0.4), aspect = static_cast<double>(kSize.width) / kSize.height;
    return kSize.width * (0.5 + 0.5 * focal / aspect * static_cast<double>(world_x) / std::sqrt(52.0));
  };
  Renderer renderer = renderer_of(scene);
  for (const double t : {-0.5, 0.75, -0.5}) {
    const Picture picture = draw(renderer, view_of_size(kSize, {}, t, t), kSize);
    EXPECT_NEAR(darkest_column(picture), column_of(static_cast<float>(t)), 2) << "time " << t;
  }
  scene.sun.casts_shadows = false;
  EXPECT_EQ(darkest_column(picture_of(scene)), -1);
}

TEST_F(LightingTest, WhatIsCutOutCastsNoShadow) {
  Scene scene = floor_scene();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].alpha_mode = AlphaMode::kMask;
  scene.meshes[1].material = 1;
  scene.instances.push_back({1, lying(at(0, 1, 0)), {}});
  const auto darkest = [&] {
    const Picture picture = picture_of(scene);
    float least = 1;
    for (int i = 0; i < kSize.area(); ++i)
      least = std::min(least, picture.rgb(i % kSize.width, i / kSize.width).g);
    return least;
  };
  scene.materials[1].base_colour.a = 0.4f;
  EXPECT_GT(darkest(), 0.5f) << "by its factor";
  scene.materials[1].base_colour.a = 1;
  for (Vertex& vertex : scene.meshes[1].vertices)
    vertex.colour.a = 0.4f;
  EXPECT_GT(darkest(), 0.5f) << "by its vertices";
}

TEST_F(LightingTest, DistantHillsTakeNoTexelsFromTheShadowMap) {
  Scene scene = floor_scene();
  scene.instances.push_back({1, lying(at(0, 1, 0)), {}});
  scene.meshes.push_back(plate({0.6f, 0.6f}, 0, 24));  // most of the triangles are near
  scene.instances.push_back({2, at(0, 0.6f, -1), {}});
  const ShadowFit near_only = lay_out(scene).shadow;
  scene.meshes.push_back(plate({400, 60}, 0));
  scene.instances.push_back({3, at(0, 60, -900), {}});
  const ShadowFit with_hills = lay_out(scene).shadow;
  EXPECT_GT(near_only.texel_metres, 0);
  EXPECT_LT(with_hills.texel_metres, 2 * near_only.texel_metres);
}

TEST_F(LightingTest, PointLightFallsWithTheSquareAndEndsAtItsRange) {
  Scene scene = floor_scene();
  scene.sun.irradiance = glm::vec3(0);
  const auto brightness = [&](float height, float range) {
    scene.lights = {{{0, height, 0}, glm::vec3(1), range}};
    return picture_of(scene).rgb(kSize.width / 2, kSize.height / 2).g;
  };
  EXPECT_NEAR(brightness(1, 1000) / brightness(2, 1000), 4, 0.05f);
  EXPECT_GT(brightness(1.9f, 2), 0);
  EXPECT_EQ(brightness(2.1f, 2), 0);
}

TEST_F(LightingTest, CuttingAMeshForItsLightsChangesNoPicture) {
  Scene whole = floor_scene();
  whole.lights = {
      {{-2, 0.5f, 0}, {1, 0, 0}, 1.5f}, {{2, 0.5f, 0}, {0, 1, 0}, 1.5f}, {{0, 0.5f, 1}, {0, 0, 1}, 1}};
  Scene twice = whole;  // a second copy far below keeps the mesh in one piece
  twice.instances.push_back({0, at(0, -500, 0), {}});
  EXPECT_GT(lay_out(whole).parts.size(), lay_out(twice).parts.size() + 4);
  const Picture a = picture_of(whole), b = picture_of(twice);
  // The same lights in the same order; lights that add nothing are left out. An ulp of half float for the
  // compiler.
  for (std::size_t i = 0; i < a.colour.size(); ++i)
    ASSERT_NEAR(a.colour[i], b.colour[i], 1.0f / 1024);
  EXPECT_GT(*std::max_element(a.colour.begin(), a.colour.end()), 0.5f);
}

TEST(MeshParts, KeepEveryTriangleOnce) {
  const Mesh mesh = plate({4, 3}, 0, 40);
  const MeshParts parts = split_mesh(mesh, {.few = 50, .many = 400, .metres = 2});
  EXPECT_GT(parts.counts.size(), 8u);
  std::map<std::array<std::uint32_t, 3>, int> seen;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    ++seen[{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}];
  }
  ASSERT_EQ(parts.indices.size(), mesh.indices.size());
  for (std::size_t i = 0; i < parts.indices.size(); i += 3) {
    --seen[{parts.indices[i], parts.indices[i + 1], parts.indices[i + 2]}];
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](const auto& entry) { return entry.second == 0; }));
  std::size_t sum = 0;
  for (const std::uint32_t count : parts.counts)
    sum += count;
  EXPECT_EQ(sum, parts.indices.size());
  EXPECT_TRUE(split_mesh(Mesh(), {}).counts.empty());
}

// The part of a distant leaf wall that is drawn.
double covered(Renderer& renderer, float distance_bias) {
  FrameView view = view_of_size(kSize);
  view.lod_bias = distance_bias;
  const Picture picture = draw(renderer, view, kSize);
  double leaves = 0;
  for (int i = 0; i < kSize.area(); ++i)
    leaves += picture.colour[static_cast<std::size_t>(4 * i) + 1] > 0.5f;
  return leaves / static_cast<double>(kSize.area());
}

TEST_F(LightingTest, CutOutsKeepTheirCoverageWithDistance) {
  // Discs of many sizes all over: alpha averages to what they cover, which plain mip levels would cut away.
  Texture dots;
  dots.width = dots.height = 128;
  dots.rgba.resize(128 * 128 * 4);
  std::uint32_t random = 1;
  const auto next = [&](std::uint32_t range) {
    random = random * 1664525u + 1013904223u;
    return static_cast<int>((random >> 16) % range);
  };
  for (int disc = 0; disc < 60; ++disc) {
    const int cx = next(128), cy = next(128), radius = 3 + next(8);
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        const auto texel = static_cast<std::size_t>(((cy + y) & 127) * 128 + ((cx + x) & 127));
        if (x * x + y * y <= radius * radius) dots.rgba[4 * texel + 3] = 255;
      }
    }
  }
  for (std::size_t i = 1; i < dots.rgba.size(); i += 4)
    dots.rgba[i] = 255;
  Scene scene;
  scene.textures = {dots};
  scene.materials = {unlit(glm::vec4(1))};
  scene.materials[0].alpha_mode = AlphaMode::kMask;
  scene.materials[0].base_colour_texture.texture = 0;
  scene.materials[0].base_colour_texture.transform =
      glm::mat3(glm::vec3(4, 0, 0), glm::vec3(0, 4, 0), glm::vec3(0, 0, 1));
  scene.meshes = {plate({3, 3}, 0)};
  scene.instances.push_back({0, at(0, 0, -3), {}});
  scene.sky.background = Background::kPlain;
  scene.sky.zenith = glm::vec3(0);
  scene.camera = fixed_camera({0, 0, 0}, {0, 0, -1});
  Renderer renderer = renderer_of(scene);
  const double sharp = covered(renderer, -8);
  EXPECT_GT(sharp, 0.2);
  EXPECT_LT(sharp, 0.8);
  // Levels are matched at their texels; filters between them and the picture's few pixels leave some
  // hundredths.
  constexpr double kCoverage = 0.06;
  for (const float bias : {0.0f, 1.0f, 2.0f}) {
    EXPECT_NEAR(covered(renderer, bias), sharp, kCoverage) << "bias " << bias;
  }
}

// The part of the shadow map that is in use: what it shows, and that nothing else of the map is ever seen.

constexpr Extent kShadowSize{160, 90};

// A white floor under slats, which move or stand still; the floor goes on far beyond the shadow map.
Scene slats_scene(bool moving) {
  Scene scene;
  Material white;
  white.base_colour = {1, 1, 1, 1};
  scene.materials = {white};
  scene.meshes = {plate({40, 40}, 0), plate({0.08f, 2}, 0, 24)};
  scene.instances.push_back({0, lying(glm::mat4(1)), {}});
  for (int i = -4; i <= 4; ++i) {
    const auto x = static_cast<float>(i) * 0.45f;
    const auto place = [x](double t) { return lying(at(x + static_cast<float>(t), 1, 0)); };
    scene.instances.push_back({1, place(0), moving ? Motion(place) : Motion()});
  }
  scene.sun.direction = {0.1f, -1, 0.05f};
  scene.sun.irradiance = glm::vec3(3);
  scene.camera = fixed_camera({0, 5, 6}, {0, 0, 0}, 0.8f);
  return scene;
}

FrameView view_at(float scale, double seconds = 0) {
  FrameView view = view_of_size(kShadowSize, {}, seconds, seconds);
  view.shadow_scale = scale;
  return view;
}

double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.colour.size(); ++i)
    sum += std::abs(static_cast<double>(a.colour[i]) - static_cast<double>(b.colour[i]));
  return sum / static_cast<double>(a.colour.size());
}

class ShadowScaleTest : public RenderTest {
 protected:
  static Picture fresh(const Scene& scene, const FrameView& view) {
    Renderer renderer = renderer_of(scene);
    return draw(renderer, view, kShadowSize);
  }
};

TEST_F(ShadowScaleTest, TheSideIsEvenAndTheScaleAsNearAsItCanBe) {
  EXPECT_EQ(shadow_side(1), kShadowTexels);
  EXPECT_EQ(shadow_side(0.5f), kShadowTexels / 2);
  EXPECT_EQ(shadow_side(kLeastPartScale), 128);
  for (float scale = kLeastPartScale; scale <= 1; scale += 0.0173f) {
    EXPECT_EQ(shadow_side(scale) % 2, 0) << scale;
    EXPECT_NEAR(shadow_side(scale), scale * kShadowTexels, 1) << scale;
  }
}

// A map that is drawn at another scale in each frame keeps nothing from the frames before.
TEST_F(ShadowScaleTest, WhatEarlierFramesLeftInTheMapChangesNoBit) {
  for (const bool moving : {false, true}) {
    const Scene scene = slats_scene(moving);
    Renderer renderer = renderer_of(scene);
    std::mt19937 random(moving ? 1 : 2);
    std::uniform_real_distribution<float> scales(kLeastPartScale, 1);
    for (int frame = 0; frame < 8; ++frame) {
      const FrameView view = view_at(frame == 1 ? 1 : scales(random), 0.07 * frame);
      const Picture picture = draw(renderer, view, kShadowSize);
      EXPECT_EQ(picture.colour, fresh(scene, view).colour)
          << "frame " << frame << ", scale " << view.shadow_scale << ", moving " << moving;
    }
  }
}

TEST_F(ShadowScaleTest, ASmallerMapIsACoarserOneOfTheSameShadows) {
  const Scene scene = slats_scene(true);
  const Picture whole = fresh(scene, view_at(1));
  double before = 0;
  for (const float scale : {0.5f, 0.25f, 0.125f}) {
    const double difference = mean_difference(whole, fresh(scene, view_at(scale)));
    EXPECT_GT(difference, before) << scale;
    before = difference;
  }
  // A texel at .5 is a pixel wide at most here: the slats' shadows lie where they lie.
  Scene lit = scene;
  lit.sun.casts_shadows = false;
  const double shadows = mean_difference(whole, fresh(lit, view_at(1)));
  EXPECT_LT(mean_difference(whole, fresh(scene, view_at(0.5f))), shadows / 8);
}

// The border of the whole map is lit; so must be what lies next to a part of it.
TEST_F(ShadowScaleTest, BeyondTheMapThereIsLightAtEachScale) {
  for (const bool moving : {false, true}) {
    Scene scene = slats_scene(moving);
    scene.camera = fixed_camera({12, 8, 12}, {0, 0, 0}, 1.2f);
    Renderer renderer = renderer_of(scene);
    draw(renderer, view_at(1), kShadowSize);  // fills the map
    Scene lit = scene;
    lit.sun.casts_shadows = false;
    const Picture light = fresh(lit, view_at(1));
    const Picture shaded = draw(renderer, view_at(1), kShadowSize);
    for (const float scale : {0.9f, 0.5f, 0.3f, 0.0625f}) {
      const Picture picture = draw(renderer, view_at(scale), kShadowSize);
      // Shadows reach over their edges by no more than a few of the coarse texels.
      const int far = kShadowSize.width / 4;
      int beyond = 0;
      for (int y = 0; y < kShadowSize.height; ++y) {
        bool near = false;
        for (int x = 0; x < kShadowSize.width; ++x)
          near = near || shaded.rgb(x, y) != light.rgb(x, y);
        for (int x = 0; x < kShadowSize.width; ++x) {
          if (near || (x > far && x < kShadowSize.width - far)) continue;
          ++beyond;
          ASSERT_EQ(picture.rgb(x, y), light.rgb(x, y)) << x << ", " << y << ", scale " << scale;
        }
      }
      EXPECT_GT(beyond, 1000) << "the picture must show what lies beyond the map";
    }
  }
}

TEST_F(ShadowScaleTest, AScaleOutOfItsRangeIsRefused) {
  Renderer renderer = renderer_of(slats_scene(false));
  const gl::RenderTargets targets = gl::RenderTargets::create({.target_extent = kShadowSize}).value();
  for (const float scale : {0.0f, 0.06f, 1.01f, -1.0f, std::nanf("")}) {
    const Status status = renderer.draw(targets, view_at(scale));
    ASSERT_FALSE(status.ok()) << scale;
    EXPECT_NE(status.message().find("shadow_scale"), std::string::npos) << status.message();
  }
}

}  // namespace

}  // namespace quincunx::scenes::testing
