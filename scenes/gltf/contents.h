// SPDX-License-Identifier: MIT
// The contents of a glTF file as those of a Scene: materials, meshes, and the node tree with its animation. Private to
// the glTF loader.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "scene.h"

namespace quincunx::scenes {

struct DecodedImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, top row first, alpha 255 where the file has none
};

// Decodes PNG or JPEG, as glTF allows (image.cpp). Throws GltfError that names the image.
DecodedImage decode_image(const GltfDocument& document, int image);

struct GltfMaterials {
  std::vector<Texture> textures;
  std::vector<Material> materials;  // as in the file, then one for primitives that name none
  std::vector<int> uv_sets;         // for each material: which TEXCOORD_n its textures are drawn with

  int default_material() const { return static_cast<int>(materials.size()) - 1; }
};

// Reads all of them. A vertex has one pair of texture coordinates: the set of the base colour serves all slots of a
// material, with a warning where another slot asks for a different one. Throws GltfError.
GltfMaterials read_materials(GltfDocument& document);

// Elements of `components` values each, tightly packed. Integers are normalised to [0, 1] or [-1, 1] where
// the accessor says so, else converted as they are. All values are finite.
struct FloatArray {
  int components = 0;
  std::vector<float> values;

  std::size_t size() const { return values.size() / static_cast<std::size_t>(components); }
};

// Reads an accessor. `use` says what for, in messages: "POSITION of primitive 0 of mesh 1 'Suzanne'". Throws GltfError
// for an accessor that leaves its bufferView, for one whose number of components is not among those allowed, and for
// values that are not finite.
FloatArray read_floats(const GltfDocument& document, int accessor, std::initializer_list<int> components,
                       const std::string& use);

// Reads triangles, strips and fans, indexed or not. Without NORMAL the triangles get flat normals of their
// own, as glTF demands. Nothing for points and lines, with a warning. Throws GltfError.
std::optional<Mesh> read_primitive(GltfDocument& document, int mesh, int primitive,
                                   const GltfMaterials& materials);

constexpr double kFar = 4096;  // metres; single precision tells half a millimetre there

enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// The values of one property over time; clamped to the first and the last key.
struct Track {
  Interpolation interpolation = Interpolation::kLinear;
  bool rotation = false;  // x y z w, unit: linear means slerp, a spline is normalised
  int components = 3;
  std::vector<float> times;   // ascending, seconds
  std::vector<float> values;  // values of each key; for a spline in-tangent, value, out-tangent

  glm::vec4 at(double seconds) const;
};

// The node tree and its motion, a pure function of time. Any number of motions may share it, and any thread may ask.
class NodeTree {
 public:
  // Takes the first animation of the file; others are named in a warning. Throws GltfError.
  explicit NodeTree(GltfDocument& document);

  double duration() const { return duration_; }  // seconds; 0: nothing moves
  bool is_animated(int node) const { return nodes_[static_cast<std::size_t>(node)].animated; }

  // Returns world from mesh, given node from mesh. Time runs round: `duration()` seconds are 0 seconds again. The last
  // two times of all nodes are kept, so that a frame and the one before cost as much as there are nodes, however deep
  // these are.
  glm::mat4 world(int node, double seconds, const glm::dmat4& node_from_mesh = glm::dmat4(1)) const;

  // Makes the place of a mesh at time 0 the world's origin where it is far from the file's: maps, buildings and tiles
  // of the globe stand at their coordinates.
  void come_near(int node, const glm::dmat4& node_from_mesh);

 private:
  glm::dmat4 of_file(int node, double seconds) const;

  enum Path : std::uint8_t { kTranslation, kRotation, kScale };
  struct Node {
    int parent = -1;
    glm::dmat4 matrix{1};  // parent from node, where nothing animates the node itself
    glm::dmat4 still{1};   // the file's world from node at time 0
    glm::dvec3 translation{0};
    glm::vec4 rotation{0, 0, 0, 1};
    glm::vec3 scale{1};
    std::array<int, 3> tracks = {-1, -1, -1};  // per Path
    bool animated = false;                     // itself or a node above
    bool has_matrix = false;
  };

  void read_pose(const tinygltf::Node& source, int index);
  void read_animation(GltfDocument& document, int index);
  int read_track(const GltfDocument& document, const tinygltf::Animation& animation, int sampler, Path path,
                 const std::string& who);
  glm::dmat4 local(const Node& node, double seconds) const;

  struct Moment {
    double seconds = std::numeric_limits<double>::quiet_NaN();
    std::vector<glm::dmat4> worlds;  // of all animated nodes
  };

  std::vector<Node> nodes_;
  std::vector<int> order_;    // of all nodes, each after its parent
  mutable std::mutex mutex_;  // of the next two
  mutable std::array<Moment, 2> moments_;
  mutable std::size_t oldest_ = 0;
  std::vector<Track> tracks_;
  double duration_ = 0;
  glm::dvec3 origin_{0};
};

}  // namespace quincunx::scenes
