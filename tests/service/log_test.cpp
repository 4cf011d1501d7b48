// SPDX-License-Identifier: MIT
// The log: to a callback, by level, to stderr without one, from any thread and from within the callback.
#include "quincunx/advanced/log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../tools/own_cache.h"
#include "passes/pass_chain.h"
#include "quincunx/device.h"
#include "quincunx/quincunx.h"
#include "service_fixture.h"

namespace quincunx {
namespace {

using Lines = std::vector<std::pair<LogLevel, std::string>>;

class Log : public ::testing::Test {
 protected:
  ~Log() override { set_log({}); }

  void keep_lines() {
    set_log([this](LogLevel level, const std::string& message) { lines_.emplace_back(level, message); });
  }

  static std::string stderr_of(const auto& act) {
    ::testing::internal::CaptureStderr();
    act();
    return ::testing::internal::GetCapturedStderr();
  }

  Lines lines_;
};

TEST_F(Log, WithoutACallbackWarningsAndWorseGoToStderrAsOneLineEach) {
  const auto all = [] {
    for (const LogLevel level : {LogLevel::kDebug, LogLevel::kInfo, LogLevel::kWarning, LogLevel::kError})
      log_line(level, "first\nsecond");
  };
  EXPECT_EQ(stderr_of(all), "quincunx: warning: first second\nquincunx: error: first second\n");
}

TEST_F(Log, SaysOnceThatCompilingTakesLong) {
  keep_lines();
  CompileNotice patient(std::chrono::hours(1)), impatient(std::chrono::milliseconds(0));
  for (int kernel = 0; kernel < 3; ++kernel) {
    patient.before_kernel(14, "a GPU");
    impatient.before_kernel(14, "a GPU");
  }
  EXPECT_EQ(lines_, (Lines{{LogLevel::kInfo, "compiling 14 kernels for 'a GPU', once"}}));
}

TEST_F(Log, ACallbackHasEveryLevelAndStderrNothing) {
  keep_lines();
  const std::string written = stderr_of([] {
    log_line(LogLevel::kDebug, "a");
    log_line(LogLevel::kError, "b\nc");
  });
  EXPECT_EQ(lines_, (Lines{{LogLevel::kDebug, "a"}, {LogLevel::kError, "b c"}}));
  EXPECT_EQ(written, "");
  set_log({});
  log_line(LogLevel::kInfo, "to nobody");
  EXPECT_EQ(lines_.size(), 2u);
}

TEST_F(Log, OpeningADeviceTellsItsClock) {
  const testing::OwnCache cache("");  // so that the clock is measured, not read
  keep_lines();
  ASSERT_TRUE(Device::open().ok());
  const auto tells = [](const auto& line) { return line.second.starts_with("pass times of '"); };
  EXPECT_EQ(std::count_if(lines_.begin(), lines_.end(), tells), 1);
}

// Resolves 8x8 to 16x16 for longer than frames are looked at; returns how many lines hold `words`.
std::ptrdiff_t lines_of_run(const Lines& lines, const char* words,
                            const std::function<void(int, testing::HostFrame&)>& set) {
  testing::ServiceRig rig({.moving_objects = false}, Method::kTemporal, {16, 16}, {16, 16});
  for (int n = 0; n < 80; ++n) {
    testing::HostFrame frame{.render = {8, 8}};
    set(n, frame);
    EXPECT_TRUE(rig.dispatch(rig.upload(frame)).ok());
  }
  return std::count_if(lines.begin(), lines.end(), [&](const auto& line) {
    return line.first == LogLevel::kWarning && line.second.find(words) != std::string::npos;
  });
}

TEST_F(Log, ACameraThatIsNeverToldIsNamedOnce) {
  keep_lines();
  const char* words = "in the first 32 frames `camera` is the identity";
  EXPECT_EQ(lines_of_run(lines_, words, [](int, auto& frame) { frame.camera = {}; }), 1);
  lines_.clear();
  EXPECT_EQ(lines_of_run(lines_, words,
                         [](int n, auto& frame) {
                           if (n == 20) frame.camera.clip_to_previous_clip[12] = .01f;
                         }),
            0);
}

TEST_F(Log, AJitterOfTooFewPlacesIsNamedOnce) {
  keep_lines();
  const char* words = "of a pixel, where temporal wants 32";
  const auto run = [&](Extent render, Extent output) {
    lines_.clear();
    return lines_of_run(lines_, words, [=](int n, testing::HostFrame& frame) {
      frame.jitter = jitter(static_cast<std::uint64_t>(n), render, output);
    });
  };
  EXPECT_EQ(run({8, 8}, {16, 16}), 0);
  EXPECT_EQ(run({16, 16}, {8, 8}), 1) << "swapped";
  EXPECT_EQ(run({}, {}), 1) << "none";
  EXPECT_EQ(run({16, 16}, {16, 16}), 0) << "fewer than best, and enough";
}

TEST_F(Log, ACallbackMayReplaceItselfAndWhatItSaysOrThrowsIsLost) {
  int calls = 0;
  set_log([&](LogLevel, const std::string& message) {
    ++calls;
    log_line(LogLevel::kError, "again: " + message);
    keep_lines();
    log_line(LogLevel::kError, "still within: " + message);
    throw std::runtime_error("not the library's matter");
  });
  EXPECT_EQ(stderr_of([] { log_line(LogLevel::kInfo, "first"); }), "");
  log_line(LogLevel::kInfo, "second");
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(lines_, (Lines{{LogLevel::kInfo, "second"}}));
}

// The counters are plain numbers: calls overlap neither each other nor set_log().
TEST_F(Log, MayBeSetWhileThreadsSpeak) {
  constexpr int kThreads = 4, kLines = 500;
  int calls = 0;
  std::atomic<bool> current = true;
  std::vector<std::thread> threads;
  set_log([&](LogLevel, const std::string&) { ++calls; });
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([] {
      for (int line = 0; line < kLines; ++line)
        log_line(LogLevel::kDebug, "line");
    });
  }
  for (int i = 0; i < 100; ++i) {
    auto used = std::make_shared<bool>(true);  // whether set_log() has not yet replaced this callback
    set_log([&, used](LogLevel, const std::string&) {
      if (!*used) current = false;
      ++calls;
    });
    set_log([&](LogLevel, const std::string&) { ++calls; });
    *used = false;
  }
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(calls, kThreads * kLines);
  EXPECT_TRUE(current) << "a callback was called after another had been set";
}

TEST_F(Log, FromC) {
  std::vector<std::pair<int, std::string>> lines;
  const auto keep = [](std::int32_t level, const char* message, void* user) {
    static_cast<decltype(lines)*>(user)->emplace_back(level, message);
  };
  ASSERT_EQ(quincunx_set_log(keep, &lines), QUINCUNX_OK);
  log_line(LogLevel::kWarning, "w");
  log_line(LogLevel::kDebug, "d");
  ASSERT_EQ(quincunx_set_log(nullptr, nullptr), QUINCUNX_OK);
  EXPECT_EQ(stderr_of([] { log_line(LogLevel::kWarning, "x"); }), "quincunx: warning: x\n");
  EXPECT_EQ(lines, (decltype(lines){{QUINCUNX_LOG_WARNING, "w"}, {QUINCUNX_LOG_DEBUG, "d"}}));
}

}  // namespace
}  // namespace quincunx
