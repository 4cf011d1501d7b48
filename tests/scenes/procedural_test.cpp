// SPDX-License-Identifier: MIT
// The built-in scenes: whole, repeatable, and what their reason says they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "catalog/scene_catalog.h"
#include "render_fixture.h"
#include "scene.h"

namespace quincunx::scenes {
namespace {

constexpr std::size_t kMostTriangles = 300'000;  // software rasterisers must draw every scene
constexpr int kLargestTexture = 1024;
constexpr float kUnitTolerance = 1e-3f;  // normal's length: fp32 through a few products of rotations
// Metres: phases are exact at the end of the loop, positions are not (fp32 at a radius of 30 m: 2e-6 m an
// operation).
constexpr float kLoopTolerance = 1e-4f;
constexpr double kFrame = 1.0 / 60;

bool finite(const glm::mat4& matrix) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(matrix[c][r])) return false;
    }
  }
  return true;
}

float largest_difference(const glm::mat4& a, const glm::mat4& b) {
  float largest = 0;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r)
      largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
  }
  return largest;
}

// FNV-1a over everything a scene shows.
class Fingerprint {
 public:
  template <typename T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); ++i)
      hash_ = (hash_ ^ bytes[i]) * 0x100000001b3u;
  }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size());
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::uint64_t fingerprint(const Scene& scene) {
  Fingerprint print;
  for (const Texture& texture : scene.textures)
    print.add(texture.rgba);
  for (const Mesh& mesh : scene.meshes) {
    print.add(mesh.vertices);
    print.add(mesh.indices);
  }
  for (const double seconds : {0.0, 0.7, 3.1}) {
    for (const Instance& instance : scene.instances) {
      const glm::mat4 place = instance.motion ? instance.motion(seconds) : instance.transform;
      print.add(&place, 1);
    }
    std::vector<Particle> particles;
    if (scene.particles) scene.particles(seconds, particles);
    print.add(particles);
    const Camera camera = scene.camera(seconds);
    print.add(&camera, 1);
  }
  return print.value();
}

class BuiltInScene : public ::testing::TestWithParam<SceneEntry> {
 protected:
  static Scene open(std::uint64_t seed = 0) {
    Result<Scene> scene = open_scene(GetParam().name, seed);
    EXPECT_TRUE(scene.ok()) << scene.status().message();
    return std::move(scene).value();
  }
};

void check_vertices(const Mesh& mesh, std::size_t index) {
  for (const Vertex& vertex : mesh.vertices) {
    ASSERT_NEAR(glm::length(vertex.normal), 1, kUnitTolerance) << "mesh " << index;
    ASSERT_TRUE(std::isfinite(vertex.uv.x) && std::isfinite(vertex.uv.y)) << "mesh " << index;
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(std::isfinite(vertex.colour[i]) && vertex.colour[i] >= 0) << "mesh " << index;
    }
  }
}

// Triangles face the way their normals point; foliage is seen from both sides with one normal, so it is left
// out.
void check_facing(const Mesh& mesh, std::size_t index) {
  std::size_t turned = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vertex& a = mesh.vertices[mesh.indices[i]];
    const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
    const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
    const glm::vec3 face = glm::cross(b.position - a.position, c.position - a.position);
    const glm::vec3 normal = a.normal + b.normal + c.normal;
    if (glm::dot(face, normal) < -1e-3f * glm::length(face) * glm::length(normal)) ++turned;
  }
  EXPECT_EQ(turned, 0u) << "mesh " << index << " of " << mesh.indices.size() / 3 << " triangles";
}

void check_particles_repeat(const Scene& scene, double seconds) {
  std::vector<Particle> now;
  std::vector<Particle> later;
  scene.particles(seconds, now);
  scene.particles(seconds + scene.duration, later);
  ASSERT_FALSE(now.empty());
  ASSERT_EQ(now.size(), later.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_LT(glm::length(now[i].position - later[i].position), kLoopTolerance);
  }
}

TEST_P(BuiltInScene, IsWhole) {
  const Scene scene = open();
  const Status status = check_scene(scene);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(scene.name, GetParam().name);
  EXPECT_FALSE(scene.summary.empty());
  EXPECT_FALSE(scene.reason.empty());
  EXPECT_GT(scene.exposure, 0);
  EXPECT_GT(scene.duration, 0);
  for (const Texture& texture : scene.textures) {
    EXPECT_LE(std::max(texture.width, texture.height), kLargestTexture);
  }
  std::size_t triangles = 0;
  for (const Instance& instance : scene.instances) {
    triangles += scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size() / 3;
  }
  EXPECT_GT(triangles, 100u);
  EXPECT_LE(triangles, kMostTriangles);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    check_vertices(mesh, i);
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.alpha_mode != AlphaMode::kMask) check_facing(mesh, i);
  }
}

TEST_P(BuiltInScene, MovesFinitelyAndRepeatsAfterItsDuration) {
  const Scene scene = open();
  constexpr int kLooks = 25;
  std::vector<Particle> particles;
  for (int i = 0; i <= kLooks; ++i) {
    const double seconds = scene.duration * i / kLooks;
    for (const Instance& instance : scene.instances) {
      ASSERT_TRUE(!instance.motion || finite(instance.motion(seconds)));
    }
    const Camera camera = scene.camera(seconds);
    ASSERT_TRUE(finite(camera.world_from_camera));
    ASSERT_GT(camera.near_plane, 0);
    ASSERT_GT(camera.vertical_fov, 0);
    if (!scene.particles) continue;
    scene.particles(seconds, particles);
    for (const Particle& particle : particles) {
      ASSERT_TRUE(std::isfinite(glm::dot(particle.position, particle.position)));
      ASSERT_GT(particle.radius, 0);
      ASSERT_TRUE(std::isfinite(glm::dot(particle.colour, particle.colour)));
      ASSERT_LE(particle.colour.a, 1);
    }
  }
  for (const double seconds : {0.0, 0.31}) {
    const double later = seconds + scene.duration;
    for (const Instance& instance : scene.instances) {
      if (instance.motion) {
        EXPECT_LT(largest_difference(instance.motion(seconds), instance.motion(later)), kLoopTolerance);
      }
    }
    EXPECT_LT(
        largest_difference(scene.camera(seconds).world_from_camera, scene.camera(later).world_from_camera),
        kLoopTolerance);
    if (scene.particles) check_particles_repeat(scene, seconds);
  }
}

TEST_P(BuiltInScene, FollowsItsSeed) {
  const std::uint64_t first = fingerprint(open(7));
  EXPECT_EQ(first, fingerprint(open(7)));
  if (GetParam().name == "chart") {
    EXPECT_EQ(first, fingerprint(open(8))) << "nothing of the chart is random";
  } else {
    EXPECT_NE(first, fingerprint(open(8)));
  }
}

struct ExpectedNeeds {
  const char* scene;
  bool objects, camera, transparents;
};

// The needs that each scene's reason promises.
constexpr std::array kExpectedNeeds = std::to_array<ExpectedNeeds>({{"courtyard", true, true, true},
                                                                    {"chart", false, false, false},
                                                                    {"pan", false, true, false},
                                                                    {"wires", false, true, false},
                                                                    {"wheel", true, false, false},
                                                                    {"occluders", true, false, false},
                                                                    {"particles", true, true, true},
                                                                    {"flight", true, true, true},
                                                                    {"still", false, false, true},
                                                                    {"zoom", false, true, false},
                                                                    {"cut", false, true, false},
                                                                    {"sparkles", true, true, false},
                                                                    {"shadows", true, false, false},
                                                                    {"cables", true, true, false},
                                                                    {"fence", false, true, false},
                                                                    {"backdrop", true, true, false},
                                                                    {"cutout", true, true, false},
                                                                    {"faults", true, false, false}});

// The motion within a frame, found by looking, must be the motion that the scene declares.
TEST_P(BuiltInScene, NeedsAreWhatMovesAndWhatItsReasonSays) {
  const Scene scene = open();
  const SceneNeeds needs = needs_of(scene);
  bool camera_moves = false;
  bool objects_move = false;
  for (int i = 0; i < 16; ++i) {
    const double seconds = scene.duration * i / 16;
    const auto moved = [&](const auto& path) {
      return largest_difference(path(seconds), path(seconds + kFrame)) > 0;
    };
    camera_moves = camera_moves || moved([&](double t) { return scene.camera(t).world_from_camera; });
    for (const Instance& instance : scene.instances) {
      if (instance.motion) objects_move = objects_move || moved(instance.motion);
    }
  }
  EXPECT_EQ(needs.camera_motion, camera_moves);
  EXPECT_EQ(needs.moving_objects, objects_move);
  const auto expected = std::find_if(kExpectedNeeds.begin(), kExpectedNeeds.end(),
                                     [&](const ExpectedNeeds& row) { return scene.name == row.scene; });
  ASSERT_NE(expected, kExpectedNeeds.end()) << "a new scene needs a row";
  EXPECT_EQ(needs.moving_objects, expected->objects);
  EXPECT_EQ(needs.camera_motion, expected->camera);
  EXPECT_EQ(needs.transparents, expected->transparents);
}

TEST_P(BuiltInScene, CutsAreWhereItsCameraJumpsAndNowhereElse) {
  constexpr float kJump = 0.5f;  // in any element of the camera's matrix; a frame of the fastest is 0.08
  const Scene scene = open();
  int cuts = 0;
  const int frames = static_cast<int>(scene.duration / kFrame);
  for (int frame = 0; frame < frames; ++frame) {
    const double now = (frame + 0.5) * kFrame;
    const float way =
        largest_difference(scene.camera(now).world_from_camera, scene.camera(now - kFrame).world_from_camera);
    EXPECT_EQ(is_cut(scene, now - kFrame, now), way > kJump) << now;
    cuts += way > kJump ? 1 : 0;
  }
  EXPECT_EQ(cuts, static_cast<int>(scene.cuts.size()));
  EXPECT_EQ(cuts > 0, scene.name == "cut");
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltInScene, ::testing::ValuesIn(list_scenes()),
                         [](const auto& entry) { return entry.param.name; });

TEST(SceneCatalog, TheDefaultIsTheCourtyard) {
  ASSERT_GE(list_scenes().size(), 6u);
  EXPECT_EQ(list_scenes().front().name, "courtyard");
}

TEST(SceneCatalog, AnUnknownNameGetsOneSentenceWithAllNames) {
  const Result<Scene> scene = open_scene("cortyard");
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.status().code(), StatusCode::kInvalidArgument);
  const std::string message = scene.status().message();
  EXPECT_NE(message.find("'cortyard'"), std::string::npos) << message;
  for (const SceneEntry& entry : list_scenes())
    EXPECT_NE(message.find(entry.name), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(SceneCatalog, AMissingFileIsAnIoFailure) {
  for (const char* path : {"no such file.gltf", "NO SUCH FILE.GLB"}) {
    const Result<Scene> scene = open_scene(path);
    ASSERT_FALSE(scene.ok());
    EXPECT_EQ(scene.status().code(), StatusCode::kIoFailure);
    EXPECT_NE(scene.status().message().find(path), std::string::npos) << scene.status().message();
  }
}

TEST(SceneCatalog, TheNextCutIsAtOrAfterATime) {
  Scene scene;
  scene.duration = 4;
  EXPECT_FALSE(next_cut(scene, 1).has_value());
  EXPECT_FALSE(is_cut(scene, 0, 100));
  scene.cuts = {1, 3};
  EXPECT_EQ(next_cut(scene, 0), 1);
  EXPECT_EQ(next_cut(scene, 1), 1);
  EXPECT_EQ(next_cut(scene, 3.5), 5);
  EXPECT_EQ(next_cut(scene, -2), -1);
  EXPECT_TRUE(is_cut(scene, 0.9, 1));
  EXPECT_FALSE(is_cut(scene, 1, 2.9));
  EXPECT_FALSE(is_cut(scene, 3.5, 4.5));
  EXPECT_TRUE(is_cut(scene, -1.1, -0.9));
  EXPECT_TRUE(is_cut(scene, 2, 0.5)) << "backwards, too";
}

TEST(SceneCatalog, ZoomGrowsByTwoPercentAFrame) {
  const Scene scene = open_scene("zoom").value();
  constexpr float kWall = -3;
  const auto distance = [&](double seconds) { return scene.camera(seconds).world_from_camera[3].z - kWall; };
  const float growth = distance(-kFrame) / distance(0);
  EXPECT_GT(growth, 1.015f);
  EXPECT_LT(growth, 1.025f);
}

TEST(SceneCatalog, OccludersPassTensOfPixelsAFrame) {
  const Result<Scene> opened = open_scene("occluders");
  ASSERT_TRUE(opened.ok());
  const Scene& scene = opened.value();
  constexpr float kHeight = 720;
  const Camera camera = scene.camera(0);
  const glm::mat4 camera_from_world = glm::inverse(camera.world_from_camera);
  const float pixels_per_slope = kHeight / 2 / std::tan(camera.vertical_fov / 2);
  float fastest = 0;
  for (int frame = 0; frame < 480; ++frame) {
    for (const Instance& instance : scene.instances) {
      if (!instance.motion) continue;
      const auto seen = [&](double seconds) {
        return glm::vec3(camera_from_world * instance.motion(seconds)[3]);
      };
      const glm::vec3 now = seen(frame * kFrame);
      const glm::vec3 before = seen((frame - 1) * kFrame);
      const bool in_picture = now.z < -0.5f && std::abs(now.x / now.z) < 0.6f;
      if (in_picture)
        fastest = std::max(fastest, std::abs(now.x / now.z - before.x / before.z) * pixels_per_slope);
    }
  }
  EXPECT_GT(fastest, 30);
  EXPECT_LT(fastest, 100);
}

}  // namespace
}  // namespace quincunx::scenes

// Pixels of the scenes that are hard for history: the scenes are as hard as their reason says.
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
