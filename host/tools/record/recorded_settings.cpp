// SPDX-License-Identifier: MIT
#include "tools/record/recorded_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <type_traits>

#include "tools/program/resolve_settings_options.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "quincunx recording 1";

const char* name_of(Storage storage) {
  return storage == Storage::kBuffer ? "buffer" : storage == Storage::kImage ? "image" : "unknown";
}

// As of each_setting().
template <typename Visit, typename Needs>
void each_need(Needs& of, Visit&& visit) {
  auto& [moving_objects, camera_motion, transparents, background] = of;
  visit("moving_objects", moving_objects);
  visit("camera_motion", camera_motion);
  visit("transparents", transparents);
  visit("background", background);
}

template <typename Value>
Json written(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return name_of(value);
  } else if constexpr (std::is_same_v<Value, Extent>) {
    return {value.width, value.height};
  } else {
    return value;
  }
}

// The values of an enum count from 0, and name_of() says "unknown" of the first number beyond.
template <typename Enum>
bool read_name(const Json& json, Enum& value) {
  if (!json.is_string()) return false;
  const auto name = json.get<std::string>();
  for (int i = 0; name_of(static_cast<Enum>(i)) != std::string_view("unknown"); ++i) {
    if (name != name_of(static_cast<Enum>(i))) continue;
    value = static_cast<Enum>(i);
    return true;
  }
  return false;
}

bool read_number(const Json& json, int& value) {
  constexpr double kMost = std::numeric_limits<int>::max();
  if (!json.is_number_integer() || std::abs(json.get<double>()) > kMost) return false;
  value = json.get<int>();
  return true;
}

// Returns whether the value can be meant.
template <typename Value>
bool read(const Json& json, Value& value) {
  if constexpr (std::is_enum_v<Value>) return read_name(json, value);
  if constexpr (std::is_same_v<Value, Extent>) {
    return json.is_array() && json.size() == 2 && read_number(json[0], value.width) &&
           read_number(json[1], value.height);
  }
  if constexpr (std::is_same_v<Value, bool>) {
    if (json.is_boolean()) value = json.get<bool>();
    return json.is_boolean();
  }
  if constexpr (std::is_same_v<Value, int>) return read_number(json, value);
  if constexpr (std::is_same_v<Value, float>) {
    if (json.is_number()) value = json.get<float>();
    return json.is_number();
  }
}

// "temporal.preset" is "preset" of the object "temporal".
Json::json_pointer pointer_to(std::string name) {
  std::replace(name.begin(), name.end(), '.', '/');
  return Json::json_pointer("/" + name);
}

Json json_of(const ResolveSettings& settings) {
  Json json = Json::object();
  each_setting(settings,
               [&](const char* name, const auto& value) { json[pointer_to(name)] = written(value); });
  return json;
}

Json json_of(const RecordedSettings& recorded) {
  Json needs = Json::object();
  each_need(recorded.needs, [&](const char* name, const auto& value) { needs[name] = written(value); });
  return {{"format", kFormat},
          {"version", QUINCUNX_VERSION},
          {"device", recorded.device},
          {"needs", needs},
          {"settings", json_of(recorded.settings)}};
}

// Returns a field of `json` that is none of this version's, which a later one may have written; else an empty name.
std::string unknown_in(const Json& json, const Json& known) {
  for (const auto& [name, value] : json.items()) {
    if (!known.contains(name)) return name;
    if (!value.is_object()) continue;
    if (const std::string inner = unknown_in(value, known[name]); !inner.empty()) return name + "." + inner;
  }
  return {};
}

std::string path_in(const std::string& folder) {
  return (std::filesystem::path(folder) / kSettingsFile).string();
}

std::optional<Json> parsed(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Json json = Json::parse(file, nullptr, false);
  if (!json.is_object() || json.value("format", Json()) != kFormat) return std::nullopt;
  return json;
}

}  // namespace

std::string to_json(const RecordedSettings& recorded) {
  return json_of(recorded).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_line(const RecordedSettings& recorded) {
  return json_of(recorded).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<std::string> differences(const ResolveSettings& now, const ResolveSettings& recorded) {
  const Json before = json_of(recorded);
  std::vector<std::string> found;
  each_setting(now, [&](const char* name, const auto& value) {
    const Json& was = before[pointer_to(name)];
    const Json is = written(value);
    const auto text = [](const Json& json) {
      return json.is_string() ? json.get<std::string>() : json.dump();
    };
    if (is != was) found.push_back(fmt::format("{} is {} in place of {}", name, text(is), text(was)));
  });
  return found;
}

bool is_recording(const std::string& folder) {
  return parsed(path_in(folder)).has_value();
}

Result<RecordedSettings> read_settings(const std::string& folder) {
  const std::string path = path_in(folder);
  const auto json = parsed(path);
  if (!json) return Status::io(fmt::format("'{}' is not there or says nothing of a recording", path));
  RecordedSettings recorded;
  std::string bad;
  const auto take = [&](const Json& from, const char* name, auto& value) {
    const auto at = pointer_to(name);
    if (from.contains(at) && !read(from[at], value) && bad.empty()) bad = name;
  };
  const Json needs = json->value("needs", Json()), settings = json->value("settings", Json());
  if (!settings.is_object() || !needs.is_object())
    return Status::io(fmt::format("'{}' lacks needs or settings; both are objects", path));
  const Json known = json_of(RecordedSettings());
  std::string unknown = unknown_in(settings, known["settings"]);
  if (unknown.empty()) unknown = unknown_in(needs, known["needs"]);
  if (!unknown.empty()) {
    const std::string quoted = Json(unknown).dump();  // on one line, whatever the name
    return Status::io(fmt::format("'{}' has a '{}' that this version does not know", path,
                                  quoted.substr(1, quoted.size() - 2)));
  }
  each_need(recorded.needs, [&](const char* name, auto& value) { take(needs, name, value); });
  each_setting(recorded.settings, [&](const char* name, auto& value) { take(settings, name, value); });
  const Json device = json->value("device", Json());
  if (device.is_string()) recorded.device = device.get<std::string>();
  if (!bad.empty()) return Status::io(fmt::format("'{}' has a '{}' that cannot be meant", path, bad));
  return recorded;
}

}  // namespace quincunx::tools
