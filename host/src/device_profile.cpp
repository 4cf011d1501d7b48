// SPDX-License-Identifier: MIT
#include "quincunx/device_profile.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <iterator>

#include "cache_entry.h"
#include "device_profile_file.h"
#include "shipped_profiles.h"

namespace quincunx {
namespace {

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
    spdlog::warn("device profile {} is not used: {}; quincunx-bench --tune writes a new one", path->string(),
                 fault);
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
      spdlog::warn("the shipped device profile {} is not used: {}", shipped.name, file.status().message());
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
