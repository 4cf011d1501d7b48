// SPDX-License-Identifier: MIT
// The table of options: one clear sentence for each mistake, the help, and the completions, which shells understand.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tools/program/command_line.h"
#include "tools/program/program.h"
#include "tools/temporary_folder.h"

namespace quincunx::tools {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::map<std::string, int> kKinds = {{"plain", 0}, {"round", 1}, {"round:very", 2}};

// A small program with an option of every kind.
struct Things {
  std::string input, out, log;
  int kind = 0, times = 1, verbosity = 0;
  float amount = 0.25f;
  std::vector<int> sizes = {1, 2};
  bool dry = false, quiet = false;
  CommandLine line{"Makes things.", "quincunx-things", "1.2",
                   "Examples:\n  quincunx-things -n .5\nExit status: 0."};

  Things() {
    line.group("Things");
    line.add("INPUT", text(input, "PATTERN"), "What to read").common();
    line.add("-n,--dry-run", flag(dry), "Don't do [it]: only say").common().tells();
    line.add("--kind", choice(kind, kKinds), "Sort of thing").common();
    line.add("--count", number(times, kPositive), "How many");
    line.add("--amount", number(amount, kFromZero, "A"), "How much")
        .counts_if([this] { return kind == 1; }, "--kind round");
    line.add("--sizes", number(sizes, {.least = 1, .most = 9}, "N,..."), "How large");
    line.group("Output");
    line.add("--out", text(out, "FOLDER"), "Folder").writes();
    line.add("--log", text(log, "FILE"), "A \\ file").writes().needs({"--out"}).excludes({"--quiet"});
    line.group("Help");
    line.add("--quiet", flag(quiet), "Say nothing");
    line.add("-v,--verbose", count(verbosity), "Say more").repeats();
  }

  std::optional<int> exit_code;
  std::string said, printed;
  void parse(const std::vector<const char*>& words) {
    std::vector<const char*> all = {"quincunx-things"};
    all.insert(all.end(), words.begin(), words.end());
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    exit_code = line.parse(static_cast<int>(all.size()), all.data());
    printed = ::testing::internal::GetCapturedStdout();
    said = ::testing::internal::GetCapturedStderr();
  }
};

void expect_refused(const std::vector<const char*>& words, const std::string& sentence) {
  Things things;
  things.parse(words);
  EXPECT_EQ(things.exit_code, kUsage) << sentence;
  EXPECT_EQ(things.said, "error: " + sentence + "\n");
}

TEST(CommandLine, ReadsEveryKindOfSetting) {
  Things things;
  things.parse(
      {"in.exr", "-n", "--kind", "Round:VERY", "--count=3", "--sizes", "4,5", "6", "-vv", "--verbose"});
  EXPECT_FALSE(things.exit_code) << things.said;
  EXPECT_EQ(things.input, "in.exr");
  EXPECT_TRUE(things.dry);
  EXPECT_EQ(things.kind, 2);
  EXPECT_EQ(things.times, 3);
  EXPECT_EQ(things.sizes, (std::vector<int>{4, 5, 6}));
  EXPECT_EQ(things.verbosity, 3);
  Things round;
  round.parse({"--amount", "1e30", "--kind", "round"});
  EXPECT_FALSE(round.exit_code) << round.said;
  EXPECT_EQ(round.amount, 1e30f);
}

TEST(CommandLine, NumbersOutOfBoundsAreNamed) {
  for (const char* text : {"-1", "0", "nan", "inf", "many", "1.5", "99999999999", ""})
    expect_refused({"--count", text}, fmt::format("--count: '{}' is no positive number", text));
  for (const char* text : {"-0.5", "nan", "-inf", "1e39"})
    expect_refused({"--kind", "round", "--amount", text},
                   fmt::format("--amount: '{}' is no number from 0 on", text));
  expect_refused({"--sizes", "3,10"}, "--sizes: '10' is no whole number from 1 to 9");
  expect_refused({"--sizes", "3,"}, "--sizes: '' is no whole number from 1 to 9");
}

TEST(CommandLine, MisspeltNamesGetTheNearestOne) {
  expect_refused({"--outpt", "x"}, "unknown option '--outpt'; did you mean '--out'?");
  expect_refused({"--cuont=3"}, "unknown option '--cuont'; did you mean '--count'?");
  expect_refused({"--something-else"},
                 "unknown option '--something-else'; --help-all lists those that there are");
  expect_refused({"--kind", "rond"},
                 "--kind: 'rond' is none of plain, round, round:very; did you mean 'round'?");
  expect_refused({"--kind", "square"}, "--kind: 'square' is none of plain, round, round:very");
  expect_refused({"--help", "thing"},
                 "--help: 'thing' is none of all, things, output, help; did you mean 'things'?");
  EXPECT_EQ(did_you_mean("lanczso3", {"lanczos2", "lanczos3"}), "; did you mean 'lanczos3'?");
  EXPECT_EQ(did_you_mean("temp", {"point", "temporal"}), "; did you mean 'temporal'?");
  EXPECT_EQ(did_you_mean("xyz", {"point", "temporal"}), "");
}

TEST(CommandLine, WordsTooManyOrTooFewAreNamed) {
  expect_refused({"--kind", "plain", "--kind", "round"}, "--kind: it is given 2 times; give it once");
  expect_refused({"--quiet", "--quiet"}, "--quiet: it is given 2 times; give it once");
  expect_refused({"a.exr", "b.exr"},
                 "'b.exr' is a second INPUT beside 'a.exr'; give one, in quotes if it has a * or ?");
  expect_refused({"--count"}, "--count: its value is missing");
  expect_refused({"--log", "--quiet"}, "--log: its value is missing; '--quiet' is an option");
  expect_refused({"--dry-run=maybe"}, "--dry-run: it takes no value");
  expect_refused({"--out", ""}, "--out: the text is empty");
}

TEST(CommandLine, OptionsThatDoNotFitTogetherAreNamed) {
  expect_refused({"--log", "x"}, "--log: it needs --out");
  expect_refused({"--log", "x", "--out", "y", "--quiet"},
                 "--quiet: --log excludes it; leave one of them out");
  expect_refused({"--amount", "1"}, "--amount: it does nothing here; it goes with --kind round");
}

TEST(CommandLine, PathsToWriteAreTriedAndLeaveNothing) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.file("file")) << "x";
  const std::string below = folder.file("file/below"), new_folder = folder.file("a/b"),
                    log = folder.file("c/log");
  Things bad;
  bad.parse({"--out", below.c_str()});
  EXPECT_EQ(bad.exit_code, kFailed);
  EXPECT_TRUE(bad.said.starts_with("error: --out: '" + below)) << bad.said;
  Things only_told;
  only_told.parse({"-n", "--out", below.c_str()});
  EXPECT_FALSE(only_told.exit_code) << only_told.said;
  Things good;
  good.parse({"--out", new_folder.c_str(), "--log", log.c_str()});
  EXPECT_FALSE(good.exit_code) << good.said;
  EXPECT_EQ(folder.entries(), 1);
  expect_refused({"--out", log.c_str(), "--log", log.c_str()},
                 fmt::format("--log: '{}' is what --out writes, too", log));
  Things device;
  device.parse({"--out", new_folder.c_str(), "--log", "/dev/null"});
  EXPECT_EQ(device.exit_code, kFailed);
  EXPECT_TRUE(has(device.said, "it is a device or a pipe")) << device.said;
}

TEST(CommandLine, ControlCharactersAreShown) {
  expect_refused({"--kind", "a\x1b[31mb\xc2\x9b"},
                 "--kind: 'a\\x1b[31mb\\x9b' is none of plain, round, round:very");
  EXPECT_EQ(printable("é\ta\nb\r"), "é\ta\nb\\x0d");
}

TEST(CommandLine, HelpHasWhatMattersFirst) {
  const CommandLine& line = Things().line;
  const std::string help = line.help(""), all = line.help("all"), output = line.help("output");
  EXPECT_TRUE(help.starts_with("Usage: quincunx-things INPUT [OPTION]...\nMakes things.\n\n  INPUT "))
      << help;
  EXPECT_TRUE(has(help, "  -n, --dry-run             Don't do [it]: only say\n")) << help;
  EXPECT_TRUE(has(help, "Sort of thing: plain, round or round:very (default: plain)\n")) << help;
  EXPECT_TRUE(has(help, "Examples:\n  quincunx-things -n .5\n")) << help;
  EXPECT_TRUE(has(help, "--help GROUP for one of things, output or help.\n")) << help;
  EXPECT_FALSE(has(help, "--count")) << help;
  EXPECT_TRUE(has(all, "\nThings:\n  INPUT ")) << all;
  EXPECT_TRUE(has(all, "How many (default: 1)\n")) << all;
  EXPECT_TRUE(has(all, "How large (default: 1,2)\n")) << all;
  EXPECT_LT(all.find("\nOutput:"), all.find("\nHelp:"));
  EXPECT_EQ(output, "  --out FOLDER              Folder\n  --log FILE                A \\ file\n");
}

class Completion : public ::testing::Test {
 protected:
  std::string form(const char* shell) { return things_.line.completion(shell); }

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
  Things things_;
};

TEST_F(Completion, BashOffersOptionsWordsAndFiles) {
  EXPECT_EQ(offers("quincunx-things --d", 1), "--dry-run\n");
  EXPECT_EQ(offers("quincunx-things --kind \"\"", 2), "plain\nround\nround:very\n");
  EXPECT_EQ(offers("quincunx-things --count \"\"", 2), "\n");
  std::filesystem::create_directory(folder_.file("compiled"));
  EXPECT_EQ(offers("quincunx-things --out comp", 2), "compiled\n");
  EXPECT_EQ(offers("quincunx-things --log comp", 2), "compiled\ncompletion\n");
  EXPECT_EQ(offers("quincunx-things completi", 1), "completion\n");
}

TEST_F(Completion, ZshAndFishDescribeEachOption) {
  const std::string zsh = form("zsh");
  EXPECT_TRUE(zsh.starts_with("#compdef quincunx-things\n")) << zsh;
  EXPECT_TRUE(has(zsh, "'(-n --dry-run)'{-n,--dry-run}'[Don'\\''t do \\[it\\]\\: only say]'")) << zsh;
  EXPECT_TRUE(has(zsh, "(default\\: plain)]:value:(plain round round\\:very)'")) << zsh;
  EXPECT_TRUE(has(zsh, "--out'[Folder]:folder:_files -/'")) << zsh;
  const std::string fish = form("fish");
  EXPECT_TRUE(has(fish, "complete -c quincunx-things -s n -l dry-run -d 'Don\\'t do [it]: only say'\n"))
      << fish;
  EXPECT_TRUE(has(fish, "-l kind -x -a 'plain round round:very' -d 'Sort of thing")) << fish;
}

TEST_F(Completion, IsPrintedOnRequest) {
  things_.parse({"--completion", "fish"});
  EXPECT_EQ(things_.exit_code, kDone);
  EXPECT_EQ(things_.printed, form("fish"));
  expect_refused({"--completion", "html"}, "--completion: 'html' is none of bash, zsh, fish");
}

}  // namespace
}  // namespace quincunx::tools
