// SPDX-License-Identifier: MIT
#include "builtin/scene_assembly.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "random.h"

namespace quincunx::scenes {

int SceneAssembly::add(Texture texture) {
  scene.textures.push_back(std::move(texture));
  return static_cast<int>(scene.textures.size()) - 1;
}

int SceneAssembly::add(Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

int SceneAssembly::add(Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene.meshes.size()) - 1;
}

int SceneAssembly::add_surface(const std::string& name, const Surface& surface, Detail detail) {
  constexpr float kNormalStrength = 0.8f;
  const bool own_roughness = detail == Detail::kReliefAndRoughness;
  Material material = plain_material(name, glm::vec3(1), own_roughness ? 1 : surface.roughness.front());
  material.base_colour_texture.texture = add(colour_texture(surface));
  if (detail != Detail::kColour)
    material.normal_texture.texture = add(normal_texture(surface, kNormalStrength));
  if (own_roughness) material.metallic_roughness_texture.texture = add(roughness_texture(surface));
  return add(std::move(material));
}

MeshBuilder& SceneAssembly::still(int material, int part) {
  return still_.try_emplace({part, material}, material).first->second;
}

// A mesh without a name of its own has that of its material.
std::string SceneAssembly::name_of(int mesh) const {
  const int material = scene.meshes[static_cast<std::size_t>(mesh)].material;
  return scene.materials[static_cast<std::size_t>(material)].name;
}

void SceneAssembly::place(int mesh, const glm::mat4& transform) {
  scene.instances.push_back({mesh, transform, {}, name_of(mesh)});
}

void SceneAssembly::move(int mesh, Motion motion) {
  scene.instances.push_back({mesh, motion(0), std::move(motion), name_of(mesh)});
}

Scene SceneAssembly::finish() {
  for (auto& [key, builder] : still_) {
    if (!builder.empty()) place(add(builder.take()), glm::mat4(1));
  }
  still_.clear();
  return std::move(scene);
}

Material plain_material(std::string name, glm::vec3 colour, float roughness, float metallic) {
  Material material;
  material.name = std::move(name);
  material.base_colour = glm::vec4(colour, 1);
  material.roughness = roughness;
  material.metallic = metallic;
  return material;
}

Material unlit_material(std::string name, glm::vec3 colour) {
  Material material = plain_material(std::move(name), colour, 1);
  material.unlit = true;
  return material;
}

Material lamp_material(std::string name, glm::vec3 radiance) {
  Material material = plain_material(std::move(name), glm::vec3(0.04f), 0.6f);
  material.emissive = radiance;
  return material;
}

glm::mat4 moved_to(glm::vec3 position) {
  return glm::translate(glm::mat4(1), position);
}

glm::mat4 turned(float angle, glm::vec3 axis) {
  return glm::rotate(glm::mat4(1), angle, axis);
}

glm::mat4 looking_from(glm::vec3 eye, glm::vec3 target) {
  return glm::inverse(glm::lookAt(eye, target, glm::vec3(0, 1, 0)));
}

float phase_at(double seconds, double period, int cycles) {
  const double turns = seconds / period * cycles;
  return static_cast<float>(glm::two_pi<double>() * (turns - std::floor(turns)));
}

Motion swinging(const glm::mat4& rest, glm::vec3 axis, float amplitude, double period, int cycles,
                float phase) {
  return [=](double seconds) {
    return rest * turned(amplitude * std::sin(phase_at(seconds, period, cycles) + phase), axis);
  };
}

Motion spinning(const glm::mat4& rest, glm::vec3 axis, double period, int cycles) {
  return [=](double seconds) { return rest * turned(phase_at(seconds, period, cycles), axis); };
}

void hold_camera(Scene& scene, double duration, float vertical_fov, glm::vec3 eye, glm::vec3 target) {
  scene.duration = duration;
  const Camera camera{.world_from_camera = looking_from(eye, target), .vertical_fov = vertical_fov};
  scene.camera = [camera](double) { return camera; };
}

void move_camera(Scene& scene, double duration, float vertical_fov, std::function<glm::mat4(double)> place) {
  scene.duration = duration;
  scene.camera_moves = true;
  scene.camera = [vertical_fov, place = std::move(place)](double seconds) {
    return Camera{.world_from_camera = place(seconds), .vertical_fov = vertical_fov};
  };
}

void swing_camera(Scene& scene, double duration, float vertical_fov, std::function<glm::mat4(float)> place) {
  move_camera(scene, duration, vertical_fov, [=, place = std::move(place)](double seconds) {
    return place(std::sin(phase_at(seconds, duration)));
  });
}

namespace {

glm::vec4 opaque(glm::vec3 colour) {
  return {colour, 1};
}

float fitted_height(const std::string& text, float wanted, float width) {
  const float natural = text_width(text, {1, 0, Align::kLeft});
  return natural > 0 ? std::min(wanted, width / natural) : wanted;
}

}  // namespace

Texture poster_texture(const Poster& poster) {
  const glm::vec2 size(poster.width, poster.height);
  const float unit = size.x / 768;
  Canvas canvas(poster.width, poster.height, opaque(poster.paper));
  const float margin = 40 * unit;
  for (const float inset : {margin, margin + 12 * unit}) {
    const glm::vec2 low(inset);
    const glm::vec2 high = size - inset;
    canvas.stroke({low, {high.x, low.y}, high, {low.x, high.y}, low}, (inset > margin ? 2.0f : 6.0f) * unit,
                  opaque(poster.ink));
  }
  const float inner = size.x - 4 * margin;
  const float middle = size.x / 2;
  float y = 190 * unit;
  const float title = fitted_height(poster.title, 110 * unit, inner);
  canvas.text(poster.title, {middle, y}, {title, 0, Align::kCentre}, 0.17f, opaque(poster.accent));
  const glm::vec2 die(middle, y + 230 * unit);
  const float half = 150 * unit;
  canvas.rectangle(die - half, die + half, opaque(poster.accent));
  canvas.rectangle(die - half + 10.0f * unit, die + half - 10.0f * unit, opaque(poster.paper));
  for (const glm::vec2 pip : {glm::vec2(-1, -1), {1, -1}, {0, 0}, {-1, 1}, {1, 1}}) {
    canvas.disc(die + pip * 84.0f * unit, 29 * unit, opaque(poster.ink));
  }
  y = die.y + half + 88 * unit;
  for (const std::string& line : poster.lines) {
    const float height = fitted_height(line, 40 * unit, inner);
    canvas.text(line, {middle, y}, {height, 0.04f, Align::kCentre}, 0.15f, opaque(poster.ink));
    y += 1.8f * 40 * unit;
  }
  y += 4 * unit;
  for (const std::string& line : poster.small_print) {
    const float height = fitted_height(line, 17 * unit, inner);
    canvas.text(line, {middle, y}, {height, 0.06f, Align::kCentre}, 0.15f, opaque(poster.ink));
    y += 2.0f * 17 * unit;
  }
  const FractalNoise age(3, 3, poster.seed);
  canvas.shade([&](glm::vec2 at) { return 0.86f + 0.16f * age(at); });
  return canvas.texture();
}

Poster quincunx_poster(std::uint64_t seed) {
  return {.title = "QUINCUNX",
          .lines = {"FIVE OF A DIE", "FOUR CORNERS, ONE CENTRE"},
          .small_print = {"From quinque and uncia: five twelfths of a Roman coin, marked by five dots.",
                          "Gardeners plant orchards in it; renderers place their samples in it.",
                          "ABCDEFGHIJKLMNOPQRSTUVWXYZ  abcdefghijklmnopqrstuvwxyz  0123456789"},
          .seed = seed};
}

Poster die_poster(std::uint64_t seed) {
  return {.paper = {0.20f, 0.31f, 0.42f},
          .ink = {0.94f, 0.91f, 0.84f},
          .accent = {0.93f, 0.68f, 0.24f},
          .title = "HALF A PIXEL",
          .lines = {"ODD FRAMES, EVEN FRAMES", "RESOLVED AS ONE PICTURE"},
          .small_print = {"Frame n lies a quarter of a pixel to one side, frame n - 1 to the other.",
                          "abcdefghijklmnopqrstuvwxyz  0123456789  ( + - = / % )"},
          .seed = seed};
}

Poster figures_poster(std::uint64_t seed) {
  return {.paper = {0.84f, 0.72f, 0.44f},
          .ink = {0.18f, 0.13f, 0.10f},
          .accent = {0.16f, 0.33f, 0.27f},
          .title = "0123456789",
          .lines = {"ABCDEFGHIJKLMNOPQRS", "TUVWXYZ abcdefghijklm"},
          .small_print = {"nopqrstuvwxyz . , : ; ! ? ' ( ) [ ] { } < > + - = * / & % # @",
                          "Read this line from where you stand: that is the resolution."},
          .seed = seed};
}

int add_picture_material(SceneAssembly& assembly, const std::string& name, Texture texture) {
  Material material = plain_material(name, glm::vec3(1), 0.85f);
  material.base_colour_texture.texture = assembly.add(std::move(texture));
  return assembly.add(std::move(material));
}

void add_poster_wall(SceneAssembly& assembly, float width, float height, float z, std::uint64_t seed) {
  MeshBuilder& brick = assembly.still(assembly.add_surface("brick", brick_surface(512, seed)));
  brick.pen.uv_per_metre = 1 / 1.92f;
  brick.patch({-width / 2, 0.5f, z}, {width, 0, 0}, {0, height - 0.5f, 0});
  MeshBuilder& stone = assembly.still(
      assembly.add_surface("stone", stone_surface(256, seed + 1), SceneAssembly::Detail::kColour));
  stone.box({-width / 2, 0, z - 0.2f}, {width / 2, 0.5f, z + 0.08f});
  stone.box({-width / 2, height, z - 0.3f}, {width / 2, height + 0.18f, z + 0.15f});
  const int materials[] = {
      add_picture_material(assembly, "poster: quincunx", poster_texture(quincunx_poster(seed))),
      add_picture_material(assembly, "poster: half a pixel", poster_texture(die_poster(seed))),
      add_picture_material(assembly, "poster: figures", poster_texture(figures_poster(seed)))};
  Random random(seed, 5);
  constexpr float kPitch = 2.3f;
  const int count = static_cast<int>(width / kPitch) - 1;
  for (int i = 0; i < count; ++i) {
    const float x = (static_cast<float>(i) - static_cast<float>(count - 1) / 2) * kPitch;
    const float tilt = 0.03f * random.signed_unit();
    const glm::vec2 size = glm::vec2(1.5f, 2.0f) * random.range(0.85f, 1.0f);
    const float low = 1.0f + random.range(0.0f, 0.4f);
    MeshBuilder& poster = assembly.still(materials[i % 3]);
    poster.pen.placement = moved_to({x, low, z + 0.01f}) * turned(tilt, {0, 0, 1});
    poster.picture({-size.x / 2, 0, 0}, {size.x, 0, 0}, {0, size.y, 0});
    poster.pen.placement = glm::mat4(1);
  }
}

void add_paving(SceneAssembly& assembly, float width, float front, float depth, std::uint64_t seed) {
  MeshBuilder& paving = assembly.still(assembly.add_surface("paving", paving_surface(512, seed)));
  paving.pen.uv_per_metre = 1 / 2.4f;
  paving.patch({-width / 2, 0, front}, {width, 0, 0}, {0, 0, -depth});
}

void set_daylight(Scene& scene) {
  scene.sun.direction = glm::normalize(glm::vec3(-0.45f, -0.75f, -0.5f));
  scene.sun.irradiance = {4.6f, 4.1f, 3.3f};
  scene.sky.zenith = {0.09f, 0.22f, 0.56f};
  scene.sky.horizon = {0.46f, 0.56f, 0.70f};
  scene.sky.ground = {0.17f, 0.15f, 0.12f};
  scene.exposure = 0.8f;
  scene.sky.sun_radiance = {120, 110, 90};
}

}  // namespace quincunx::scenes
