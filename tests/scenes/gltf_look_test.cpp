// SPDX-License-Identifier: MIT
// The results of load_gltf for materials, textures and lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "../tools/temporary_folder.h"
#include "gltf/loader.h"
#include "gltf_fixture.h"

namespace quincunx::testing {
namespace {

using scenes::Material;
using scenes::Scene;

constexpr float kRounding = 1e-6f;  // a few float operations on values around 1

class GltfLook : public ::testing::Test {
 protected:
  Scene load(const GltfFile& file) {
    Result<Scene> scene = scenes::load_gltf(file.save_gltf(folder_.file("a.gltf")));
    EXPECT_TRUE(scene.ok()) << scene.status().message();
    return scene.ok() ? std::move(scene).value() : Scene{};
  }

  // A file of one triangle with that material and texture 0, a PNG of 2 x 1 pixels.
  static GltfFile textured(const json& material) {
    GltfFile file;
    file.append("materials", material);
    file.triangle({{"material", 0}});
    file.append("images", {{"bufferView", file.view(png(2, 1, kPixels))}, {"mimeType", "image/png"}});
    file.append("textures", {{"source", 0}});
    return file;
  }

  static inline const Bytes kPixels = {255, 0, 0, 255, 10, 20, 30, 40};
  TemporaryFolder folder_;
};

TEST_F(GltfLook, FactorsAndModes) {
  GltfFile file;
  file.append(
      "materials",
      {{"name", "Leaf"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.7},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
         {"KHR_materials_unlit", json::object()}}}});
  file.append("materials", {{"alphaMode", "BLEND"}});
  file.triangle({{"material", 0}});
  file.triangle({{"material", 1}});
  file.triangle();
  const Scene scene = load(file);
  ASSERT_EQ(scene.materials.size(), 3u);
  const Material& leaf = scene.materials[0];
  EXPECT_EQ(leaf.name, "Leaf");
  EXPECT_EQ(leaf.base_colour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(leaf.metallic, 0.5f);
  EXPECT_EQ(leaf.roughness, 0.25f);
  EXPECT_EQ(leaf.emissive, glm::vec3(8, 4, 0));
  EXPECT_EQ(leaf.alpha_mode, scenes::AlphaMode::kMask);
  EXPECT_EQ(leaf.alpha_cutoff, 0.7f);
  EXPECT_TRUE(leaf.double_sided);
  EXPECT_TRUE(leaf.unlit);
  const Material& defaults = scene.materials[1];
  EXPECT_EQ(defaults.alpha_mode, scenes::AlphaMode::kBlend);
  EXPECT_EQ(defaults.metallic, 1);  // glTF's default, not Material's
  EXPECT_EQ(defaults.emissive, glm::vec3(0));
  EXPECT_FALSE(defaults.unlit);
  EXPECT_EQ(scene.meshes[1].material, 1);
  EXPECT_EQ(scene.meshes[2].material, 2);  // the mesh of primitives that name none
  EXPECT_EQ(scene.materials[2].base_colour, glm::vec4(1));
  EXPECT_EQ(scene.materials[2].metallic, 1);
}

TEST_F(GltfLook, ImagesFromEverywhere) {
  GltfFile file = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                            {"emissiveTexture", {{"index", 1}}},
                            {"normalTexture", {{"index", 2}, {"scale", 0.5}}}});
  const Bytes encoded = png(2, 1, kPixels);
  file.append("images", {{"uri", "data:image/png;base64," + base64(encoded)}});
  file.append("images", {{"uri", "a%20picture.png"}});
  write_bytes(folder_.file("a picture.png"), encoded.data(), encoded.size());
  file.append("textures", {{"source", 1}});
  file.append("textures", {{"source", 2}});
  const Scene scene = load(file);
  ASSERT_EQ(scene.textures.size(), 3u);
  for (const scenes::Texture& texture : scene.textures) {
    EXPECT_EQ(texture.width, 2);
    EXPECT_EQ(texture.height, 1);
    EXPECT_EQ(texture.rgba, kPixels);
  }
  const Material& material = scene.materials[0];
  const auto is_srgb = [&](const scenes::TextureSlot& slot) {
    return scene.textures.at(static_cast<std::size_t>(slot.texture)).srgb;
  };
  EXPECT_TRUE(is_srgb(material.base_colour_texture));
  EXPECT_TRUE(is_srgb(material.emissive_texture));
  EXPECT_FALSE(is_srgb(material.normal_texture));
  EXPECT_EQ(material.normal_scale, 0.5f);
  EXPECT_EQ(material.metallic_roughness_texture.texture, -1);
}

// Legal, and a decoder's trap: an IDAT chunk without data ahead of the real one.
TEST_F(GltfLook, AnEmptyDataChunkInAPng) {
  GltfFile file = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  Bytes encoded = png(2, 1, kPixels);
  const Bytes empty = {0, 0, 0, 0, 'I', 'D', 'A', 'T', 0x35, 0xaf, 0x06, 0x1e};
  encoded.insert(encoded.begin() + 33, empty.begin(), empty.end());  // after signature and IHDR
  file.root["images"][0] = {{"uri", "data:image/png;base64," + base64(encoded)}};
  const Scene scene = load(file);
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].rgba, kPixels);
}

TEST_F(GltfLook, ATextureForColourAndForDataBecomesTwo) {
  const Scene scene =
      load(textured({{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}},
                     {"emissiveTexture", {{"index", 0}}}}));
  ASSERT_EQ(scene.textures.size(), 2u);
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.base_colour_texture.texture, material.emissive_texture.texture);
  EXPECT_NE(material.base_colour_texture.texture, material.metallic_roughness_texture.texture);
  EXPECT_NE(scene.textures[0].srgb, scene.textures[1].srgb);
}

TEST_F(GltfLook, Samplers) {
  GltfFile file = textured({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                            {"emissiveTexture", {{"index", 1}}}});
  file.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  file.append("textures", {{"source", 0}, {"sampler", 0}});
  const Scene scene = load(file);
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(scene.textures[0].wrap_u, scenes::Wrap::kRepeat);
  EXPECT_FALSE(scene.textures[0].nearest);
  EXPECT_EQ(scene.textures[1].wrap_u, scenes::Wrap::kClamp);
  EXPECT_EQ(scene.textures[1].wrap_v, scenes::Wrap::kMirror);
  EXPECT_TRUE(scene.textures[1].nearest);
}

TEST_F(GltfLook, TextureTransform) {
  const Scene scene = load(textured(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0},
           {"extensions",
            {{"KHR_texture_transform",
              {{"offset", {0.25, 1}}, {"rotation", 1.5707963267948966}, {"scale", {2, 0.5}}}}}}}}}}}));
  const glm::mat3 matrix = scene.materials.at(0).base_colour_texture.transform;
  // (1, 4) scaled is (2, 2); turned from u towards -v, as v points down, (2, -2); moved, (2.25, -1).
  const glm::vec3 uv = matrix * glm::vec3(1, 4, 1);
  EXPECT_NEAR(uv.x, 2.25f, kRounding);
  EXPECT_NEAR(uv.y, -1.0f, kRounding);
  EXPECT_EQ(uv.z, 1);
  const glm::vec3 along_u = matrix * glm::vec3(1, 0, 0);
  EXPECT_NEAR(along_u.x, 0, kRounding);
  EXPECT_NEAR(along_u.y, -2, kRounding);
}

TEST_F(GltfLook, TheBaseColourChoosesTheTextureCoordinates) {
  for (const int set : {0, 1}) {
    for (const bool by_extension : {false, true}) {
      json slot = {{"index", 0}, {"texCoord", by_extension ? 1 - set : set}};
      if (by_extension) slot["extensions"]["KHR_texture_transform"]["texCoord"] = set;
      GltfFile file = textured({{"pbrMetallicRoughness", {{"baseColorTexture", slot}}},
                                {"emissiveTexture", {{"index", 0}, {"texCoord", 1 - set}}}});
      json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
      attributes["TEXCOORD_0"] = file.floats({0.5f, 0, 0, 0, 0, 0}, 2);
      attributes["TEXCOORD_1"] = file.floats({0.75f, 0, 0, 0, 0, 0}, 2);
      const Scene scene = load(file);
      ASSERT_EQ(scene.meshes.size(), 1u);
      EXPECT_EQ(scene.meshes[0].vertices[0].uv.x, set == 0 ? 0.5f : 0.75f);
    }
  }
}

TEST_F(GltfLook, WithoutLightsASunAndASky) {
  GltfFile file;
  file.triangle();
  const Scene scene = load(file);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_GT(scene.sun.irradiance.g, 1);
  EXPECT_LT(scene.sun.direction.y, 0);
  EXPECT_NEAR(glm::length(scene.sun.direction), 1, kRounding);
  EXPECT_EQ(scene.sky.background, scenes::Background::kSky);
  EXPECT_EQ(scene.exposure, 1);
}

json lights(const json& list) {
  return {{"KHR_lights_punctual", {{"lights", list}}}};
}

int light_node(GltfFile& file, int light, const json& transform) {
  json node = {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
  node.update(transform);
  const int index = file.append("nodes", node);
  file.list_in_scene(index);
  return index;
}

TEST_F(GltfLook, PunctualLights) {
  GltfFile file;
  file.triangle();
  file.root["extensions"] = lights({{{"type", "directional"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}},
                                    {{"type", "point"}, {"intensity", 3}, {"range", 7}},
                                    {{"type", "point"}},
                                    {{"type", "spot"}, {"spot", json::object()}}});
  light_node(file, 0, {{"rotation", {-0.70710678, 0, 0, 0.70710678}}});  // -z turned down
  light_node(file, 1, {{"translation", {1, 2, 3}}});
  light_node(file, 2, {{"scale", {2, 2, 2}}});
  light_node(file, 3, json::object());
  const Scene scene = load(file);
  EXPECT_EQ(scene.sun.irradiance, glm::vec3(2, 1, 0.5f));
  EXPECT_NEAR(scene.sun.direction.y, -1, kRounding);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].position, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3));
  EXPECT_EQ(scene.lights[0].range, 7);
  EXPECT_EQ(scene.lights[1].intensity, glm::vec3(1));
  EXPECT_GT(scene.lights[1].range, glm::length(glm::vec2(1, 1)));  // further than the scene is wide
  EXPECT_EQ(scene.exposure, 1);
}

TEST_F(GltfLook, ALampAloneIsNotOutshoneByASun) {
  GltfFile file;
  file.triangle();
  file.root["extensions"] = lights({{{"type", "point"}, {"intensity", 3}}});
  light_node(file, 0, json::object());
  const Scene scene = load(file);
  EXPECT_EQ(scene.sun.irradiance, glm::vec3(0));
  EXPECT_LT(scene.sky.zenith.b, scenes::Sky{}.zenith.b);
}

TEST_F(GltfLook, AFarLampReachesASmallThing) {
  GltfFile file;
  file.triangle();
  file.root["extensions"] = lights({{{"type", "point"}}});
  light_node(file, 0, {{"translation", {0, 300, 400}}});
  const Scene scene = load(file);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_GT(scene.lights[0].range, 1500);  // what is lost at a third of it is an eightieth
}

TEST_F(GltfLook, PhotometricLightsAreExposedDown) {
  GltfFile file;
  file.triangle();
  file.root["extensions"] = lights({{{"type", "directional"}, {"intensity", 100000}}});
  light_node(file, 0, json::object());
  const Scene scene = load(file);
  EXPECT_EQ(scene.sun.irradiance, glm::vec3(100000));
  // White paper, in the sun, exposed: bright, but not thousands of times so.
  const float paper = scene.sun.irradiance.g * scene.exposure / 3.14159f;
  EXPECT_GT(paper, 0.5f);
  EXPECT_LT(paper, 5.0f);
  EXPECT_NEAR(scene.sky.zenith.b * scene.exposure, scenes::Sky{}.zenith.b, kRounding);
}

TEST_F(GltfLook, NoMorePointLightsThanASceneHolds) {
  GltfFile file;
  file.triangle();
  file.root["extensions"] = lights({{{"type", "point"}}});
  for (int i = 0; i < Scene::kMaxPointLights + 3; ++i)
    light_node(file, 0, {{"translation", {i, 0, 0}}});
  const Scene scene = load(file);
  ASSERT_EQ(scene.lights.size(), static_cast<std::size_t>(Scene::kMaxPointLights));
  EXPECT_EQ(scene.lights.back().position.x, Scene::kMaxPointLights - 1);
}

}  // namespace
}  // namespace quincunx::testing
