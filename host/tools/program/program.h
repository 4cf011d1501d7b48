// SPDX-License-Identifier: MIT
// Common parts of the command line programs: exit codes, log, reading of sizes, their own command lines.
#pragma once

#include <string>

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

// Logs the message; kUsage where the caller asked for what can never work, else kFailed.
int fail(const Status& status);

// Runs a program for main() and returns the exit code of `run`. An exception that reaches here is reported as an
// internal error.
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

}  // namespace quincunx::tools
