// SPDX-License-Identifier: MIT
// Damages good glTF files in thousands of ways, the same ones each time: whatever comes of it is a Result,
// and a Scene that holds together when it is not an error.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "../scenes/gltf_fixture.h"
#include "../tools/temporary_folder.h"
#include "gltf/loader.h"
#include "scene.h"
#include "wild.h"

namespace quincunx::testing {
namespace {

using scenes::Scene;

// A file in which everything that is read occurs.
GltfFile everything() {
  GltfFile file;
  const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 3);
  file.root["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", file.view(GltfFile::bytes_of(std::vector<std::uint16_t>{2}))},
        {"componentType", 5123}}},
      {"values", {{"bufferView", file.view(GltfFile::bytes_of(std::vector<float>{0, 2, 0}))}}}};
  const json attributes = {
      {"POSITION", positions},
      {"NORMAL", file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3)},
      {"TEXCOORD_0", file.floats({0, 0, 1, 0, 0, 1, 1, 1}, 2)},
      {"COLOR_0", file.accessor<std::uint8_t>({9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 1, 2}, 3, kUByte, true)}};
  const int indices = file.accessor<std::uint16_t>({0, 1, 2, 2, 1, 3}, 1, kUShort);
  const int node = file.show({{"attributes", attributes}, {"indices", indices}, {"material", 0}}, "Indexed");
  const int strip = file.show({{"attributes", {{"POSITION", positions}}}, {"mode", 5}}, "Strip");
  file.root["nodes"][0]["children"] = {strip};
  file.root["scenes"][0]["nodes"] = {node};
  const json slot = {
      {"index", 0},
      {"extensions",
       {{"KHR_texture_transform", {{"offset", {0.1, 0.2}}, {"rotation", 1}, {"scale", {2, 3}}}}}}};
  file.append("materials",
              {{"pbrMetallicRoughness", {{"baseColorTexture", slot}, {"baseColorFactor", {1, 1, 1, 0.5}}}},
               {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
               {"alphaMode", "MASK"},
               {"extensions",
                {{"KHR_materials_unlit", json::object()},
                 {"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}}});
  const Bytes picture = png(4, 4, Bytes(64, 99));
  file.append("images", {{"bufferView", file.view(picture)}, {"mimeType", "image/png"}});
  file.append("samplers", {{"wrapS", 33071}, {"magFilter", 9728}});
  file.append("textures", {{"source", 0}, {"sampler", 0}});
  const int times = file.floats({0, 1, 2}, 1);
  file.append("animations",
              {{"channels",
                {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}},
                 {{"sampler", 1}, {"target", {{"node", strip}, {"path", "rotation"}}}}}},
               {"samplers",
                {{{"input", times},
                  {"output", file.floats(std::vector<float>(27, 0.5f), 3)},
                  {"interpolation", "CUBICSPLINE"}},
                 {{"input", times}, {"output", file.floats({0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0}, 4)}}}}});
  file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  file.list_in_scene(file.append("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}}));
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 2}},
                                                              {{"type", "directional"}}};
  for (const int light : {0, 1}) {
    file.list_in_scene(file.append("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}}));
  }
  return file;
}

// Loads, and uses what was loaded. Returns whether it was a scene.
bool load_and_use(const std::string& path) {
  const Result<Scene> result = scenes::load_gltf(path);
  if (!result.ok()) {
    EXPECT_EQ(result.status().code(), StatusCode::kIoFailure);
    EXPECT_NE(result.status().message().find(path), std::string::npos) << result.status().message();
    return false;
  }
  const Scene& scene = result.value();
  const Status status = scenes::check_scene(scene);
  EXPECT_TRUE(status.ok()) << status.message();
  for (const double seconds : {0.0, 0.7, -1e9, 1e18}) {
    (void)scene.camera(seconds);
    for (const scenes::Instance& instance : scene.instances) {
      if (instance.motion) (void)instance.motion(seconds);
    }
  }
  return true;
}

class GltfFuzz : public ::testing::Test {
 protected:
  void SetUp() override {
    level_ = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);  // thousands of warnings
  }
  void TearDown() override { spdlog::set_level(level_); }

  bool survives(const void* bytes, std::size_t size) {
    const std::string path = folder_.file("damaged.gltf");
    std::filesystem::remove(path);  // overwriting in place makes some file systems wait for the disk
    write_bytes(path, bytes, size);
    return load_and_use(path);
  }
  bool survives(const Bytes& bytes) { return survives(bytes.data(), bytes.size()); }

  TemporaryFolder folder_;

 private:
  spdlog::level::level_enum level_ = spdlog::level::info;
};

void damage_bytes(Bytes& bytes, std::size_t first, Random& random) {
  const auto place = [&] { return first + static_cast<std::size_t>(random.next() % (bytes.size() - first)); };
  for (int hit = 0, hits = 1 + random.below(4); hit < hits; ++hit) {
    switch (random.below(5)) {
      case 0:
        bytes[place()] ^= static_cast<std::uint8_t>(1 << random.below(8));
        break;
      case 1:
        bytes[place()] = static_cast<std::uint8_t>(random.below(256));
        break;
      case 2:
        bytes[place()] = random.below(2) == 0 ? 0xff : 0x00;
        break;
      case 3: {  // a run copied over another
        const std::size_t from = place();
        const std::size_t to = place();
        const std::size_t count = std::min({bytes.size() - from, bytes.size() - to, std::size_t{16}});
        std::copy_n(Bytes(bytes).begin() + static_cast<std::ptrdiff_t>(from), count,
                    bytes.begin() + static_cast<std::ptrdiff_t>(to));
        break;
      }
      default:
        if (random.below(8) == 0) bytes.resize(std::max(place(), first + 1));
        break;
    }
  }
}

TEST_F(GltfFuzz, DamagedBytesOfABinaryFile) {
  const Bytes good = everything().glb();
  ASSERT_TRUE(survives(good));
  Random random(1);
  int scenes_left = 0;
  for (int round = 0; round < rounds(); ++round) {
    Bytes bytes = good;
    damage_bytes(bytes, 0, random);
    SCOPED_TRACE(round);
    scenes_left += survives(bytes) ? 1 : 0;
  }
  EXPECT_GT(scenes_left, 0) << "some damage only changes values";
  EXPECT_LT(scenes_left, rounds());
}

// The JSON stays as it is, so that damage reaches accessors and the image.
TEST_F(GltfFuzz, DamagedBinaryChunk) {
  const GltfFile file = everything();
  const Bytes good = file.glb();
  const std::size_t first = good.size() - file.binary.size();
  Random random(2);
  int scenes_left = 0;
  for (int round = 0; round < rounds(); ++round) {
    Bytes bytes = good;
    damage_bytes(bytes, first, random);
    SCOPED_TRACE(round);
    scenes_left += survives(bytes) ? 1 : 0;
  }
  EXPECT_GT(scenes_left, 0);
}

TEST_F(GltfFuzz, EveryTruncation) {
  const Bytes good = everything().glb();
  for (std::size_t size = 0; size < good.size(); size += size < 64 ? 1 : 7) {
    SCOPED_TRACE(size);
    EXPECT_FALSE(survives(good.data(), size));
  }
}

// Walks to a value somewhere in the document.
json* somewhere(json& root, Random& random) {
  json* value = &root;
  while (value->is_structured() && !value->empty() && random.below(8) != 0) {
    auto child = value->begin();
    std::advance(child, random.below(static_cast<int>(value->size())));
    value = &*child;
  }
  return value;
}

json odd_value(Random& random) {
  static const json values =
      json::parse(R"([-1, 0, 1, 2, 3, 5, 255, 65535, 2147483647, 2147483648, 4294967295,
    4294967296, 9223372036854775807, 18446744073709551615, -9223372036854775808, 1e300, -1e300, 1e-320, 0.5, null,
    true, false, "", "x", "data:,", "data:;base64,AAAAAAAA", "../", "%00", "/dev/zero", "MASK", "VEC3", "SCALAR",
    "STEP", "rotation", [], {}, [0], [1, 2, 3], [0, 0, 0, 0], {"index": 0}, [[[[]]]], 5121, 5126, 3e38])");
  return values[static_cast<std::size_t>(random.below(static_cast<int>(values.size())))];
}

TEST_F(GltfFuzz, DamagedJson) {
  const GltfFile good = everything();
  Random random(3);
  int scenes_left = 0;
  for (int round = 0; round < rounds(); ++round) {
    GltfFile file = good;
    for (int hit = 0, hits = 1 + random.below(3); hit < hits; ++hit) {
      json* target = somewhere(file.root, random);
      const json other = *somewhere(file.root, random);
      switch (random.below(3)) {
        case 0:
          *target = other;
          break;
        case 1:
          if (target->is_structured() && !target->empty()) {
            auto child = target->begin();
            std::advance(child, random.below(static_cast<int>(target->size())));
            target->erase(child);
            break;
          }
          [[fallthrough]];
        default:
          *target = odd_value(random);
      }
    }
    if (!file.root.is_object()) continue;
    SCOPED_TRACE(round);
    scenes_left += survives(file.glb()) ? 1 : 0;
  }
  EXPECT_GT(scenes_left, 0);
}

// Text damage reaches the parser and, with the buffer inside, the base64.
TEST_F(GltfFuzz, DamagedText) {
  const std::string text = [] {
    GltfFile file = everything();
    file.root["buffers"] =
        json::array({{{"byteLength", file.binary.size()}, {"uri", "data:;base64," + base64(file.binary)}}});
    return file.root.dump();
  }();
  const Bytes good(text.begin(), text.end());
  ASSERT_TRUE(survives(good));
  Random random(4);
  for (int round = 0; round < rounds(); ++round) {
    Bytes bytes = good;
    damage_bytes(bytes, 0, random);
    SCOPED_TRACE(round);
    survives(bytes);
  }
}

}  // namespace
}  // namespace quincunx::testing
