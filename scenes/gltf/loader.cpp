// SPDX-License-Identifier: MIT
#include "gltf/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "gltf/contents.h"
#include "scene.h"

namespace quincunx::scenes {
namespace {

constexpr glm::vec3 kSunIrradiance{3.3f, 3.1f, 2.8f};
constexpr glm::vec3 kSunDirection{-0.45f, -0.75f, -0.5f};  // from the upper right of who looks along -z

// White paper under this irradiance has radiance 3.2, about what tone mapping still shows as bright.
constexpr float kBrightIrradiance = 10;

// Without a range a light reaches so many times as far as the scene's far side.
constexpr float kReach = 4;

// How much of the day's sky is left where the file lights the scene with lamps alone.
constexpr float kNightSky = 0.1f;

void default_light(Scene& scene) {
  scene.sun.direction = glm::normalize(kSunDirection);
  scene.sun.irradiance = kSunIrradiance;
  scene.sky.sun_radiance = 20.0f * kSunIrradiance;
}

glm::vec3 power_of(const tinygltf::Light& light) {
  glm::vec3 colour(1);
  for (std::size_t c = 0; c < light.color.size() && c < 3; ++c) {
    colour[static_cast<int>(c)] = static_cast<float>(light.color[c]);
  }
  return colour * static_cast<float>(light.intensity);
}

float brightness(const glm::vec3& colour) {
  return std::max({colour.r, colour.g, colour.b});
}

void scale_to_photometric(Scene& scene, const Bounds& bounds) {
  const glm::vec3 centre = 0.5f * bounds.low + 0.5f * bounds.high;
  const float radius = 0.5f * glm::length(bounds.high - bounds.low);
  float irradiance = brightness(scene.sun.irradiance);
  for (const PointLight& light : scene.lights) {
    const float distance = std::max(glm::length(light.position - centre), radius);
    if (distance > 0) irradiance += brightness(light.intensity) / (distance * distance);
  }
  const float gain =
      irradiance > kBrightIrradiance && std::isfinite(irradiance) ? irradiance / kBrightIrradiance : 1.0f;
  scene.exposure = 1 / gain;
  const bool is_day = scene.sun.irradiance != glm::vec3(0);
  for (glm::vec3* colour : {&scene.sky.zenith, &scene.sky.horizon, &scene.sky.ground}) {
    *colour *= gain * (is_day ? 1.0f : kNightSky);
  }
}

// Lights of the given nodes where they stand at time 0. The first directional light becomes the sun, further
// ones and spot lights are left out with a warning, as are point lights beyond Scene::kMaxPointLights. A file
// without lights gets a sun and a sky. Lights in photometric units (thousands of lux or candela) lower
// Scene::exposure so that a white surface in the middle of `bounds` is not burnt out; the sky follows.
void read_lights(GltfDocument& document, const NodeTree& tree, const std::vector<int>& nodes,
                 const Bounds& bounds, Scene& scene) {
  const float diagonal = glm::length(bounds.high - bounds.low);
  bool has_sun = false;
  for (const int node : nodes) {
    const tinygltf::Node& source = document.model.nodes[static_cast<std::size_t>(node)];
    const auto extension = source.extensions.find("KHR_lights_punctual");
    if (extension == source.extensions.end()) continue;
    const int index = extension->second.Get("light").GetNumberAsInt();
    const tinygltf::Light& light = document.model.lights[static_cast<std::size_t>(index)];
    const std::string who = described("light", index, light.name);
    const glm::mat4 world = tree.world(node, 0);
    if (tree.is_animated(node)) document.warn(who + " is animated; it stays where it is at time 0");
    if (light.type == "spot") {
      document.warn(who + " is a spot light, which is left out; point and directional lights are read");
    } else if (light.type == "directional") {
      const glm::vec3 direction = -glm::vec3(world[2]);
      if (has_sun || !(glm::length(direction) > 0)) {
        document.warn(who + " is left out; one directional light can shine, and needs a direction");
        continue;
      }
      has_sun = true;
      scene.sun.direction = glm::normalize(direction);
      scene.sun.irradiance = power_of(light);
    } else if (scene.lights.size() < static_cast<std::size_t>(Scene::kMaxPointLights)) {
      const glm::vec3 place(world[3]);
      const float far_side = diagonal + glm::distance(place, 0.5f * bounds.low + 0.5f * bounds.high);
      const float range = light.range > 0 ? static_cast<float>(light.range) : kReach * far_side;
      scene.lights.push_back({place, power_of(light), range});
    } else {
      document.warn(fmt::format("only the first {} point lights can shine", Scene::kMaxPointLights));
    }
  }
  if (!has_sun && scene.lights.empty()) {
    default_light(scene);
  } else {
    scale_to_photometric(scene, bounds);
  }
}

constexpr double kElevation = 18 * std::numbers::pi / 180;
constexpr double kStart = 30 * std::numbers::pi / 180;
constexpr double kVerticalFov = 40 * std::numbers::pi / 180;
constexpr double kAspect = 4.0 / 3.0;
constexpr double kMargin = 1.08;  // a little air round the box

// The smallest distance from which the cylinder that the box's corners turn on is all in view.
double fitting_distance(double radius, double half_height) {
  constexpr int kSteps = 128;
  const double tan_y = std::tan(kVerticalFov / 2);
  const double tan_x = tan_y * kAspect;
  double distance = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double angle = step * 2 * std::numbers::pi / kSteps;
    const double towards = radius * std::cos(angle);  // horizontally, to the camera's side
    const double across = radius * std::sin(angle);
    for (const double height : {-half_height, half_height}) {
      const double nearer = towards * std::cos(kElevation) + height * std::sin(kElevation);
      const double up = height * std::cos(kElevation) - towards * std::sin(kElevation);
      distance = std::max(distance, nearer + std::max(std::abs(up) / tan_y, std::abs(across) / tan_x));
    }
  }
  return distance * kMargin;
}

// Rigid, at `eye`, with `back` the unit vector away from what it looks at, never straight up or down. From
// the direction, not from two points: far from the origin their difference is lost.
glm::mat4 camera_at(const glm::vec3& eye, const glm::vec3& back) {
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  return {glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(eye, 1)};
}

// A small file can ask for a great deal by using the same data many times.
constexpr std::size_t kMaxVertices = std::size_t{1} << 26;
constexpr std::size_t kMaxInstances = std::size_t{1} << 20;

// Squares and cubes of lengths stay finite in single precision.
constexpr float kMaxCoordinate = 1e9f;

// Moments of the animation that the orbit camera is made to fit.
constexpr int kBoundsMoments = 16;

bool is_sane(const glm::mat4& matrix) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!(std::abs(matrix[c][r]) <= kMaxCoordinate)) return false;
    }
  }
  return true;
}

class SceneReader {
 public:
  explicit SceneReader(GltfDocument document)
      : document_(std::move(document)),
        model_(document_.model),
        tree_(std::make_shared<NodeTree>(document_)) {}

  Scene read() {
    const std::vector<int> nodes = shown_nodes();
    read_materials_into_scene();
    for (const int node : nodes)
      add_instances(node);
    if (scene_.instances.empty()) {
      throw GltfError(fmt::format("there is nothing to draw: none of the {} nodes in its scene has triangles",
                                  nodes.size()));
    }
    const Bounds bounds = bounds_over_time();
    read_lights(document_, *tree_, nodes, bounds, scene_);
    find_camera(nodes, bounds);
    describe();
    return std::move(scene_);
  }

 private:
  // Depth first, in the order of the file.
  std::vector<int> shown_nodes() const {
    std::vector<int> pending;
    if (!model_.scenes.empty()) {
      pending = model_.scenes[static_cast<std::size_t>(std::max(model_.defaultScene, 0))].nodes;
    } else {
      const std::vector<int> parents = parents_of(model_);
      for (int i = 0; i < static_cast<int>(parents.size()); ++i) {
        if (parents[static_cast<std::size_t>(i)] < 0) pending.push_back(i);
      }
    }
    std::reverse(pending.begin(), pending.end());
    std::vector<int> nodes;
    while (!pending.empty()) {
      nodes.push_back(pending.back());
      pending.pop_back();
      const auto& children = model_.nodes[static_cast<std::size_t>(nodes.back())].children;
      pending.insert(pending.end(), children.rbegin(), children.rend());
    }
    return nodes;
  }

  void read_materials_into_scene() {
    materials_ = read_materials(document_);
    scene_.textures = std::move(materials_.textures);
    scene_.materials = materials_.materials;
  }

  // The meshes of a scene for one of the file: each primitive is one.
  const std::vector<int>& scene_meshes(int mesh) {
    const auto [place, is_new] = meshes_.try_emplace(mesh);
    if (!is_new) return place->second;
    const auto& primitives = model_.meshes[static_cast<std::size_t>(mesh)].primitives;
    for (int p = 0; p < static_cast<int>(primitives.size()); ++p) {
      std::optional<Mesh> read = read_primitive(document_, mesh, p, materials_);
      if (!read) continue;
      vertices_ += read->vertices.size() + read->indices.size();
      if (vertices_ > kMaxVertices) {
        throw GltfError(fmt::format(
            "the meshes have more than {} vertices and indices in all, which is the limit", kMaxVertices));
      }
      place->second.push_back(static_cast<int>(scene_.meshes.size()));
      const Bounds box = bounds_of(*read);
      check_extent(box, described("mesh", mesh, model_.meshes[static_cast<std::size_t>(mesh)].name));
      const glm::vec3 middle = 0.5f * (box.low + box.high);
      const glm::vec3 centre = glm::length(glm::dvec3(middle)) > kFar ? middle : glm::vec3(0);
      for (Vertex& vertex : read->vertices)
        vertex.position -= centre;
      mesh_centres_.emplace_back(centre);
      mesh_bounds_.push_back({box.low - centre, box.high - centre});
      scene_.meshes.push_back(std::move(*read));
    }
    return place->second;
  }

  static void check_extent(const Bounds& box, const std::string& who) {
    for (int axis = 0; axis < 3; ++axis) {
      if (box.low[axis] >= -kMaxCoordinate && box.high[axis] <= kMaxCoordinate) continue;
      throw GltfError(
          fmt::format("{} has positions beyond {:g} m, which cannot be drawn", who, kMaxCoordinate));
    }
  }

  // What places the meshes of a node: itself, or of a skinned one, whose own transform means nothing, the first joint.
  struct Place {
    int node = 0;
    glm::dmat4 from_mesh{1};
  };

  Place place_of(int node) {
    const tinygltf::Node& source = model_.nodes[static_cast<std::size_t>(node)];
    if (source.skin < 0) return {node};
    document_.warn(described("node", node, source.name) +
                   " is skinned; it keeps its bind pose and follows its first joint");
    const tinygltf::Skin& skin = model_.skins[static_cast<std::size_t>(source.skin)];
    if (skin.joints.empty()) return {node};
    Place place{skin.joints[0]};
    if (skin.inverseBindMatrices < 0) return place;
    const FloatArray matrices =
        read_floats(document_, skin.inverseBindMatrices, {16},
                    "inverseBindMatrices of " + described("skin", source.skin, skin.name));
    place.from_mesh = glm::dmat4(glm::make_mat4(matrices.values.data()));
    return place;
  }

  bool moves(int node) const { return tree_->duration() > 0 && tree_->is_animated(node); }

  void add_instances(int node) {
    const tinygltf::Node& source = model_.nodes[static_cast<std::size_t>(node)];
    if (source.mesh < 0) return;
    const std::string who = described("node", node, source.name);
    const Place place = place_of(node);
    const auto& of_mesh = model_.meshes[static_cast<std::size_t>(source.mesh)].weights;
    const std::vector<double>& weights = source.weights.empty() ? of_mesh : source.weights;
    if (std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; }))
      document_.warn(who + " has morph weights, which are left out; it keeps its basic shape");
    for (const int mesh : scene_meshes(source.mesh)) {
      if (scene_.instances.size() >= kMaxInstances) {
        throw GltfError(
            fmt::format("the nodes show more than {} primitives, which is the limit", kMaxInstances));
      }
      Instance instance;
      instance.mesh = mesh;
      instance.name =
          !source.name.empty() ? source.name : model_.meshes[static_cast<std::size_t>(source.mesh)].name;
      const glm::dmat4 from_mesh =
          glm::translate(place.from_mesh, mesh_centres_[static_cast<std::size_t>(mesh)]);
      if (scene_.instances.empty()) tree_->come_near(place.node, from_mesh);
      instance.transform = tree_->world(place.node, 0, from_mesh);
      if (!is_sane(instance.transform)) {
        throw GltfError(fmt::format("{} has a transform with values beyond {:g}, which cannot be drawn", who,
                                    kMaxCoordinate));
      }
      if (moves(place.node)) {
        instance.motion = [tree = tree_, node = place.node, from_mesh](double seconds) {
          return tree->world(node, seconds, from_mesh);
        };
      }
      scene_.instances.push_back(std::move(instance));
    }
  }

  // Moment by moment, as the tree keeps two of them.
  Bounds bounds_over_time() const {
    Bounds bounds;
    for (int moment = 0; moment < kBoundsMoments; ++moment) {
      const double seconds = tree_->duration() * moment / kBoundsMoments;
      for (const Instance& instance : scene_.instances) {
        const bool first = moment == 0 && &instance == scene_.instances.data();
        if (moment > 0 && !instance.motion) continue;
        const Bounds placed = transformed(mesh_bounds_[static_cast<std::size_t>(instance.mesh)],
                                          instance.motion ? instance.motion(seconds) : instance.transform);
        bounds.low = first ? placed.low : glm::min(bounds.low, placed.low);
        bounds.high = first ? placed.high : glm::max(bounds.high, placed.high);
      }
    }
    check_extent(bounds, "the scene");
    return bounds;
  }

  void find_camera(const std::vector<int>& nodes, const Bounds& bounds) {
    for (const int node : nodes) {
      const int index = model_.nodes[static_cast<std::size_t>(node)].camera;
      if (index < 0) continue;
      const tinygltf::Camera& camera = model_.cameras[static_cast<std::size_t>(index)];
      if (camera.type == "perspective" && use_camera(node, camera)) return;
      document_.warn(described("camera", index, camera.name) +
                     " is not a perspective camera with a rigid transform, and is left out");
    }
    scene_.camera = orbit_camera(bounds);
    scene_.camera_moves = true;
  }

  bool use_camera(int node, const tinygltf::Camera& source) {
    if (!rigid(tree_->world(node, 0))) return false;
    Camera still;
    still.vertical_fov = static_cast<float>(source.perspective.yfov);
    still.near_plane = static_cast<float>(source.perspective.znear);
    still.world_from_camera = *rigid(tree_->world(node, 0));
    scene_.camera_moves = moves(node);
    scene_.camera = [still](double) { return still; };
    if (scene_.camera_moves) {
      scene_.camera = [still, tree = tree_, node](double seconds) {
        Camera camera = still;
        if (const auto placed = rigid(tree->world(node, seconds))) camera.world_from_camera = *placed;
        return camera;
      };
    }
    return true;
  }

  // A camera sees through its place and direction only: scales above it in the tree mean nothing.
  static std::optional<glm::mat4> rigid(const glm::mat4& world) {
    const auto back = glm::vec3(world[2]);
    const glm::vec3 right = glm::cross(glm::vec3(world[1]), back);
    const float size = glm::length(right) * glm::length(back);
    if (!is_sane(world) || !(size > 0) || !std::isfinite(size)) return std::nullopt;
    const glm::vec3 z = glm::normalize(back);
    const glm::vec3 x = glm::normalize(right);
    return glm::mat4(glm::vec4(x, 0), glm::vec4(glm::cross(z, x), 0), glm::vec4(z, 0), world[3]);
  }

  void describe() {
    std::size_t triangles = 0;
    for (const Instance& instance : scene_.instances) {
      triangles += scene_.meshes[static_cast<std::size_t>(instance.mesh)].indices.size() / 3;
    }
    scene_.name = document_.path.stem().string();
    scene_.summary =
        fmt::format("{}: {} triangles in {} instances, {} textures", document_.path.filename().string(),
                    triangles, scene_.instances.size(), scene_.textures.size());
    scene_.reason = "a user's own glTF 2.0 file";
    const bool anything_moves = tree_->duration() > 0;
    scene_.duration = anything_moves ? tree_->duration() : kOrbitSeconds;
  }

  GltfDocument document_;
  const tinygltf::Model& model_;
  std::shared_ptr<NodeTree> tree_;
  GltfMaterials materials_;
  std::map<int, std::vector<int>> meshes_;  // the scene's meshes, by mesh of the file
  std::vector<Bounds> mesh_bounds_;         // by mesh of the scene
  std::vector<glm::dvec3> mesh_centres_;    // by mesh of the scene: what its vertices are relative to
  std::size_t vertices_ = 0;
  Scene scene_;
};

}  // namespace

CameraPath orbit_camera(const Bounds& bounds, double seconds) {
  const glm::vec3 centre = 0.5f * bounds.low + 0.5f * bounds.high;
  const glm::dvec3 half = 0.5 * (glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
  double radius = std::hypot(half.x, half.z);
  double half_height = half.y;
  if (!(std::max(radius, half_height) > 0)) radius = half_height = 0.5;
  const double distance = fitting_distance(radius, half_height);
  // Half way to the nearest point of the box, or close to the eye where the box surrounds it.
  const double nearest = distance - std::hypot(radius, half_height);
  const auto near_plane = static_cast<float>(std::max(0.5 * nearest, 0.01 * distance));

  return [=](double time) {
    const double angle = kStart + 2 * std::numbers::pi * std::fmod(time / seconds, 1.0);
    const glm::dvec3 towards(std::sin(angle) * std::cos(kElevation), std::sin(kElevation),
                             std::cos(angle) * std::cos(kElevation));
    Camera camera;
    camera.world_from_camera = camera_at(centre + glm::vec3(distance * towards), glm::vec3(towards));
    camera.vertical_fov = static_cast<float>(kVerticalFov);
    camera.near_plane = near_plane;
    return camera;
  };
}

Result<Scene> load_gltf(const std::string& path) {
  try {
    return SceneReader(open_gltf_document(path)).read();
  } catch (const std::exception& error) {
    return Status::io(fmt::format("cannot load '{}': {}", path, error.what()));
  }
}

}  // namespace quincunx::scenes
