// SPDX-License-Identifier: MIT
// CommandLine: the options of a program. CLI11 does the work, behind this header, because every file that
// includes CLI11 takes seconds to compile.
#pragma once

#include <algorithm>
#include <cctype>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/program/manual.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace quincunx::tools {

// Thrown by a function that reads an option's text: what is wrong with it. `option` is its name.
struct UsageError {
  std::string option;
  std::string reason;
};

// A function that tells what is wrong with a text, in one sentence; empty when nothing is.
using Complaint = std::function<std::string(const std::string& text)>;

// A view of one option of a CommandLine, which must outlive it.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option check(Complaint complaint) const;
  Option in_range(int lowest, int highest) const;
  Option in_range(double lowest, double highest) const;
  Option positive() const;
  Option non_negative() const;
  Option one_of(std::initializer_list<int> values) const;

  Option type_name(const std::string& name) const;  // what --help calls its value
  Option show_default() const;                      // --help tells the target's present value
  Option delimiter(char separator) const;           // between a list's values in one word
  Option expected(int fewest, int most) const;      // how many values it takes

  Option needs(const Option& other) const;
  Option needs(const std::string& other) const;
  Option excludes(const Option& other) const;
  Option excludes(const std::string& other) const;

 private:
  CLI::Option* option_;
};

class CommandLine {
 public:
  // `examples` end the help. An empty `version` leaves --version out, and --manual, which help does not list: it
  // prints the manual page or a shell's completion.
  CommandLine(const std::string& description, const std::string& program, const std::string& version,
              const std::string& examples);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // Target: std::string, int, 64-bit integers, float, double, or a vector of these. It must outlive parse().
  template <typename Target>
  Option add_option(const std::string& names, Target& target, const std::string& description);

  // Value: std::string, int, float or a vector of strings. `set` may throw UsageError.
  template <typename Value>
  Option add_option_function(const std::string& names, std::function<void(const Value&)> set,
                             const std::string& description);

  // A name that begins with "!" sets the target to false.
  Option add_flag(const std::string& names, bool& target, const std::string& description);
  Option add_flag(const std::string& names, int& count, const std::string& description);
  Option add_flag_callback(const std::string& names, std::function<void()> set,
                           const std::string& description);

  // Words that shells offer for an option's value; `name` is its first long one.
  void offer(const std::string& name, std::vector<std::string> words) { words_[name] = std::move(words); }

  Option option(const std::string& name) const;  // that was added before
  bool has(const std::string& name) const;       // the user gave it
  void when_read(std::function<void()> check);   // after the last option, in turn; may throw UsageError

  // On --help, --version or a usage error, prints and gives the program's exit code. `check` comes after all
  // else and may throw UsageError.
  std::optional<int> parse(int argc, const char* const* argv, const std::function<void()>& check = {});

  ProgramText text() const;  // what --help lists

 private:
  void print_manual(const std::string& form) const;

  std::unique_ptr<CLI::App> app_;
  std::vector<std::function<void()>> checks_;  // the checks of when_read()
  std::string version_;
  std::map<std::string, std::vector<std::string>> words_;
};

// The text as a number, as options read them; nothing where it is none.
std::optional<double> number_in(const std::string& text);

// The values of an enum by their names. They count from 0, and name_of() says "unknown" of the first number beyond.
template <typename Enum>
const std::map<std::string, Enum>& choices() {
  static const auto by_name = [] {
    std::map<std::string, Enum> all;
    for (int i = 0; name_of(static_cast<Enum>(i)) != std::string("unknown"); ++i)
      all[name_of(static_cast<Enum>(i))] = static_cast<Enum>(i);
    return all;
  }();
  return by_name;
}

// An option that takes one of a few names, whatever the case of its letters; set() gets the name's value.
// `names` must outlive the parsing.
template <typename Value, typename Set>
void add_choice(CommandLine& line, const std::string& option, const std::map<std::string, Value>& names,
                const std::string& description, Set set) {
  const auto choose = [option, set, &names](const std::string& name) {
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    const auto found = names.find(lower);
    if (found == names.end()) {
      std::string choices;
      for (const auto& [choice, value] : names)
        choices += (choices.empty() ? "" : ", ") + choice;
      throw UsageError{option, "'" + name + "' is none of " + choices};
    }
    set(found->second);
  };
  line.add_option_function<std::string>(option, choose, description).type_name("NAME");
  std::vector<std::string> words;
  for (const auto& [choice, value] : names)
    words.push_back(choice);
  line.offer(option, std::move(words));
}

template <typename Target, typename Value>
void add_choice(CommandLine& line, const std::string& option, Target& target,
                const std::map<std::string, Value>& names, const std::string& description) {
  add_choice(line, option, names, description, [&target](const Value& value) { target = value; });
}

}  // namespace quincunx::tools
