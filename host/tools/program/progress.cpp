// SPDX-License-Identifier: MIT
#include "tools/program/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace quincunx::tools {

namespace {

constexpr int kBarWidth = 24;
constexpr double kEstimateAfterSeconds = 1.0;
constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr const char* kEraseLine = "\r\033[K";

std::string minutes_and_seconds(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

std::string progress_line(const std::string& what, std::int64_t done, std::int64_t total,
                          std::chrono::duration<double> elapsed, const std::string& note) {
  const double part =
      total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(part * kBarWidth);
  std::string line = fmt::format("{}  [{}{}]  {}/{}  {:3.0f} %", what, std::string(filled, '#'),
                                 std::string(kBarWidth - filled, '.'), done, total, part * 100);
  if (elapsed.count() >= kEstimateAfterSeconds && done > 0) {
    const double rate = static_cast<double>(done) / elapsed.count();
    const double left = static_cast<double>(std::max<std::int64_t>(total - done, 0)) / rate;
    line += fmt::format("  {:.{}f} fps  {} left", rate, rate < 10 ? 1 : 0, minutes_and_seconds(left));
  }
  if (!note.empty()) line += "  " + note;
  return line;
}

Progress::Progress(std::string what, std::int64_t total, Show show)
    : what_(std::move(what)),
      total_(total),
      visible_(show == Show::kOnTerminal && ::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_draw_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::update(std::int64_t done, const std::string& note) {
  if (!visible_) return;
  const Clock::time_point now = Clock::now();
  if (drawn_ && now - last_draw_ < kRedrawInterval) return;
  last_draw_ = now;
  drawn_ = true;
  fmt::print(stderr, "{}{}", kEraseLine, progress_line(what_, done, total_, now - start_, note));
  std::fflush(stderr);
}

void Progress::clear() {
  if (!visible_ || !drawn_) return;
  fmt::print(stderr, "{}", kEraseLine);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace quincunx::tools
