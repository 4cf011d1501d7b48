// SPDX-License-Identifier: MIT
// What CommandLine prints of its rows: the help, which help2man turns into the manual page, and the completions.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

constexpr std::size_t kHelpColumns = 100;
constexpr std::size_t kHelpIndent = 28;  // of the options' descriptions

bool is_positional(const Row& row) {
  return !row.names.front().starts_with('-');
}

// "a, b or c".
std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

std::string description_of(const Row& row) {
  std::string text = row.help;
  const Setting& setting = row.setting;
  if (!setting.words.empty() && text.find(setting.words.front()) == std::string::npos)
    text += ": " + alternatives(setting.words);
  if (!setting.usual.empty() && text.find("(default") == std::string::npos)
    text += fmt::format(" (default: {})", setting.usual);
  return text;
}

// Breaks words into lines of at most kHelpColumns; the first begins at `column`, the others behind `indent` spaces.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t column) {
  std::string lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kHelpColumns) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines + "\n";
}

std::string lines_of(const Row& row) {
  std::string head = fmt::format("  {}", fmt::join(row.names, ", "));
  if (!is_positional(row) && !row.setting.value.empty()) head += " " + row.setting.value;
  if (head.size() + 2 > kHelpIndent) {
    head += "\n" + std::string(kHelpIndent, ' ');
  } else {
    head.resize(kHelpIndent, ' ');
  }
  return head + wrapped(description_of(row), kHelpIndent, kHelpIndent);
}

enum class ValueKind { kNone, kAny, kWord, kFile, kFolder };

ValueKind kind_of(const Setting& setting) {
  if (setting.value.empty()) return ValueKind::kNone;
  if (!setting.words.empty()) return ValueKind::kWord;
  const auto has = [&](const char* part) { return setting.value.find(part) != std::string::npos; };
  if (has("FOLDER")) return ValueKind::kFolder;
  return has("FILE") || has("PATTERN") || has("BASE") || has(".json") ? ValueKind::kFile : ValueKind::kAny;
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

std::string spaced(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

std::string bash_completion(const std::string& program, const std::deque<Row>& rows) {
  std::vector<std::string> all;
  std::string cases;
  for (const Row& row : rows) {
    if (is_positional(row)) continue;
    all.insert(all.end(), row.names.begin(), row.names.end());
    std::string action = "COMPREPLY=()";
    switch (kind_of(row.setting)) {
      case ValueKind::kNone:
        continue;
      case ValueKind::kAny:
        break;
      case ValueKind::kWord:
        action = fmt::format(
            "COMPREPLY=($(compgen -W {} -- \"$cur\"))\n"
            "      declare -F __ltrim_colon_completions >/dev/null && __ltrim_colon_completions \"$cur\"",
            quoted(spaced(row.setting.words)));
        break;
      case ValueKind::kFile:
        action = "compopt -o filenames 2>/dev/null\n      COMPREPLY=($(compgen -f -- \"$cur\"))";
        break;
      case ValueKind::kFolder:
        action = "compopt -o filenames 2>/dev/null\n      COMPREPLY=($(compgen -d -- \"$cur\"))";
        break;
    }
    cases += fmt::format("    {})\n      {}\n      return\n      ;;\n", fmt::join(row.names, "|"), action);
  }
  return fmt::format(
      "# bash completion for {0}; made by {0} --completion bash\n"
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
      program, "_" + replaced(program, "-", "_"), cases, quoted(spaced(all)));
}

std::string zsh_completion(const std::string& program, const std::deque<Row>& rows) {
  std::string text = fmt::format("#compdef {0}\n# made by {0} --completion zsh\n_arguments -s", program);
  std::string end;
  for (const Row& row : rows) {
    if (is_positional(row)) {
      end = " \\\n  '*:file:_files'";
      continue;
    }
    std::string rest = replaced(description_of(row), "\\", "\\\\");
    for (const char* special : {"[", "]", ":"})
      rest = replaced(rest, special, std::string("\\") + special);
    const char* const values[] = {"", ":value: ", ":value:({})", ":file:_files", ":folder:_files -/"};
    rest = quoted("[" + rest + "]" +
                  replaced(values[static_cast<int>(kind_of(row.setting))], "{}",
                           replaced(spaced(row.setting.words), ":", "\\:")));
    text += " \\\n  ";
    text += row.names.size() == 1
                ? row.names.front() + rest
                : fmt::format("'({})'{{{}}}{}", spaced(row.names), fmt::join(row.names, ","), rest);
  }
  return text + end + "\n";
}

std::string fish_completion(const std::string& program, const std::deque<Row>& rows) {
  std::string text = fmt::format("# made by {} --completion fish\n", program);
  for (const Row& row : rows) {
    if (is_positional(row)) continue;
    text += "complete -c " + program;
    for (const std::string& name : row.names)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    const char* const values[] = {"", " -x", " -x -a '{}'", " -r -F",
                                  " -x -a '(__fish_complete_directories)'"};
    text += replaced(values[static_cast<int>(kind_of(row.setting))], "{}", spaced(row.setting.words));
    text += fmt::format(" -d '{}'\n", replaced(replaced(description_of(row), "\\", "\\\\"), "'", "\\'"));
  }
  return text;
}

}  // namespace

std::string CommandLine::help(const std::string& group) const {
  const bool all = group == "all";
  std::string positional, body;
  for (const Row& row : rows_) {
    if (is_positional(row)) positional = " " + row.names.front();
  }
  for (const std::string& each : groups()) {
    if (all) body += "\n" + each + ":\n";
    for (const Row& row : rows_) {
      const bool listed = all || (group.empty() ? row.is_common : in_lower_case(each) == group);
      if (listed && row.group == each) body += lines_of(row);
    }
  }
  if (!group.empty() && !all) return body;
  std::vector<std::string> names = groups();
  std::transform(names.begin(), names.end(), names.begin(), in_lower_case);
  const std::string more =
      all ? ""
          : wrapped(fmt::format("More: --help-all for every option, --help GROUP for one of {}.",
                                alternatives(names)),
                    0, 0);
  return fmt::format("Usage: {}{} [OPTION]...\n{}{}{}\n{}{}{}", program_, positional,
                     wrapped(description_, 0, 0), all ? "" : "\n", body, examples_,
                     examples_.empty() ? "" : "\n", more);
}

std::string CommandLine::completion(const std::string& shell) const {
  if (shell == "bash") return bash_completion(program_, rows_);
  return shell == "zsh" ? zsh_completion(program_, rows_) : fish_completion(program_, rows_);
}

}  // namespace quincunx::tools
