// SPDX-License-Identifier: MIT
// Bad glTF files: each gets one sentence that names the file, the object and what would be right.
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>

#include "../tools/temporary_folder.h"
#include "gltf/loader.h"
#include "gltf_fixture.h"

namespace quincunx::testing {
namespace {

using Words = std::vector<std::string>;

class GltfErrors : public ::testing::Test {
 protected:
  // That loading fails, with a message of one line that holds the path and all the words.
  void expect_refused(const std::string& path, const Words& words) {
    const Result<scenes::Scene> scene = scenes::load_gltf(path);
    ASSERT_FALSE(scene.ok()) << "expected: " << words.front();
    EXPECT_EQ(scene.status().code(), StatusCode::kIoFailure);
    const std::string message = scene.status().message();
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << "no \"" << word << "\" in: " << message;
    }
  }

  void expect_refused(const GltfFile& file, const Words& words) {
    expect_refused(file.save_gltf(folder_.file("bad.gltf")), words);
  }

  // The good file with one thing broken.
  void expect_refused(const std::function<void(json& root)>& damage, const Words& words) {
    GltfFile file = good();
    damage(file.root);
    expect_refused(file, words);
  }

  // What loading says.
  std::string log_of(const GltfFile& file) const {
    std::ostringstream log;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
    const auto scene = scenes::load_gltf(file.save_gltf(folder_.file("logged.gltf")));
    spdlog::set_default_logger(before);
    EXPECT_TRUE(scene.ok()) << scene.status().message();
    return log.str();
  }

  void expect_refused(const std::string& name, const Bytes& bytes, const Words& words) {
    write_bytes(folder_.file(name), bytes.data(), bytes.size());
    expect_refused(folder_.file(name), words);
  }

  // Accessors: 0 POSITION, 1 NORMAL, 2 indices, 3 times, 4 values.
  static GltfFile good() {
    GltfFile file;
    const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    const int normals = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const int indices = file.accessor<std::uint16_t>({0, 1, 2}, 1, kUShort);
    const int node = file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                {"indices", indices},
                                {"material", 0}},
                               "Suzanne");
    file.append("materials",
                {{"name", "Skin"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    file.append("textures", {{"source", 0}});
    file.append("images", {{"name", "Face"}, {"bufferView", file.view(png(1, 1, {1, 2, 3, 4}))}});
    file.append("animations",
                {{"name", "Walk"},
                 {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}},
                 {"samplers",
                  {{{"input", file.floats({0, 1}, 1)}, {"output", file.floats({0, 0, 0, 1, 1, 1}, 3)}}}}});
    return file;
  }

  TemporaryFolder folder_;
};

json& primitive(json& root) {
  return root["meshes"][0]["primitives"][0];
}

TEST_F(GltfErrors, TheGoodFileIsGood) {
  const auto scene = scenes::load_gltf(good().save_gltf(folder_.file("good.gltf")));
  EXPECT_TRUE(scene.ok()) << scene.status().message();
}

TEST_F(GltfErrors, NotAFile) {
  expect_refused(folder_.file("none.gltf"), {"missing", "there is no file"});
  std::filesystem::create_directories(folder_.file("folder.gltf"));
  expect_refused(folder_.file("folder.gltf"), {"is a directory"});
  expect_refused("empty.gltf", {}, {"empty", "glTF 2.0"});
  expect_refused("text.gltf", {'h', 'e', 'l', 'l', 'o'}, {"not glTF"});
  expect_refused("blank.gltf", {' ', '\n'}, {"not glTF"});
}

TEST_F(GltfErrors, Containers) {
  const Bytes glb = good().glb();
  for (const std::size_t kept : {std::size_t{5}, std::size_t{19}}) {
    expect_refused("short.glb", Bytes(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(kept)),
                   {"bytes"});
  }
  expect_refused("cut.glb", Bytes(glb.begin(), glb.end() - 100), {"truncated"});
  Bytes changed = glb;
  changed[4] = 1;
  expect_refused("old.glb", changed, {"version 1", "version 2"});
  changed = glb;
  changed[15] = 0x70;  // the size of the first chunk
  expect_refused("chunk.glb", changed, {"chunk 0"});
  changed = glb;
  changed[16] = 'X';  // its type
  expect_refused("type.glb", changed, {"JSON chunk"});
  const std::string text = good().root.dump();
  expect_refused("cut.gltf", Bytes(text.begin(), text.begin() + 200), {"truncated", "column"});
  const std::string deep = "{\"extras\":" + std::string(100000, '[');
  expect_refused("deep.gltf", Bytes(deep.begin(), deep.end()), {"nested deeper"});
}

TEST_F(GltfErrors, Versions) {
  expect_refused([](json& root) { root["asset"]["version"] = "1.0"; }, {"asset", "version", "1.0", "2.0"});
  expect_refused([](json& root) { root["asset"]["minVersion"] = "2.7"; }, {"minVersion", "2.7"});
  expect_refused([](json& root) { root.erase("asset"); }, {"lacks 'asset'"});
  expect_refused(
      [](json& root) {
        root["extensionsRequired"] = {"KHR_texture_transform", "KHR_draco_mesh_compression"};
      },
      {"requires", "KHR_draco_mesh_compression"});
}

// Used ones are named once each, and the picture goes without.
TEST_F(GltfErrors, UnknownExtensionsAreNamed) {
  GltfFile file = good();
  file.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_materials_unlit", "KHR_materials_sheen",
                                 "EXT_mesh_gpu_instancing"};
  const std::string text = log_of(file);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
  for (const char* name : {"\"EXT_mesh_gpu_instancing\"", "\"KHR_materials_sheen\""})
    EXPECT_NE(text.find(name), std::string::npos) << text;
}

TEST_F(GltfErrors, MorphWeightsAreNamed) {
  GltfFile file = good();
  EXPECT_EQ(log_of(file), "");
  file.root["nodes"][0]["weights"] = {0.0, 0.5};
  EXPECT_NE(log_of(file).find("node 0 'Suzanne node' has morph weights, which are left out"),
            std::string::npos);
}

TEST_F(GltfErrors, IndicesOutOfRange) {
  expect_refused([](json& root) { root["scene"] = 3; }, {"'scene' 3", "only 1 'scenes'"});
  expect_refused([](json& root) { root["scenes"][0]["nodes"] = {9}; }, {"scene 0", "'nodes' 9"});
  expect_refused([](json& root) { root["nodes"][0]["mesh"] = 1; }, {"node 0 'Suzanne node'", "'mesh' 1"});
  expect_refused([](json& root) { root["nodes"][0]["mesh"] = -1; }, {"node 0 'Suzanne node'", "'mesh' -1"});
  expect_refused([](json& root) { root["nodes"][0]["mesh"] = 0.5; }, {"'mesh' 0.5", "integer"});
  expect_refused([](json& root) { root["nodes"][0]["camera"] = 0; }, {"'camera' 0", "no 'cameras'"});
  expect_refused([](json& root) { root["nodes"][0]["children"] = {5}; }, {"node 0", "'children' 5"});
  expect_refused([](json& root) { primitive(root)["material"] = 2; },
                 {"primitive 0 of mesh 0 'Suzanne'", "'material' 2"});
  expect_refused([](json& root) { primitive(root)["indices"] = 99; },
                 {"primitive 0 of mesh 0 'Suzanne'", "'indices' 99"});
  expect_refused([](json& root) { primitive(root)["attributes"]["NORMAL"] = 77; },
                 {"primitive 0 of mesh 0 'Suzanne'", "'NORMAL' 77"});
  expect_refused([](json& root) { root["accessors"][0]["bufferView"] = 50; },
                 {"accessor 0", "'bufferView' 50"});
  expect_refused([](json& root) { root["bufferViews"][1]["buffer"] = 1; }, {"bufferView 1", "'buffer' 1"});
  expect_refused([](json& root) { root["textures"][0]["source"] = 1; }, {"texture 0", "'source' 1"});
  expect_refused([](json& root) { root["textures"][0]["sampler"] = 0; }, {"texture 0", "'sampler' 0"});
  expect_refused([](json& root) { root["images"][0]["bufferView"] = 50; },
                 {"image 0 'Face'", "'bufferView' 50"});
  expect_refused(
      [](json& root) { root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1; },
      {"baseColorTexture of pbrMetallicRoughness of material 0 'Skin'", "'index' 1"});
  expect_refused([](json& root) { root["animations"][0]["samplers"][0]["input"] = 50; },
                 {"sampler 0 of animation 0 'Walk'", "'input' 50"});
  expect_refused([](json& root) { root["animations"][0]["channels"][0]["target"]["node"] = 50; },
                 {"channel 0 of animation 0 'Walk'", "'node' 50"});
  expect_refused([](json& root) { root["animations"][0]["channels"][0]["sampler"] = 1; },
                 {"channel 0 of animation 0 'Walk'", "'sampler' 1"});
  expect_refused([](json& root) { root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; },
                 {"node 0 'Suzanne node'", "'light' 0", "no 'lights'"});
}

TEST_F(GltfErrors, FieldsOfTheWrongKind) {
  expect_refused([](json& root) { root["samplers"] = 5; }, {"'samplers' 5", "list"});
  expect_refused([](json& root) { root["meshes"][0] = "x"; }, {"mesh 0", "object"});
  expect_refused([](json& root) { root["accessors"][0].erase("count"); }, {"accessor 0", "lacks 'count'"});
  expect_refused([](json& root) { root["accessors"][0]["count"] = -3; }, {"accessor 0", "'count' -3"});
  expect_refused([](json& root) { root["accessors"][0]["count"] = 1e30; }, {"accessor 0", "'count' 1e+30"});
  expect_refused([](json& root) { root["accessors"][0]["type"] = "VEC5"; }, {"accessor 0", "VEC5", "VEC4"});
  expect_refused([](json& root) { root["accessors"][0]["componentType"] = 5130; }, {"5130", "5126"});
  expect_refused([](json& root) { root["bufferViews"][0]["byteStride"] = 2; },
                 {"bufferView 0", "byteStride"});
  expect_refused(
      [](json& root) {
        root["nodes"][0]["scale"] = {1, 2};
      },
      {"node 0", "'scale' [1,2]", "3 numbers"});
  expect_refused([](json& root) { root["nodes"][0]["scale"] = {1, 2, 1e300}; }, {"node 0", "finite"});
  expect_refused([](json& root) { root["materials"][0]["alphaMode"] = "GLASS"; },
                 {"material 0 'Skin'", "GLASS", "OPAQUE, MASK, BLEND"});
  expect_refused([](json& root) { root["materials"][0]["doubleSided"] = 1; },
                 {"'doubleSided' 1", "true or false"});
  expect_refused([](json& root) { root["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 2; },
                 {"material 0 'Skin'", "'metallicFactor' 2", "at most 1"});
  expect_refused([](json& root) { root["images"][0]["uri"] = 5; }, {"image 0 'Face'", "string"});
  expect_refused([](json& root) { root["images"][0].erase("bufferView"); }, {"image 0 'Face'", "'uri'"});
  expect_refused(
      [](json& root) {
        root["cameras"] = json::array({{{"type", "perspective"}}});
      },
      {"camera 0", "lacks 'perspective'"});
}

TEST_F(GltfErrors, Ranges) {
  expect_refused([](json& root) { root["bufferViews"][0]["byteOffset"] = 2147483000; },
                 {"bufferView 0", "buffer 0 has only"});
  expect_refused([](json& root) { root["accessors"][0]["count"] = 4; },
                 {"accessor 0", "POSITION of primitive 0 of mesh 0 'Suzanne'", "bufferView 0", "only 36"});
  expect_refused([](json& root) { root["accessors"][0]["byteOffset"] = 4; }, {"accessor 0", "only 36"});
  expect_refused([](json& root) { root["bufferViews"][0]["byteStride"] = 8; },
                 {"accessor 0", "12 bytes", "8 bytes apart"});
  expect_refused([](json& root) { root["accessors"][1]["count"] = 2; },
                 {"primitive 0 of mesh 0 'Suzanne'", "NORMAL"});
  expect_refused([](json& root) { root["accessors"][0]["type"] = "VEC4"; }, {"accessor 0", "3 components"});
  expect_refused([](json& root) { root["accessors"][2]["componentType"] = 5122; }, {"accessor 2", "indices"});
  expect_refused(
      [](json& root) {
        root["accessors"][0]["count"] = 2;
        root["accessors"][1]["count"] = 2;
      },
      {"accessor 2", "index 2", "only 2 vertices"});
  expect_refused(
      [](json& root) {
        root["accessors"][0].erase("bufferView");
        root["accessors"][0]["count"] = 2000000000;
      },
      {"accessor 0", "without a bufferView"});
  expect_refused(
      [](json& root) {
        root["accessors"][0]["sparse"] = {
            {"count", 1},
            {"indices", {{"bufferView", 0}, {"componentType", 5125}, {"byteOffset", 12}}},
            {"values", {{"bufferView", 0}}}};
      },
      {"accessor 0", "sparse", "only 3 elements"});
}

TEST_F(GltfErrors, ValuesThatAreNotFinite) {
  GltfFile file;
  file.show({{"attributes", {{"POSITION", file.floats({0, 0, 0, 1, NAN, 0, 0, 1, 0}, 3)}}}}, "Hole");
  expect_refused(file, {"POSITION of primitive 0 of mesh 0 'Hole'", "not finite", "element 1"});
  GltfFile far;
  far.show({{"attributes", {{"POSITION", far.floats({0, 0, 0, 1e30f, 0, 0, 0, 1, 0}, 3)}}}}, "Far");
  expect_refused(far, {"mesh 0 'Far'", "beyond"});
}

TEST_F(GltfErrors, Buffers) {
  const auto buffer = [](json value) {
    return [value](json& root) { root["buffers"] = json::array({value}); };
  };
  expect_refused(buffer({{"byteLength", 10}}), {"buffer 0", "no 'uri'"});
  expect_refused(buffer({{"byteLength", 1000}, {"uri", "gone.bin"}}), {"buffer 0", "no file", "gone.bin"});
  expect_refused(buffer({{"byteLength", 10}, {"uri", "data:;base64,AAAA"}}),
                 {"buffer 0", "truncated", "3 bytes of the 10"});
  expect_refused(buffer({{"byteLength", 10}, {"uri", "data:;base64,A*AA"}}), {"buffer 0", "base64"});
  expect_refused(buffer({{"byteLength", 10}, {"uri", "a%2"}}), {"buffer 0", "'%'"});
  for (const char* uri :
       {"http://x/y", "../a.bin", "b/../../a.bin", "%2e%2e/a.bin", "..\\a.bin", "/etc/hostname"})
    expect_refused(buffer({{"byteLength", 1}, {"uri", uri}}), {"buffer 0", "only files beside the glTF"});
}

TEST_F(GltfErrors, Images) {
  const auto image = [](const std::string& uri) {
    return [uri](json& root) { root["images"][0] = {{"name", "Face"}, {"uri", uri}}; };
  };
  expect_refused(image("gone.png"), {"image 0 'Face'", "missing", "gone.png"});
  expect_refused(image("data:image/png;base64,AAAA"), {"image 0 'Face'", "neither PNG nor JPEG"});
  Bytes cut = png(8, 8, Bytes(256, 77));
  cut.resize(45);
  expect_refused(image("data:image/png;base64," + base64(cut)), {"image 0 'Face'", "cannot be decoded"});
  Bytes huge = png(1, 1, {1, 2, 3, 4});
  huge[16] = 1;  // 2^24 pixels wide
  expect_refused(image("data:image/png;base64," + base64(huge)), {"image 0 'Face'"});
}

TEST_F(GltfErrors, NodeGraphs) {
  const auto nodes = [](json value) {
    return [value](json& root) {
      for (const json& node : value)
        root["nodes"].push_back(node);
    };
  };
  expect_refused(nodes({{{"name", "A"}, {"children", {2}}}, {{"children", {1}}}}), {"node 1 'A'", "cycle"});
  expect_refused(nodes({{{"name", "Self"}, {"children", {1}}}}), {"node 1 'Self'", "cycle"});
  expect_refused(nodes({{{"children", {3}}}, {{"children", {3}}}, {{"name", "Twice"}}}),
                 {"node 3 'Twice'", "one parent"});
  expect_refused(nodes({{{"children", {0}}}}), {"scene 0", "node 0 'Suzanne node'", "child"});
  expect_refused([](json& root) { root["scenes"][0]["nodes"] = {0, 0}; }, {"scene 0", "node 0", "twice"});
  expect_refused(
      [](json& root) {
        root["nodes"][0]["matrix"] = json::array({1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
      },
      {"node 0 'Suzanne node'", "last row"});
}

TEST_F(GltfErrors, Animations) {
  expect_refused([](json& root) { root["accessors"][3]["count"] = 1; },
                 {"channel 0 of animation 0 'Walk'", "2 values for 1 times"});
  expect_refused([](json& root) { root["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; },
                 {"channel 0 of animation 0 'Walk'", "6 are needed"});
  expect_refused([](json& root) { root["animations"][0]["channels"][0]["target"]["path"] = "rotation"; },
                 {"values of channel 0 of animation 0 'Walk'", "4 components"});
  expect_refused(
      [](json& root) { root["animations"][0]["channels"].push_back(root["animations"][0]["channels"][0]); },
      {"channel 1 of animation 0 'Walk'", "translation of node 0", "second time"});
  expect_refused(
      [](json& root) {
        root["nodes"][0]["matrix"] = json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
      },
      {"channel 0 of animation 0 'Walk'", "node 0 'Suzanne node'", "matrix"});
  GltfFile file = good();
  file.root["animations"][0]["samplers"][0]["input"] = file.floats({1, 1}, 1);
  expect_refused(file, {"channel 0 of animation 0 'Walk'", "ascend"});
}

TEST_F(GltfErrors, NothingToDraw) {
  expect_refused([](json& root) { root["nodes"][0].erase("mesh"); }, {"nothing to draw", "triangles"});
  expect_refused([](json& root) { primitive(root)["mode"] = 1; }, {"nothing to draw", "triangles"});
  expect_refused([](json& root) { root = {{"asset", {{"version", "2.0"}}}}; }, {"nothing to draw"});
}

}  // namespace
}  // namespace quincunx::testing
