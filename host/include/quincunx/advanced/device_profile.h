// SPDX-License-Identifier: MIT
// DeviceProfile: how the work of each pass is divided into work-items and groups on a device. Only speed depends on it.
//
// Device::open() takes the first one that exists of
//   tuned     measured by quincunx-bench --tune on this device with this driver, kept in cache_folder()
//   shipped   of host/profiles, for the device's platform and kind
//   default   the same shape for every pass, by the device's kind
// The search is modelled on CLBlast's (Nugteren, "CLBlast: A Tuned OpenCL BLAS Library", 2018).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "quincunx/advanced/export.h"
#include "quincunx/status.h"

namespace quincunx {

class Device;

// The division of a pass's rows into work-items, and of those into groups.
struct WorkShape {
  static constexpr int kMostOfGroup = 1024;  // on either axis
  static constexpr int kMostPixels = 1 << 16;

  // A group, in work-items. It is halved until the device can run the kernel with it.
  int group_width = 1;
  int group_height = 4;
  // Pixels of a row that one work-item makes, rounded up to a kernel's block; 0: the whole row.
  int pixels_per_item = 0;

  friend bool operator==(const WorkShape&, const WorkShape&) = default;
};

enum class ProfileSource { kDefault, kShipped, kTuned };

struct QUINCUNX_API DeviceProfile {
  ProfileSource source = ProfileSource::kDefault;
  std::string date;    // date of the measurement, "2026-11-22 21:05 UTC"; empty for kDefault
  std::string driver;  // it was measured with; empty for kDefault
  WorkShape shape;     // shape of every pass that has none of its own
  std::map<std::string, WorkShape, std::less<>> passes;  // by the kernel's name

  const WorkShape& shape_of(std::string_view kernel) const;

  // Returns "tuned 2026-11-22 21:05 UTC", "shipped (measured 2026-11-22 21:05 UTC, driver 3.1)" or "default"
  std::string describe() const;

  friend bool operator==(const DeviceProfile&, const DeviceProfile&) = default;
};

// Returns the profile of a device without measurements. Pure.
QUINCUNX_API DeviceProfile default_profile(const Device& device);

// Returns the path of this device's tuned profile for this driver, a JSON file that may not exist yet; nothing without
// a cache_folder().
QUINCUNX_API std::optional<std::filesystem::path> profile_path(const Device& device);

// Writes that file, whole or not at all; Device::open() uses it from now on.
// Errors: kUnsupported where there is no cache folder, kIoFailure where the file cannot be written.
QUINCUNX_API Status keep_profile(const Device& device, const DeviceProfile& profile);

}  // namespace quincunx
