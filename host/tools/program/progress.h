// SPDX-License-Identifier: MIT
// Progress: one line on stderr that redraws itself, with an estimate of the time left; nothing where stderr
// is not a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace quincunx::tools {

// "rendering  [#########...........]  108/240  45 %  31 fps  0:04 left  0.71". Pure. `elapsed` since the
// start; the estimate appears after the first second and takes all items as equally long.
std::string progress_line(const std::string& what, std::int64_t done, std::int64_t total,
                          std::chrono::duration<double> elapsed, const std::string& note);

// Not thread-safe. The destructor clears the line.
class Progress {
 public:
  enum class Show { kOnTerminal, kNever };

  Progress(std::string what, std::int64_t total, Show show = Show::kOnTerminal);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  bool visible() const { return visible_; }

  // Redraws at most ten times a second. `note`: a few words about the item at hand.
  void update(std::int64_t done, const std::string& note = {});

  // Removes the line, for a log message or the end; the next update() draws it again.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  std::int64_t total_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_draw_;
};

}  // namespace quincunx::tools
