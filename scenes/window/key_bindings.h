// SPDX-License-Identifier: MIT
// The keys of the window: the one table that the keyboard, scripts, the help and the tests go by; and Script, which
// presses them in place of a person.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/status.h"
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

// Runs the action bound to a key; ignores unbound keys.
void act_on(const KeyPress& press, WindowSettings& settings);

// "m", "shift+m". Nothing where no key is called so.
std::optional<KeyPress> key_named(const std::string& name);

// Acts on the window in place of a person, by a file, turn by turn of its loop: for tests and for showing something
// the same way twice.
//
//   # turn  action
//   10      key shift+m        as if the key was pressed: a name of key_bindings()
//   20      resize 800x450
//   30      minimise           a turn passes about every 20 ms while the window is minimised
//   40      restore
class Script {
 public:
  // Errors: kIoFailure for a file that cannot be read; kInvalidArgument for a line that is none, with its
  // number and what would be right.
  static Result<Script> read(const std::string& path);
  static Result<Script> parse(const std::string& text);

  Script() = default;  // does nothing

  // Does what is written for a turn. Turns come in order, from 0.
  void play(std::int64_t turn, Window& window);

 private:
  enum class Action : std::uint8_t { kKey, kResize, kMinimise, kRestore };
  struct Step {
    std::int64_t turn = 0;
    Action action = Action::kKey;
    KeyPress key = {};
    Extent extent = {};
  };
  static Result<Step> parse_line(const std::string& line);

  std::vector<Step> steps_;  // by their turns
  std::size_t next_ = 0;
};

}  // namespace quincunx::scenes
