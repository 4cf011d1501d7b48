// SPDX-License-Identifier: MIT
// The options of quincunx-resolve that words of a command line set.
#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tools/sequence/resolve_task.h"

namespace quincunx::testing {

inline tools::ResolveOptions parsed_options(const std::string& words) {
  std::vector<std::string> given = {"quincunx-resolve", "f.%04d.exr", "-n"};
  std::istringstream stream(words);
  for (std::string word; stream >> word;)
    given.push_back(word);
  std::vector<char*> argv;
  for (std::string& word : given)
    argv.push_back(word.data());
  tools::ResolveOptions options;
  EXPECT_FALSE(tools::parse_command_line(static_cast<int>(argv.size()), argv.data(), options)) << words;
  return options;
}

}  // namespace quincunx::testing
