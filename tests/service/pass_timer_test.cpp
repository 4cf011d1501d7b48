// SPDX-License-Identifier: MIT
// Devices whose events lie: clGetEventProfilingInfo is replaced in this executable by one that passes on, or lies.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "device/device_impl.h"
#include "quincunx/advanced/pass_timer.h"
#include "real_function.h"
#include "service_fixture.h"

namespace {

enum class Lie { kNone, kZero, kConstant, kReversed, kNoAnswer };
std::atomic<Lie> g_lie = Lie::kNone;
std::atomic<int> g_asked = 0;

}  // namespace

extern "C" cl_int clGetEventProfilingInfo(cl_event event, cl_profiling_info what, size_t size, void* value,
                                          size_t* size_back) {
  static const auto real = REAL(clGetEventProfilingInfo);
  ++g_asked;
  const Lie lie = g_lie;
  if (lie == Lie::kNoAnswer) return CL_PROFILING_INFO_NOT_AVAILABLE;
  const cl_int code = real(event, what, size, value, size_back);
  if (lie == Lie::kNone || code != CL_SUCCESS || value == nullptr) return code;
  const bool end = what == CL_PROFILING_COMMAND_END;
  constexpr cl_ulong kBegin = 1000;
  constexpr cl_ulong kShort = 1000;  // ns
  auto& stamp = *static_cast<cl_ulong*>(value);
  if (lie == Lie::kZero) stamp = 0;
  if (lie == Lie::kConstant) stamp = end ? kBegin + kShort : kBegin;
  if (lie == Lie::kReversed) stamp = ~stamp;
  return code;
}

namespace quincunx {
namespace {

using testing::Pixel;
using testing::ServiceRig;

namespace fs = std::filesystem;

class PassTimerTest : public ::testing::Test {
 protected:
  PassTimerTest() : folder_(fs::temp_directory_path() / ("quincunx-timer-test-" + std::to_string(getpid()))) {
    if (const char* before = std::getenv("QUINCUNX_CACHE_DIR")) before_ = before;
    fs::remove_all(folder_);
    setenv("QUINCUNX_CACHE_DIR", folder_.c_str(), 1);
  }
  ~PassTimerTest() override {
    g_lie = Lie::kNone;
    fs::remove_all(folder_);
    if (before_) {
      setenv("QUINCUNX_CACHE_DIR", before_->c_str(), 1);
    } else {
      unsetenv("QUINCUNX_CACHE_DIR");
    }
  }

  static PassTimer timer_of_a_new_device() { return pass_timer(Device::open().value()); }

  int entries() const {
    int count = 0;
    if (fs::exists(folder_)) {
      for (const auto& entry : fs::directory_iterator(folder_))
        count += entry.path().filename().string().starts_with("pass_timer-") ? 1 : 0;
    }
    return count;
  }

  fs::path folder_;

 private:
  std::optional<std::string> before_;
};

// The reports of three frames from a service that blurs and presents, and the last one's picture.
struct Outcome {
  std::vector<FrameReport> reports;
  std::vector<Pixel> resolved;
};

Outcome run_frames(bool allow_waits) {
  ServiceRig rig(Device::open().value(), {}, {.method = Method::kQuincunx}, {64, 48}, {64, 48});
  rig.service().allow_timing_waits(allow_waits);
  g_asked = 0;  // while the device was opened they were
  Outcome outcome;
  for (int frame = 0; frame < 3; ++frame) {
    outcome.resolved = rig.resolve(
        {.render = {32, 24 + frame}, .colour = [frame](int x, int y) {
           return Pixel{static_cast<float>(x), static_cast<float>(y), static_cast<float>(frame), 1};
         }});
  }
  EXPECT_TRUE(rig.service().finish().ok());
  while (const auto report = rig.service().next_completed())
    outcome.reports.push_back(*report);
  EXPECT_EQ(outcome.reports.size(), 3u);
  return outcome;
}

TEST_F(PassTimerTest, EventsThatTellTheTruthAreBelieved) {
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents);
}

TEST_F(PassTimerTest, EventsThatLieAreNot) {
  for (const Lie lie : {Lie::kZero, Lie::kConstant, Lie::kReversed, Lie::kNoAnswer}) {
    fs::remove_all(folder_);
    g_lie = lie;
    EXPECT_EQ(timer_of_a_new_device(), PassTimer::kHostClock) << "lie " << static_cast<int>(lie);
  }
}

// A doubt may come from others who used the device at that moment.
TEST_F(PassTimerTest, BeliefIsKeptAndDoubtIsNot) {
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents);
  EXPECT_EQ(entries(), 1);
  g_lie = Lie::kZero;
  g_asked = 0;
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents) << "asked again, in spite of what is kept";
  EXPECT_EQ(g_asked, 0);
  fs::remove_all(folder_);
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kHostClock);
  g_lie = Lie::kNone;
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents) << "a doubt was kept";
}

TEST_F(PassTimerTest, WithoutACacheItIsAskedEachTime) {
  setenv("QUINCUNX_CACHE_DIR", "", 1);
  g_lie = Lie::kZero;
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kHostClock);
  g_lie = Lie::kNone;
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents);
}

TEST_F(PassTimerTest, AQueueWithoutProfilingTakesNoTimes) {
  const Device owner = Device::open().value();
  cl_int error = CL_SUCCESS;
  cl_command_queue queue = clCreateCommandQueue(owner.context(), owner.id(), 0, &error);
  ASSERT_EQ(error, CL_SUCCESS);
  EXPECT_EQ(pass_timer(Device::borrow(owner.context(), owner.id(), queue).value()), PassTimer::kNone);
  EXPECT_EQ(pass_timer(Device::borrow(owner.context(), owner.id(), owner.queue()).value()),
            PassTimer::kEvents);
  clReleaseCommandQueue(queue);
}

TEST_F(PassTimerTest, ALiarsPassesHaveNoTimesUnlessTheServiceMayWait) {
  g_lie = Lie::kZero;
  for (const FrameReport& report : run_frames(false).reports) {
    ASSERT_GT(report.passes.size(), 1u);
    for (const PassReport& pass : report.passes)
      EXPECT_EQ(pass.ms, -1) << pass.kernel;
  }
  for (const FrameReport& report : run_frames(true).reports) {
    ASSERT_GT(report.passes.size(), 1u);
    for (const PassReport& pass : report.passes)
      EXPECT_GT(pass.ms, 0) << pass.kernel;
  }
  EXPECT_EQ(g_asked, 0) << "events that lie are asked for nothing";
}

TEST_F(PassTimerTest, NothingElseChanges) {
  const Outcome believed = run_frames(true);
  fs::remove_all(folder_);
  g_lie = Lie::kZero;
  const Outcome waited = run_frames(true);
  EXPECT_EQ(believed.resolved, waited.resolved);
  ASSERT_EQ(believed.reports.size(), waited.reports.size());
  for (std::size_t i = 0; i < waited.reports.size(); ++i) {
    const FrameReport& a = believed.reports[i];
    const FrameReport& b = waited.reports[i];
    EXPECT_EQ(a.frame_index, b.frame_index);
    EXPECT_EQ(a.used_previous, b.used_previous);
    EXPECT_EQ(a.non_finite_pixels, b.non_finite_pixels);
    ASSERT_EQ(a.passes.size(), b.passes.size());
    for (std::size_t pass = 0; pass < a.passes.size(); ++pass) {
      EXPECT_STREQ(a.passes[pass].kernel, b.passes[pass].kernel);
      EXPECT_EQ(a.passes[pass].bytes, b.passes[pass].bytes);
      EXPECT_GT(a.passes[pass].ms, 0);
    }
  }
}

// How stamps are judged.

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
