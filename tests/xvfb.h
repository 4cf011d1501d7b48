// SPDX-License-Identifier: MIT
// Xvfb: a display without a screen, and programs that run beside a test.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "tools/temporary_folder.h"

namespace quincunx::testing {

// A program that runs beside the test. Ended by force with this object, if it still runs.
class Process {
 public:
  // Standard output and error go to `out` and `err`, files; `display` empty: none.
  Process(const std::string& command, const std::string& display, const std::string& out,
          const std::string& err) {
    pid_ = fork();
    if (pid_ != 0) return;
    display.empty() ? unsetenv("DISPLAY") : setenv("DISPLAY", display.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    const int to_out = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const int to_err = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(to_out, STDOUT_FILENO);
    dup2(to_err, STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
    _exit(127);
  }
  ~Process() { end(SIGKILL); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // The exit code; -1 when it was ended by a signal, -2 when it still runs after a time that is long for any
  // test here.
  int wait() {
    for (int i = 0; i < 6000 && pid_ > 0; ++i) {
      int status = 0;
      if (waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return -2;
  }

  bool runs() const {
    siginfo_t info = {};
    return pid_ > 0 && waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == 0;
  }

  void end(int signal) {
    if (pid_ <= 0) return;
    kill(pid_, signal);
    waitpid(std::exchange(pid_, -1), nullptr, 0);
  }

 private:
  pid_t pid_ = -1;
};

inline bool is_installed(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null", program).c_str()) == 0;
}

// False when it has not come true after a time that is long for any test here.
inline bool wait_until(const std::function<bool()>& is_true) {
  for (int i = 0; i < 1200; ++i) {
    if (is_true()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return is_true();
}

// A display of its own, with its files in `folder`: `screen` holds what it shows.
class Xvfb {
 public:
  explicit Xvfb(const TemporaryFolder& folder) : number_(folder.file("number")) {
    std::filesystem::remove(number_);
    std::filesystem::create_directories(folder.file("screen"));
    const std::string command = fmt::format(
        "Xvfb -displayfd 1 -screen 0 800x600x24 -nolisten tcp -fbdir '{}'", folder.file("screen"));
    server_ = std::make_unique<Process>(command, "", number_, folder.file("server"));
    EXPECT_TRUE(wait_until([&] { return read_file(number_).ends_with("\n"); }))
        << read_file(folder.file("server"));
  }

  std::string name() const {  // ":99"
    const std::string number = read_file(number_);
    return ":" + number.substr(0, number.find('\n'));
  }

  void close() { server_->end(SIGTERM); }

 private:
  std::string number_;
  std::unique_ptr<Process> server_;
};

}  // namespace quincunx::testing
