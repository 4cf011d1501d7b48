// SPDX-License-Identifier: MIT
// What a user reads who gives an option a wrong number.
#include "tools/program/command_line.h"

#include <gtest/gtest.h>

#include <string>

#include "tools/program/program.h"

namespace quincunx::tools {
namespace {

struct Answer {
  std::optional<int> exit_code;
  std::string said;
};

// Parses `--count TEXT` and `--amount TEXT`, of which the first must be positive, the second not negative.
Answer answer_to(const char* option, const char* text) {
  CommandLine line("", "program", "", "");
  int count = 1;
  float amount = 0;
  line.add_option("--count", count, "").positive();
  line.add_option("--amount", amount, "").non_negative();
  const char* const arguments[] = {"program", option, text};
  ::testing::internal::CaptureStderr();
  const auto exit_code = line.parse(3, arguments);
  return {exit_code, ::testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, NumbersWithinTheirBoundsAreTaken) {
  EXPECT_FALSE(answer_to("--count", "3").exit_code);
  EXPECT_FALSE(answer_to("--amount", "0").exit_code);
  EXPECT_FALSE(answer_to("--amount", "1e30").exit_code);
}

TEST(CommandLine, OthersAreNamedInAShortSentence) {
  const auto expect_refused = [](const char* option, const char* text, const std::string& part) {
    const Answer answer = answer_to(option, text);
    EXPECT_EQ(answer.exit_code, kUsage) << text;
    EXPECT_NE(answer.said.find(std::string(option) + ": " + part), std::string::npos) << answer.said;
    EXPECT_LT(answer.said.find('\n'), 80u) << answer.said;
  };
  for (const char* text : {"-1", "0", "nan", "inf", "many"})
    expect_refused("--count", text, std::string("'") + text + "' is no positive number");
  for (const char* text : {"-0.5", "nan", "-inf", ""})
    expect_refused("--amount", text, std::string("'") + text + "' is no number from 0 on");
}

}  // namespace
}  // namespace quincunx::tools
