// SPDX-License-Identifier: MIT
// Checks of a program's table of options: each pair is accepted or refused in one sentence; the help is readable.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tools/program/command_line.h"
#include "tools/program/program.h"
#include "tools/temporary_folder.h"

namespace quincunx::testing {

// Options: what command_line() of a program takes, beside this header's by argument-dependent lookup.
template <typename Options>
class OptionPairs {
 public:
  // Words without which the program refuses everything; left out where the pair has one of these options.
  struct Base {
    std::vector<std::string> words;
    std::set<std::string> unless;
  };
  explicit OptionPairs(std::vector<Base> base) : base_(std::move(base)) {}

  void expect_each_is_judged() {
    Options options;
    const tools::CommandLine line = command_line(options);
    for (const tools::Row& row : line.rows())
      words_.push_back(words_for(row));
    std::size_t accepted = 0, pairs = 0;
    for (std::size_t a = 0; a < words_.size(); ++a) {
      for (std::size_t b = a + 1; b < words_.size(); ++b) {
        const std::string first = verdict(line, a, b);
        if (pairs % 8 == 0) {
          EXPECT_EQ(first, verdict(line, b, a)) << "the order of two options counts";
        }
        accepted += first.empty() ? 1 : 0;
        ++pairs;
      }
    }
    // Neither everything passes nor nothing does.
    EXPECT_GT(accepted, pairs / 3);
    EXPECT_LT(accepted, pairs);
  }

  static void expect_readable_help() {
    Options options;
    const tools::CommandLine line = command_line(options);
    std::istringstream all(line.help("all"));
    for (std::string text; std::getline(all, text);)
      EXPECT_LE(text.size(), 100u) << text;
    const std::string first = line.help("");
    EXPECT_LE(std::count(first.begin(), first.end(), '\n'), 48) << first;
    EXPECT_TRUE(first.find("Examples:") != std::string::npos) << first;
  }

 private:
  // The option and a value that it takes by itself.
  std::vector<std::string> words_for(const tools::Row& row) const {
    // As messages name it.
    const std::string& name = row.names.front().starts_with("--") ? row.names.front() : row.names.back();
    std::string value = row.setting.words.empty() ? "" : row.setting.words.front();
    const std::string file = folder_.file(name.substr(name.find_first_not_of('-')));
    if (value.empty() && row.setting.take) {
      const std::string& kind = row.setting.value;
      if (kind == "PATTERN") value = file + ".%04d.exr";
      if (kind == "FOLDER" || kind == "BASE") value = file;
      if (kind.ends_with("FILE")) value = file + ".png";
      Options scratch;
      const tools::CommandLine line = command_line(scratch);
      const auto same = std::find_if(line.rows().begin(), line.rows().end(),
                                     [&](const tools::Row& other) { return other.names == row.names; });
      for (const char* text : {"1", "4", "0.5", "0.5,0.5", "64x48", "1GB", "a,b", "auto", "name"}) {
        if (value.empty() && same->setting.take(text).empty()) value = text;
      }
    }
    if (row.setting.value.empty()) return {name};
    if (!name.starts_with('-')) return {value};
    if (row.setting.value == "[GROUP]") return {name, "help"};
    return {name, value};
  }

  // Returns what the program says of both; empty where it accepts them.
  std::string verdict(const tools::CommandLine& line, std::size_t a, std::size_t b) {
    std::vector<std::string> words = {"program"};
    for (const std::size_t row : {a, b})
      add_needed(line, row, a, b, words);
    for (const std::size_t row : {a, b})
      words.insert(words.end(), words_[row].begin(), words_[row].end());
    for (const Base& base : base_) {
      const auto replaces = [&](const std::string& word) { return base.unless.contains(word); };
      bool replaced = std::any_of(words.begin(), words.end(), replaces);
      for (const std::size_t row : {a, b})
        replaced |= std::any_of(line.rows()[row].names.begin(), line.rows()[row].names.end(), replaces);
      if (!replaced) words.insert(words.end(), base.words.begin(), base.words.end());
    }
    std::vector<const char*> arguments;
    for (const std::string& word : words)
      arguments.push_back(word.c_str());
    Options options;
    tools::CommandLine parsed = command_line(options);
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    const auto code = parsed.parse(static_cast<int>(arguments.size()), arguments.data());
    ::testing::internal::GetCapturedStdout();
    const std::string said = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.empty(), !code || *code == tools::kDone) << said;
    EXPECT_NE(code.value_or(tools::kDone), tools::kFailed) << said;
    if (!said.empty()) expect_sentence(said, words);
    return said;
  }

  // What the row needs, unless the pair or the base has it.
  void add_needed(const tools::CommandLine& line, std::size_t row, std::size_t a, std::size_t b,
                  std::vector<std::string>& words) const {
    const auto& needed = line.rows()[row].needed;
    if (needed.empty()) return;
    for (std::size_t other = 0; other < words_.size(); ++other) {
      const auto& names = line.rows()[other].names;
      if (std::find(names.begin(), names.end(), needed.front()) == names.end()) continue;
      if (other == a || other == b ||
          std::find(words.begin(), words.end(), words_[other].front()) != words.end())
        continue;
      add_needed(line, other, a, b, words);
      words.insert(words.end(), words_[other].begin(), words_[other].end());
    }
  }

  // One line that names an option that was given.
  static void expect_sentence(const std::string& said, const std::vector<std::string>& words) {
    EXPECT_TRUE(said.starts_with("error: ")) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_LE(said.size(), 230u) << said;
    EXPECT_TRUE(std::any_of(words.begin(), words.end(),
                            [&](const std::string& word) {
                              return word.starts_with("--") && said.find(word) != std::string::npos;
                            }))
        << fmt::format("{}", fmt::join(words, " ")) << " gives: " << said;
  }

  TemporaryFolder folder_;
  std::vector<Base> base_;
  std::vector<std::vector<std::string>> words_;  // by row
};

}  // namespace quincunx::testing
