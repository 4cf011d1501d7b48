// SPDX-License-Identifier: MIT
// The renderer: viewport, orientation, depth, jitter, transparents, determinism, refusals.
#include "render/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "quincunx_gl/render_targets.h"
#include "render_fixture.h"
#include "tools/image/display_light.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{96, 54};

glm::mat4 at(float x, float y, float z) {
  return glm::translate(glm::mat4(1), glm::vec3(x, y, z));
}

// Lit, textured, shadowed, moving, blended and with particles: all that the renderer does in one small
// picture.
Scene rich_scene() {
  Scene scene;
  scene.textures = {smooth_texture(8, 128)};
  Material lit;
  lit.base_colour_texture.texture = 0;
  lit.normal_texture.texture = 0;
  lit.roughness = 0.5f;
  lit.double_sided = true;
  Material glass;
  glass.base_colour = {0.2f, 0.4f, 0.9f, 0.5f};
  glass.alpha_mode = AlphaMode::kBlend;
  Material leaf = lit;
  leaf.alpha_mode = AlphaMode::kMask;
  leaf.alpha_cutoff = 0.5f;
  scene.materials = {lit, glass, leaf};
  scene.meshes = {plate({6, 6}, 0, 8), plate({0.8f, 0.8f}, 1), plate({0.5f, 0.5f}, 0),
                  plate({0.4f, 0.4f}, 2)};
  scene.instances.push_back({0, glm::rotate(at(0, -1, 0), -1.5708f, glm::vec3(1, 0, 0)), {}});
  scene.instances.push_back({1, at(-1, 0, 1), {}});
  scene.instances.push_back({2, glm::mat4(1), [](double t) { return at(static_cast<float>(t), 0.3f, 0); }});
  scene.instances.push_back({3, at(1.6f, -0.4f, 0.5f), {}});
  scene.particles = [](double t, std::vector<Particle>& particles) {
    for (int i = 0; i < 5; ++i) {
      particles.push_back(
          {{0.3f * static_cast<float>(i) + static_cast<float>(t), 0.8f, 0.2f}, 0.2f, {1, 0.5f, 0.2f, 0}});
    }
  };
  scene.sun.direction = {-0.3f, -1, -0.4f};
  scene.sun.irradiance = {3, 3, 3};
  scene.lights = {{{0, 1, 1}, {2, 1, 0.5f}, 5}, {{2, 0, 1}, {0, 1, 2}, 3}};
  scene.camera = fixed_camera({0, 0.8f, 4}, {0, 0, 0});
  return scene;
}

// Targets of RGBA8 hold the light of the others exposed, through the curve and encoded. Nothing is blended here: that
// happens on the screen's light, after the curve.
TEST_F(RenderTest, EncodedTargetsHoldTheLightOfTheScreen) {
  Scene scene = rich_scene();
  scene.instances.erase(scene.instances.begin() + 1);
  scene.particles = nullptr;
  Renderer renderer = renderer_of(scene);
  const gl::RenderTargets linear = gl::RenderTargets::create({.target_extent = kSize}).value();
  const gl::RenderTargets encoded =
      gl::RenderTargets::create({.target_extent = kSize, .colour = PixelFormat::kRGBA8}).value();
  FrameView view = view_of_size(kSize);
  view.display.exposure = 1.5f;
  for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
    view.display.tone_map = tone_map;
    ASSERT_TRUE(renderer.draw(linear, view).ok());
    ASSERT_TRUE(renderer.draw(encoded, view).ok());
    const std::vector<float> shown =
        tools::display_light(read_back(linear).colour, tone_map, view.display.exposure);
    const gl::TargetPixels pixels = gl::read_targets(encoded, kSize).value();
    ASSERT_EQ(pixels.codes.size(), shown.size());
    int differ = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (i % 4 == 3) continue;
      const double x = static_cast<double>(shown[i]);
      const double exact = 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
      // Half a code of rounding; a tenth that OpenGL allows the encoding beyond it; a tenth of the half that x was.
      EXPECT_NEAR(static_cast<double>(pixels.codes[i]), exact, 0.7) << name_of(tone_map) << ", value " << i;
      differ += pixels.codes[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(differ, 1000) << "nothing is drawn";
    EXPECT_EQ(read_back(linear).velocity, read_back(encoded).velocity);
  }
}

// Each half is that of the whole frame; the other pixels keep what a clear has left there.
TEST_F(RenderTest, ACheckerboardDrawsHalfOfThePixels) {
  Renderer renderer = renderer_of(rich_scene());
  FrameView view = view_of_size(kSize, {0.25f, 0.25f}, 0.4, 0.3);
  const Picture whole = draw(renderer, view, kSize);
  const gl::RenderTargets targets =
      gl::RenderTargets::create({.target_extent = kSize, .checkerboard = true}).value();
  for (const int parity : {0, 1}) {
    targets.clear(kSize);
    view.parity = parity;
    ASSERT_TRUE(renderer.draw(targets, view).ok());
    const Picture half = read_back(targets);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const bool shaded = (x + y) % 2 == parity;
        const std::size_t i = half.index(x, y);
        ASSERT_EQ(half.rgb(x, y), shaded ? whole.rgb(x, y) : glm::vec3(0)) << x << " " << y;
        ASSERT_EQ(half.v(x, y), shaded ? whole.v(x, y) : glm::vec2(0)) << x << " " << y;
        ASSERT_EQ(half.depth[i], shaded ? whole.depth[i] : 0) << x << " " << y;
        ASSERT_EQ(half.reactive[i], shaded ? whole.reactive[i] : 0) << x << " " << y;
      }
    }
  }
  view.parity = 2;
  EXPECT_EQ(renderer.draw(targets, view).message(), "FrameView::parity is 2; it must be 0 or 1");
  view.parity = 0;
  const gl::RenderTargets plain = gl::RenderTargets::create({.target_extent = kSize}).value();
  EXPECT_EQ(renderer.draw(plain, view).message(),
            "FrameView::parity is given, but the targets have no checkerboard");
}

TEST_F(RenderTest, ViewportLeavesTheRestOfTheTargetAlone) {
  constexpr float kPoison = 77;  // representable in every float target; R8 clamps it to 1
  constexpr Extent kTarget{2 * kSize.width, 2 * kSize.height};
  Renderer renderer = renderer_of(rich_scene());
  const FrameView view = view_of_size(kSize, {0.25f, 0.25f}, 0.4, 0.3);
  const Picture exact = draw(renderer, view, kSize);
  const gl::RenderTargets targets = gl::RenderTargets::create({kTarget, true, true}).value();
  fill_with(targets, kPoison);
  ASSERT_TRUE(renderer.draw(targets, view).ok());
  const Picture larger = read_back(targets);
  for (int y = 0; y < kTarget.height; ++y) {
    for (int x = 0; x < kTarget.width; ++x) {
      const std::size_t i = larger.index(x, y);
      if (x < kSize.width && y < kSize.height) {
        const std::size_t e = exact.index(x, y);
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_EQ(larger.colour[4 * i + c], exact.colour[4 * e + c]) << x << "," << y;
        ASSERT_EQ(larger.depth[i], exact.depth[e]) << x << "," << y;
        ASSERT_EQ(larger.v(x, y), exact.v(x, y)) << x << "," << y;
        ASSERT_EQ(larger.reactive[i], exact.reactive[e]) << x << "," << y;
      } else {  // depth is cleared whole, as the targets say
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_EQ(larger.colour[4 * i + c], kPoison) << x << "," << y;
        ASSERT_EQ(larger.v(x, y), glm::vec2(kPoison)) << x << "," << y;
        ASSERT_EQ(larger.reactive[i], 1.0f) << x << "," << y;
        ASSERT_EQ(larger.depth[i], 0.0f) << x << "," << y;
      }
    }
  }
}

TEST_F(RenderTest, SmallSurfacesAreLeftOutWhereAskedFor) {
  Scene scene;
  scene.materials = {unlit({1, 0, 0, 1})};
  scene.meshes = {plate({0.5f, 0.5f}, 0)};
  scene.instances.push_back({0, at(-1, 0, 0), {}});
  scene.instances.push_back({0, at(4, 0, -12), {}});  // four times as far
  scene.sky.background = Background::kPlain;
  scene.sky.zenith = glm::vec3(0);
  scene.camera = fixed_camera({0, 0, 4}, {0, 0, 0});
  Renderer renderer = renderer_of(scene);
  const auto red = [&](float least_size) {
    FrameView view = view_of_size(kSize);
    view.least_size = least_size;
    const Picture picture = draw(renderer, view, kSize);
    int count = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x)
        count += picture.rgb(x, y).x > 0 ? 1 : 0;
    }
    return count;
  };
  const int both = red(0);
  EXPECT_EQ(red(0.01f), both);
  EXPECT_LT(red(0.2f), both) << "the far one spans less";
  EXPECT_GT(red(0.2f), 0);
  EXPECT_EQ(red(2), 0);
}

TEST_F(RenderTest, MovingShadowsStayAsLongAsTheyMay) {
  const auto after = [](double shadow_age) {
    Renderer renderer = renderer_of(rich_scene());
    FrameView view = view_of_size(kSize, {}, 0.4, 0.3);
    draw(renderer, view, kSize);
    view.seconds = 0.6;
    view.shadow_age = shadow_age;
    return draw(renderer, view, kSize).colour;
  };
  const auto fresh = after(0);
  EXPECT_NE(after(0.3), fresh);
  EXPECT_EQ(after(0.1), fresh) << "older than it may be";
}

TEST_F(RenderTest, NothingOfTheFrameBeforeShinesThrough) {
  Renderer renderer = renderer_of(rich_scene());
  const FrameView view = view_of_size(kSize, {}, 0.4, 0.3);
  const gl::RenderTargets targets = gl::RenderTargets::create({kSize, true, true}).value();
  fill_with(targets, 500);
  ASSERT_TRUE(renderer.draw(targets, view).ok());
  const Picture over_poison = read_back(targets);
  fill_with(targets, 0);
  ASSERT_TRUE(renderer.draw(targets, view).ok());
  const Picture over_zero = read_back(targets);
  EXPECT_EQ(over_poison.colour, over_zero.colour);
  EXPECT_EQ(over_poison.velocity, over_zero.velocity);
  EXPECT_EQ(over_poison.reactive, over_zero.reactive);
}

// A red plate up and to the left of the camera's axis, 3 m before it, facing it.
Scene marker_scene() {
  Scene scene;
  scene.materials = {unlit({1, 0, 0, 1})};
  scene.meshes = {plate({0.5f, 0.5f}, 0)};
  scene.instances.push_back({0, at(-1.5f, 0.8f, -3), {}});
  scene.sky.background = Background::kPlain;
  scene.sky.zenith = {0, 0, 0.25f};
  scene.camera = fixed_camera({0, 0, 0}, {0, 0, -1});
  return scene;
}

TEST_F(RenderTest, TopLeftIsTheFirstTexelAndDepthIsNearOverDistance) {
  Renderer renderer = renderer_of(marker_scene());
  const Picture picture = draw(renderer, view_of_size(kSize), kSize);
  double sum_x = 0, sum_y = 0, count = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const float depth = picture.depth[picture.index(x, y)];
      if (picture.rgb(x, y).r > 0.5f) {
        sum_x += x + 0.5, sum_y += y + 0.5, ++count;
        ASSERT_NEAR(depth, 0.1f / 3.0f, 1e-7f);  // near / distance; an ulp or two of float
      } else {
        ASSERT_EQ(depth, 0.0f);
        ASSERT_EQ(picture.rgb(x, y), glm::vec3(0, 0, 0.25f))
            << "a plain background where the sky is invisible";
      }
    }
  }
  ASSERT_GT(count, 50);
  const double focal = 1 / std::tan(0.5), aspect = static_cast<double>(kSize.width) / kSize.height;
  EXPECT_NEAR(sum_x / count, kSize.width * (0.5 - 0.5 * focal / aspect * 1.5 / 3), 0.5);
  EXPECT_NEAR(sum_y / count, kSize.height * (0.5 - 0.5 * focal * 0.8 / 3), 0.5);
}

TEST_F(RenderTest, BackFacesAreHiddenUnlessDoubleSided) {
  Scene scene = marker_scene();
  scene.instances[0].transform = glm::rotate(scene.instances[0].transform, 3.14159265f, glm::vec3(0, 1, 0));
  const auto red_pixels = [&] {
    Renderer renderer = renderer_of(scene);
    const Picture picture = draw(renderer, view_of_size(kSize), kSize);
    int red = 0;
    for (int i = 0; i < kSize.area(); ++i)
      red += picture.colour[static_cast<std::size_t>(4 * i)] > 0.5f;
    return red;
  };
  EXPECT_EQ(red_pixels(), 0);
  scene.instances[0].transform = glm::scale(scene.instances[0].transform, glm::vec3(1, 1, -1));
  EXPECT_GT(red_pixels(), 50) << "a mirrored mesh shows its other side";
  scene.instances[0].transform = glm::rotate(at(-1.5f, 0.8f, -3), 3.14159265f, glm::vec3(0, 1, 0));
  scene.materials[0].double_sided = true;
  EXPECT_GT(red_pixels(), 50);
}

TEST_F(RenderTest, AMotionMayMirror) {
  Scene scene = marker_scene();
  scene.instances[0].motion = [place = scene.instances[0].transform](double seconds) {
    return glm::scale(place, glm::vec3(1 - 2 * seconds, 1, 1));
  };
  Renderer renderer = renderer_of(scene);
  for (const double seconds : {0.0, 1.0}) {
    const Picture picture = draw(renderer, view_of_size(kSize, {}, seconds, seconds), kSize);
    EXPECT_GT(
        std::count_if(picture.depth.begin(), picture.depth.end(), [](float depth) { return depth > 0; }), 50)
        << seconds;
  }
}

TEST_F(RenderTest, AspectIsThePicturesWhateverTheViewport) {
  Renderer renderer = renderer_of(marker_scene());
  FrameView view = view_of_size({kSize.width / 2, kSize.height});  // half the columns of the same picture
  view.aspect = static_cast<float>(kSize.width) / kSize.height;
  const Picture narrow = draw(renderer, view, view.render);
  const Picture full = draw(renderer, view_of_size(kSize), kSize);
  int differing = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width / 2; ++x) {
      const bool both = narrow.rgb(x, y) == full.rgb(2 * x, y) || narrow.rgb(x, y) == full.rgb(2 * x + 1, y);
      differing += !both;
    }
  }
  EXPECT_EQ(differing, 0);
}

TEST_F(RenderTest, JitterToTheRightShowsWhatLiesToTheRight) {
  // A jitter of one pixel is a whole step: the picture moves by a texel against it. The wall fills the view.
  constexpr float kRounding = 0.01f;  // texture filter weights (8 bits) and half float
  Scene scene;
  scene.textures = {smooth_texture(6, 0)};
  scene.materials = {unlit(glm::vec4(1))};
  scene.materials[0].base_colour_texture.texture = 0;
  scene.meshes = {plate({6, 6}, 0)};
  scene.instances.push_back({0, at(0, 0, -3), {}});
  scene.camera = fixed_camera({0, 0, 0}, {0, 0, -1});
  Renderer renderer = renderer_of(scene);
  const Picture centred = draw(renderer, view_of_size(kSize), kSize);
  const Picture right = draw(renderer, view_of_size(kSize, {1, 0}), kSize);
  const Picture down = draw(renderer, view_of_size(kSize, {0, 1}), kSize);
  float contrast = 0;
  for (int y = 0; y + 1 < kSize.height; ++y) {
    for (int x = 0; x + 1 < kSize.width; ++x) {
      ASSERT_NEAR(right.rgb(x, y).r, centred.rgb(x + 1, y).r, kRounding);
      ASSERT_NEAR(down.rgb(x, y).g, centred.rgb(x, y + 1).g, kRounding);
      contrast = std::max(contrast, std::abs(centred.rgb(x + 1, y).r - centred.rgb(x, y).r));
    }
  }
  EXPECT_GT(contrast, 4 * kRounding) << "a step the wrong way must be visible";
}

TEST_F(RenderTest, TwoRunsAgreeBitForBit) {
  const FrameView view = view_of_size(kSize, {0.1f, -0.3f}, 0.7, 0.65);
  Renderer first = renderer_of(rich_scene());
  Renderer second = renderer_of(rich_scene());
  const Picture a = draw(first, view, kSize);
  (void)draw(second, view_of_size({31, 17}, {}, 2.0, 1.0), kSize);  // another frame first must not matter
  const Picture b = draw(second, view, kSize);
  EXPECT_EQ(a.colour, b.colour);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.reactive, b.reactive);
}

TEST_F(RenderTest, ColourDoesNotDependOnTheOtherTargets) {
  Renderer renderer = renderer_of(rich_scene());
  const FrameView view = view_of_size(kSize, {0.1f, -0.3f}, 0.7, 0.65);
  const Picture all = draw(renderer, view, kSize, true, true);
  for (const auto& [velocity, reactive] : {std::pair{false, false}, {true, false}, {false, true}}) {
    const Picture some = draw(renderer, view, kSize, velocity, reactive);
    EXPECT_EQ(some.colour, all.colour);
    EXPECT_EQ(some.depth, all.depth);
    EXPECT_EQ(some.velocity, velocity ? all.velocity : std::vector<float>());
    EXPECT_EQ(some.reactive, reactive ? all.reactive : std::vector<float>());
  }
}

TEST_F(RenderTest, TransparentsWriteReactiveValuesButNoVelocityNorDepth) {
  constexpr float kHalf = 128.0f / 255;  // .5 in R8
  Scene scene = marker_scene();
  scene.materials.push_back(unlit({0, 1, 0, 0.5f}));
  scene.materials[1].alpha_mode = AlphaMode::kBlend;
  scene.meshes = {plate({6, 6}, 0), plate({0.5f, 0.5f}, 1)};
  scene.instances[0].transform = at(0, 0, -6);
  Scene bare = scene;
  // Two sheets that overlap in part and move fast; the nearer is named first, and must still be drawn last.
  scene.instances.push_back(
      {1, glm::mat4(1), [](double t) { return at(0.3f + static_cast<float>(t), 0, -2); }});
  scene.instances.push_back(
      {1, glm::mat4(1), [](double t) { return at(-0.3f + static_cast<float>(t), 0, -3); }});
  Renderer with = renderer_of(scene), without = renderer_of(bare);
  const FrameView view = view_of_size(kSize, {}, 0, -0.1);
  const Picture a = draw(with, view, kSize), b = draw(without, view, kSize);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.depth, b.depth);
  for (const float r : b.reactive)
    ASSERT_EQ(r, 0.0f);
  int one = 0, two = 0;
  for (std::size_t i = 0; i < a.reactive.size(); ++i) {
    const glm::vec2 rg(a.colour[4 * i], a.colour[4 * i + 1]);
    const float r = a.reactive[i];
    if (r == 0) {
      ASSERT_EQ(rg, glm::vec2(1, 0));
    } else if (std::abs(r - kHalf) < 0.01f) {
      ++one;
      ASSERT_EQ(rg, glm::vec2(0.5f, 0.5f));
    } else {
      ++two;
      ASSERT_NEAR(r, 0.75f, 0.01f) << "marks add up as r + a (1 - r)";
      ASSERT_EQ(rg, glm::vec2(0.25f, 0.75f));
    }
  }
  EXPECT_GT(one, 50);
  EXPECT_GT(two, 20);
}

TEST_F(RenderTest, ParticlesAreReactiveEvenWhenAdditive) {
  Scene scene = marker_scene();
  Scene bare = scene;
  scene.particles = [](double, std::vector<Particle>& particles) {
    particles.push_back({{0, 0, -3}, 0.8f, {4, 2, 1, 0}});
  };
  Renderer with = renderer_of(scene), without = renderer_of(bare);
  const Picture a = draw(with, view_of_size(kSize), kSize), b = draw(without, view_of_size(kSize), kSize);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.depth, b.depth);
  const int x = kSize.width / 2, y = kSize.height / 2;
  EXPECT_GT(a.reactive[a.index(x, y)], 0.9f);
  EXPECT_EQ(a.reactive[0], 0.0f);
  EXPECT_GT(a.rgb(x, y).r, b.rgb(x, y).r + 3);
  EXPECT_GT(a.rgb(x, y).b, b.rgb(x, y).b) << "additive light keeps what lies behind";
}

TEST_F(RenderTest, PicturesStayFiniteWithAbsurdLight) {
  Scene scene = rich_scene();
  scene.sun.irradiance = glm::vec3(1e30f);
  scene.materials[0].emissive = glm::vec3(1e38f);
  scene.materials[0].roughness = 0;
  scene.materials[0].metallic = 1;
  scene.meshes[2].vertices[0].normal = glm::vec3(0);  // a degenerate normal must not become NaN
  Renderer renderer = renderer_of(scene);
  const Picture picture = draw(renderer, view_of_size(kSize, {}, 0.4, 0.3), kSize);
  for (const float c : picture.colour) {
    ASSERT_TRUE(std::isfinite(c));
    ASSERT_LE(c, 65504.0f);
  }
}

TEST_F(RenderTest, SmallestViewportWorks) {
  Renderer renderer = renderer_of(rich_scene());
  for (const Extent render : {Extent{1, 1}, Extent{1, 7}, Extent{9, 1}}) {
    const Picture picture = draw(renderer, view_of_size(render, {0.5f, -0.5f}, 0.4, 0.3), render);
    for (const float c : picture.colour)
      ASSERT_TRUE(std::isfinite(c));
    for (const float v : picture.velocity)
      ASSERT_TRUE(std::isfinite(v));
  }
}

TEST_F(RenderTest, BadViewsAreRefusedByName) {
  Renderer renderer = renderer_of(rich_scene());
  const gl::RenderTargets targets = gl::RenderTargets::create({kSize, true, true}).value();
  const Status too_large = renderer.draw(targets, view_of_size({kSize.width + 1, kSize.height}));
  EXPECT_EQ(too_large.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(too_large.message().find("97 x 54"), std::string::npos) << too_large.message();
  EXPECT_EQ(renderer.draw(targets, view_of_size({0, 1})).code(), StatusCode::kInvalidArgument);
  const Status jitter = renderer.draw(targets, view_of_size(kSize, {NAN, 0}));
  EXPECT_EQ(jitter.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(jitter.message().find("jitter"), std::string::npos) << jitter.message();
}

TEST_F(RenderTest, BadScenesAreRefusedByName) {
  const auto message_of = [](auto change) {
    Scene scene = rich_scene();
    change(scene);
    const Result<Renderer> renderer = Renderer::create(scene);
    EXPECT_FALSE(renderer.ok());
    return renderer.ok() ? std::string() : renderer.status().message();
  };
  const auto expect = [&](auto change, const char* part) {
    const std::string message = message_of(change);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect([](Scene& s) { s.meshes[1].indices[2] = 99; }, "mesh 1 has index 99");
  expect([](Scene& s) { s.meshes[1].indices.pop_back(); }, "multiple of 3");
  expect([](Scene& s) { s.meshes[2].material = 7; }, "mesh 2 names material 7");
  expect([](Scene& s) { s.instances[0].mesh = -1; }, "instance 0 names mesh -1");
  expect([](Scene& s) { s.materials[0].normal_texture.texture = 3; }, "names texture 3");
  expect([](Scene& s) { s.textures[0].rgba.pop_back(); }, "texture 0");
  expect([](Scene& s) { s.meshes[0].vertices[1].position.y = INFINITY; }, "not finite");
  expect([](Scene& s) { s.lights.resize(17); }, "17 point lights");
  expect([](Scene& s) { s.camera = nullptr; }, "camera");
}

}  // namespace
}  // namespace quincunx::scenes::testing
