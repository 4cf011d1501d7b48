// SPDX-License-Identifier: MIT
#include "quincunx/advanced/device_profile.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "device/device_impl.h"
#include "device/program_cache.h"
#include "quincunx/advanced/log.h"
#include "shipped_profile_files.h"

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

const Json& member(const Json& object, const char* key, std::string_view where) {
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

namespace fs = std::filesystem;

// A CPU runs a group in one thread, and values of a row are loaded once where one work-item makes it. All other
// devices want many small work-items, and a compact tile of them as a group.
DeviceProfile default_profile(DeviceKind kind) {
  DeviceProfile profile;
  if (kind != DeviceKind::kCpu) profile.shape = {.group_width = 16, .group_height = 8, .pixels_per_item = 1};
  return profile;
}

std::optional<fs::path> path_of(const Device::Impl& device) {
  const std::optional<fs::path> folder = cache_folder();
  if (!folder) return std::nullopt;
  return *folder / fmt::format("device_profile-{}.json", cache_key(device, "device_profile", ""));
}

// Why a file of the cache is not for this device; empty where it is.
std::string misfit(const ProfileOwner& owner, const ProfileOwner& wanted) {
  const auto differs = [](const char* what, const std::string& has, const std::string& is) {
    return has == is ? "" : fmt::format("it is for {} '{}', which here is '{}'", what, has, is);
  };
  for (const std::string& found :
       {differs("platform", owner.platform, wanted.platform), differs("device", owner.device, wanted.device),
        differs("driver", owner.driver, wanted.driver)}) {
    if (!found.empty()) return found;
  }
  return {};
}

std::optional<DeviceProfile> tuned_profile(const Device::Impl& device) {
  const std::optional<fs::path> path = path_of(device);
  if (!path) return std::nullopt;
  std::ifstream stream(*path, std::ios::binary);
  if (!stream) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const Result<ProfileFile> file = parse_profile(text);
  std::string fault = file.ok() ? misfit(file.value().owner, owner_of(device.info)) : file.status().message();
  if (!fault.empty()) {
    log_line(LogLevel::kWarning,
             fmt::format("device profile {} is not used: {}; quincunx-bench --tune writes a new one",
                         path->string(), fault));
    return std::nullopt;
  }
  DeviceProfile profile = file.value().profile;
  profile.source = ProfileSource::kTuned;
  return profile;
}

std::optional<DeviceProfile> shipped_profile(const DeviceInfo& info) {
  const ProfileOwner wanted = owner_of(info);
  for (const EmbeddedFile& shipped : shipped_profile_files()) {
    const Result<ProfileFile> file = parse_profile(std::string(shipped.text));
    if (!file.ok()) {
      log_line(LogLevel::kWarning, fmt::format("the shipped device profile {} is not used: {}", shipped.name,
                                               file.status().message()));
      continue;
    }
    if (file.value().owner.platform != wanted.platform || file.value().owner.kind != wanted.kind) continue;
    DeviceProfile profile = file.value().profile;
    profile.source = ProfileSource::kShipped;
    return profile;
  }
  return std::nullopt;
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
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

const WorkShape& DeviceProfile::shape_of(std::string_view kernel) const {
  const auto found = passes.find(kernel);
  return found == passes.end() ? shape : found->second;
}

std::string DeviceProfile::describe() const {
  switch (source) {
    case ProfileSource::kTuned:
      return fmt::format("tuned {}", date);
    case ProfileSource::kShipped:
      return fmt::format("shipped (measured {}, driver {})", date, driver);
    case ProfileSource::kDefault:
      break;
  }
  return "default";
}

DeviceProfile find_profile(const Device::Impl& device) {
  if (auto tuned = tuned_profile(device)) return *std::move(tuned);
  if (auto shipped = shipped_profile(device.info)) return *std::move(shipped);
  return default_profile(device.info.kind);
}

DeviceProfile default_profile(const Device& device) {
  return default_profile(device.info().kind);
}

std::optional<fs::path> profile_path(const Device& device) {
  return path_of(*device.impl());
}

Status keep_profile(const Device& device, const DeviceProfile& profile) {
  const std::optional<fs::path> path = profile_path(device);
  if (!path) {
    return Status::unsupported(
        "a device profile needs a cache folder: set QUINCUNX_CACHE_DIR, XDG_CACHE_HOME or HOME");
  }
  const std::string text = profile_text({owner_of(device.info()), profile});
  if (write_whole_file(*path, text)) return {};
  return Status::io(fmt::format("cannot write the device profile {}", path->string()));
}

}  // namespace quincunx
