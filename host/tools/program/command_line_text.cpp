// SPDX-License-Identifier: MIT
// What a command line can take, in words: for its manual page and its completions.
#include <CLI/CLI.hpp>
#include <algorithm>

#include "tools/program/command_line.h"
#include "tools/program/manual.h"

namespace quincunx::tools {
namespace {

// How --help writes an option's value.
class ValueText : public CLI::Formatter {
 public:
  std::string of(const CLI::Option* option) const {
    const std::string text = make_option_opts(option);
    return text.substr(std::min(text.find_first_not_of(' '), text.size()));
  }
};

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

ValueKind kind_of(const CLI::Option* option, const std::vector<std::string>& words) {
  if (option->get_items_expected_max() == 0) return ValueKind::kNone;
  if (!words.empty()) return ValueKind::kWord;
  const std::string type = option->get_type_name();
  const auto has = [&type](const char* name) { return type.find(name) != std::string::npos; };
  if (has("FOLDER")) return ValueKind::kFolder;
  const bool is_file = has("FILE") || has("PATTERN") || has("BASE") || has(".json") || has("TEXT");
  return is_file ? ValueKind::kFile : ValueKind::kAny;
}

}  // namespace

ProgramText CommandLine::text() const {
  ProgramText program = {app_->get_name(),   version_, one_line(app_->get_description()),
                         app_->get_footer(), {},       {}};
  for (const CLI::Option* option : app_->get_options()) {
    if (option->get_group().empty()) continue;  // it is not in the help either
    const auto words = words_.find(option->get_name());
    OptionText text;
    text.words = words != words_.end() ? words->second : std::vector<std::string>();
    text.kind = kind_of(option, text.words);
    text.value = ValueText().of(option);
    text.description = one_line(option->get_description());
    for (const std::string& name : option->get_snames())
      text.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames())
      text.names.push_back("--" + name);
    if (option->get_positional()) text.names = {option->get_name()};
    (option->get_positional() ? program.positionals : program.options).push_back(std::move(text));
  }
  return program;
}

}  // namespace quincunx::tools
