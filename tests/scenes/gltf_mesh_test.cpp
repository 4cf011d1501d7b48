// SPDX-License-Identifier: MIT
// The results of load_gltf for containers, accessors and primitives.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "../tools/temporary_folder.h"
#include "gltf/loader.h"
#include "gltf_fixture.h"

namespace quincunx::testing {
namespace {

using scenes::load_gltf;
using scenes::Mesh;
using scenes::Scene;

Scene loaded(const std::string& path) {
  Result<Scene> scene = load_gltf(path);
  EXPECT_TRUE(scene.ok()) << scene.status().message();
  return scene.ok() ? std::move(scene).value() : Scene{};
}

class GltfMesh : public ::testing::Test {
 protected:
  Scene load(const GltfFile& file) { return loaded(file.save_gltf(folder_.file("a.gltf"))); }

  // The first mesh; an empty one where loading failed.
  Mesh mesh_of(const GltfFile& file) {
    Scene scene = load(file);
    return scene.meshes.empty() ? Mesh{} : scene.meshes[0];
  }

  TemporaryFolder folder_;
};

using Corners = std::vector<std::uint32_t>;

std::vector<glm::vec3> corner_positions(const Mesh& mesh) {
  std::vector<glm::vec3> result;
  for (const std::uint32_t index : mesh.indices)
    result.push_back(mesh.vertices.at(index).position);
  return result;
}

const std::vector<glm::vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST_F(GltfMesh, AllContainersHoldTheSame) {
  GltfFile file;
  file.triangle();
  const Scene embedded = loaded(file.save_gltf(folder_.file("embedded.gltf")));
  const Scene binary = loaded(file.save_glb(folder_.file("binary.glb")));
  file.root["buffers"] = json::array({{{"byteLength", file.binary.size()}, {"uri", "my%20buffer%2Ebin"}}});
  file.binary.resize(file.binary.size() + 5);  // a longer file than stated is fine
  write_bytes(folder_.file("my buffer.bin"), file.binary.data(), file.binary.size());
  const Scene external = loaded(file.save_gltf(folder_.file("external.gltf")));
  for (const Scene* scene : {&embedded, &binary, &external}) {
    ASSERT_EQ(scene->meshes.size(), 1u);
    EXPECT_EQ(corner_positions(scene->meshes[0]), kTriangle);
    EXPECT_EQ(scene->instances.size(), 1u);
    EXPECT_FALSE(scene->instances[0].motion);
  }
}

// Names as they stand, with a % or the backslashes of Windows; data with line breaks or percent-encoded.
TEST_F(GltfMesh, UrisAsExportersWriteThem) {
  GltfFile file;
  file.triangle();
  std::filesystem::create_directories(folder_.file("parts"));
  for (const char* name : {"100% real.bin", "a%20b.bin", "parts/c d.bin"})
    write_bytes(folder_.file(name), file.binary.data(), file.binary.size());
  std::string lines, encoded;
  for (const char c : base64(file.binary)) {
    encoded += c == '=' ? "%3D" : c == '+' ? "%2B" : c == '/' ? "%2f" : std::string(1, c);
    lines += std::string(1, c) + "\r\n";
  }
  for (const std::string& uri :
       {std::string("100% real.bin"), std::string("a%20b.bin"), std::string("parts\\c%20d.bin"),
        "data:;base64," + lines, "DATA:application/octet-stream;BASE64," + encoded}) {
    file.root["buffers"] = json::array({{{"byteLength", file.binary.size()}, {"uri", uri}}});
    const Mesh mesh = mesh_of(file);
    EXPECT_EQ(corner_positions(mesh), kTriangle) << uri;
  }
}

TEST_F(GltfMesh, ByteOrderMarkIsSkipped) {
  GltfFile file;
  file.triangle();
  file.save_gltf(folder_.file("plain.gltf"));
  const std::string text = "\xef\xbb\xbf" + testing::read_file(folder_.file("plain.gltf"));
  write_bytes(folder_.file("marked.gltf"), text.data(), text.size());
  EXPECT_EQ(loaded(folder_.file("marked.gltf")).meshes.size(), 1u);
}

TEST_F(GltfMesh, IndicesOfEveryWidth) {
  for (const Component type : {kUByte, kUShort, kUInt}) {
    GltfFile file;
    const int indices = type == kUByte    ? file.accessor<std::uint8_t>({2, 0, 1}, 1, type)
                        : type == kUShort ? file.accessor<std::uint16_t>({2, 0, 1}, 1, type)
                                          : file.accessor<std::uint32_t>({2, 0, 1}, 1, type);
    file.triangle({{"indices", indices}});
    const std::vector<glm::vec3> expected = {kTriangle[2], kTriangle[0], kTriangle[1]};
    EXPECT_EQ(corner_positions(mesh_of(file)), expected) << type;
  }
}

TEST_F(GltfMesh, StripsAndFansKeepTheirWinding) {
  const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::vector<float> around = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const int mode : {5, 6}) {
    GltfFile file;
    file.show({{"mode", mode}, {"attributes", {{"POSITION", file.floats(mode == 5 ? square : around, 3)}}}});
    const Mesh mesh = mesh_of(file);
    ASSERT_EQ(mesh.indices.size(), 6u) << mode;
    for (const scenes::Vertex& vertex : mesh.vertices) {
      EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1)) << mode;  // generated from the winding
    }
  }
}

TEST_F(GltfMesh, PointsAreLeftOutAndLeftoverCornersDropped) {
  GltfFile file;
  const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5}, 3);
  file.show({{"mode", 0}, {"attributes", {{"POSITION", positions}}}}, "Dots");
  file.show({{"attributes", {{"POSITION", positions}}}}, "Face");
  const Scene scene = load(file);
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(corner_positions(scene.meshes[0]), kTriangle);
  EXPECT_EQ(scene.instances.size(), 1u);
}

TEST_F(GltfMesh, GivenNormalsAreNormalisedAndVerticesShared) {
  GltfFile file;
  const int normals = file.floats({0, 0, 2, 0, 3, 4, 0, 0, 0}, 3);
  const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
             {"indices", file.accessor<std::uint8_t>({0, 1, 2, 2, 1, 0}, 1, kUByte)}});
  const Mesh mesh = mesh_of(file);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.vertices[1].normal, glm::vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(mesh.vertices[2].normal, glm::vec3(0, 1, 0));  // none to be had: the default
}

TEST_F(GltfMesh, FlatNormalsOfTinyTriangles) {
  GltfFile file;
  file.show({{"attributes", {{"POSITION", file.floats({0, 0, 0, 1e-15f, 0, 0, 0, 0, 1e-15f}, 3)}}}});
  for (const scenes::Vertex& vertex : mesh_of(file).vertices)
    EXPECT_EQ(vertex.normal, glm::vec3(0, -1, 0));
}

TEST_F(GltfMesh, ColoursFloatAndNormalised) {
  GltfFile file;
  const int bytes = file.accessor<std::uint8_t>({255, 0, 51, 255, 0, 0, 255, 0, 0}, 3, kUByte, true);
  const int unmarked = file.accessor<std::uint8_t>({255, 0, 51, 255, 0, 0, 255, 0, 0}, 3, kUByte);
  const int shorts =
      file.accessor<std::uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, kUShort, true);
  const int floats = file.floats({1, 0, 0.2f, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0}, 4);
  const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  for (const int colour : {bytes, shorts, floats, unmarked}) {
    file.show({{"attributes", {{"POSITION", positions}, {"COLOR_0", colour}}}});
  }
  const Scene scene = load(file);
  ASSERT_EQ(scene.meshes.size(), 4u);
  EXPECT_EQ(scene.meshes[0].vertices[0].colour, glm::vec4(1, 0, 0.2f, 1));
  EXPECT_EQ(scene.meshes[3].vertices[0].colour, glm::vec4(1, 0, 0.2f, 1));
  EXPECT_EQ(scene.meshes[1].vertices[0].colour, glm::vec4(1, 0, 0.2f, 0));
  EXPECT_EQ(scene.meshes[2].vertices[0].colour, glm::vec4(1, 0, 0.2f, 0.5f));
}

TEST_F(GltfMesh, QuantisedPositionsAndSignedNormals) {
  GltfFile file;
  file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int positions = file.accessor<std::int16_t>({0, 0, 0, 300, 0, 0, 0, -7, 0}, 3, kShort);
  const int normals = file.accessor<std::int8_t>({-128, 0, 0, 0, 127, 0, 0, 0, -127}, 3, kByte, true);
  file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
  const Mesh mesh = mesh_of(file);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[1].position, glm::vec3(300, 0, 0));
  EXPECT_EQ(mesh.vertices[2].position, glm::vec3(0, -7, 0));
  EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(-1, 0, 0));  // -128 counts as -127
  EXPECT_EQ(mesh.vertices[2].normal, glm::vec3(0, 0, -1));
}

TEST_F(GltfMesh, InterleavedVertices) {
  GltfFile file;
  std::vector<float> vertices;
  for (std::size_t i = 0; i < 3; ++i) {
    const float u = static_cast<float>(i) / 4;
    vertices.insert(vertices.end(), {kTriangle[i].x, kTriangle[i].y, kTriangle[i].z, u, 1 - u});
  }
  const int view = file.view(GltfFile::bytes_of(vertices), 20);
  const json common = {{"bufferView", view}, {"componentType", 5126}, {"count", 3}};
  json position = common;
  position["type"] = "VEC3";
  json uv = common;
  uv["type"] = "VEC2";
  uv["byteOffset"] = 12;
  file.show(
      {{"attributes",
        {{"POSITION", file.append("accessors", position)}, {"TEXCOORD_0", file.append("accessors", uv)}}}});
  const Mesh mesh = mesh_of(file);
  EXPECT_EQ(corner_positions(mesh), kTriangle);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[2].uv, glm::vec2(0.5f, 0.5f));
}

TEST_F(GltfMesh, SparseAccessorsReplaceElements) {
  GltfFile file;
  const int indices = file.view(GltfFile::bytes_of(std::vector<std::uint16_t>{1, 2}));
  const int values = file.view(GltfFile::bytes_of(std::vector<float>{1, 0, 0, 0, 1, 0}));
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  const int on_zeros =
      file.append("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
  const int on_data = file.floats({0, 0, 0, 9, 9, 9, 8, 8, 8}, 3);
  file.root["accessors"][static_cast<std::size_t>(on_data)]["sparse"] = sparse;
  for (const int positions : {on_zeros, on_data})
    file.show({{"attributes", {{"POSITION", positions}}}});
  const Scene scene = load(file);
  ASSERT_EQ(scene.meshes.size(), 2u);
  for (const Mesh& mesh : scene.meshes)
    EXPECT_EQ(corner_positions(mesh), kTriangle);
}

TEST_F(GltfMesh, AMeshOfSeveralNodesIsReadOnce) {
  GltfFile file;
  file.triangle();
  file.list_in_scene(file.append("nodes", {{"mesh", 0}, {"translation", {0, 0, 5}}}));
  const Scene scene = load(file);
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(glm::vec3(scene.instances[1].transform[3]), glm::vec3(0, 0, 5));
}

TEST_F(GltfMesh, OnlyTheDefaultSceneIsShown) {
  GltfFile file;
  file.triangle();
  const int other = file.append("nodes", {{"mesh", 0}, {"translation", {7, 0, 0}}});
  file.append("scenes", {{"nodes", {other}}});
  file.root["scene"] = 1;
  const Scene scene = load(file);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].transform[3].x, 7);
}

}  // namespace
}  // namespace quincunx::testing
