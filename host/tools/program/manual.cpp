// SPDX-License-Identifier: MIT
#include "tools/program/manual.h"

#include <fmt/format.h>

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

}  // namespace quincunx::tools
