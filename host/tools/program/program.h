// SPDX-License-Identifier: MIT
// Common parts of the command line programs: exit codes, log, progress, reading of sizes, their own command
// lines.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "quincunx/advanced/extent.h"
#include "quincunx/device.h"
#include "quincunx/status.h"

namespace quincunx::tools {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

// The log goes to stderr: stdout is for what was asked for. `verbosity` 1: say more, 2: everything. Once a
// program.
void set_up_log(bool quiet, int verbosity);

// Whether TERM=dumb says that the terminal knows no escapes.
bool has_plain_terminal();

// Returns the text with \\x1b and the like in place of control characters, but for ends of lines and tabs.
std::string printable(std::string_view text);

// Logs the message; kUsage where the caller asked for what can never work, else kFailed.
int fail(const Status& status);

// Runs a program for main() and returns the exit code of `run`. An exception that reaches here is reported as an
// internal error, standard output that cannot be written as a failure.
int run_program(const char* program, int (*run)(int argc, char** argv), int argc, char** argv);

// Reads "1280x720" into `extent`. Returns what is wrong with the text, in one sentence; empty when nothing is.
std::string parse_extent(const std::string& text, Extent& extent);

// The OpenCL devices on stdout, as --list-devices has them.
void print_opencl_devices();

// As it was typed, quoted for a shell where need be.
std::string command_line_text(const std::string& program, int argc, const char* const* argv);

std::string date_now();  // UTC, "2026-11-21 14:03 UTC"

// Lines for --explain, as ResolvePlan::explain() words them: the device that a program opened and which profile cuts
// its work, or why there is none.
std::string device_lines(const Result<Device>& device);

// "rendering  [#########...........]  108/240  45 %  31 fps  0:04 left  0.71". Pure. `elapsed` since the
// start; the estimate appears after the first second and takes all items as equally long.
std::string progress_line(const std::string& what, std::int64_t done, std::int64_t total,
                          std::chrono::duration<double> elapsed, const std::string& note);

// One line on stderr that redraws itself, with an estimate of the time left; nothing where stderr is no terminal. Not
// thread-safe. The destructor clears the line.
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
