// SPDX-License-Identifier: MIT
#include "event_judge.h"

#include <gtest/gtest.h>

#include <limits>

namespace quincunx {
namespace {

constexpr std::uint64_t kBegin = 7'000'000'000;  // a device's clock may begin anywhere
constexpr std::uint64_t kWaitNs = 20'000;        // between submission and start

// A run of `ms` by the stamps, of which the host saw `overhead_ms` more.
TimedLoad honest(double ms, double overhead_ms = 0.05) {
  const std::uint64_t start = kBegin + kWaitNs;
  return {{kBegin, start, start + static_cast<std::uint64_t>(ms * 1e6)}, ms + overhead_ms};
}

TimedLoad stamped(std::uint64_t submitted, std::uint64_t started, std::uint64_t ended, double host_ms) {
  return {{submitted, started, ended}, host_ms};
}

void expect_doubt(const TimedLoad& light, const TimedLoad& heavy, const std::string& clause) {
  const std::string doubt = doubt_about(light, heavy);
  EXPECT_NE(doubt.find(clause), std::string::npos) << "'" << doubt << "' has no '" << clause << "'";
}

TEST(EventJudge, BelievesStampsThatGrowWithTheWork) {
  EXPECT_EQ(doubt_about(honest(1), honest(8)), "");
  EXPECT_EQ(doubt_about(honest(0.2), honest(1.6)), "");
  EXPECT_EQ(doubt_about(honest(1), honest(3)), "") << "a device may be wider than the light load";
  EXPECT_EQ(doubt_about(honest(1, 0), honest(8, 0)), "") << "the host saw no more than the device";
}

TEST(EventJudge, BelievesThemWhereTheHostWaitedLongForWakingUp) {
  EXPECT_EQ(doubt_about(honest(1, 10), honest(8, 0.05)), "") << "the light run woke up late";
  EXPECT_EQ(doubt_about(honest(1), honest(8, 6)), "") << "the heavy run woke up late";
}

TEST(EventJudge, StampsMayShareOneMoment) {
  EXPECT_EQ(doubt_about(stamped(5, 5, 1'000'005, 1.1), stamped(9, 9, 8'000'009, 8.1)), "");
}

TEST(EventJudge, NoDurationIsNoTime) {
  expect_doubt(stamped(0, 0, 0, 1), stamped(0, 0, 0, 8), "last 0 ms");
  expect_doubt(stamped(kBegin, kBegin, kBegin, 1), honest(8), "last 0 ms");
  expect_doubt(honest(1), stamped(kBegin, kBegin, kBegin, 8), "last 0 ms");
}

TEST(EventJudge, StampsOutOfOrderAreNoTimes) {
  expect_doubt(honest(1), stamped(kBegin, kBegin + 2, kBegin + 1, 8), "end before they start");
  expect_doubt(stamped(kBegin, kBegin + 2, kBegin + 1, 1), honest(8), "end before they start");
  expect_doubt(honest(1), stamped(kBegin + 1, kBegin, kBegin + 8'000'000, 8.1), "before they are submitted");
  constexpr auto kNever = std::numeric_limits<std::uint64_t>::max();
  expect_doubt(honest(1), stamped(kBegin, kNever, kBegin, 8), "end before they start");
}

TEST(EventJudge, TimesThatDoNotGrowAreNoTimes) {
  expect_doubt(honest(1), stamped(kBegin, kBegin, kBegin + 1'000'000, 8.1), "grow by 0.000 ms");
  expect_doubt(stamped(kBegin, kBegin, kBegin + 1'000'000, 1.1),
               stamped(kBegin, kBegin, kBegin + 900'000, 8.1), "grow by -0.100 ms");
  // Microseconds, say, that a driver takes for nanoseconds.
  expect_doubt(stamped(kBegin, kBegin, kBegin + 1'000, 1), stamped(kBegin, kBegin, kBegin + 8'000, 8),
               "grow by 0.007 ms");
  // Not even where a busy machine lets the host see no growth.
  expect_doubt(stamped(kBegin, kBegin, kBegin + 1'000, 9), stamped(kBegin, kBegin, kBegin + 1'000, 8),
               "grow by");
}

TEST(EventJudge, TimesThatTheHostDidNotSeeAreNoTimes) {
  // The time since the machine started, and ticks of a tenth of a nanosecond.
  expect_doubt(stamped(0, 0, 3'600'000'000'000, 1), stamped(0, 0, 3'600'007'000'000, 8), "that the host saw");
  expect_doubt(stamped(0, 0, 10'000'000, 1), stamped(0, 0, 80'000'000, 8), "that the host saw");
}

}  // namespace
}  // namespace quincunx
