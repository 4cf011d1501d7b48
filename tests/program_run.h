// SPDX-License-Identifier: MIT
// Runs a program and gives back what a user would see.
#pragma once

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tools/temporary_folder.h"

namespace quincunx::testing {

struct ProgramResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

// `program`: that of the room, unless a test says otherwise. `arguments` go through a shell; "{}/" in them is
// the folder.
inline ProgramResult run_program(const TemporaryFolder& folder, std::string arguments,
                                 const char* program = QUINCUNX_PROGRAM) {
  for (std::size_t at; (at = arguments.find("{}/")) != std::string::npos;) {
    arguments.replace(at, 3, folder.file(""));
  }
  const std::string out = folder.file("stdout");
  const std::string err = folder.file("stderr");
  const int status = std::system(fmt::format("{} {} >'{}' 2>'{}'", program, arguments, out, err).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

}  // namespace quincunx::testing
