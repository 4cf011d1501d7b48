// SPDX-License-Identifier: MIT
// The results of load_gltf for node trees, animations and cameras.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../tools/temporary_folder.h"
#include "gltf/loader.h"
#include "gltf_fixture.h"

namespace quincunx::testing {
namespace {

using scenes::Scene;

// A handful of float operations on values around 1.
constexpr float kRounding = 2e-6f;

constexpr float kHalfRoot = 0.70710678f;

class GltfMotion : public ::testing::Test {
 protected:
  Scene load(const GltfFile& file) {
    Result<Scene> scene = scenes::load_gltf(file.save_gltf(folder_.file("a.gltf")));
    EXPECT_TRUE(scene.ok()) << scene.status().message();
    return scene.ok() ? std::move(scene).value() : Scene{};
  }

  // Animates `path` of a node; returns nothing, there is one animation.
  static void animate(GltfFile& file, int node, const std::string& path, const std::vector<float>& times,
                      const std::vector<float>& values, const std::string& interpolation) {
    if (!file.root.contains("animations")) {
      file.append("animations", {{"name", "Walk"}, {"channels", json::array()}, {"samplers", json::array()}});
    }
    json& animation = file.root["animations"][0];
    animation["samplers"].push_back({{"input", file.floats(times, 1)},
                                     {"output", file.floats(values, path == "rotation" ? 4 : 3)},
                                     {"interpolation", interpolation}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  TemporaryFolder folder_;
};

void expect_near(const glm::vec3& actual, const glm::vec3& expected, const std::string& what = "") {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(actual[c], expected[c], kRounding) << what << " component " << c;
}

glm::vec3 moved(const glm::mat4& matrix, const glm::vec3& point) {
  return matrix * glm::vec4(point, 1);
}

// Each frame costs as much as there are nodes: a chain as deep as this would take minutes if each node asked all above.
TEST_F(GltfMotion, ADeepChainMovesAsAWhole) {
  constexpr int kDepth = 20000;
  GltfFile file;
  const json mesh = file.root["nodes"][static_cast<std::size_t>(file.triangle())]["mesh"];
  file.root["nodes"] = json::array();
  for (int i = 0; i < kDepth; ++i) {
    json node = {{"mesh", mesh}, {"translation", {0, 0.5, 0}}};
    if (i + 1 < kDepth) node["children"] = {i + 1};
    file.root["nodes"].push_back(node);
  }
  file.root["scenes"][0]["nodes"] = {0};
  animate(file, 0, "translation", {0, 4}, {0, 0, 0, 8, 0, 0}, "LINEAR");
  const Scene scene = load(file);
  ASSERT_EQ(scene.instances.size(), static_cast<std::size_t>(kDepth));
  for (const double seconds : {0.0, 1.0, 2.5}) {
    for (int i = 0; i < kDepth; ++i) {
      const glm::vec3 place = scene.instances[static_cast<std::size_t>(i)].motion(seconds)[3];
      ASSERT_EQ(place, glm::vec3(2 * seconds, 0.5 * i, 0)) << i;
    }
  }
}

TEST_F(GltfMotion, TransformsMultiplyDownTheTree) {
  GltfFile file;
  const int node = file.triangle();
  file.root["nodes"][0].update({{"translation", {1, 2, 3}},
                                {"rotation", {0, 0, kHalfRoot, kHalfRoot}},  // 90 degrees about z
                                {"scale", {2, 3, 4}}});
  const int parent = file.append(
      "nodes", {{"children", {node}}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1}}});
  file.root["scenes"][0]["nodes"] = {parent};
  const Scene scene = load(file);
  ASSERT_EQ(scene.instances.size(), 1u);
  // (1,1,1) scaled (2,3,4), turned (-3,2,4), moved (-2,4,7), doubled (-4,8,14), moved (6,8,14).
  expect_near(moved(scene.instances[0].transform, {1, 1, 1}), {6, 8, 14});
}

TEST_F(GltfMotion, RoundedMatricesAreAffine) {
  GltfFile file;
  const auto node = static_cast<std::size_t>(file.triangle());
  file.root["nodes"][node]["matrix"] = {1, 0, 0, 1e-7, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 0.9999999};
  const glm::mat4 matrix = load(file).instances.at(0).transform;
  EXPECT_EQ(glm::transpose(matrix)[3], glm::vec4(0, 0, 0, 1));
  expect_near(moved(matrix, {1, 1, 1}), {5, 6, 7});
}

// Its own transform means nothing; that of the joint and of the bind pose does.
TEST_F(GltfMotion, ASkinnedMeshGoesWithItsFirstJoint) {
  GltfFile file;
  const auto node = static_cast<std::size_t>(file.triangle());
  file.root["nodes"][node]["translation"] = {100, 0, 0};
  file.root["nodes"][node]["skin"] = 0;
  const int joint = file.append("nodes", {{"translation", {0, 2, 0}}});
  file.list_in_scene(joint);
  file.append("skins", {{"joints", {joint}}});
  expect_near(moved(load(file).instances.at(0).transform, {1, 0, 0}), {1, 2, 0});
  file.root["skins"][0]["inverseBindMatrices"] = file.append(
      "accessors", {{"bufferView",
                     file.view(GltfFile::bytes_of<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1}))},
                    {"componentType", static_cast<int>(kFloat)},
                    {"count", 1},
                    {"type", "MAT4"}});
  expect_near(moved(load(file).instances.at(0).transform, {1, 0, 0}), {1, 0, 0});
  animate(file, joint, "translation", {0, 1}, {0, 2, 0, 4, 2, 0}, "LINEAR");
  expect_near(moved(load(file).instances.at(0).motion(0.5), {1, 0, 0}), {3, 0, 0});
}

// A millimetre, six thousand kilometres from the middle of the earth: only where all stands to each other is seen.
TEST_F(GltfMotion, FarThingsStandWhereTheyStandToEachOther) {
  GltfFile file;
  file.root["nodes"][static_cast<std::size_t>(file.triangle())]["translation"] = {6.4e6, 0, 1e6};
  const int moving = file.triangle();
  file.root["nodes"][static_cast<std::size_t>(moving)]["rotation"] = {0, 0, 0, 1};
  const int parent = file.append("nodes", {{"translation", {6.4e6, 0.001, 1e6}}, {"children", {moving}}});
  file.root["scenes"][0]["nodes"] = {0, parent};
  animate(file, moving, "translation", {0, 1}, {0, 0, 0, 0.002f, 0, 0}, "LINEAR");
  file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.75}, {"znear", 0.25}}}});
  file.list_in_scene(file.append("nodes", {{"camera", 0}, {"translation", {6.4e6, 0.003, 1e6}}}));
  const Scene scene = load(file);
  const auto apart = [&](const glm::mat4& matrix) {
    return moved(matrix, {0, 0, 0}) - moved(scene.instances.at(0).transform, {0, 0, 0});
  };
  expect_near(apart(scene.instances.at(1).motion(0.5)), {0.001f, 0.001f, 0});
  expect_near(apart(scene.camera(0).world_from_camera), {0, 0.003f, 0});
}

TEST_F(GltfMotion, FarVerticesComeNear) {
  GltfFile file;
  file.show({{"attributes", {{"POSITION", file.floats({1e6f, 0, 0, 1e6f + 1, 0, 0, 1e6f, 1, 0}, 3)}}}});
  const Scene scene = load(file);
  const scenes::Instance& instance = scene.instances.at(0);
  for (const scenes::Vertex& vertex : scene.meshes.at(0).vertices)
    EXPECT_LT(glm::length(moved(instance.transform, vertex.position)), 1) << "around the origin";
  expect_near(scene.meshes[0].vertices[1].position - scene.meshes[0].vertices[0].position, {1, 0, 0});
}

TEST_F(GltfMotion, LinearTranslationLoops) {
  GltfFile file;
  animate(file, file.triangle(), "translation", {1, 3}, {0, 0, 0, 4, 8, 0}, "LINEAR");
  const Scene scene = load(file);
  ASSERT_EQ(scene.instances.size(), 1u);
  ASSERT_TRUE(scene.instances[0].motion);
  EXPECT_EQ(scene.duration, 3);
  const auto at = [&](double seconds) { return moved(scene.instances[0].motion(seconds), {0, 0, 0}); };
  expect_near(at(0), {0, 0, 0}, "before the first key");
  expect_near(at(1.5), {1, 2, 0});
  expect_near(at(2), {2, 4, 0});
  expect_near(at(3), {0, 0, 0}, "the end is the beginning");
  expect_near(at(5), {2, 4, 0}, "one round later");
  expect_near(at(-1), {2, 4, 0}, "one round earlier");
}

TEST_F(GltfMotion, StepHoldsTheKeyBefore) {
  GltfFile file;
  animate(file, file.triangle(), "scale", {0, 1, 2}, {1, 1, 1, 2, 2, 2, 3, 3, 3}, "STEP");
  const Scene scene = load(file);
  const auto size = [&](double seconds) { return scene.instances.at(0).motion(seconds)[0][0]; };
  EXPECT_EQ(size(0.999), 1);
  EXPECT_EQ(size(1), 2);
  EXPECT_EQ(size(1.999), 2);
}

TEST_F(GltfMotion, RotationsTakeTheShorterWayAtConstantSpeed) {
  GltfFile file;
  // 0 to 90 degrees about z; the second key is negated, which is the same rotation.
  animate(file, file.triangle(), "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, -kHalfRoot, -kHalfRoot}, "LINEAR");
  const Scene scene = load(file);
  for (const double part : {0.0, 1.0 / 3, 0.5, 0.9}) {
    const auto angle = static_cast<float>(part * 1.5707963267948966);
    expect_near(moved(scene.instances.at(0).motion(part), {1, 0, 0}), {std::cos(angle), std::sin(angle), 0});
  }
}

TEST_F(GltfMotion, CubicSplineAgainstHandComputedValues) {
  GltfFile file;
  // Keys at 0 s and 2 s with values 1 and 5, out-tangent 3 per second, in-tangent -1 per second (x only).
  // At 0.5 s, t = 1/4: 27/32 * 1 + 2 * 9/64 * 3 + 5/32 * 5 + 2 * -3/64 * -1 = 2.5625.
  // At 1 s, t = 1/2: 1/2 * 1 + 2/8 * 3 + 1/2 * 5 - 2/8 * -1 = 4.
  animate(file, file.triangle(), "translation", {0, 2},
          {9, 9, 9, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 0, 9, 9, 9}, "CUBICSPLINE");
  const Scene scene = load(file);
  const auto at = [&](double seconds) { return moved(scene.instances.at(0).motion(seconds), {0, 0, 0}); };
  expect_near(at(0), {1, 0, 0});
  expect_near(at(0.5), {2.5625f, 0, 0});
  expect_near(at(1), {4, 0, 0});
}

TEST_F(GltfMotion, CubicSplineRotationsAreNormalised) {
  GltfFile file;
  animate(file, file.triangle(), "rotation", {0, 1},
          {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}, "CUBICSPLINE");
  const Scene scene = load(file);
  // Half way lies (0, 0, 1/2, 1/2): 90 degrees about z once it is of length 1.
  expect_near(moved(scene.instances.at(0).motion(0.5), {1, 0, 0}), {0, 1, 0});
}

TEST_F(GltfMotion, ChildrenOfAnAnimatedNodeMoveAndOthersStand) {
  GltfFile file;
  const int child = file.triangle();
  file.triangle(json::object(), "Still");
  const int parent = file.append("nodes", {{"children", {child}}});
  file.root["scenes"][0]["nodes"] = {parent, 1};
  animate(file, parent, "translation", {0, 1}, {0, 0, 0, 0, 0, 6}, "LINEAR");
  const Scene scene = load(file);
  ASSERT_EQ(scene.instances.size(), 2u);
  ASSERT_TRUE(scene.instances[0].motion);
  expect_near(moved(scene.instances[0].motion(0.5), {0, 0, 0}), {0, 0, 3});
  EXPECT_FALSE(scene.instances[1].motion);
  EXPECT_TRUE(scenes::needs_of(scene).moving_objects);
}

TEST_F(GltfMotion, MorphWeightsAreLeftOut) {
  GltfFile file;
  const int node = file.triangle();
  animate(file, node, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "LINEAR");
  file.root["animations"][0]["channels"].push_back(
      {{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
  expect_near(moved(load(file).instances.at(0).motion(0.5), {0, 0, 0}), {0.5f, 0, 0});
}

TEST_F(GltfMotion, NormalisedIntegerRotations) {
  GltfFile file;
  const int node = file.triangle();
  file.append(
      "animations",
      {{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}}}},
       {"samplers",
        {{{"input", file.floats({0, 1}, 1)},
          {"output", file.accessor<std::int16_t>({0, 0, 32767, 0, 0, 0, 32767, 0}, 4, kShort, true)}}}}});
  expect_near(moved(load(file).instances.at(0).motion(0.5), {1, 0, 0}), {-1, 0, 0});  // 180 degrees about z
}

TEST_F(GltfMotion, ThePerspectiveCameraOfTheFile) {
  GltfFile file;
  file.triangle();
  file.append("cameras", {{"type", "orthographic"},
                          {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 10}, {"znear", 0.1}}}});
  file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.75}, {"znear", 0.25}}}});
  file.list_in_scene(file.append("nodes", {{"camera", 0}}));
  const int node = file.append(
      "nodes", {{"camera", 1}, {"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}, {"rotation", {0, 1, 0, 0}}});
  file.list_in_scene(node);
  const Scene still = load(file);
  EXPECT_FALSE(still.camera_moves);
  const scenes::Camera camera = still.camera(7);
  EXPECT_EQ(camera.vertical_fov, 0.75f);
  EXPECT_EQ(camera.near_plane, 0.25f);
  expect_near(moved(camera.world_from_camera, {0, 0, -1}), {1, 2, 4}, "turned round, not scaled");

  animate(file, node, "translation", {0, 2}, {1, 2, 3, 3, 2, 3}, "LINEAR");
  const Scene moving = load(file);
  EXPECT_TRUE(moving.camera_moves);
  EXPECT_FALSE(scenes::needs_of(moving).moving_objects);
  expect_near(moved(moving.camera(1).world_from_camera, {0, 0, 0}), {2, 2, 3});
}

TEST_F(GltfMotion, WithoutACameraOneGoesRound) {
  GltfFile file;
  file.triangle();
  const Scene scene = load(file);
  EXPECT_TRUE(scene.camera_moves);
  EXPECT_EQ(scene.duration, scenes::kOrbitSeconds);
  const glm::vec3 eye = moved(scene.camera(0).world_from_camera, {0, 0, 0});
  const glm::vec3 opposite = moved(scene.camera(scenes::kOrbitSeconds / 2).world_from_camera, {0, 0, 0});
  expect_near(moved(scene.camera(scenes::kOrbitSeconds).world_from_camera, {0, 0, 0}), eye);
  expect_near(0.5f * (eye + opposite), {0.5f, eye.y, 0}, "the axis goes through the middle");
  EXPECT_GT(eye.y, 0.5f);
}

// The corner of a box in the picture, x and y in [-1, 1] where it is 4:3; z is the distance along the view.
glm::vec3 in_picture(const scenes::Camera& camera, const glm::vec3& point) {
  const glm::vec3 seen = glm::inverse(camera.world_from_camera) * glm::vec4(point, 1);
  const float scale = 1 / (std::tan(camera.vertical_fov / 2) * -seen.z);
  return {seen.x * scale * 0.75f, seen.y * scale, -seen.z};
}

TEST(OrbitCamera, FitsEveryBoxAtEveryMoment) {
  const scenes::Bounds boxes[] = {{{-1, -1, -1}, {1, 1, 1}},
                                  {{-20, 0, -0.1f}, {30, 0.2f, 0.1f}},
                                  {{5, -40, 7}, {6, 40, 8}},
                                  {{1e-5f, 0, 0}, {2e-5f, 1e-5f, 3e-5f}}};
  for (const scenes::Bounds& box : boxes) {
    const scenes::CameraPath path = scenes::orbit_camera(box);
    float fullest = 0;
    for (int moment = 0; moment < 64; ++moment) {
      const scenes::Camera camera = path(scenes::kOrbitSeconds * moment / 64);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point((corner & 1) != 0 ? box.high.x : box.low.x,
                              (corner & 2) != 0 ? box.high.y : box.low.y,
                              (corner & 4) != 0 ? box.high.z : box.low.z);
        const glm::vec3 seen = in_picture(camera, point);
        EXPECT_LT(std::abs(seen.x), 1);
        EXPECT_LT(std::abs(seen.y), 1);
        EXPECT_GT(seen.z, camera.near_plane);
        fullest = std::max({fullest, std::abs(seen.x), std::abs(seen.y)});
      }
    }
    EXPECT_GT(fullest, 0.8f) << "it need not be further away";
  }
}

TEST(OrbitCamera, NothingToSeeIsStillACamera) {
  const scenes::Camera camera = scenes::orbit_camera({})(1);
  EXPECT_GT(camera.near_plane, 0);
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r)
      EXPECT_TRUE(std::isfinite(camera.world_from_camera[c][r]));
  }
}

}  // namespace
}  // namespace quincunx::testing
