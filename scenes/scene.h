// SPDX-License-Identifier: MIT
// Scene: everything a renderer needs to know, as data. No GL here.
//
// World space is right-handed, y up, metres; colours are linear, light in arbitrary radiometric units. All
// motion is a pure function of time in seconds, so any frame can be drawn in any order, twice, and come out
// the same.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

struct Vertex {
  glm::vec3 position{0};
  glm::vec3 normal{0, 1, 0};
  glm::vec2 uv{0};
  glm::vec4 colour{1};  // multiplies the base colour
};

enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };

struct Texture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, row 0 at v = 0
  bool srgb = true;                // RGB is sRGB encoded
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
  bool nearest = false;  // no filtering; else trilinear with mipmaps and anisotropy
};

struct TextureSlot {
  int texture = -1;        // index into Scene::textures; -1: none
  glm::mat3 transform{1};  // transform of uv (KHR_texture_transform)
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

// Metallic-roughness as in glTF 2.0.
struct Material {
  std::string name;
  glm::vec4 base_colour{1};
  float metallic = 0;
  float roughness = 1;
  glm::vec3 emissive{0};  // may exceed 1: lamps
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;
  float reactive = 1;  // kBlend only: reactive value written where alpha is 1
  TextureSlot base_colour_texture;
  TextureSlot metallic_roughness_texture;  // G roughness, B metallic
  TextureSlot emissive_texture;
  TextureSlot normal_texture;  // tangent space from screen-space derivatives
  float normal_scale = 1;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise seen from the front
  int material = 0;
};

using Motion = std::function<glm::mat4(double seconds)>;

struct Instance {
  int mesh = 0;
  glm::mat4 transform{1};  // world from mesh, when there is no motion
  Motion motion;           // world from mesh at a time; empty: it stands still
  std::string name = {};   // name of the object that it belongs to; several may share it
};

// A camera-facing, additively or alpha blended quad; no velocity, reactive.
struct Particle {
  glm::vec3 position{0};
  float radius = 0.1f;
  glm::vec4 colour{1};  // premultiplied linear; alpha 0: purely additive
};
using ParticleSystem = std::function<void(double seconds, std::vector<Particle>& particles)>;

struct Camera {
  glm::mat4 world_from_camera{1};  // looks along -z
  float vertical_fov = 1.0f;       // radians
  float near_plane = 0.1f;         // metres; the far plane is at infinity
};
using CameraPath = std::function<Camera(double seconds)>;

struct SunLight {
  glm::vec3 direction{0, -1, 0};  // the way light travels; normalised by the renderer
  glm::vec3 irradiance{0};
  bool casts_shadows = true;
};

struct PointLight {
  glm::vec3 position{0};
  glm::vec3 intensity{0};  // radiant intensity: irradiance = intensity / distance^2
  float range = 10;        // metres: falls smoothly to zero
};

enum class Background : std::uint8_t {
  kSky,
  kPlain,  // `zenith` everywhere
  kNone,   // colour and alpha 0: what no surface covers is transparent
};

struct Sky {
  Background background = Background::kSky;
  // Its velocity is that of the camera's turning; else it is 0, as many renderers write it.
  bool has_velocity = true;
  glm::vec3 zenith{0.2f, 0.4f, 0.8f};
  glm::vec3 horizon{0.6f, 0.7f, 0.8f};
  glm::vec3 ground{0.2f, 0.18f, 0.15f};
  glm::vec3 sun_radiance{0};  // radiance of a disc along -sun.direction; 0: none
  float sun_radius = 0.02f;   // radians
};

// A square that a fault of the renderer leaves in the colour of one frame, the first at or after `seconds`. Truth,
// which is drawn without a frame before it, has none.
struct Fault {
  double seconds = 0;  // in [0, Scene::duration)
  glm::vec2 place{0};  // upper left corner, parts of the viewport's width and height, in [0, 1)
  float side = 0;      // part of the viewport's height, in [0, 1)
  float value = 0;     // R, G and B; anything, infinity and NaN too
};

struct Bounds {
  glm::vec3 low{0};
  glm::vec3 high{0};
};

struct Scene {
  std::string name;
  std::string summary;  // one line: what is seen
  std::string reason;   // one line: what it tests
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  ParticleSystem particles;  // empty: none
  SunLight sun;
  std::vector<PointLight> lights;  // at most kMaxPointLights
  Sky sky;
  CameraPath camera;
  bool camera_moves = false;
  std::vector<Fault> faults;
  std::vector<double> cuts;  // seconds in [0, duration), ascending: where another shot begins
  double duration = 4;       // seconds after which it is meant to repeat or end
  float exposure = 1;

  static constexpr int kMaxPointLights = 16;
};

// Returns the facts from which follows what the resolve plan may leave out.
SceneNeeds needs_of(const Scene& scene);

// Returns whether the frame at `seconds` belongs to another shot than the one at `previous_seconds`: nothing of that
// one may be used then.
bool is_cut(const Scene& scene, double previous_seconds, double seconds);

// Returns whether the frame at `seconds` that follows on one at `previous_seconds` shows a fault; a scene repeats.
bool shows(const Scene& scene, const Fault& fault, double previous_seconds, double seconds);

// The first cut at or after `seconds`; nothing where the scene has none.
std::optional<double> next_cut(const Scene& scene, double seconds);

// Returns the box around a mesh's vertices; zeros where it has none.
Bounds bounds_of(const Mesh& mesh);

// Returns the axis-aligned box around a transformed box.
Bounds transformed(const Bounds& box, const glm::mat4& transform);

// Checks whether a scene holds together: indices, sizes, counts, finite positions. Errors: kInvalidArgument; the
// message names the first object that does not, what it holds and what would be right.
Status check_scene(const Scene& scene);

}  // namespace quincunx::scenes
