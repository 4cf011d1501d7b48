// SPDX-License-Identifier: MIT
#include "window/script.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tools/program/program.h"
#include "window/key_bindings.h"

namespace quincunx::scenes {

Result<Script::Step> Script::parse_line(const std::string& line) {
  std::istringstream words(line);
  Step step;
  std::string action;
  std::string value;
  std::string more;
  if (!(words >> step.turn >> action) || step.turn < 0) {
    return Status::invalid("write a turn, from 0, and an action: 10 key m");
  }
  words >> value;
  if (words >> more) return Status::invalid(fmt::format("'{}' is one word too many", more));
  if (action == "key") {
    const auto key = key_named(value);
    if (!key) return Status::invalid(fmt::format("no key is called '{}'", value));
    step.key = *key;
  } else if (action == "resize") {
    step.action = Action::kResize;
    if (const std::string error = tools::parse_extent(value, step.extent); !error.empty())
      return Status::invalid(error);
  } else if (action == "minimise" || action == "restore") {
    step.action = action == "restore" ? Action::kRestore : Action::kMinimise;
    if (!value.empty()) return Status::invalid(fmt::format("'{}' is one word too many", value));
  } else {
    return Status::invalid(
        fmt::format("'{}' is no action; there are key, resize, minimise and restore", action));
  }
  return step;
}

Result<Script> Script::parse(const std::string& text) {
  Script script;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line.resize(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto step = parse_line(line);
    if (!step.ok()) return Status::invalid(fmt::format("line {}: {}", number, step.status().message()));
    script.steps_.push_back(step.value());
  }
  std::stable_sort(script.steps_.begin(), script.steps_.end(),
                   [](const Step& a, const Step& b) { return a.turn < b.turn; });
  return script;
}

Result<Script> Script::read(const std::string& path) {
  std::ifstream file(path);
  if (!file) return Status(StatusCode::kIoFailure, fmt::format("script '{}' cannot be read", path));
  auto script = parse({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
  if (!script.ok()) return Status::invalid(fmt::format("script '{}', {}", path, script.status().message()));
  return script;
}

void Script::play(std::int64_t turn, Window& window) {
  for (; next_ < steps_.size() && steps_[next_].turn <= turn; ++next_) {
    const Step& step = steps_[next_];
    switch (step.action) {
      case Action::kKey:
        window.press(step.key);
        break;
      case Action::kResize:
        window.resize(step.extent);
        break;
      case Action::kMinimise:
        window.minimise();
        break;
      case Action::kRestore:
        window.restore();
        break;
    }
  }
}

}  // namespace quincunx::scenes
