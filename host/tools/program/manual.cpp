// SPDX-License-Identifier: MIT
#include "tools/program/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

namespace quincunx::tools {
namespace {

constexpr const char* kExamples = "Examples:";
constexpr const char* kExitStatus = "Exit status: ";
constexpr std::array kPrograms = {"quincunx-bench", "quincunx-dump", "quincunx-render", "quincunx-resolve"};

// As troff shows it letter by letter.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    if (letter == '\\') {
      out += "\\e";
    } else if (letter == '-') {
      out += "\\-";
    } else {
      out += letter;
    }
  }
  const bool is_command = out.starts_with('.') || out.starts_with('\'');
  return is_command ? "\\&" + out : out;
}

std::string names_of(const OptionText& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", escaped(name));
  return names;
}

void add_options(const char* heading, const std::vector<OptionText>& options, std::string& page) {
  if (options.empty()) return;
  page += fmt::format(".SH {}\n", heading);
  for (const OptionText& option : options) {
    page += fmt::format(".TP\n{}{}\n{}\n", names_of(option),
                        option.value.empty() ? "" : " \\fI" + escaped(option.value) + "\\fR",
                        escaped(option.description));
  }
}

// Indented lines are examples and stay as they are; the others are prose.
void add_footer(const std::string& footer, std::string& page) {
  std::istringstream lines(footer);
  bool verbatim = false;
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with("  ");
    if (indented != verbatim) page += indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
    verbatim = indented;
    if (line == kExamples) {
      page += ".SH EXAMPLES\n";
    } else if (line.starts_with(kExitStatus)) {
      page += fmt::format(".SH EXIT STATUS\n{}\n", escaped(line.substr(std::string(kExitStatus).size())));
    } else {
      page += escaped(indented ? line.substr(2) : line) + "\n";
    }
  }
  if (verbatim) page += ".fi\n";
}

std::string see_also(const std::string& program) {
  std::string others;
  for (const char* other : kPrograms) {
    if (other == program) continue;
    others += fmt::format("{}\\fB{}\\fR(1)", others.empty() ? "" : ",\n", escaped(other));
  }
  return others;
}

// "Makes frames." as whatis(1) wants it: "makes frames".
std::string summary_of(std::string description) {
  if (description.ends_with('.')) description.pop_back();
  if (!description.empty())
    description[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(description[0])));
  return description;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// Within single quotes of a shell of the Bourne family.
std::string quoted(const std::string& text) {
  return "'" + replaced(text, "'", "'\\''") + "'";
}

std::string function_name(const std::string& program) {
  return "_" + replaced(program, "-", "_");
}

// The names of the options whose value is of this kind, as a pattern of `case`; empty where there is none.
std::string pattern_of(const ProgramText& program, ValueKind kind) {
  std::vector<std::string> names;
  for (const OptionText& option : program.options) {
    if (option.kind == kind) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string bash_case(const std::string& pattern, const std::string& action) {
  return pattern.empty() ? std::string()
                         : fmt::format("    {})\n      {}\n      return\n      ;;\n", pattern, action);
}

// Returns the text between colons after an option's description.
std::string zsh_value(const OptionText& option) {
  switch (option.kind) {
    case ValueKind::kNone:
      return {};
    case ValueKind::kWord:
      return fmt::format(":value:({})",
                         replaced(fmt::format("{}", fmt::join(option.words, " ")), ":", "\\:"));
    case ValueKind::kFile:
      return ":file:_files";
    case ValueKind::kFolder:
      return ":folder:_files -/";
    case ValueKind::kAny:
      return ":value: ";
  }
  return {};
}

std::string zsh_option(const OptionText& option) {
  std::string description = replaced(option.description, "\\", "\\\\");
  for (const char* special : {"[", "]", ":"})
    description = replaced(description, special, std::string("\\") + special);
  const std::string rest = quoted("[" + description + "]" + zsh_value(option));
  if (option.names.size() == 1) return option.names.front() + rest;
  return fmt::format("'({})'{{{}}}{}", fmt::join(option.names, " "), fmt::join(option.names, ","), rest);
}

}  // namespace

std::string man_page(const ProgramText& program) {
  std::string upper = program.name;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  std::string page = fmt::format(".TH {} 1 \"\" \"Quincunx {}\" \"User Commands\"\n", upper, program.version);
  page +=
      fmt::format(".SH NAME\n{} \\- {}\n", escaped(program.name), escaped(summary_of(program.description)));
  page += fmt::format(".SH SYNOPSIS\n\\fB{}\\fR [\\fIOPTIONS\\fR]", escaped(program.name));
  for (const OptionText& positional : program.positionals)
    page += fmt::format(" [\\fI{}\\fR]", escaped(positional.names.front()));
  page += fmt::format("\n.SH DESCRIPTION\n{}\n", escaped(program.description));
  add_options("ARGUMENTS", program.positionals, page);
  add_options("OPTIONS", program.options, page);
  add_footer(program.footer, page);
  page +=
      ".SH FILES\n.TP\n\\fI~/.cache/quincunx\\fR\nCompiled kernels. The environment variable\n"
      "\\fBQUINCUNX_CACHE_DIR\\fR names another folder, or none if it is empty.\n";
  return page + fmt::format(".SH SEE ALSO\n{}\n", see_also(program.name));
}

std::optional<std::string> manual(const ProgramText& program, const std::string& form) {
  if (form == "man") return man_page(program);
  if (form == "bash") return bash_completion(program);
  if (form == "zsh") return zsh_completion(program);
  if (form == "fish") return fish_completion(program);
  return std::nullopt;
}

std::string bash_completion(const ProgramText& program) {
  const std::string function = function_name(program.name);
  std::string cases;
  std::vector<std::string> names;
  for (const OptionText& option : program.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
    if (option.kind != ValueKind::kWord) continue;
    cases += bash_case(fmt::format("{}", fmt::join(option.names, "|")),
                       fmt::format("COMPREPLY=($(compgen -W {} -- \"$cur\"))\n"
                                   "      declare -F __ltrim_colon_completions >/dev/null && "
                                   "__ltrim_colon_completions \"$cur\"",
                                   quoted(fmt::format("{}", fmt::join(option.words, " ")))));
  }
  cases += bash_case(pattern_of(program, ValueKind::kFile),
                     "compopt -o filenames 2>/dev/null\n      COMPREPLY=($(compgen -f -- \"$cur\"))");
  cases += bash_case(pattern_of(program, ValueKind::kFolder),
                     "compopt -o filenames 2>/dev/null\n      COMPREPLY=($(compgen -d -- \"$cur\"))");
  cases += bash_case(pattern_of(program, ValueKind::kAny), "COMPREPLY=()");
  return fmt::format(
      "# bash completion for {0}; made by {0} --manual bash\n"
      "{1}() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  if declare -F _get_comp_words_by_ref >/dev/null; then\n"
      "    _get_comp_words_by_ref -n : cur prev\n"
      "  fi\n"
      "  case $prev in\n{2}  esac\n"
      "  if [[ $cur == -* ]]; then\n"
      "    COMPREPLY=($(compgen -W {3} -- \"$cur\"))\n"
      "  else\n"
      "    compopt -o filenames 2>/dev/null\n"
      "    COMPREPLY=($(compgen -f -- \"$cur\"))\n"
      "  fi\n"
      "}}\n"
      "complete -F {1} {0}\n",
      program.name, function, cases, quoted(fmt::format("{}", fmt::join(names, " "))));
}

std::string zsh_completion(const ProgramText& program) {
  std::string text = fmt::format("#compdef {0}\n# made by {0} --manual zsh\n_arguments -s", program.name);
  for (const OptionText& option : program.options)
    text += " \\\n  " + zsh_option(option);
  if (!program.positionals.empty()) text += " \\\n  '*:file:_files'";
  return text + "\n";
}

std::string fish_completion(const ProgramText& program) {
  std::string text = fmt::format("# made by {} --manual fish\n", program.name);
  for (const OptionText& option : program.options) {
    text += "complete -c " + program.name;
    for (const std::string& name : option.names)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.kind == ValueKind::kFile) text += " -r -F";
    if (option.kind == ValueKind::kFolder) text += " -x -a '(__fish_complete_directories)'";
    if (option.kind == ValueKind::kAny) text += " -x";
    if (option.kind == ValueKind::kWord) text += fmt::format(" -x -a '{}'", fmt::join(option.words, " "));
    text += fmt::format(" -d '{}'\n", replaced(replaced(option.description, "\\", "\\\\"), "'", "\\'"));
  }
  return text;
}

}  // namespace quincunx::tools
