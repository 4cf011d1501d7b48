// SPDX-License-Identifier: MIT
#pragma once

#include "quincunx/status.h"
#include "scene.h"

namespace quincunx::scenes {

// Whether a scene holds together: indices, sizes, counts, finite positions. Errors: kInvalidArgument; the
// message names the first object that does not, what it holds and what would be right.
Status check_scene(const Scene& scene);

}  // namespace quincunx::scenes
