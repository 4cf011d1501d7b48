// SPDX-License-Identifier: MIT
// CommandLine: the options of a program, each of them one row of a table. Help, completions, checks and messages all
// follow from the rows. CLI11 tells options from values, behind this header: including it takes seconds.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "tools/program/lower_case.h"

namespace quincunx::tools {

// Thrown by a check. `option` is the name of the one that is wrong, `reason` says why.
struct UsageError {
  std::string option;
  std::string reason;
};

// How the text behind an option is read, and where it goes. The functions below make them.
struct Setting {
  std::string value = {};  // what help calls the text: "N", "FILE"; empty: a flag
  // Takes one text, an empty one of a flag. Returns what is wrong with it in one sentence; empty when nothing is.
  std::function<std::string(const std::string& text)> take = {};
  std::string usual = {};               // the default; empty: the row's help has it, where there is one
  std::vector<std::string> words = {};  // every text that is taken; empty: others are, too
  bool list = false;                    // several texts with commas between, or several times
};

struct Bounds {
  double least = std::numeric_limits<double>::lowest();
  double most = std::numeric_limits<double>::max();
  bool beyond = false;  // `least` itself is out of bounds
};
inline constexpr Bounds kPositive = {.least = 0, .beyond = true};
inline constexpr Bounds kFromZero = {.least = 0};
inline constexpr Bounds kPartOfOne = {.least = 0, .most = 1};

// An option. Each method adds to the row and returns it.
struct Row {
  // --help lists it, not only --help-all.
  Row& common() {
    is_common = true;
    return *this;
  }
  // It may be given more than once.
  Row& repeats() {
    may_repeat = true;
    return *this;
  }
  // Where it is given nothing is written.
  Row& tells() {
    only_tells = true;
    return *this;
  }
  // Its text is a path to write, which is tried before any work.
  Row& writes() {
    is_written = true;
    return *this;
  }
  // One of these must be given as well.
  Row& needs(std::vector<std::string> others) {
    needed = std::move(others);
    return *this;
  }
  // None of these options and groups may be given as well. `why` ends the sentence.
  Row& excludes(std::vector<std::string> others, std::string why = "leave one of them out") {
    excluded.push_back({std::move(others), std::move(why)});
    return *this;
  }
  // It does nothing unless `condition`, asked when all options are read. `with` names what it goes with.
  Row& counts_if(std::function<bool()> condition, std::string with) {
    counts = std::move(condition);
    counts_with = std::move(with);
    return *this;
  }

  struct Exclusion {
    std::vector<std::string> others;
    std::string why;
  };
  std::vector<std::string> names;  // {"-n", "--dry-run"}; of a positional one {"INPUT"}
  Setting setting;
  std::string help;
  std::string group;
  bool is_common = false, may_repeat = false, only_tells = false, is_written = false;
  std::vector<std::string> needed = {};
  std::vector<Exclusion> excluded = {};
  std::function<bool()> counts = {};
  std::string counts_with = {};
};

class CommandLine {
 public:
  // `examples` end the help.
  CommandLine(std::string description, std::string program, std::string version, std::string examples);

  // Begins a group of the help, or goes on with it. "Help" is listed last, and has rows of its own.
  void group(const std::string& name) { group_ = name; }
  // Adds an option to that group. `names`: "-n,--dry-run"; of a positional one "INPUT". The row is good until the next.
  Row& add(const std::string& names, Setting setting, std::string help);
  // Called after the last option is read, in turn; may throw UsageError.
  void check(std::function<void(const CommandLine& line)> check) { checks_.push_back(std::move(check)); }

  bool has(const std::string& name) const;  // the user gave it
  // Throws UsageError for the first option of `names`, options or groups, that the user gave.
  void refuse(std::initializer_list<const char*> names, const std::string& why) const;

  // On --help, --version, --completion or an error, prints and returns the program's exit code.
  std::optional<int> parse(int argc, const char* const* argv);

  const std::deque<Row>& rows() const { return rows_; }
  std::string help(
      const std::string& group) const;  // "": the common options; "all"; or a group, in lower case
  std::string completion(const std::string& shell) const;  // "bash", "zsh" or "fish"

 private:
  std::vector<std::string> groups() const;
  void read_words(int argc, const char* const* argv);
  void refuse_unknown(const std::vector<std::string>& words) const;
  bool answer() const;
  void take_texts(const Row& row) const;
  void check_beside_others(const Row& row) const;
  void try_paths() const;

  std::string description_, program_, version_, examples_;
  std::deque<Row> rows_;
  std::vector<std::function<void(const CommandLine&)>> checks_;
  std::string group_;
  std::map<const Row*, std::vector<std::string>> texts_;  // of the rows that were given
};

// Returns the text as a number; nothing where it is none.
std::optional<double> number_in(const std::string& text);

// Returns "; did you mean 'NAME'?" with the name that is most like `word`; empty where none is alike.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names);

// Returns "'WORD' is none of A, B", with the nearest name.
std::string none_of(const std::string& word, const std::vector<std::string>& names);

namespace detail {

template <typename Type>
struct Inner {
  using Value = Type;
};
template <typename Type>
struct Inner<std::optional<Type>> {
  using Value = Type;
};
template <typename Type>
struct Inner<std::vector<Type>> {
  using Value = Type;
};
template <typename Target>
constexpr bool kIsList = std::is_same_v<Target, std::vector<typename Inner<Target>::Value>>;

std::string number_text(double number);
std::string read_number(const std::string& text, const Bounds& bounds, bool whole, long double& number);

// Returns a function that stores values: the first one of a list replaces the default.
template <typename Target>
auto store_in(Target& target) {
  if constexpr (kIsList<Target>) {
    return [&target, first = true](typename Inner<Target>::Value value) mutable {
      if (std::exchange(first, false)) target.clear();
      target.push_back(std::move(value));
    };
  } else {
    return [&target](typename Inner<Target>::Value value) { target = std::move(value); };
  }
}

}  // namespace detail

// The following make settings. A target must outlive the parsing and holds the default; an optional one has none, and
// a vector takes a list.

Setting flag(bool& target, bool to = true);
Setting count(int& times);
Setting call(std::function<void()> set);
Setting extent(Extent& target);
Setting extent(std::optional<Extent>& target);

// `take` returns what is wrong with a text, in one sentence.
inline Setting text(std::string value, std::function<std::string(const std::string&)> take) {
  return {.value = std::move(value), .take = std::move(take)};
}

template <typename Target>
Setting text(Target& target, std::string value) {
  return {.value = std::move(value),
          .take =
              [store = detail::store_in(target)](const std::string& words) mutable {
                store(words);
                return std::string(words.empty() ? "the text is empty" : "");
              },
          .list = detail::kIsList<Target>};
}

template <typename Target>
Setting number(Target& target, Bounds bounds = {}, std::string value = "N") {
  using Number = typename detail::Inner<Target>::Value;
  bounds.least = std::max(bounds.least, static_cast<double>(std::numeric_limits<Number>::lowest()));
  bounds.most = std::min(bounds.most, static_cast<double>(std::numeric_limits<Number>::max()));
  Setting setting = {.value = std::move(value), .list = detail::kIsList<Target>};
  setting.take = [bounds, store = detail::store_in(target)](const std::string& words) mutable {
    long double number = 0;
    std::string wrong = detail::read_number(words, bounds, std::is_integral_v<Number>, number);
    if (wrong.empty()) store(static_cast<Number>(number));
    return wrong;
  };
  if constexpr (detail::kIsList<Target>) {
    for (const Number each : target)
      setting.usual += (setting.usual.empty() ? "" : ",") + detail::number_text(static_cast<double>(each));
  } else if constexpr (std::is_same_v<Target, Number>) {
    if (target > 0) setting.usual = detail::number_text(static_cast<double>(target));
  }
  return setting;
}

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

// One of a few names, whatever the case of its letters; set() gets the name's value.
template <typename Value, typename Set>
Setting choice(const std::map<std::string, Value>& names, Set set) {
  Setting setting = {.value = "NAME"};
  for (const auto& [name, value] : names)
    setting.words.push_back(name);
  setting.take = [set, names, words = setting.words](const std::string& text) {
    const auto found = names.find(in_lower_case(text));
    if (found == names.end()) return none_of(text, words);
    set(found->second);
    return std::string();
  };
  return setting;
}

template <typename Target>
Setting choice(Target& target, const std::map<std::string, typename detail::Inner<Target>::Value>& names =
                                   choices<typename detail::Inner<Target>::Value>()) {
  Setting setting = choice(names, [&target](auto value) { target = value; });
  for (const auto& [name, value] : names) {
    if (value == target) setting.usual = name;
  }
  return setting;
}

}  // namespace quincunx::tools
