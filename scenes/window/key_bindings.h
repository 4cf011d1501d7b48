// SPDX-License-Identifier: MIT
// What each key of the window does: the one table that the keyboard, scripts, the help and the tests go by.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "window/window.h"
#include "window/window_settings.h"

namespace quincunx::scenes {

struct KeyBinding {
  int key;            // GLFW_KEY_...
  const char* name;   // "space", "m"; as scripts call it
  const char* shown;  // "Space"; with what Shift does, if it does: "M"
  const char* does;   // "freeze the frame"
  void (*act)(WindowSettings& settings, bool shift);
};

std::span<const KeyBinding> key_bindings();

// Does what the key stands for; nothing for one that is not bound.
void act_on(const KeyPress& press, WindowSettings& settings);

// "m", "shift+m". Nothing where no key is called so.
std::optional<KeyPress> key_named(const std::string& name);

}  // namespace quincunx::scenes
