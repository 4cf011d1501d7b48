// SPDX-License-Identifier: MIT
// The built-in scenes that stand for each class of an ErrorFront, and those that its users are judged by.
#pragma once

#include <span>
#include <string_view>

#include "quincunx/error_front.h"

namespace quincunx::bench {

struct ClassScenes {
  SceneClass scene_class;
  std::span<const std::string_view> measured;  // by --front
  std::span<const std::string_view> held_out;  // never: who chooses by a front proves itself on these
};

// Each class once, in the order of SceneClass. No scene is there twice.
std::span<const ClassScenes> class_scenes();

}  // namespace quincunx::bench
