// SPDX-License-Identifier: MIT
#include "builtin/scene_assembly.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

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

Motion sliding(const glm::mat4& rest, glm::vec3 way, double period, int cycles, float phase) {
  return [=](double seconds) {
    return rest * moved_to(way * std::sin(phase_at(seconds, period, cycles) + phase));
  };
}

Motion spinning(const glm::mat4& rest, glm::vec3 axis, double period, int cycles) {
  return [=](double seconds) { return rest * turned(phase_at(seconds, period, cycles), axis); };
}

void hold_camera(Scene& scene, double duration, float vertical_fov, glm::vec3 eye, glm::vec3 target) {
  scene.duration = duration;
  Camera camera;
  camera.vertical_fov = vertical_fov;
  camera.world_from_camera = looking_from(eye, target);
  scene.camera = [camera](double) { return camera; };
}

void swing_camera(Scene& scene, double duration, float vertical_fov, std::function<glm::mat4(float)> place) {
  scene.duration = duration;
  scene.camera_moves = true;
  scene.camera = [=, place = std::move(place)](double seconds) {
    Camera camera;
    camera.vertical_fov = vertical_fov;
    camera.world_from_camera = place(std::sin(phase_at(seconds, duration)));
    return camera;
  };
}

}  // namespace quincunx::scenes
