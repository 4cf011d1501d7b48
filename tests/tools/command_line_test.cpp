// SPDX-License-Identifier: MIT
// The messages for a user who gives an option a wrong number.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tools/program/command_line.h"
#include "tools/program/manual.h"
#include "tools/program/program.h"
#include "tools/temporary_folder.h"

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

// The manual page and the completions have every option that the help has, and shells understand them.

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Manual : public ::testing::Test {
 protected:
  Manual()
      : line_("Makes things.", "quincunx-things", "1.2",
              "Examples:\n  quincunx-things -n .5\nMore is said.\nExit status: 0.") {
    static const std::map<std::string, int> kKinds = {{"plain", 0}, {"round", 1}, {"round:very", 2}};
    line_.add_option("INPUT", input_, "What to read").type_name("PATTERN");
    line_.add_flag("-n,--dry-run", dry_, "Don't do [it]: only say");
    add_choice(line_, "--kind", kind_, kKinds, "plain or round");
    line_.add_option("--out", out_, "Folder").type_name("FOLDER");
    line_.add_option("--log", log_, "A \\ file").type_name("FILE");
    line_.add_option("--count", count_, "How many").positive();
  }

  std::string form(const char* name) { return manual(line_.text(), name).value(); }

  // Returns bash's offers for the last of these words, one a line.
  std::string offers(const std::string& words, int last) {
    std::ofstream(folder_.file("completion")) << form("bash");
    std::ofstream(folder_.file("ask")) << fmt::format(
        ". ./completion\nCOMP_WORDS=({}) COMP_CWORD={}\n_quincunx_things\nprintf '%s\\n' "
        "\"${{COMPREPLY[@]}}\" | sort\n",
        words, last);
    const std::string command = fmt::format("cd '{}' && bash ask 2>&1", folder_.file(""));
    const std::unique_ptr<FILE, int (*)(FILE*)> shell(::popen(command.c_str(), "r"), ::pclose);
    std::string out;
    for (int letter; shell && (letter = std::fgetc(shell.get())) != EOF;)
      out += static_cast<char>(letter);
    return out;
  }

  testing::TemporaryFolder folder_;
  CommandLine line_;
  std::string input_, out_, log_;
  int kind_ = 0, count_ = 1;
  bool dry_ = false;
};

TEST_F(Manual, ThePageHasWhatTheHelpHas) {
  const std::string page = form("man");
  for (const char* part : {".TH QUINCUNX-THINGS 1 \"\" \"Quincunx 1.2\"",
                           "quincunx\\-things \\- makes things\n", "[\\fIOPTIONS\\fR] [\\fIINPUT\\fR]",
                           "\\fB\\-n\\fR, \\fB\\-\\-dry\\-run\\fR\nDon't do [it]: only say\n",
                           "\\fB\\-\\-log\\fR \\fIFILE\\fR\nA \\e file\n",
                           ".SH EXAMPLES\n.PP\n.nf\nquincunx\\-things \\-n .5\n.fi\n",
                           ".fi\n.PP\nMore is said.\n", ".SH EXIT STATUS\n0.\n"}) {
    EXPECT_TRUE(has(page, part)) << part << "\nis not in\n" << page;
  }
}

TEST_F(Manual, HiddenOptionsStayHidden) {
  for (const char* name : {"man", "bash", "zsh", "fish"})
    EXPECT_FALSE(has(form(name), "[--manual")) << form(name);
  EXPECT_FALSE(has(form("man"), "\\-\\-manual"));
}

TEST_F(Manual, BashOffersOptionsWordsAndFiles) {
  EXPECT_EQ(offers("quincunx-things --d", 1), "--dry-run\n");
  EXPECT_EQ(offers("quincunx-things --kind \"\"", 2), "plain\nround\nround:very\n");
  EXPECT_EQ(offers("quincunx-things --count \"\"", 2), "\n");
  std::filesystem::create_directory(folder_.file("compiled"));
  EXPECT_EQ(offers("quincunx-things --out comp", 2), "compiled\n");
  EXPECT_EQ(offers("quincunx-things --log comp", 2), "compiled\ncompletion\n");
  EXPECT_EQ(offers("quincunx-things completi", 1), "completion\n");
}

TEST_F(Manual, ZshAndFishDescribeEachOption) {
  const std::string zsh = form("zsh");
  EXPECT_TRUE(zsh.starts_with("#compdef quincunx-things\n")) << zsh;
  EXPECT_TRUE(has(zsh, "'(-n --dry-run)'{-n,--dry-run}'[Don'\\''t do \\[it\\]\\: only say]'")) << zsh;
  EXPECT_TRUE(has(zsh, "--kind'[plain or round]:value:(plain round round\\:very)'")) << zsh;
  EXPECT_TRUE(has(zsh, "--out'[Folder]:folder:_files -/'")) << zsh;
  const std::string fish = form("fish");
  EXPECT_TRUE(has(fish, "complete -c quincunx-things -s n -l dry-run -d 'Don\\'t do [it]: only say'\n"))
      << fish;
  EXPECT_TRUE(has(fish, "-l kind -x -a 'plain round round:very' -d 'plain or round'\n")) << fish;
}

TEST_F(Manual, AsksForAFormThatThereIs) {
  const char* const good[] = {"quincunx-things", "--manual", "fish"};
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(line_.parse(3, good), kDone);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), form("fish"));
  const char* const bad[] = {"quincunx-things", "--manual", "html"};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(line_.parse(3, bad), kUsage);
  EXPECT_TRUE(has(::testing::internal::GetCapturedStderr(), "'html' is none of man, bash, zsh, fish"));
}

}  // namespace

}  // namespace quincunx::tools
