// SPDX-License-Identifier: MIT
#include "device_profile_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace quincunx {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr const char* kVersionKey = "quincunx_device_profile";

const char* name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::kCpu:
      return "cpu";
    case DeviceKind::kGpu:
      return "gpu";
    case DeviceKind::kAccelerator:
      return "accelerator";
    case DeviceKind::kOther:
      break;
  }
  return "other";
}

struct Fault {
  std::string what;
};

const Json& member(const Json& object, const char* key, const std::string& where) {
  if (!object.is_object() || !object.contains(key)) throw Fault{fmt::format("{} has no {}", where, key)};
  return object.at(key);
}

std::string text_at(const Json& object, const char* key) {
  const Json& value = member(object, key, "it");
  if (!value.is_string()) throw Fault{fmt::format("{} is {}; it must be text", key, value.dump())};
  return value.get<std::string>();
}

int number_in(const Json& value, const std::string& what, int least, int most) {
  if (!value.is_number_integer() || value < least || value > most)
    throw Fault{
        fmt::format("{} is {}; it must be a whole number in [{}, {}]", what, value.dump(), least, most)};
  return value.get<int>();
}

WorkShape shape_from(const Json& value, const std::string& what) {
  const Json& group = member(value, "group", what);
  if (!group.is_array() || group.size() != 2)
    throw Fault{fmt::format("the group of {} is {}; it must be [width, height]", what, group.dump())};
  const auto side = [&](std::size_t axis) {
    return number_in(group[axis], fmt::format("a side of the group of {}", what), 1, WorkShape::kMostOfGroup);
  };
  return {.group_width = side(0),
          .group_height = side(1),
          .pixels_per_item = number_in(member(value, "pixels", what), fmt::format("pixels of {}", what), 0,
                                       WorkShape::kMostPixels)};
}

Json json_of(const WorkShape& shape) {
  return {{"group", {shape.group_width, shape.group_height}}, {"pixels", shape.pixels_per_item}};
}

ProfileFile file_from(const Json& root) {
  const Json& version = member(root, kVersionKey, "it");
  if (version != kVersion) {
    throw Fault{
        fmt::format("{} is {}; this version of Quincunx reads {}", kVersionKey, version.dump(), kVersion)};
  }
  ProfileFile file{.owner = {.platform = text_at(root, "platform"),
                             .device = text_at(root, "device"),
                             .kind = text_at(root, "kind"),
                             .driver = text_at(root, "driver")},
                   .profile = {}};
  file.profile.driver = file.owner.driver;
  file.profile.date = text_at(root, "date");
  file.profile.shape = shape_from(member(root, "shape", "it"), "shape");
  const Json& passes = member(root, "passes", "it");
  if (!passes.is_object()) throw Fault{"passes is no object; it must hold a shape for each kernel's name"};
  for (const auto& [kernel, shape] : passes.items())
    file.profile.passes[kernel] = shape_from(shape, kernel);
  return file;
}

}  // namespace

ProfileOwner owner_of(const DeviceInfo& info) {
  return {info.platform, info.name, name_of(info.kind), info.driver};
}

Result<ProfileFile> parse_profile(const std::string& text) {
  const Json root = Json::parse(text, nullptr, false);
  if (root.is_discarded()) return Status::invalid("it is no JSON");
  try {
    return file_from(root);
  } catch (const Fault& fault) {
    return Status::invalid(fault.what);
  }
}

std::string profile_text(const ProfileFile& file) {
  Json root = {{kVersionKey, kVersion},
               {"platform", file.owner.platform},
               {"device", file.owner.device},
               {"kind", file.owner.kind},
               {"driver", file.owner.driver},
               {"date", file.profile.date},
               {"shape", json_of(file.profile.shape)},
               {"passes", Json::object()}};
  for (const auto& [kernel, shape] : file.profile.passes)
    root["passes"][kernel] = json_of(shape);
  return root.dump(1) + "\n";
}

}  // namespace quincunx
