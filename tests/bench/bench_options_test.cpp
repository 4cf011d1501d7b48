// SPDX-License-Identifier: MIT
// The table of options of quincunx-bench.
#include "bench/bench_options.h"
#include "option_pairs.h"
#include "page_commands.h"

namespace quincunx {
namespace {

using BenchPairs = testing::OptionPairs<bench::BenchOptions>;

TEST(Options, EachPairOfBenchIsJudged) {
  BenchPairs({}).expect_each_is_judged();
}

TEST(Options, ThosePagesShowOfBenchAreAccepted) {
  testing::expect_pages_accepted<bench::BenchOptions>("quincunx-bench");
}

TEST(Options, HelpOfBenchIsReadable) {
  BenchPairs::expect_readable_help();
}

}  // namespace
}  // namespace quincunx
