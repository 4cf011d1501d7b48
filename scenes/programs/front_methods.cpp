// SPDX-License-Identifier: MIT
#include "programs/front_methods.h"

namespace quincunx::scenes {

const std::vector<std::string>& front_methods() {
  static const std::vector<std::string> names = {
      "bilinear",      "catmull-rom",       "quincunx:velocity", "quincunx:reprojected",
      "temporal:fast", "temporal:balanced", "temporal:quality"};
  return names;
}

}  // namespace quincunx::scenes
