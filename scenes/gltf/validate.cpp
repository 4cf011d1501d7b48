// SPDX-License-Identifier: MIT
// The form of a glTF 2.0 file: the part that the loader reads, as a table, and the check against it.
// Source: Khronos Group, "glTF 2.0 Specification", version 2.0.1, 2021, and the extensions named in gltf/loader.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gltf/document.h"

namespace quincunx::scenes {
namespace {

using nlohmann::json;

// An object of the file by its fields; "!" marks those that it must have. A list: the name of an element, and its
// fields; each may also have a "name". Of all others the first word tells the kind:
//   index LIST             integer that points into a list of the file; indices LIST: a list of those
//   attributes LIST        object of indices
//   count LOW [HIGH]       integer; number [LOW [HIGH]]: finite; numbers LENGTH [LOW]: a list of those (0: any length)
//   choice A B             one of these, integers or strings; string and bool: any
const char* const kSchema = R"({
  "asset!": {"version!": "string", "minVersion": "string"},
  "scene": "index scenes",
  "scenes": ["scene", {"nodes": "indices nodes"}],
  "nodes": ["node", {
    "camera": "index cameras", "children": "indices nodes", "mesh": "index meshes", "skin": "index skins",
    "matrix": "numbers 16", "rotation": "numbers 4", "scale": "numbers 3", "translation": "numbers 3",
    "weights": "numbers 0", "extensions": {"KHR_lights_punctual": {"light!": "index lights"}}}],
  "meshes": ["mesh", {"weights": "numbers 0", "primitives!": ["primitive", {
    "attributes!": "attributes accessors", "indices": "index accessors", "material": "index materials",
    "mode": "count 0 6"}]}],
  "accessors": ["accessor", {
    "bufferView": "index bufferViews", "byteOffset": "count 0", "normalized": "bool", "count!": "count 1",
    "componentType!": "choice 5120 5121 5122 5123 5125 5126",
    "type!": "choice SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4",
    "sparse": {
      "count!": "count 1",
      "indices!": {"bufferView!": "index bufferViews", "byteOffset": "count 0",
                   "componentType!": "choice 5121 5123 5125"},
      "values!": {"bufferView!": "index bufferViews", "byteOffset": "count 0"}}}],
  "bufferViews": ["bufferView", {
    "buffer!": "index buffers", "byteOffset": "count 0", "byteLength!": "count 1", "byteStride": "count 4 252"}],
  "buffers": ["buffer", {"byteLength!": "count 1", "uri": "string"}],
  "materials": ["material", {
    "pbrMetallicRoughness": {
      "baseColorFactor": "numbers 4 0", "baseColorTexture": "texture",
      "metallicFactor": "number 0 1", "roughnessFactor": "number 0 1", "metallicRoughnessTexture": "texture"},
    "normalTexture": "texture", "occlusionTexture": "texture", "emissiveTexture": "texture",
    "emissiveFactor": "numbers 3 0", "alphaMode": "choice OPAQUE MASK BLEND", "alphaCutoff": "number 0",
    "doubleSided": "bool",
    "extensions": {
      "KHR_materials_emissive_strength": {"emissiveStrength": "number 0"}, "KHR_materials_unlit": {}}}],
  "textures": ["texture", {"sampler": "index samplers", "source": "index images"}],
  "images": ["image", {"uri": "string", "mimeType": "string", "bufferView": "index bufferViews"}],
  "samplers": ["sampler", {
    "magFilter": "choice 9728 9729", "minFilter": "choice 9728 9729 9984 9985 9986 9987",
    "wrapS": "choice 33071 33648 10497", "wrapT": "choice 33071 33648 10497"}],
  "skins": ["skin", {"joints!": "indices nodes", "inverseBindMatrices": "index accessors"}],
  "animations": ["animation", {
    "channels!": ["channel", {"sampler!": "count 0", "target!": {"node": "index nodes", "path!": "string"}}],
    "samplers!": ["sampler", {
      "input!": "index accessors", "output!": "index accessors",
      "interpolation": "choice LINEAR STEP CUBICSPLINE"}]}],
  "cameras": ["camera", {
    "type!": "choice perspective orthographic",
    "perspective": {"yfov!": "number 1e-3 3.1", "znear!": "number 1.2e-38"},
    "orthographic": {"xmag!": "number", "ymag!": "number", "zfar!": "number", "znear!": "number"}}],
  "extensions": {"KHR_lights_punctual": {"lights!": ["light", {
    "type!": "choice directional point spot", "color": "numbers 3 0", "intensity": "number 0",
    "range": "number 1.2e-38", "spot": {}}]}}
})";
const char* const kTextureSchema = R"({
  "index!": "index textures", "texCoord": "count 0", "scale": "number",
  "extensions": {"KHR_texture_transform": {
    "offset": "numbers 2", "rotation": "number", "scale": "numbers 2", "texCoord": "count 0"}}
})";

constexpr int kMaxDepth =
    64;  // far more than glTF needs; bounds the recursion of whatever walks the document
constexpr double kMaxCount = 2147483647;

constexpr std::array<std::string_view, 5> kExtensions = {
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_mesh_quantization",
    "KHR_texture_transform"};

// An object and those around it, for messages: "channel 1 of animation 0 'Walk'".
struct Place {
  const Place* outer = nullptr;
  std::string label;

  std::string text() const {
    std::string result = label;
    for (const Place* place = outer; place != nullptr; place = place->outer) {
      if (!result.empty() && !place->label.empty()) result += " of ";
      result += place->label;
    }
    return result.empty() ? "the file" : result;
  }
};

[[noreturn]] void refuse(const Place& place, std::string_view field, const std::string& reason) {
  throw GltfError(fmt::format("{} has '{}' {}", place.text(), field, reason));
}

// Returns the value as it stands in the file, short enough for a message.
std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

double number_in(const json& value) {
  return value.is_number() ? value.get<double>() : std::nan("");
}

// A kind of the table: its first word, and the others.
struct Kind {
  std::string_view name;
  std::vector<std::string_view> words;

  explicit Kind(std::string_view text) : name(text.substr(0, text.find(' '))) {
    for (std::size_t end = name.size(); end < text.size();) {
      const std::size_t begin = end + 1;
      end = std::min(text.find(' ', begin), text.size());
      words.push_back(text.substr(begin, end - begin));
    }
  }
  double number(std::size_t i, double otherwise) const {
    if (i < words.size()) std::from_chars(words[i].data(), words[i].data() + words[i].size(), otherwise);
    return otherwise;
  }
};

// Rebuilds a document from the fields of the table only.
class Checker {
 public:
  explicit Checker(const json& root) : root_(root) {}

  json object(const json& value, const json& fields, const Place& place) const {
    json result = json::object();
    for (const auto& [key, kind] : fields.items()) {
      const std::string name = key.substr(0, key.find('!'));
      const auto found = value.find(name);
      if (found != value.end()) {
        result[name] = checked(*found, kind, name, place);
      } else if (name.size() < key.size()) {
        throw GltfError(fmt::format("{} lacks '{}', which glTF 2.0 demands", place.text(), name));
      }
    }
    return result;
  }

 private:
  json checked(const json& value, const json& schema, const std::string& field, const Place& place) const {
    if (schema.is_object()) return inner(value, schema, field, place);
    if (schema.is_array()) return list(value, schema, field, place);
    const Kind kind(schema.get_ref<const std::string&>());
    if (kind.name == "texture") return inner(value, texture_, field, place);
    if (kind.name == "index") return index(value, kind, field, place);
    if (kind.name == "indices") return indices(value, kind, field, place);
    if (kind.name == "attributes") return attributes(value, kind, field, place);
    if (kind.name == "count") return count(value, kind, field, place);
    if (kind.name == "number") return number(value, kind, 0, field, place);
    if (kind.name == "numbers") return numbers(value, kind, field, place);
    if (kind.name == "choice") return choice(value, kind, field, place);
    const bool wants_bool = kind.name == "bool";
    if (wants_bool ? !value.is_boolean() : !value.is_string())
      refuse(place, field,
             shown(value) + (wants_bool ? "; true or false is needed" : "; a string is needed"));
    return value;
  }

  // 1.0 is as good an integer as 1, says JSON; the result is always of unsigned type.
  static json count(const json& value, const Kind& kind, const std::string& field, const Place& place) {
    const double number = number_in(value), low = kind.number(0, 0), high = kind.number(1, kMaxCount);
    if (!(number >= low && number <= high) || number != std::floor(number)) {
      refuse(place, field,
             fmt::format("{}; an integer from {:.0f} to {:.0f} is needed", shown(value), low, high));
    }
    return static_cast<std::uint64_t>(number);
  }

  json index(const json& value, const Kind& kind, std::string_view field, const Place& place) const {
    const double number = number_in(value);
    const std::size_t size = size_of(kind.words[0]);
    if (number != std::floor(number)) refuse(place, field, shown(value) + "; an integer index is needed");
    if (!(number >= 0 && number < static_cast<double>(size))) {
      const std::string right =
          size == 0 ? fmt::format("but the file has no '{}'", kind.words[0])
                    : fmt::format("but the file has only {} '{}' (0 to {})", size, kind.words[0], size - 1);
      refuse(place, field, fmt::format("{}, {}", shown(value), right));
    }
    return static_cast<std::uint64_t>(number);
  }

  json indices(const json& value, const Kind& kind, const std::string& field, const Place& place) const {
    if (!value.is_array()) refuse(place, field, shown(value) + "; a list of indices is needed");
    json result = json::array();
    for (const json& element : value)
      result.push_back(index(element, kind, field, place));
    return result;
  }

  json attributes(const json& value, const Kind& kind, const std::string& field, const Place& place) const {
    if (!value.is_object()) refuse(place, field, shown(value) + "; an object of indices is needed");
    json result = json::object();
    for (const auto& [name, element] : value.items())
      result[name] = index(element, kind, name, place);
    return result;
  }

  // `first`: the word with the lower bound.
  static json number(const json& value, const Kind& kind, std::size_t first, const std::string& field,
                     const Place& place) {
    const double number = number_in(value), most = static_cast<double>(FLT_MAX);
    const double low = kind.number(first, -most), high = kind.number(first + 1, most);
    if (!(number >= low && number <= high)) {
      refuse(place, field,
             fmt::format("{}; a finite number{}{} is needed", shown(value),
                         low > -most ? fmt::format(" of at least {:g}", low) : "",
                         high < most ? fmt::format(" and at most {:g}", high) : ""));
    }
    return number;
  }

  static json numbers(const json& value, const Kind& kind, const std::string& field, const Place& place) {
    const auto length = static_cast<std::size_t>(kind.number(0, 0));
    if (!value.is_array() || (length > 0 && value.size() != length))
      refuse(place, field,
             fmt::format("{}; a list of {}{}numbers is needed", shown(value), length > 0 ? kind.words[0] : "",
                         length > 0 ? " " : ""));
    json result = json::array();
    for (const json& element : value)
      result.push_back(number(element, kind, 1, field, place));
    return result;
  }

  static json choice(const json& value, const Kind& kind, const std::string& field, const Place& place) {
    const bool wants_number = kind.words[0][0] >= '0' && kind.words[0][0] <= '9';
    const bool fits = wants_number ? value.is_number_integer() : value.is_string();
    const std::string text = !fits ? "" : wants_number ? value.dump() : value.get<std::string>();
    if (std::find(kind.words.begin(), kind.words.end(), text) == kind.words.end())
      refuse(place, field, fmt::format("{}; one of {} is needed", shown(value), fmt::join(kind.words, ", ")));
    return value;
  }

  json inner(const json& value, const json& fields, const std::string& field, const Place& place) const {
    if (!value.is_object()) refuse(place, field, shown(value) + "; an object is needed");
    json result = object(value, fields, Place{&place, field == "extensions" ? "" : field});
    if (fields.empty())
      result["present"] = true;  // an empty object would be lost on its way through tinygltf
    return result;
  }

  json list(const json& value, const json& schema, const std::string& field, const Place& place) const {
    if (!value.is_array()) refuse(place, field, shown(value) + "; a list is needed");
    const std::string& kind = schema[0].get_ref<const std::string&>();
    json result = json::array();
    for (std::size_t i = 0; i < value.size(); ++i) {
      const json& element = value[i];
      if (!element.is_object())
        throw GltfError(fmt::format("{} {} is {}; an object is needed", kind, i, shown(element)));
      const auto name = element.find("name");
      const bool is_named = name != element.end() && name->is_string();
      const Place own{&place, described(kind.c_str(), static_cast<int>(i),
                                        is_named ? name->get<std::string>() : std::string())};
      result.push_back(object(element, schema[1], own));
      if (name != element.end()) result.back()["name"] = checked(*name, "string", "name", own);
    }
    return result;
  }

  std::size_t size_of(std::string_view name) const {
    const json* owner = &root_;
    if (name == "lights") {
      const json::json_pointer lights("/extensions/KHR_lights_punctual");
      if (!root_.contains(lights)) return 0;
      owner = &root_.at(lights);
    }
    const auto found = owner->find(name);
    return found != owner->end() && found->is_array() ? found->size() : 0;
  }

  const json& root_;
  const json texture_ = json::parse(kTextureSchema);
};

// The parser of nlohmann is iterative, but what comes after it recurses.
void check_depth(const std::string& text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kMaxDepth) {
      throw GltfError(
          fmt::format("the JSON is nested deeper than {} levels, which no glTF needs", kMaxDepth));
    }
  }
}

json parsed(const std::string& text) {
  check_depth(text);
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    std::string reason = error.what();
    if (const std::size_t end = reason.find("] "); reason.starts_with("[") && end != std::string::npos)
      reason = reason.substr(end + 2);
    throw GltfError("the JSON is broken or truncated (" + reason + "); one complete object is needed");
  }
}

void check_version(const json& root) {
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object()) return;
  for (const char* field : {"minVersion", "version"}) {
    if (!asset->contains(field)) continue;
    const json& value = (*asset)[field];
    const bool is_minimum = field == std::string_view("minVersion");
    if (!value.is_string() || !value.get<std::string>().starts_with("2.") || (is_minimum && value != "2.0"))
      refuse({nullptr, "asset"}, field, shown(value) + "; only glTF \"2.0\" can be read");
  }
}

// Returns the names in `list` of extensions that cannot be read, as they stand in the file.
std::vector<std::string> unknown_extensions(const json& root, const char* list) {
  std::vector<std::string> unknown;
  const auto names = root.find(list);
  if (names == root.end()) return unknown;
  if (!names->is_array()) refuse({}, list, shown(*names) + "; a list of names is needed");
  for (const json& name : *names) {
    if (!name.is_string() ||
        std::find(kExtensions.begin(), kExtensions.end(), name.get<std::string>()) == kExtensions.end())
      unknown.push_back(shown(name));
  }
  return unknown;
}

// Checks what the table cannot say: the object that belongs to a type.
void complete_types(json& root) {
  for (std::size_t i = 0; root.contains("cameras") && i < root["cameras"].size(); ++i) {
    const auto type = root["cameras"][i]["type"].get<std::string>();
    if (!root["cameras"][i].contains(type))
      throw GltfError(fmt::format("camera {} lacks '{}', which its type demands", i, type));
  }
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(lights)) return;
  for (json& light : root[lights]) {
    if (light["type"] == "spot") light["spot"] = json::object();
  }
}

}  // namespace

CheckedJson checked_gltf_json(const std::string& text) {
  const json root = parsed(text);
  if (!root.is_object()) throw GltfError("the JSON is " + shown(root) + "; glTF needs an object");
  check_version(root);
  if (const auto required = unknown_extensions(root, "extensionsRequired"); !required.empty()) {
    throw GltfError(fmt::format("the file requires the extension {}, which cannot be read; known are {}",
                                required.front(), fmt::join(kExtensions, ", ")));
  }
  CheckedJson checked{Checker(root).object(root, json::parse(kSchema), Place{}),
                      unknown_extensions(root, "extensionsUsed")};
  complete_types(checked.root);
  return checked;
}

}  // namespace quincunx::scenes
