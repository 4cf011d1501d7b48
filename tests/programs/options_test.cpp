// SPDX-License-Identifier: MIT
// The tables of options of quincunx-render, -dump and -resolve.
#include "option_pairs.h"
#include "page_commands.h"
#include "programs/dump_session.h"
#include "session/render_options.h"
#include "tools/sequence/resolve_task.h"

namespace quincunx {
namespace {

using RenderPairs = testing::OptionPairs<scenes::RenderOptions>;
using DumpPairs = testing::OptionPairs<scenes::DumpOptions>;
using ResolvePairs = testing::OptionPairs<tools::ResolveOptions>;

TEST(Options, EachPairOfRenderIsJudged) {
  RenderPairs({}).expect_each_is_judged();
}
TEST(Options, EachPairOfDumpIsJudged) {
  DumpPairs({{{"--out", "stages"}, {"--out", "--sequence"}}}).expect_each_is_judged();
}
TEST(Options, EachPairOfResolveIsJudged) {
  ResolvePairs({{{"in.%04d.exr"}, {"INPUT"}}, {{"--out", "out.%04d.exr"}, {"--out"}}})
      .expect_each_is_judged();
}

TEST(Options, HelpIsReadable) {
  RenderPairs::expect_readable_help();
  DumpPairs::expect_readable_help();
  ResolvePairs::expect_readable_help();
}

TEST(Options, ThosePagesShowAreAccepted) {
  testing::expect_pages_accepted<scenes::RenderOptions>("quincunx-render");
  testing::expect_pages_accepted<scenes::DumpOptions>("quincunx-dump");
  testing::expect_pages_accepted<tools::ResolveOptions>("quincunx-resolve");
}

}  // namespace
}  // namespace quincunx
