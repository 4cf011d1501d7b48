// SPDX-License-Identifier: MIT
// This file is the only one that includes CLI11.
#include "tools/program/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "tools/program/atomic_file.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/program.h"

namespace quincunx::tools {
namespace {

constexpr const char* kAll = "all";

const std::string& name_of(const Row& row) {
  return row.names.front().starts_with("--") ? row.names.front() : row.names.back();
}

bool is_named(const Row& row, const std::string& name) {
  return std::find(row.names.begin(), row.names.end(), name) != row.names.end();
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts = {""};
  for (const char letter : text) {
    if (letter == ',') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

// Damerau's distance: letters to change, add, leave out or swap with their neighbour.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      cost[i][j] = i + j;
      if (i == 0 || j == 0) continue;
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1,
                             cost[i - 1][j - 1] + static_cast<std::size_t>(a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

std::string text_of(const Bounds& bounds, bool whole) {
  const std::string kind = whole ? "whole number" : "number";
  const bool endless = bounds.most >= std::numeric_limits<int>::max();
  if (bounds.least == 0 && endless) return bounds.beyond ? "positive number" : kind + " from 0 on";
  if (bounds.least <= std::numeric_limits<int>::lowest() && endless) return kind;
  return fmt::format("{} {} {:g} to {:g}", kind, bounds.beyond ? "above" : "from", bounds.least, bounds.most);
}

// The file that is written for a text of this kind.
std::filesystem::path path_to_try(const std::string& kind, const std::string& text) {
  if (kind == "FOLDER") return std::filesystem::path(text) / "file";
  if (kind == "BASE") return text.ends_with('/') ? text : text + ".json";
  if (kind != "PATTERN") return text;
  const auto pattern = FramePattern::parse(text);
  return pattern.ok() ? pattern->expand(0) : text;
}

// Thrown where a path cannot be written.
struct Unwritable {
  std::string message;
};

}  // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t far = distance(in_lower_case(word), in_lower_case(name));
    if (far < least) {
      least = far;
      nearest = name;
    }
  }
  for (const std::string& name : names) {
    if (nearest.empty() && word.size() > 2 && name.starts_with(word)) nearest = name;
  }
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

std::string none_of(const std::string& word, const std::vector<std::string>& names) {
  return fmt::format("'{}' is none of {}{}", word, fmt::join(names, ", "), did_you_mean(word, names));
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  return read.ec == std::errc() && read.ptr == end ? std::optional(value) : std::nullopt;
}

namespace detail {

std::string number_text(double number) {
  return fmt::format("{:g}", number);
}

std::string read_number(const std::string& text, const Bounds& bounds, bool whole, long double& number) {
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, number);
  const bool good = read.ec == std::errc() && read.ptr == end && std::isfinite(number) &&
                    number <= bounds.most &&
                    (bounds.beyond ? number > bounds.least : number >= bounds.least) &&
                    (!whole || number == std::floor(number));
  return good ? "" : fmt::format("'{}' is no {}", text, text_of(bounds, whole));
}

}  // namespace detail

Setting flag(bool& target, bool to) {
  return call([&target, to] { target = to; });
}
Setting count(int& times) {
  return call([&times] { ++times; });
}
Setting call(std::function<void()> set) {
  return {.take = [set = std::move(set)](const std::string&) { return set(), std::string(); }};
}
Setting extent(Extent& target) {
  Setting setting = text("WxH", [&target](const std::string& size) { return parse_extent(size, target); });
  if (target != Extent{}) setting.usual = fmt::format("{}x{}", target.width, target.height);
  return setting;
}
Setting extent(std::optional<Extent>& target) {
  return text("WxH", [&target](const std::string& size) {
    Extent read;
    std::string wrong = parse_extent(size, read);
    if (wrong.empty()) target = read;
    return wrong;
  });
}

CommandLine::CommandLine(std::string description, std::string program, std::string version,
                         std::string examples)
    : description_(std::move(description)),
      program_(std::move(program)),
      version_(std::move(version)),
      examples_(std::move(examples)) {
  Setting shell = {.value = "SHELL"};
  shell.words = {"bash", "zsh", "fish"};
  group("Help");
  add("-h,--help", Setting{.value = "[GROUP]"}, "Print the main options, or those of a group").common();
  add("--help-all", call([] {}), "Print every option").common();
  add("--completion", shell, "Print the completions for a shell");
  add("--version", call([] {}), "Print name and version");
}

Row& CommandLine::add(const std::string& names, Setting setting, std::string help) {
  Row& row = rows_.emplace_back();
  row.names = split(names);
  row.setting = std::move(setting);
  row.help = std::move(help);
  row.group = group_;
  return row;
}

std::vector<std::string> CommandLine::groups() const {
  std::vector<std::string> all;
  for (const Row& row : rows_) {
    if (std::find(all.begin(), all.end(), row.group) == all.end()) all.push_back(row.group);
  }
  std::rotate(all.begin(), all.begin() + 1, all.end());  // the first is "Help"
  return all;
}

// By one of its names, or that of its group.
bool CommandLine::has(const std::string& name) const {
  return std::any_of(rows_.begin(), rows_.end(), [&](const Row& row) {
    return (row.group == name || is_named(row, name)) && texts_.contains(&row);
  });
}

void CommandLine::refuse(std::initializer_list<const char*> names, const std::string& why) const {
  for (const char* name : names) {
    for (const Row& row : rows_) {
      if ((row.group == name || is_named(row, name)) && texts_.contains(&row))
        throw UsageError{name_of(row), why};
    }
  }
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    read_words(argc, argv);
    if (answer()) return kDone;
    for (const Row& row : rows_)
      take_texts(row);
    for (const Row& row : rows_)
      check_beside_others(row);
    for (const auto& check : checks_)
      check(*this);
    try_paths();
  } catch (const UsageError& error) {
    fmt::print(stderr, "error: {}{}{}\n", error.option, error.option.empty() ? "" : ": ",
               printable(error.reason));
    return kUsage;
  } catch (const Unwritable& error) {
    fmt::print(stderr, "error: {}\n", printable(error.message));
    return kFailed;
  }
  return std::nullopt;
}

// Sorts the words into texts_.
void CommandLine::read_words(int argc, const char* const* argv) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  for (const Row& row : rows_) {
    if (row.setting.value.empty()) {
      app.add_flag(fmt::format("{}", fmt::join(row.names, ",")));
    } else {
      app.add_option(fmt::format("{}", fmt::join(row.names, ",")))
          ->expected(is_named(row, "--help") ? 0 : 1, 1)
          ->allow_extra_args(row.setting.list)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string what = error.what();
    const std::string name = what.substr(0, what.find_first_of(": "));
    if (what.find("missing") != std::string::npos || what.find("required") != std::string::npos)
      throw UsageError{name, "its value is missing"};
    throw UsageError{name, "it takes no value"};
  }
  texts_.clear();
  for (const Row& row : rows_) {
    const CLI::Option* option = app.get_option(row.names.back());
    if (option->count() > 0) texts_[&row] = option->results();
  }
  if (!has("--help") && !has("--help-all")) refuse_unknown(app.remaining());
}

void CommandLine::refuse_unknown(const std::vector<std::string>& words) const {
  std::vector<std::string> known;
  const Row* positional = nullptr;
  for (const Row& row : rows_) {
    if (row.names.front().starts_with('-')) {
      known.insert(known.end(), row.names.begin(), row.names.end());
    } else {
      positional = &row;
    }
  }
  for (const std::string& word : words) {
    if (!word.starts_with('-') || word == "-") continue;
    const std::string name = word.substr(0, word.find('='));
    const std::string meant = did_you_mean(name, known);
    throw UsageError{"", fmt::format("unknown option '{}'{}", name,
                                     meant.empty() ? "; --help-all lists those that there are" : meant)};
  }
  if (words.empty()) return;
  if (positional == nullptr)
    throw UsageError{"", fmt::format("'{}' belongs to no option; name the one before it", words.front())};
  const auto texts = texts_.find(positional);
  throw UsageError{"", fmt::format("'{}' is a second {} beside '{}'; give one, in quotes if it has a * or ?",
                                   words.front(), positional->names.front(),
                                   texts == texts_.end() ? "" : texts->second.front())};
}

// Prints what a row of the group "Help" asks for. Returns whether there was one.
bool CommandLine::answer() const {
  if (has("--help-all")) {
    fmt::print("{}", help(kAll));
    return true;
  }
  if (has("--version")) {
    fmt::print("{} {}\n", program_, version_);
    return true;
  }
  const auto answer_with = [&](const char* option, const std::vector<std::string>& words,
                               const auto& text_for) {
    const auto row =
        std::find_if(rows_.begin(), rows_.end(), [&](const Row& each) { return is_named(each, option); });
    const auto texts = texts_.find(&*row);
    if (texts == texts_.end()) return false;
    std::string word = texts->second.empty() ? "" : in_lower_case(texts->second.back());
    if (word == "true" || word == "{}") word.clear();  // stands for no value, by CLI11's version
    if (!word.empty() && std::find(words.begin(), words.end(), word) == words.end())
      throw UsageError{option, none_of(word, words)};
    fmt::print("{}", text_for(word));
    return true;
  };
  std::vector<std::string> names = {kAll};
  for (const std::string& group : groups())
    names.push_back(in_lower_case(group));
  return answer_with("--help", names, [&](const std::string& group) { return help(group); }) ||
         answer_with("--completion", {"bash", "zsh", "fish"},
                     [&](const std::string& shell) { return completion(shell); });
}

void CommandLine::take_texts(const Row& row) const {
  const auto given = texts_.find(&row);
  if (given == texts_.end()) return;
  const Setting& setting = row.setting;
  const std::string name = name_of(row);
  if (given->second.size() > 1 && !setting.list && !row.may_repeat)
    throw UsageError{name, fmt::format("it is given {} times; give it once", given->second.size())};
  for (const std::string& whole : given->second) {
    if (setting.value.empty() && whole != "true") throw UsageError{name, "it takes no value"};
    for (const Row& other : rows_) {
      if (whole.starts_with("--") && is_named(other, whole))
        throw UsageError{name, fmt::format("its value is missing; '{}' is an option", whole)};
    }
    for (const std::string& part : setting.list ? split(whole) : std::vector<std::string>{whole}) {
      if (const std::string wrong = setting.take(part); !wrong.empty()) throw UsageError{name, wrong};
    }
  }
}

void CommandLine::check_beside_others(const Row& row) const {
  if (!texts_.contains(&row)) return;
  const std::string name = name_of(row);
  const bool needs_met =
      row.needed.empty() ||
      std::any_of(row.needed.begin(), row.needed.end(), [&](const std::string& other) { return has(other); });
  if (!needs_met) throw UsageError{name, fmt::format("it needs {}", fmt::join(row.needed, " or "))};
  for (const Row::Exclusion& exclusion : row.excluded) {
    for (const Row& other : rows_) {
      const bool excluded = std::any_of(
          exclusion.others.begin(), exclusion.others.end(),
          [&](const std::string& listed) { return listed == other.group || is_named(other, listed); });
      if (!excluded || &other == &row || !texts_.contains(&other)) continue;
      throw UsageError{name_of(other), fmt::format("{} excludes it; {}", name, exclusion.why)};
    }
  }
  if (row.counts && !row.counts())
    throw UsageError{name, fmt::format("it does nothing here; it goes with {}", row.counts_with)};
}

// Tries every path that is to be written, so that none is found wrong after the work.
void CommandLine::try_paths() const {
  std::map<std::string, std::string> options;  // by path
  for (const Row& row : rows_) {
    if (row.only_tells && texts_.contains(&row)) return;
  }
  for (const Row& row : rows_) {
    const auto given = texts_.find(&row);
    if (!row.is_written || given == texts_.end()) continue;
    const std::string& text = given->second.front();
    const auto [other, is_new] = options.emplace(text, name_of(row));
    if (!is_new)
      throw UsageError{name_of(row), fmt::format("'{}' is what {} writes, too", text, other->second)};
    const Status status = try_to_write(path_to_try(row.setting.value, text));
    if (!status.ok()) throw Unwritable{fmt::format("{}: {}", name_of(row), status.message())};
  }
}

}  // namespace quincunx::tools
