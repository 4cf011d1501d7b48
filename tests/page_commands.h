// SPDX-License-Identifier: MIT
// The command lines that README.md and docs show in blocks of code, handed to the parser of their program.
#pragma once

#include <gtest/gtest.h>
#include <wordexp.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace quincunx::testing {

inline std::vector<std::string> command_lines(const std::string& program, const std::filesystem::path& page) {
  std::ifstream file(page);
  std::string text(std::istreambuf_iterator<char>(file), {}), code;
  for (std::size_t begin, end = 0; (begin = text.find("\n```", end)) != std::string::npos;) {
    end = text.find("\n```", begin + 4);
    if (end == std::string::npos) break;
    code += text.substr(begin + 4, end - begin - 3);
    end += 4;
  }
  code = std::regex_replace(code, std::regex("\\\\\n"), " ");
  code = std::regex_replace(code, std::regex("#FRAMESPEC#"), "1-2");  // as OpenCue does
  code = std::regex_replace(code, std::regex("\\$\\(\\([^)]*\\)\\)"),
                            "100");  // sums, in which wordexp() knows no names
  // The name after a folder or settings; a comment may follow, and a report of a run begins with a version.
  const std::regex command("(?:^|\n)(?:exec |[A-Z_]+=\\S+ |chrt \\S+ \\S+ |\\S+/)*" + program +
                           "( (?!\\d)[^\n]*?)(?=\\s+# |\\s*\n)");
  std::vector<std::string> lines;
  for (std::sregex_iterator found(code.begin(), code.end(), command), none; found != none; ++found)
    lines.push_back((*found)[1]);
  return lines;
}

// `Options`: what the program's table of options writes to.
template <typename Options>
void expect_pages_accepted(const std::string& program) {
  const std::filesystem::path root = std::filesystem::path(__FILE__).parent_path().parent_path();
  ::setenv("first", "1", 0), ::setenv("SLURM_CPUS_PER_TASK", "2", 0);  // as Slurm does
  std::vector<std::filesystem::path> pages = {root / "README.md"};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  int count = 0;
  for (const std::filesystem::path& page : pages) {
    for (const std::string& line : command_lines(program, page)) {
      if (line.find("…") != std::string::npos) continue;
      wordexp_t words = {};
      ASSERT_EQ(::wordexp((program + " --list-devices " + line).c_str(), &words, WRDE_NOCMD), 0)
          << page << line;
      Options options;
      const auto code = command_line(options).parse(static_cast<int>(words.we_wordc), words.we_wordv);
      EXPECT_FALSE(code.has_value()) << page << line;
      ::wordfree(&words);
      ++count;
    }
  }
  EXPECT_GT(count, 0) << program;
}

}  // namespace quincunx::testing
