// SPDX-License-Identifier: MIT
// Script: what a file does to the window in place of a person, turn by turn of its loop: for tests and for
// showing something the same way twice.
//
//   # turn  action
//   10      key shift+m        as if the key was pressed: a name of key_bindings()
//   20      resize 800x450
//   30      minimise           a turn passes about every 20 ms while the window is minimised
//   40      restore
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quincunx/status.h"
#include "window/window.h"

namespace quincunx::scenes {

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
