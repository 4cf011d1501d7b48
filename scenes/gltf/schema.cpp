// SPDX-License-Identifier: MIT
#include "gltf/schema.h"

#include <array>

namespace quincunx::scenes {
namespace {

using Kind = FieldKind;

constexpr double kLowest = Field::kLowest;
constexpr double kHighest = Field::kHighest;
constexpr double kMaxCount = 2147483647;

constexpr Field named() {
  return {.name = "name", .kind = Kind::kString};
}
constexpr Field index(const char* name, const char* of, bool required = false) {
  return {.name = name, .kind = Kind::kIndex, .of = of, .required = required};
}
constexpr Field count(const char* name, double low, bool required = false, double high = kMaxCount) {
  return {.name = name, .kind = Kind::kCount, .required = required, .low = low, .high = high};
}
constexpr Field number(const char* name, double low, double high = kHighest) {
  return {.name = name, .kind = Kind::kNumber, .low = low, .high = high};
}
constexpr Field numbers(const char* name, std::size_t length, double low = kLowest) {
  return {.name = name, .kind = Kind::kNumbers, .low = low, .length = length};
}
constexpr Field choice(const char* name, const char* of, bool required = false) {
  return {.name = name, .kind = Kind::kChoice, .of = of, .required = required};
}
constexpr Field object(const char* name, const ObjectSchema& schema, bool required = false) {
  return {.name = name, .kind = Kind::kObject, .object = &schema, .required = required};
}
constexpr Field objects(const char* name, const ObjectSchema& schema, bool required = false) {
  return {.name = name, .kind = Kind::kObjects, .object = &schema, .required = required};
}
constexpr double kTiny = static_cast<double>(FLT_MIN);  // stands for "more than zero"

constexpr std::array kAssetFields = {Field{.name = "version", .kind = Kind::kString, .required = true},
                                     Field{.name = "minVersion", .kind = Kind::kString}};
constexpr ObjectSchema kAsset = {"asset", kAssetFields};

constexpr std::array kBufferFields = {named(), count("byteLength", 1, true),
                                      Field{.name = "uri", .kind = Kind::kString}};
constexpr ObjectSchema kBuffer = {"buffer", kBufferFields};

constexpr std::array kBufferViewFields = {named(), index("buffer", "buffers", true), count("byteOffset", 0),
                                          count("byteLength", 1, true), count("byteStride", 4, false, 252)};
constexpr ObjectSchema kBufferView = {"bufferView", kBufferViewFields};

constexpr std::array kSparseIndicesFields = {index("bufferView", "bufferViews", true), count("byteOffset", 0),
                                             choice("componentType", "5121|5123|5125", true)};
constexpr ObjectSchema kSparseIndices = {"sparse indices", kSparseIndicesFields};
constexpr std::array kSparseValuesFields = {index("bufferView", "bufferViews", true), count("byteOffset", 0)};
constexpr ObjectSchema kSparseValues = {"sparse values", kSparseValuesFields};
constexpr std::array kSparseFields = {count("count", 1, true), object("indices", kSparseIndices, true),
                                      object("values", kSparseValues, true)};
constexpr ObjectSchema kSparse = {"", kSparseFields};
constexpr std::array kAccessorFields = {named(),
                                        index("bufferView", "bufferViews"),
                                        count("byteOffset", 0),
                                        choice("componentType", "5120|5121|5122|5123|5125|5126", true),
                                        Field{.name = "normalized", .kind = Kind::kBool},
                                        count("count", 1, true),
                                        choice("type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4", true),
                                        object("sparse", kSparse)};
constexpr ObjectSchema kAccessor = {"accessor", kAccessorFields};

constexpr std::array kPrimitiveFields = {
    Field{.name = "attributes", .kind = Kind::kAttributes, .of = "accessors", .required = true},
    index("indices", "accessors"), index("material", "materials"), count("mode", 0, false, 6)};
constexpr ObjectSchema kPrimitive = {"primitive", kPrimitiveFields};
constexpr std::array kMeshFields = {named(), objects("primitives", kPrimitive, true)};
constexpr ObjectSchema kMesh = {"mesh", kMeshFields};

constexpr std::array kNodeLightFields = {index("light", "lights", true)};
constexpr ObjectSchema kNodeLight = {"KHR_lights_punctual", kNodeLightFields};
constexpr std::array kNodeExtensionFields = {object("KHR_lights_punctual", kNodeLight)};
constexpr ObjectSchema kNodeExtensions = {"", kNodeExtensionFields};
constexpr std::array kNodeFields = {named(),
                                    index("camera", "cameras"),
                                    Field{.name = "children", .kind = Kind::kIndices, .of = "nodes"},
                                    index("mesh", "meshes"),
                                    index("skin", "skins"),
                                    numbers("matrix", 16),
                                    numbers("rotation", 4),
                                    numbers("scale", 3),
                                    numbers("translation", 3),
                                    object("extensions", kNodeExtensions)};
constexpr ObjectSchema kNode = {"node", kNodeFields};

constexpr std::array kSceneFields = {named(), Field{.name = "nodes", .kind = Kind::kIndices, .of = "nodes"}};
constexpr ObjectSchema kScene = {"scene", kSceneFields};

constexpr std::array kTransformFields = {numbers("offset", 2), number("rotation", kLowest),
                                         numbers("scale", 2), count("texCoord", 0)};
constexpr ObjectSchema kTransform = {"KHR_texture_transform", kTransformFields};
constexpr std::array kTextureExtensionFields = {object("KHR_texture_transform", kTransform)};
constexpr ObjectSchema kTextureExtensions = {"", kTextureExtensionFields};
constexpr std::array kTextureInfoFields = {index("index", "textures", true), count("texCoord", 0),
                                           number("scale", kLowest),
                                           object("extensions", kTextureExtensions)};
constexpr ObjectSchema kTextureInfo = {"texture slot", kTextureInfoFields};

constexpr std::array kRoughnessFields = {numbers("baseColorFactor", 4, 0),
                                         object("baseColorTexture", kTextureInfo),
                                         number("metallicFactor", 0, 1), number("roughnessFactor", 0, 1),
                                         object("metallicRoughnessTexture", kTextureInfo)};
constexpr ObjectSchema kRoughness = {"", kRoughnessFields};
constexpr std::array kStrengthFields = {number("emissiveStrength", 0)};
constexpr ObjectSchema kStrength = {"KHR_materials_emissive_strength", kStrengthFields};
constexpr ObjectSchema kUnlit = {"KHR_materials_unlit", {}};
constexpr std::array kMaterialExtensionFields = {object("KHR_materials_emissive_strength", kStrength),
                                                 object("KHR_materials_unlit", kUnlit)};
constexpr ObjectSchema kMaterialExtensions = {"", kMaterialExtensionFields};
constexpr std::array kMaterialFields = {named(),
                                        object("pbrMetallicRoughness", kRoughness),
                                        object("normalTexture", kTextureInfo),
                                        object("occlusionTexture", kTextureInfo),
                                        object("emissiveTexture", kTextureInfo),
                                        numbers("emissiveFactor", 3, 0),
                                        choice("alphaMode", "OPAQUE|MASK|BLEND"),
                                        number("alphaCutoff", 0),
                                        Field{.name = "doubleSided", .kind = Kind::kBool},
                                        object("extensions", kMaterialExtensions)};
constexpr ObjectSchema kMaterial = {"material", kMaterialFields};

constexpr std::array kTextureFields = {named(), index("sampler", "samplers"), index("source", "images")};
constexpr ObjectSchema kTexture = {"texture", kTextureFields};
constexpr std::array kImageFields = {named(), Field{.name = "uri", .kind = Kind::kString},
                                     Field{.name = "mimeType", .kind = Kind::kString},
                                     index("bufferView", "bufferViews")};
constexpr ObjectSchema kImage = {"image", kImageFields};
constexpr std::array kSamplerFields = {
    named(), choice("magFilter", "9728|9729"), choice("minFilter", "9728|9729|9984|9985|9986|9987"),
    choice("wrapS", "33071|33648|10497"), choice("wrapT", "33071|33648|10497")};
constexpr ObjectSchema kSampler = {"sampler", kSamplerFields};

constexpr std::array kTargetFields = {index("node", "nodes"),
                                      Field{.name = "path", .kind = Kind::kString, .required = true}};
constexpr ObjectSchema kTarget = {"", kTargetFields};
constexpr std::array kChannelFields = {count("sampler", 0, true), object("target", kTarget, true)};
constexpr ObjectSchema kChannel = {"channel", kChannelFields};
constexpr std::array kAnimationSamplerFields = {index("input", "accessors", true),
                                                index("output", "accessors", true),
                                                choice("interpolation", "LINEAR|STEP|CUBICSPLINE")};
constexpr ObjectSchema kAnimationSampler = {"sampler", kAnimationSamplerFields};
constexpr std::array kAnimationFields = {named(), objects("channels", kChannel, true),
                                         objects("samplers", kAnimationSampler, true)};
constexpr ObjectSchema kAnimation = {"animation", kAnimationFields};

constexpr std::array kPerspectiveFields = {
    Field{.name = "yfov", .kind = Kind::kNumber, .required = true, .low = 1e-3, .high = 3.1},
    Field{.name = "znear", .kind = Kind::kNumber, .required = true, .low = kTiny}};
constexpr ObjectSchema kPerspective = {"", kPerspectiveFields};
constexpr std::array kOrthographicFields = {Field{.name = "xmag", .kind = Kind::kNumber, .required = true},
                                            Field{.name = "ymag", .kind = Kind::kNumber, .required = true},
                                            Field{.name = "zfar", .kind = Kind::kNumber, .required = true},
                                            Field{.name = "znear", .kind = Kind::kNumber, .required = true}};
constexpr ObjectSchema kOrthographic = {"", kOrthographicFields};
constexpr std::array kCameraFields = {named(), choice("type", "perspective|orthographic", true),
                                      object("perspective", kPerspective),
                                      object("orthographic", kOrthographic)};
constexpr ObjectSchema kCamera = {"camera", kCameraFields};

constexpr ObjectSchema kSpot = {"", {}};
constexpr std::array kLightFields = {named(),
                                     choice("type", "directional|point|spot", true),
                                     numbers("color", 3, 0),
                                     number("intensity", 0),
                                     number("range", kTiny),
                                     object("spot", kSpot)};
constexpr ObjectSchema kLight = {"light", kLightFields};
constexpr std::array kLightsFields = {objects("lights", kLight, true)};
constexpr ObjectSchema kLights = {"KHR_lights_punctual", kLightsFields};
constexpr std::array kRootExtensionFields = {object("KHR_lights_punctual", kLights)};
constexpr ObjectSchema kRootExtensions = {"", kRootExtensionFields};

constexpr std::array kRootFields = {object("asset", kAsset, true),
                                    index("scene", "scenes"),
                                    objects("scenes", kScene),
                                    objects("nodes", kNode),
                                    objects("meshes", kMesh),
                                    objects("accessors", kAccessor),
                                    objects("bufferViews", kBufferView),
                                    objects("buffers", kBuffer),
                                    objects("materials", kMaterial),
                                    objects("textures", kTexture),
                                    objects("images", kImage),
                                    objects("samplers", kSampler),
                                    objects("animations", kAnimation),
                                    objects("cameras", kCamera),
                                    object("extensions", kRootExtensions)};
constexpr ObjectSchema kRoot = {"", kRootFields};

}  // namespace

const ObjectSchema& gltf_schema() {
  return kRoot;
}

}  // namespace quincunx::scenes
