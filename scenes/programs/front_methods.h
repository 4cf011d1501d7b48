// SPDX-License-Identifier: MIT
// The methods that ErrorFronts are measured for.
#pragma once

#include <string>
#include <vector>

namespace quincunx::scenes {

// Those that are on a front of some class of scenes, as docs/quality.md shows, by the names of tools::method_choices().
// In the order of growing effort.
const std::vector<std::string>& front_methods();

}  // namespace quincunx::scenes
