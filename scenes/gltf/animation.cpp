// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "gltf/contents.h"

namespace quincunx::scenes {
namespace {

constexpr double kRounding = 1e-4;  // that products of single-precision matrices leave where 0 or 1 is right

glm::vec4 normalised(const glm::vec4& value) {
  const float length = glm::length(value);
  return length > 0 ? value / length : glm::vec4(0, 0, 0, 1);
}

glm::quat quat_of(const glm::vec4& value) {
  return glm::quat(value.w, value.x, value.y, value.z);
}

glm::vec4 slerp(const glm::vec4& from, const glm::vec4& to, float part) {
  const glm::quat q = glm::slerp(quat_of(from), quat_of(to), part);  // takes the shorter way
  return normalised({q.x, q.y, q.z, q.w});
}

glm::dmat4 composed(const glm::dvec3& translation, const glm::vec4& rotation, const glm::vec3& scale) {
  glm::dmat4 matrix(glm::mat4_cast(quat_of(rotation)));
  for (int c = 0; c < 3; ++c)
    matrix[c] *= static_cast<double>(scale[c]);
  matrix[3] = glm::dvec4(translation, 1);
  return matrix;
}

std::string node_name(const tinygltf::Model& model, int node) {
  return described("node", node, model.nodes[static_cast<std::size_t>(node)].name);
}

}  // namespace

glm::vec4 Track::at(double seconds) const {
  const std::size_t stride = static_cast<std::size_t>(components);
  const bool spline = interpolation == Interpolation::kCubicSpline;
  // part: 0 in-tangent, 1 value, 2 out-tangent.
  const auto element = [&](std::size_t key, std::size_t part) {
    const float* values_of_key = values.data() + (spline ? key * 3 + part : key) * stride;
    glm::vec4 result(0);
    for (std::size_t c = 0; c < stride; ++c)
      result[static_cast<int>(c)] = values_of_key[c];
    return result;
  };
  const auto value = [&](std::size_t key) {
    return rotation ? normalised(element(key, 1)) : element(key, 1);
  };
  const auto after =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
  if (after == 0) return value(0);
  if (after == times.size() || interpolation == Interpolation::kStep) return value(after - 1);

  const std::size_t before = after - 1;
  const double span = static_cast<double>(times[after]) - static_cast<double>(times[before]);
  const double t = (seconds - static_cast<double>(times[before])) / span;
  const auto part = static_cast<float>(t);
  if (!spline) {
    if (rotation) return slerp(value(before), value(after), part);
    return glm::mix(value(before), value(after), part);
  }
  // Hermite; the tangents are per second.
  const auto to_value = static_cast<float>(t * t * (3 - 2 * t));
  const auto out_tangent = static_cast<float>(span * t * (t - 1) * (t - 1));
  const auto in_tangent = static_cast<float>(span * t * t * (t - 1));
  const glm::vec4 result = (1 - to_value) * element(before, 1) + out_tangent * element(before, 2) +
                           to_value * element(after, 1) + in_tangent * element(after, 0);
  return rotation ? normalised(result) : result;
}

NodeTree::NodeTree(GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  const std::vector<int> parents = parents_of(model);
  nodes_.resize(model.nodes.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].parent = parents[i];
    read_pose(model.nodes[i], static_cast<int>(i));
    if (parents[i] < 0) order_.push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto& children = model.nodes[static_cast<std::size_t>(order_[i])].children;
    order_.insert(order_.end(), children.begin(), children.end());
  }
  if (!model.animations.empty()) read_animation(document, 0);
  if (model.animations.size() > 1) {
    document.warn(fmt::format("of {} animations only the first, {}, is played", model.animations.size(),
                              described("animation", 0, model.animations[0].name)));
  }
  for (const int index : order_) {
    Node& node = nodes_[static_cast<std::size_t>(index)];
    node.still = local(node, 0);
    if (node.parent < 0) continue;
    const Node& parent = nodes_[static_cast<std::size_t>(node.parent)];
    node.animated |= parent.animated;
    node.still = parent.still * node.still;
  }
}

void NodeTree::read_pose(const tinygltf::Node& source, int index) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  const auto copy = [](const std::vector<double>& from, float* to) {
    std::transform(from.begin(), from.end(), to, [](double value) { return static_cast<float>(value); });
  };
  std::copy(source.translation.begin(), source.translation.end(), &node.translation[0]);
  copy(source.rotation, &node.rotation[0]);
  copy(source.scale, &node.scale[0]);
  node.rotation = normalised(node.rotation);
  node.has_matrix = !source.matrix.empty();
  node.matrix = composed(node.translation, node.rotation, node.scale);
  if (!node.has_matrix) return;
  std::copy(source.matrix.begin(), source.matrix.end(), &node.matrix[0][0]);
  for (int c = 0; c < 4; ++c) {
    const double last = c == 3 ? 1 : 0;
    const bool is_rounded = std::abs(node.matrix[c][3] - last) <= kRounding;
    node.matrix[c][3] = last;
    if (is_rounded) continue;
    throw GltfError(fmt::format(
        "{} has a 'matrix' whose last row is not 0 0 0 1; it must be a translation, rotation and scale",
        described("node", index, source.name)));
  }
}

void NodeTree::read_animation(GltfDocument& document, int index) {
  const tinygltf::Model& model = document.model;
  const tinygltf::Animation& animation = model.animations[static_cast<std::size_t>(index)];
  const std::string name = described("animation", index, animation.name);
  for (std::size_t c = 0; c < animation.channels.size(); ++c) {
    const tinygltf::AnimationChannel& channel = animation.channels[c];
    const std::string who = fmt::format("channel {} of {}", c, name);
    if (channel.target_node < 0) continue;
    if (channel.target_path != "translation" && channel.target_path != "rotation" &&
        channel.target_path != "scale") {
      document.warn(
          fmt::format("{} animates '{}', which is left out; translation, rotation and scale are played", name,
                      channel.target_path));
      continue;
    }
    if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= animation.samplers.size()) {
      throw GltfError(fmt::format("{} has 'sampler' {}, but {} has only {}", who, channel.sampler, name,
                                  animation.samplers.size()));
    }
    Node& node = nodes_[static_cast<std::size_t>(channel.target_node)];
    if (node.has_matrix) {
      throw GltfError(
          fmt::format("{} animates {}, which has a 'matrix'; it needs translation, rotation and scale", who,
                      node_name(model, channel.target_node)));
    }
    const Path path = channel.target_path == "translation" ? kTranslation
                      : channel.target_path == "rotation"  ? kRotation
                                                           : kScale;
    if (node.tracks[path] >= 0) {
      throw GltfError(fmt::format("{} animates the {} of {} a second time; one channel each is right", who,
                                  channel.target_path, node_name(model, channel.target_node)));
    }
    node.tracks[path] = read_track(document, animation, channel.sampler, path, who);
    node.animated = true;
  }
}

int NodeTree::read_track(const GltfDocument& document, const tinygltf::Animation& animation,
                         int sampler_index, Path path, const std::string& who) {
  const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(sampler_index)];
  Track track;
  track.interpolation = sampler.interpolation == "STEP"          ? Interpolation::kStep
                        : sampler.interpolation == "CUBICSPLINE" ? Interpolation::kCubicSpline
                                                                 : Interpolation::kLinear;
  track.rotation = path == kRotation;
  track.components = track.rotation ? 4 : 3;
  track.times = read_floats(document, sampler.input, {1}, "times of " + who).values;
  for (std::size_t i = 1; i < track.times.size(); ++i) {
    if (track.times[i] <= track.times[i - 1]) {
      throw GltfError(fmt::format("{} has key {} at {} s after key {} at {} s; times must ascend", who, i,
                                  track.times[i], i - 1, track.times[i - 1]));
    }
  }
  const FloatArray output = read_floats(document, sampler.output, {track.components}, "values of " + who);
  const std::size_t wanted =
      track.times.size() *
      (track.interpolation == Interpolation::kCubicSpline ? std::size_t{3} : std::size_t{1});
  if (output.size() != wanted) {
    throw GltfError(fmt::format("{} has {} values for {} times; {} are needed", who, output.size(),
                                track.times.size(), wanted));
  }
  track.values = output.values;
  duration_ = std::max(duration_, static_cast<double>(track.times.back()));
  tracks_.push_back(std::move(track));
  return static_cast<int>(tracks_.size()) - 1;
}

glm::dmat4 NodeTree::local(const Node& node, double seconds) const {
  if (std::all_of(node.tracks.begin(), node.tracks.end(), [](int track) { return track < 0; })) {
    return node.matrix;
  }
  const auto value = [&](Path path, const glm::vec4& rest) {
    const int track = node.tracks[path];
    return track < 0 ? rest : tracks_[static_cast<std::size_t>(track)].at(seconds);
  };
  const bool stays = node.tracks[kTranslation] < 0;
  return composed(stays ? node.translation : glm::dvec3(value(kTranslation, glm::vec4(0))),
                  value(kRotation, node.rotation), glm::vec3(value(kScale, glm::vec4(node.scale, 0))));
}

glm::mat4 NodeTree::world(int node, double seconds, const glm::dmat4& node_from_mesh) const {
  glm::dmat4 world = of_file(node, seconds) * node_from_mesh;
  world[3] -= glm::dvec4(origin_, 0);
  return glm::mat4(world);
}

void NodeTree::come_near(int node, const glm::dmat4& node_from_mesh) {
  const glm::dvec3 place((of_file(node, 0) * node_from_mesh)[3]);
  if (glm::length(place) > kFar) origin_ = place;
}

glm::dmat4 NodeTree::of_file(int node_index, double seconds) const {
  const Node& wanted = nodes_[static_cast<std::size_t>(node_index)];
  double time = duration_ > 0 ? std::fmod(seconds, duration_) : 0.0;
  if (time < 0) time += duration_;
  if (!wanted.animated || time == 0) return wanted.still;
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(moments_.begin(), moments_.end(),
                                  [&](const Moment& moment) { return moment.seconds == time; });
  if (known != moments_.end()) return known->worlds[static_cast<std::size_t>(node_index)];
  Moment& moment = moments_[oldest_];
  oldest_ = 1 - oldest_;
  moment.seconds = time;
  moment.worlds.resize(nodes_.size());
  for (const int index : order_) {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!node.animated) continue;
    const glm::dmat4 own = local(node, time);
    glm::dmat4& world = moment.worlds[static_cast<std::size_t>(index)];
    if (node.parent < 0) {
      world = own;
    } else {
      const Node& parent = nodes_[static_cast<std::size_t>(node.parent)];
      world = (parent.animated ? moment.worlds[static_cast<std::size_t>(node.parent)] : parent.still) * own;
    }
  }
  return moment.worlds[static_cast<std::size_t>(node_index)];
}

}  // namespace quincunx::scenes
