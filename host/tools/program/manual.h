// SPDX-License-Identifier: MIT
// The manual page of a program and its completions for shells, from the options that --help lists.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace quincunx::tools {

// Kind of completion of a value.
enum class ValueKind { kNone, kAny, kWord, kFile, kFolder };

struct OptionText {
  std::vector<std::string> names;     // "-n", "--dry-run"; of a positional one "INPUT"
  std::string value;                  // as --help has it, for example "NAME Needs: --truth"; may be empty
  std::string description;            // one line
  ValueKind kind = ValueKind::kNone;  // kNone: a flag
  std::vector<std::string> words;     // choices of kWord
};

struct ProgramText {
  std::string name, version, description;
  std::string footer;  // examples, and what else ends the help
  std::vector<OptionText> options, positionals;
};

std::string man_page(const ProgramText& program);  // troff, for section 1
std::string bash_completion(const ProgramText& program);
std::string zsh_completion(const ProgramText& program);
std::string fish_completion(const ProgramText& program);

// "man", "bash", "zsh" or "fish"; nothing for another form.
std::optional<std::string> manual(const ProgramText& program, const std::string& form);

}  // namespace quincunx::tools
