// SPDX-License-Identifier: MIT
// SceneAssembly: collects the parts of a procedural scene. And what several of them share: motions, all of which
// repeat, cameras, and props.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "builtin/mesh_builder.h"
#include "builtin/textures.h"
#include "scene.h"

namespace quincunx::scenes {

inline constexpr double kDuration =
    8;  // seconds after which a scene repeats, unless it has a reason for others

class SceneAssembly {
 public:
  Scene scene;

  int add(Texture texture);  // the indices within the scene
  int add(Material material);
  int add(Mesh mesh);
  // A dielectric with the colour of a surface and, where asked for, its relief and its own roughness; each is
  // a texture more to sample.
  enum class Detail { kColour, kRelief, kReliefAndRoughness };
  int add_surface(const std::string& name, const Surface& surface, Detail detail = Detail::kRelief);

  // Returns the builder of what stands still, which is collected in one mesh per material and part of the scene; parts
  // that lie apart let the renderer leave out what is not seen, and the lamps that do not reach.
  MeshBuilder& still(int material, int part = 0);

  void place(int mesh, const glm::mat4& transform);
  void move(int mesh, Motion motion);
  void move(MeshBuilder& built, Motion motion) { move(add(built.take()), std::move(motion)); }

  // Adds what was collected; call once, last.
  Scene finish();

 private:
  std::string name_of(int mesh) const;

  std::map<std::pair<int, int>, MeshBuilder> still_;
};

Material plain_material(std::string name, glm::vec3 colour, float roughness, float metallic = 0);
Material unlit_material(std::string name, glm::vec3 colour);  // shown as is; vertex colours multiply
Material lamp_material(std::string name, glm::vec3 radiance);

glm::mat4 moved_to(glm::vec3 position);
glm::mat4 turned(float angle, glm::vec3 axis);            // about the origin
glm::mat4 looking_from(glm::vec3 eye, glm::vec3 target);  // world from camera

// The whole turns that `cycles` within `period` seconds make up to `seconds`, as an angle.
float phase_at(double seconds, double period, int cycles = 1);

// `rest` swinging about `axis` through its origin: amplitude in radians.
Motion swinging(const glm::mat4& rest, glm::vec3 axis, float amplitude, double period, int cycles,
                float phase);
// `rest` turning about `axis` through its origin.
Motion spinning(const glm::mat4& rest, glm::vec3 axis, double period, int cycles);

// A camera that stands still for `duration` seconds, the scene's.
void hold_camera(Scene& scene, double duration, float vertical_fov, glm::vec3 eye, glm::vec3 target);
// A camera that moves, over `duration` seconds, the scene's. `place`: world from camera at a time.
void move_camera(Scene& scene, double duration, float vertical_fov, std::function<glm::mat4(double)> place);
// A camera that swings to and fro once in `duration` seconds, the scene's. `place`: world from camera, of -1 to 1.
void swing_camera(Scene& scene, double duration, float vertical_fov, std::function<glm::mat4(float)> place);

// Lettering on a sheet: a title, a motif of five pips, lines of text, small print.
struct Poster {
  int width = 768;  // pixels
  int height = 1024;
  glm::vec3 paper{0.93f, 0.89f, 0.80f};  // as displayed
  glm::vec3 ink{0.13f, 0.12f, 0.14f};
  glm::vec3 accent{0.70f, 0.16f, 0.12f};
  std::string title;
  std::vector<std::string> lines;
  std::vector<std::string> small_print;
  std::uint64_t seed = 0;
};
Texture poster_texture(const Poster& poster);
Poster quincunx_poster(std::uint64_t seed);  // what the name means, and the alphabet
Poster die_poster(std::uint64_t seed);
Poster figures_poster(std::uint64_t seed);

// A material that shows a texture, matt.
int add_picture_material(SceneAssembly& assembly, const std::string& name, Texture texture);

// A brick wall that faces +z, its foot at y = 0, with a stone base and posters; `width` around x = 0.
void add_poster_wall(SceneAssembly& assembly, float width, float height, float z, std::uint64_t seed);

// Paving at y = 0 in front of such a wall: `width` around x = 0, from z = `front` to `depth` behind it.
void add_paving(SceneAssembly& assembly, float width, float front, float depth, std::uint64_t seed);

// A sunny day for scenes without a mood of their own.
void set_daylight(Scene& scene);

}  // namespace quincunx::scenes
