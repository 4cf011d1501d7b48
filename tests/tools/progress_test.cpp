// SPDX-License-Identifier: MIT
#include "tools/program/progress.h"

#include <gtest/gtest.h>

namespace quincunx::tools {
namespace {

using Seconds = std::chrono::duration<double>;

TEST(Progress, SaysHowFarAndHowLong) {
  const std::string line = progress_line("rendering", 60, 240, Seconds(2.0), "0.71");
  EXPECT_EQ(line, "rendering  [######..................]  60/240   25 %  30 fps  0:06 left  0.71");
}

TEST(Progress, EstimatesOnlyAfterASecond) {
  const std::string line = progress_line("rendering", 1, 240, Seconds(0.5), "");
  EXPECT_EQ(line.find("left"), std::string::npos);
  EXPECT_NE(progress_line("rendering", 1, 7201, Seconds(1.0), "").find("2:00:00 left"), std::string::npos);
}

TEST(Progress, SurvivesOddCounts) {
  EXPECT_NE(progress_line("x", 0, 0, Seconds(5), "").find("0/0"), std::string::npos);
  EXPECT_NE(progress_line("x", 9, 3, Seconds(5), "").find("100 %"), std::string::npos);
}

TEST(Progress, IsSilentWithoutATerminal) {
  ::testing::internal::CaptureStderr();  // stderr is a file now
  {
    Progress progress("rendering", 10);
    EXPECT_FALSE(progress.visible());
    progress.update(1, "note");
    progress.clear();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace quincunx::tools
