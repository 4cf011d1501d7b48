// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gltf/document.h"
#include "gltf/schema.h"

namespace quincunx::scenes {
namespace {

using nlohmann::json;

// Far more than glTF needs; bounds the recursion of whatever walks the document.
constexpr int kMaxDepth = 64;

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
      if (place->label.empty()) continue;
      if (!result.empty()) result += " of ";
      result += place->label;
    }
    return result.empty() ? "the file" : result;
  }
};

[[noreturn]] void refuse(const Place& place, const char* field, const std::string& reason) {
  throw GltfError(fmt::format("{} has '{}' {}", place.text(), field, reason));
}

// The value as it stands in the file, short enough for a message.
std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

std::string alternatives(std::string_view choices) {
  std::string text(choices);
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at)) {
    text.replace(at, 1, ", ");
  }
  return text;
}

class Checker {
 public:
  explicit Checker(const json& root) : root_(root) {}

  json object(const json& value, const ObjectSchema& schema, const Place& place) const {
    json result = json::object();
    for (const Field& field : schema.fields) {
      const auto found = value.find(field.name);
      if (found != value.end()) {
        result[field.name] = checked(*found, field, place);
      } else if (field.required) {
        throw GltfError(fmt::format("{} lacks '{}', which glTF 2.0 demands", place.text(), field.name));
      }
    }
    return result;
  }

 private:
  json checked(const json& value, const Field& field, const Place& place) const {
    switch (field.kind) {
      case FieldKind::kIndex:
        return index(value, field, place);
      case FieldKind::kIndices:
        return indices(value, field, place);
      case FieldKind::kAttributes:
        return attributes(value, field, place);
      case FieldKind::kCount:
        return integer(value, field, place);
      case FieldKind::kNumber:
        return number(value, field, place);
      case FieldKind::kNumbers:
        return numbers(value, field, place);
      case FieldKind::kBool:
        if (!value.is_boolean()) refuse(place, field.name, shown(value) + "; true or false is needed");
        return value;
      case FieldKind::kString:
        if (!value.is_string()) refuse(place, field.name, shown(value) + "; a string is needed");
        return value;
      case FieldKind::kChoice:
        return choice(value, field, place);
      case FieldKind::kObject:
        return inner(value, field, place);
      case FieldKind::kObjects:
        return list(value, field, place);
    }
    return {};
  }

  // 1.0 is as good an integer as 1, says JSON; the result is always of unsigned type.
  json integer(const json& value, const Field& field, const Place& place) const {
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    const double low = std::max(field.low, 0.0);
    const double high = std::min(field.high, 2147483647.0);
    if (!(number >= low && number <= high) || number != std::floor(number)) {
      refuse(place, field.name,
             fmt::format("{}; an integer from {:.0f} to {:.0f} is needed", shown(value), low, high));
    }
    return static_cast<std::uint64_t>(number);
  }

  json index(const json& value, const Field& field, const Place& place) const {
    const std::size_t size = size_of(field.of);
    if (!value.is_number() || value.get<double>() != std::floor(value.get<double>())) {
      refuse(place, field.name, shown(value) + "; an integer index is needed");
    }
    const double number = value.get<double>();
    if (!(number >= 0 && number < static_cast<double>(size))) {
      const std::string right =
          size == 0 ? fmt::format("but the file has no '{}'", field.of)
                    : fmt::format("but the file has only {} '{}' (0 to {})", size, field.of, size - 1);
      refuse(place, field.name, fmt::format("{}, {}", shown(value), right));
    }
    return static_cast<std::uint64_t>(number);
  }

  json indices(const json& value, const Field& field, const Place& place) const {
    if (!value.is_array()) refuse(place, field.name, shown(value) + "; a list of indices is needed");
    json result = json::array();
    for (const json& element : value)
      result.push_back(index(element, field, place));
    return result;
  }

  json attributes(const json& value, const Field& field, const Place& place) const {
    if (!value.is_object()) refuse(place, field.name, shown(value) + "; an object of indices is needed");
    json result = json::object();
    for (const auto& [name, element] : value.items()) {
      Field attribute = field;
      attribute.name = name.c_str();
      result[name] = index(element, attribute, place);
    }
    return result;
  }

  json number(const json& value, const Field& field, const Place& place) const {
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    if (!(number >= field.low && number <= field.high)) {
      const std::string low = field.low > Field::kLowest ? fmt::format(" of at least {:g}", field.low) : "";
      const std::string high =
          field.high < Field::kHighest ? fmt::format(" and at most {:g}", field.high) : "";
      refuse(place, field.name, fmt::format("{}; a finite number{}{} is needed", shown(value), low, high));
    }
    return number;
  }

  json numbers(const json& value, const Field& field, const Place& place) const {
    if (!value.is_array() || value.size() != field.length) {
      refuse(place, field.name,
             fmt::format("{}; a list of {} numbers is needed", shown(value), field.length));
    }
    json result = json::array();
    for (const json& element : value)
      result.push_back(number(element, field, place));
    return result;
  }

  json choice(const json& value, const Field& field, const Place& place) const {
    const std::string text = value.is_string()           ? value.get<std::string>()
                             : value.is_number_integer() ? value.dump()
                                                         : std::string();
    const bool wants_number = field.of[0] >= '0' && field.of[0] <= '9';
    const std::string all = fmt::format("|{}|", field.of);
    if (text.empty() || value.is_string() == wants_number || text.find('|') != std::string::npos ||
        all.find("|" + text + "|") == std::string::npos) {
      refuse(place, field.name, fmt::format("{}; one of {} is needed", shown(value), alternatives(field.of)));
    }
    return value;
  }

  json inner(const json& value, const Field& field, const Place& place) const {
    if (!value.is_object()) refuse(place, field.name, shown(value) + "; an object is needed");
    const bool anonymous = field.object->label[0] == '\0';
    json result = object(value, *field.object, Place{&place, anonymous ? "" : field.name});
    // An empty object would be lost on its way through tinygltf.
    if (field.object->fields.empty()) result["present"] = true;
    return result;
  }

  json list(const json& value, const Field& field, const Place& place) const {
    if (!value.is_array()) refuse(place, field.name, shown(value) + "; a list is needed");
    json result = json::array();
    for (std::size_t i = 0; i < value.size(); ++i) {
      const json& element = value[i];
      if (!element.is_object()) {
        throw GltfError(
            fmt::format("{} {} is {}; an object is needed", field.object->label, i, shown(element)));
      }
      const auto name = element.find("name");
      const bool is_named = name != element.end() && name->is_string();
      const std::string label = described(field.object->label, static_cast<int>(i),
                                          is_named ? name->get<std::string>() : std::string());
      result.push_back(object(element, *field.object, Place{&place, label}));
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
    if (const std::size_t end = reason.find("] "); reason.starts_with("[") && end != std::string::npos) {
      reason = reason.substr(end + 2);
    }
    throw GltfError("the JSON is broken or truncated (" + reason + "); one complete object is needed");
  }
}

void check_version(const json& root) {
  const Place asset{nullptr, "asset"};
  for (const char* field : {"minVersion", "version"}) {
    const auto& object = root.find("asset");
    if (object == root.end() || !object->is_object() || !object->contains(field)) continue;
    const json& value = (*object)[field];
    if (!value.is_string() || !value.get<std::string>().starts_with("2.")) {
      refuse(asset, field, shown(value) + "; only glTF \"2.0\" can be read");
    }
    if (field == std::string_view("minVersion") && value != "2.0") {
      refuse(asset, field, shown(value) + "; only glTF \"2.0\" can be read");
    }
  }
}

void check_extensions(const json& root) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end()) return;
  if (!required->is_array()) {
    refuse({}, "extensionsRequired", shown(*required) + "; a list of names is needed");
  }
  for (const json& name : *required) {
    const bool known = name.is_string() && std::find(kExtensions.begin(), kExtensions.end(),
                                                     name.get<std::string>()) != kExtensions.end();
    if (known) continue;
    throw GltfError(fmt::format("the file requires the extension {}, which cannot be read; known are {}",
                                shown(name), fmt::join(kExtensions, ", ")));
  }
}

// Checks what the tables cannot say: the object that belongs to a type.
void complete_types(json& root) {
  for (std::size_t i = 0; root.contains("cameras") && i < root["cameras"].size(); ++i) {
    const auto type = root["cameras"][i]["type"].get<std::string>();
    if (!root["cameras"][i].contains(type)) {
      throw GltfError(fmt::format("camera {} lacks '{}', which its type demands", i, type));
    }
  }
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(lights)) return;
  for (json& light : root[lights]) {
    if (light["type"] == "spot") light["spot"] = json::object();
  }
}

}  // namespace

json checked_gltf_json(const std::string& text) {
  const json root = parsed(text);
  if (!root.is_object()) throw GltfError("the JSON is " + shown(root) + "; glTF needs an object");
  check_version(root);
  check_extensions(root);
  json result = Checker(root).object(root, gltf_schema(), Place{});
  complete_types(result);
  return result;
}

}  // namespace quincunx::scenes
