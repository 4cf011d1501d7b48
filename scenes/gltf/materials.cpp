// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "gltf/contents.h"

namespace quincunx::scenes {
namespace {

// Some 4 GiB decoded: what a scene of many textures may take, and no more.
constexpr std::size_t kMaxTotalTexels = std::size_t{1} << 30;

glm::vec3 vec3_of(const std::vector<double>& values, const glm::vec3& fallback) {
  if (values.size() != 3) return fallback;
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

glm::vec2 vec2_of(const tinygltf::Value& object, const char* name, const glm::vec2& fallback) {
  if (!object.Has(name)) return fallback;
  const tinygltf::Value& value = object.Get(name);
  return {static_cast<float>(value.Get(0).GetNumberAsDouble()),
          static_cast<float>(value.Get(1).GetNumberAsDouble())};
}

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::kMirror;
  return Wrap::kRepeat;
}

// Offset * rotation * scale. The rotation turns counter-clockwise in uv space, whose v points down: the other
// way round than the GLSL in early versions of the extension's text (glTF issue 1563).
glm::mat3 transform_of(const tinygltf::Value& extension) {
  const glm::vec2 offset = vec2_of(extension, "offset", {0, 0});
  const glm::vec2 scale = vec2_of(extension, "scale", {1, 1});
  const double angle = extension.Has("rotation") ? extension.Get("rotation").GetNumberAsDouble() : 0;
  const auto c = static_cast<float>(std::cos(angle));
  const auto s = static_cast<float>(std::sin(angle));
  return {glm::vec3(c * scale.x, -s * scale.x, 0), glm::vec3(s * scale.y, c * scale.y, 0),
          glm::vec3(offset, 1)};
}

// The settings of a slot, before it is known whether its set of texture coordinates can be had.
struct SlotSource {
  int texture = -1;
  int uv_set = 0;
  const tinygltf::ExtensionMap* extensions = nullptr;
};

template <typename Info>
SlotSource source_of(const Info& info) {
  SlotSource source{info.index, info.texCoord, &info.extensions};
  const auto found = info.extensions.find("KHR_texture_transform");
  if (found != info.extensions.end() && found->second.Has("texCoord")) {
    source.uv_set = found->second.Get("texCoord").GetNumberAsInt();
  }
  return source;
}

class MaterialReader {
 public:
  explicit MaterialReader(GltfDocument& document) : document_(document), model_(document.model) {}

  GltfMaterials read() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i)
      add(model_.materials[i], static_cast<int>(i));
    Material plain;  // the defaults of glTF are not those of Material
    plain.name = "default";
    plain.metallic = 1;
    result_.materials.push_back(plain);
    result_.uv_sets.push_back(0);
    return std::move(result_);
  }

 private:
  void add(const tinygltf::Material& source, int index) {
    const std::string who = described("material", index, source.name);
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material material;
    material.name = source.name;
    for (int c = 0; c < 4; ++c) {
      material.base_colour[c] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(c)]);
    }
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.emissive = vec3_of(source.emissiveFactor, glm::vec3(0)) * emissive_strength(source);
    material.alpha_mode = source.alphaMode == "MASK"    ? AlphaMode::kMask
                          : source.alphaMode == "BLEND" ? AlphaMode::kBlend
                                                        : AlphaMode::kOpaque;
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    material.double_sided = source.doubleSided;
    material.unlit = source.extensions.count("KHR_materials_unlit") != 0;
    material.normal_scale = static_cast<float>(source.normalTexture.scale);

    const SlotSource colour = source_of(pbr.baseColorTexture);
    const int uv_set = colour.texture >= 0 ? colour.uv_set : first_uv_set(source);
    if (uv_set > 1) {
      document_.warn(
          fmt::format("{} draws with TEXCOORD_{}; only sets 0 and 1 are read, set 0 is used", who, uv_set));
    }
    const int used_set = uv_set == 1 ? 1 : 0;
    material.base_colour_texture = slot(colour, true, used_set, who);
    material.metallic_roughness_texture = slot(source_of(pbr.metallicRoughnessTexture), false, used_set, who);
    material.emissive_texture = slot(source_of(source.emissiveTexture), true, used_set, who);
    material.normal_texture = slot(source_of(source.normalTexture), false, used_set, who);
    result_.materials.push_back(std::move(material));
    result_.uv_sets.push_back(used_set);
  }

  static float emissive_strength(const tinygltf::Material& source) {
    const auto found = source.extensions.find("KHR_materials_emissive_strength");
    if (found == source.extensions.end() || !found->second.Has("emissiveStrength")) return 1;
    return static_cast<float>(found->second.Get("emissiveStrength").GetNumberAsDouble());
  }

  // Without a base colour texture, the first slot that has one decides.
  static int first_uv_set(const tinygltf::Material& source) {
    for (const SlotSource& slot : {source_of(source.pbrMetallicRoughness.metallicRoughnessTexture),
                                   source_of(source.emissiveTexture), source_of(source.normalTexture)}) {
      if (slot.texture >= 0) return slot.uv_set;
    }
    return 0;
  }

  TextureSlot slot(const SlotSource& source, bool srgb, int uv_set, const std::string& who) {
    TextureSlot result;
    if (source.texture < 0) return result;
    if (source.uv_set != uv_set) {
      document_.warn(fmt::format("{} mixes TEXCOORD_{} and TEXCOORD_{}; all its textures use set {}", who,
                                 uv_set, source.uv_set, uv_set));
    }
    const auto found = source.extensions->find("KHR_texture_transform");
    if (found != source.extensions->end()) result.transform = transform_of(found->second);
    result.texture = texture(source.texture, srgb);
    return result;
  }

  // A texture that serves as colour and as data becomes two.
  int texture(int index, bool srgb) {
    const auto [place, is_new] = known_.try_emplace({index, srgb}, -1);
    if (!is_new) return place->second;
    const tinygltf::Texture& source = model_.textures[static_cast<std::size_t>(index)];
    if (source.source < 0) {
      document_.warn(described("texture", index, source.name) +
                     " has no PNG or JPEG 'source'; it is left out");
      return -1;
    }
    const DecodedImage& image = decoded(source.source);
    texels_ += image.rgba.size() / 4;
    if (texels_ > kMaxTotalTexels) {
      throw GltfError(
          fmt::format("the textures have more than {} pixels in all, which is the limit", kMaxTotalTexels));
    }
    Texture texture;
    texture.width = image.width;
    texture.height = image.height;
    texture.rgba = image.rgba;
    texture.srgb = srgb;
    if (source.sampler >= 0) {
      const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(source.sampler)];
      texture.wrap_u = wrap_of(sampler.wrapS);
      texture.wrap_v = wrap_of(sampler.wrapT);
      texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    result_.textures.push_back(std::move(texture));
    place->second = static_cast<int>(result_.textures.size()) - 1;
    return place->second;
  }

  const DecodedImage& decoded(int image) {
    const auto found = images_.find(image);
    if (found != images_.end()) return found->second;
    return images_.emplace(image, decode_image(document_, image)).first->second;
  }

  GltfDocument& document_;
  const tinygltf::Model& model_;
  GltfMaterials result_;
  std::map<std::pair<int, bool>, int> known_;  // texture and whether it holds sRGB colour
  std::map<int, DecodedImage> images_;
  std::size_t texels_ = 0;
};

}  // namespace

GltfMaterials read_materials(GltfDocument& document) {
  return MaterialReader(document).read();
}

}  // namespace quincunx::scenes
