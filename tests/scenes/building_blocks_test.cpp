// SPDX-License-Identifier: MIT
// The parts of the procedural scenes: solids, lettering, textures, baked occlusion, randomness.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "builtin/mesh_builder.h"
#include "builtin/scene_assembly.h"
#include "builtin/textures.h"
#include "random.h"

namespace quincunx::scenes {
namespace {

// Six times the volume that a closed mesh encloses, with sign: positive where triangles face outwards.
double signed_volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position);
    const glm::dvec3 b(mesh.vertices[mesh.indices[i + 1]].position);
    const glm::dvec3 c(mesh.vertices[mesh.indices[i + 2]].position);
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum / 6;
}

TEST(MeshBuilder, SolidsEncloseTheirVolume) {
  constexpr double kPi = 3.14159265358979;
  MeshBuilder builder(0);
  builder.pen.placement = moved_to({3, -2, 5}) * turned(0.7f, {0, 1, 0});
  builder.box({-1, -2, -0.5f}, {1, 1, 0.5f});
  EXPECT_NEAR(signed_volume(builder.take()), 6, 1e-4);
  // Inscribed polygons: n sides enclose n/(2 pi) sin(2 pi/n) of the circle, 0.9983 for 64.
  builder.sphere({0, 0, 0}, 1, 64);
  EXPECT_NEAR(signed_volume(builder.take()) / (4 * kPi / 3), 1, 0.005);
  builder.rod({0, 0, 0}, {0, 2, 1}, 0.5f, 64);
  EXPECT_NEAR(signed_volume(builder.take()) / (kPi * 0.25 * std::sqrt(5.0)), 1, 0.005);
  builder.ring({1, 1, 1}, {0, 0, 1}, 2, 0.25f, 64, 64);
  EXPECT_NEAR(signed_volume(builder.take()) / (2 * kPi * 2 * kPi * 0.0625), 1, 0.005);
  const std::array<glm::vec2, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  builder.prism(square, -0.5f, 0.25f);
  EXPECT_NEAR(signed_volume(builder.take()), 0.75, 1e-4);
}

TEST(MeshBuilder, ThePenPaintsPlacesAndDivides) {
  MeshBuilder builder(3);
  builder.pen.colour = {0.5f, 0.25f, 1, 1};
  builder.pen.placement = moved_to({10, 0, 0});
  builder.pen.cell = 0.5f;
  builder.patch({0, 0, 0}, {2, 0, 0}, {0, 1, 0});
  const Mesh mesh = builder.take();
  EXPECT_EQ(mesh.material, 3);
  EXPECT_EQ(mesh.indices.size(), 4u * 2 * 6);
  EXPECT_EQ(mesh.vertices[0].position, glm::vec3(10, 0, 0));
  EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.vertices[0].colour, glm::vec4(0.5f, 0.25f, 1, 1));
  EXPECT_TRUE(builder.empty());
}

TEST(MeshBuilder, PicturesReadFromTopLeft) {
  MeshBuilder builder(0);
  builder.picture({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const Vertex& vertex : builder.take().vertices) {
    EXPECT_EQ(vertex.uv, glm::vec2(vertex.position.x, 1 - vertex.position.y));
  }
}

TEST(Glyphs, EveryPrintableCharacterIsDrawnWithinItsLine) {
  std::set<std::vector<std::pair<float, float>>> shapes;
  for (char c = '!'; c <= '~'; ++c) {
    const std::string text(1, c);
    const auto strokes = text_strokes(text, {0, 0}, {});
    ASSERT_FALSE(strokes.empty()) << c;
    std::vector<std::pair<float, float>> shape;
    for (const Polyline& stroke : strokes) {
      ASSERT_GE(stroke.size(), 2u) << c;
      for (const glm::vec2 point : stroke) {
        EXPECT_GE(point.x, -1e-5f) << c;
        EXPECT_LE(point.x, text_width(text, {}) + 1e-5f) << c;
        EXPECT_GE(point.y, -0.36f) << c;
        EXPECT_LE(point.y, 1.12f) << c;
        shape.emplace_back(point.x, point.y);
      }
    }
    EXPECT_TRUE(shapes.insert(shape).second) << c << " looks like another character";
  }
}

TEST(Glyphs, LinesAlignAndScale) {
  const auto extent = [](const TextStyle& style) {
    float low = 1e9f;
    float high = -1e9f;
    for (const Polyline& stroke : text_strokes("QUINCUNX", {5, 1}, style)) {
      for (const glm::vec2 point : stroke) {
        low = std::min(low, point.x);
        high = std::max(high, point.x);
      }
    }
    return glm::vec2(low, high);
  };
  const TextStyle style{2, 0.1f, Align::kLeft};
  const float width = text_width("QUINCUNX", style);
  EXPECT_NEAR(width, 2 * text_width("QUINCUNX", {1, 0.1f, Align::kLeft}), 1e-4);
  EXPECT_NEAR(extent(style).x, 5, 1e-4);
  EXPECT_NEAR(extent(style).y, 5 + width, 1e-4);
  EXPECT_NEAR(extent({2, 0.1f, Align::kRight}).y, 5, 1e-4);
  EXPECT_NEAR(extent({2, 0.1f, Align::kCentre}).x, 5 - width / 2, 1e-4);
}

TEST(Textures, NoiseRepeatsAndStaysInRange) {
  const FractalNoise noise(5, 4, 99);
  Random random(1);
  float low = 1;
  float high = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::vec2 at(random.unit(), random.unit());
    const float value = noise(at);
    low = std::min(low, value);
    high = std::max(high, value);
    EXPECT_NEAR(value, noise(at + glm::vec2(1, 0)), 1e-4);
    EXPECT_NEAR(value, noise(at - glm::vec2(2, 1)), 1e-4);
  }
  EXPECT_GE(low, 0);
  EXPECT_LE(high, 1);
  EXPECT_GT(high - low, 0.3f);
}

TEST(Textures, NormalsAreUnitAndSlopesPointTheGltfWay) {
  // A ramp that rises to the right and towards the top of the picture: its normal leans to the left and down.
  Surface surface;
  surface.size = 16;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      surface.height.push_back(0.5f * static_cast<float>(x) - 0.25f * static_cast<float>(y));
    }
  }
  surface.colour.resize(256);
  const Texture texture = normal_texture(surface);
  const auto at = [&](std::size_t x, std::size_t y) {
    const std::uint8_t* texel = &texture.rgba[(y * 16 + x) * 4];
    return glm::vec3(texel[0], texel[1], texel[2]) / 127.5f - 1.0f;
  };
  EXPECT_FALSE(texture.srgb);
  EXPECT_NEAR(glm::length(at(8, 8)), 1, 0.01);  // eight bits
  EXPECT_NEAR(at(8, 8).x / at(8, 8).z, -0.5f, 0.02);
  EXPECT_NEAR(at(8, 8).y / at(8, 8).z, -0.25f, 0.02);
}

TEST(Textures, SurfacesContinueOverTheirSeams) {
  for (const Surface& surface : {brick_surface(64, 3), ashlar_surface(64, 3), plaster_surface(64, 3),
                                 paving_surface(64, 3), plank_surface(64, 3), stone_surface(64, 3)}) {
    const auto step = [&](int column) {  // mean change of colour from a column to the next
      double sum = 0;
      for (int y = 0; y < 64; ++y) {
        const auto texel = [&](int x) { return surface.colour[static_cast<std::size_t>(y * 64 + x % 64)]; };
        sum += glm::length(texel(column + 1) - texel(column));
      }
      return sum / 64;
    };
    double largest_inside = 0;
    for (int column = 0; column < 63; ++column)
      largest_inside = std::max(largest_inside, step(column));
    EXPECT_LE(step(63), 1.5 * largest_inside) << "the seam must not be seen among the joints";
  }
}

TEST(Textures, TheCanvasCoversWhatIsDrawn) {
  Canvas canvas(32, 16, {0, 0, 0, 1});
  canvas.rectangle({2, 4}, {10.5f, 8}, {1, 1, 1, 1});
  const Texture texture = canvas.texture();
  double sum = 0;
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4)
    sum += texture.rgba[i] / 255.0;
  EXPECT_NEAR(sum, 8.5 * 4, 0.05);  // half-covered pixels are rounded to eight bits
  EXPECT_EQ(texture.rgba[(4 * 32 + 2) * 4], 255);
  EXPECT_EQ(texture.rgba[(3 * 32 + 2) * 4], 0);
  EXPECT_EQ(texture.rgba[(5 * 32 + 10) * 4], 128);
}

TEST(AmbientOcclusion, DarkensTheFootOfAWallAndNotTheOpenFloor) {
  SceneAssembly assembly;
  MeshBuilder& builder = assembly.still(assembly.add(plain_material("plain", glm::vec3(1), 1)));
  builder.pen.cell = 0.5f;
  builder.patch({-6, 0, 6}, {12, 0, 0}, {0, 0, -12});
  builder.box({-6, 0, -6.5f}, {6, 4, -6});
  const int clear = assembly.add(unlit_material("unlit", glm::vec3(1)));
  assembly.still(clear).patch({-6, 1, 6}, {12, 0, 0}, {0, 0, -12});
  Scene scene = assembly.finish();
  bake_ambient_occlusion(scene, {}, [](const Material& material) { return !material.unlit; });
  int open = 0;
  int foot = 0;
  for (const Vertex& vertex : scene.meshes[0].vertices) {
    const bool floor = vertex.position.y == 0 && vertex.normal.y > 0.5f && std::abs(vertex.position.x) < 3;
    EXPECT_GE(vertex.colour.g, 0.05f);
    if (floor && vertex.position.z > 0) {
      EXPECT_GT(vertex.colour.g, 0.97f);
      ++open;
    }
    if (floor && std::abs(vertex.position.z + 5.5f) < 0.01f) {
      EXPECT_LT(vertex.colour.g, 0.85f);
      ++foot;
    }
  }
  EXPECT_GT(open, 50);
  EXPECT_GT(foot, 5);
  for (const Vertex& vertex : scene.meshes[1].vertices)
    EXPECT_EQ(vertex.colour, glm::vec4(1));
}

TEST(Random, IsTheSameOnEveryPlatform) {
  // SplitMix64 from state 0, as published with the algorithm.
  EXPECT_EQ(Random::mix(0x9e3779b97f4a7c15u), 0xe220a8397b1dcdafu);
  Random a(42);
  Random b(42);
  Random other_stream(42, 1);
  EXPECT_EQ(a.next(), b.next());
  EXPECT_NE(a.next(), other_stream.next());
  double sum = 0;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    const float value = a.unit();
    ASSERT_GE(value, 0);
    ASSERT_LT(value, 1);
    sum += value;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 4 * 0.2887 / std::sqrt(kCount));  // four standard errors
}

}  // namespace
}  // namespace quincunx::scenes
