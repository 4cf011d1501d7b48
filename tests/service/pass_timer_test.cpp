// SPDX-License-Identifier: MIT
// Devices whose events lie: clGetEventProfilingInfo is replaced in this executable by one that passes on, or lies.
#include "quincunx/pass_timer.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "service_fixture.h"

namespace {

enum class Lie { kNone, kZero, kConstant, kReversed, kNoAnswer };
std::atomic<Lie> g_lie = Lie::kNone;
std::atomic<int> g_asked = 0;

}  // namespace

extern "C" cl_int clGetEventProfilingInfo(cl_event event, cl_profiling_info what, size_t size, void* value,
                                          size_t* size_back) {
  static const auto real =
      reinterpret_cast<decltype(&clGetEventProfilingInfo)>(dlsym(RTLD_NEXT, "clGetEventProfilingInfo"));
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

// What a service that blurs and presents reports of three frames, and the last one's picture.
struct Outcome {
  std::vector<FrameReport> reports;
  std::vector<Pixel> resolved;
};

Outcome run_frames(bool allow_waits) {
  ServiceRig rig({}, Method::kQuincunx, {64, 48}, {64, 48});
  rig.service().allow_timing_waits(allow_waits);
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

TEST_F(PassTimerTest, TheAnswerIsKept) {
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents);
  EXPECT_EQ(entries(), 1);
  g_lie = Lie::kZero;
  g_asked = 0;
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kEvents) << "asked again, in spite of what is kept";
  EXPECT_EQ(g_asked, 0);
  fs::remove_all(folder_);
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kHostClock);
  g_lie = Lie::kNone;
  EXPECT_EQ(timer_of_a_new_device(), PassTimer::kHostClock) << "that is kept, too";
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
    ASSERT_GT(report.pass_count, 1);
    for (int i = 0; i < report.pass_count; ++i)
      EXPECT_EQ(report.passes[i].ms, -1) << report.passes[i].kernel;
  }
  g_asked = 0;
  for (const FrameReport& report : run_frames(true).reports) {
    ASSERT_GT(report.pass_count, 1);
    for (int i = 0; i < report.pass_count; ++i)
      EXPECT_GT(report.passes[i].ms, 0) << report.passes[i].kernel;
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
    ASSERT_EQ(a.pass_count, b.pass_count);
    for (int pass = 0; pass < a.pass_count; ++pass) {
      EXPECT_STREQ(a.passes[pass].kernel, b.passes[pass].kernel);
      EXPECT_EQ(a.passes[pass].bytes, b.passes[pass].bytes);
      EXPECT_GT(a.passes[pass].ms, 0);
    }
  }
}

}  // namespace
}  // namespace quincunx
