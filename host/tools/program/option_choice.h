// SPDX-License-Identifier: MIT
// Command line options that take one of a few names.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace quincunx::tools {

// set() gets the value of the name, whatever the case of its letters. `names` must outlive the parsing.
template <typename Value, typename Set>
void add_choice(CLI::App& app, const std::string& option, const std::map<std::string, Value>& names,
                const std::string& description, Set set) {
  const auto choose = [option, set, &names](const std::string& name) {
    const auto found = names.find(CLI::detail::to_lower(name));
    if (found == names.end()) {
      std::string choices;
      for (const auto& [choice, value] : names)
        choices += (choices.empty() ? "" : ", ") + choice;
      throw CLI::ValidationError(option, fmt::format("'{}' is none of {}", name, choices));
    }
    set(found->second);
  };
  app.add_option_function<std::string>(option, choose, description)->type_name("NAME");
}

template <typename Target, typename Value>
void add_choice(CLI::App& app, const std::string& option, Target& target,
                const std::map<std::string, Value>& names, const std::string& description) {
  add_choice(app, option, names, description, [&target](const Value& value) { target = value; });
}

}  // namespace quincunx::tools
