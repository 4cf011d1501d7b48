// SPDX-License-Identifier: MIT
// DeviceProfile: how the work of a pass is cut for a device. No result depends on it.
#pragma once

#include "quincunx/device.h"

namespace quincunx {

struct DeviceProfile {
  // A group, in work-items.
  int group_width = 1;
  int group_height = 4;
  // Of a row that one work-item makes, rounded up to a kernel's block; 0: the whole row.
  int pixels_per_item = 0;
};

// A CPU runs a group in one thread, and values of a row are loaded once where one work-item makes it. All other
// devices want many small work-items, and a compact tile of them as a group.
constexpr DeviceProfile default_profile(DeviceKind kind) {
  if (kind == DeviceKind::kCpu) return {.group_width = 1, .group_height = 4, .pixels_per_item = 0};
  return {.group_width = 16, .group_height = 8, .pixels_per_item = 1};
}

}  // namespace quincunx
