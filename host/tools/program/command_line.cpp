// SPDX-License-Identifier: MIT
// This file is the only one that includes CLI11.
#include "tools/program/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "tools/program/manual.h"
#include "tools/program/program.h"

namespace quincunx::tools {
namespace {

// Passes on what callers throw, in the type that CLI11 reports.
template <typename Call>
void report_usage_errors(const Call& call) {
  try {
    call();
  } catch (const UsageError& error) {
    throw CLI::ValidationError(error.option, error.reason);
  }
}

// CLI11's own checks print the largest double, which has 309 digits.
Complaint unless_number(const char* kind, bool (*good)(double)) {
  return [kind, good](const std::string& text) {
    const std::optional<double> number = number_in(text);
    if (number && std::isfinite(*number) && good(*number)) return std::string();
    return fmt::format("'{}' is no {}", text, kind);
  };
}

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

Option Option::check(Complaint complaint) const {
  return Option(option_->check(std::move(complaint)));
}
Option Option::in_range(int lowest, int highest) const {
  return Option(option_->check(CLI::Range(lowest, highest)));
}
Option Option::in_range(double lowest, double highest) const {
  return Option(option_->check(CLI::Range(lowest, highest)));
}
Option Option::positive() const {
  return Option(
      option_->check(unless_number("positive number", [](double number) { return number > 0; }), "POSITIVE"));
}
Option Option::non_negative() const {
  return Option(option_->check(unless_number("number from 0 on", [](double number) { return number >= 0; }),
                               "NONNEGATIVE"));
}
Option Option::one_of(std::initializer_list<int> values) const {
  return Option(option_->check(CLI::IsMember(std::set<int>(values)).description("")));
}

Option Option::type_name(const std::string& name) const {
  return Option(option_->type_name(name));
}
Option Option::show_default() const {
  return Option(option_->capture_default_str());
}
Option Option::delimiter(char separator) const {
  return Option(option_->delimiter(separator));
}
Option Option::expected(int fewest, int most) const {
  return Option(option_->expected(fewest, most));
}

Option Option::needs(const Option& other) const {
  return Option(option_->needs(other.option_));
}
Option Option::needs(const std::string& other) const {
  return Option(option_->needs(other));
}
Option Option::excludes(const Option& other) const {
  return Option(option_->excludes(other.option_));
}
Option Option::excludes(const std::string& other) const {
  return Option(option_->excludes(other));
}

CommandLine::CommandLine(const std::string& description, const std::string& program,
                         const std::string& version, const std::string& examples)
    : app_(std::make_unique<CLI::App>(description, program)), version_(version) {
  app_->footer(examples);
  if (!version.empty()) {
    app_->set_version_flag("--version", program + " " + version);
    app_->add_option_function<std::string>("--manual",
                                           [this](const std::string& form) { print_manual(form); })
        ->group("");
  }
  app_->get_formatter()->column_width(30);
}

CommandLine::~CommandLine() = default;

void CommandLine::print_manual(const std::string& form) const {
  const std::optional<std::string> printed = manual(text(), form);
  if (!printed) throw CLI::ValidationError("--manual", "'" + form + "' is none of man, bash, zsh, fish");
  fmt::print("{}", *printed);
  throw CLI::Success();
}

template <typename Target>
Option CommandLine::add_option(const std::string& names, Target& target, const std::string& description) {
  return Option(app_->add_option(names, target, description));
}

template <typename Value>
Option CommandLine::add_option_function(const std::string& names, std::function<void(const Value&)> set,
                                        const std::string& description) {
  const auto checked = [set = std::move(set)](const Value& value) {
    report_usage_errors([&] { set(value); });
  };
  return Option(app_->add_option_function<Value>(names, checked, description));
}

Option CommandLine::add_flag(const std::string& names, bool& target, const std::string& description) {
  return Option(app_->add_flag(names, target, description));
}
Option CommandLine::add_flag(const std::string& names, int& count, const std::string& description) {
  return Option(app_->add_flag(names, count, description));
}
Option CommandLine::add_flag_callback(const std::string& names, std::function<void()> set,
                                      const std::string& description) {
  return Option(app_->add_flag_callback(names, std::move(set), description));
}

Option CommandLine::option(const std::string& name) const {
  return Option(app_->get_option(name));
}
bool CommandLine::has(const std::string& name) const {
  return app_->count(name) > 0;
}
void CommandLine::when_read(std::function<void()> check) {
  checks_.push_back(std::move(check));
  app_->parse_complete_callback([this] {
    for (const auto& read : checks_)
      report_usage_errors(read);
  });
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv, const std::function<void()>& check) {
  try {
    app_->parse(argc, argv);
    if (check) report_usage_errors(check);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? kDone : kUsage;
  }
  return std::nullopt;
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  if (!CLI::detail::lexical_cast(text, value)) return std::nullopt;
  return value;
}

template Option CommandLine::add_option(const std::string&, std::string&, const std::string&);
template Option CommandLine::add_option(const std::string&, int&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::int64_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, float&, const std::string&);
template Option CommandLine::add_option(const std::string&, double&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<int>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<std::uint64_t>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<float>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<double>&, const std::string&);

template Option CommandLine::add_option_function<std::string>(const std::string&,
                                                              std::function<void(const std::string&)>,
                                                              const std::string&);
template Option CommandLine::add_option_function<int>(const std::string&, std::function<void(const int&)>,
                                                      const std::string&);
template Option CommandLine::add_option_function<float>(const std::string&, std::function<void(const float&)>,
                                                        const std::string&);
template Option CommandLine::add_option_function<std::vector<std::string>>(
    const std::string&, std::function<void(const std::vector<std::string>&)>, const std::string&);

// Options and arguments of a command line in words, for its manual page and its completions.

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
