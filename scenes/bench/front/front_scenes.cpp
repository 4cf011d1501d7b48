// SPDX-License-Identifier: MIT
#include "bench/front/front_scenes.h"

namespace quincunx::bench {
namespace {

using Names = std::string_view[];

constexpr Names kStill = {"still"};
constexpr Names kPan = {"pan"};
constexpr Names kObjects = {"occluders", "wheel"};
constexpr Names kThin = {"wires", "spokes", "twigs"};
constexpr Names kLight = {"shadows", "sparkles"};
constexpr Names kZoom = {"zoom"};

constexpr Names kHeldStill = {"chart"};
constexpr Names kHeldPan = {"backdrop", "cut"};
constexpr Names kHeldObjects = {"courtyard", "cutout"};
constexpr Names kHeldThin = {"cables", "fence", "crossings"};
constexpr Names kHeldLight = {"particles"};
constexpr Names kHeldZoom = {"flight"};

constexpr ClassScenes kClasses[] = {
    {SceneClass::kStill, kStill, kHeldStill},       {SceneClass::kPan, kPan, kHeldPan},
    {SceneClass::kObjects, kObjects, kHeldObjects}, {SceneClass::kThin, kThin, kHeldThin},
    {SceneClass::kLight, kLight, kHeldLight},       {SceneClass::kZoom, kZoom, kHeldZoom},
};

}  // namespace

std::span<const ClassScenes> class_scenes() {
  return kClasses;
}

}  // namespace quincunx::bench
