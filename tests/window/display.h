// SPDX-License-Identifier: MIT
// A display of its own for each test (Xvfb), and programs that run on it.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "program_run.h"
#include "quincunx/image.h"
#include "skip.h"

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
    for (int i = 0; i < 1200 && pid_ > 0; ++i) {
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

class OnDisplay : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"Xvfb", "xdotool", "openbox"}) {
      if (!is_installed(program)) QUINCUNX_SKIP(std::string(program) + " is not installed");
    }
    open_display();
  }

  void open_display() {
    server_.reset();
    std::filesystem::remove(path("number"));
    std::filesystem::create_directories(path("screen"));
    const std::string command =
        fmt::format("Xvfb -displayfd 1 -screen 0 800x600x24 -nolisten tcp -fbdir '{}'", path("screen"));
    server_ = std::make_unique<Process>(command, "", path("number"), path("server"));
    ASSERT_TRUE(wait_until([&] { return read_file(path("number")).ends_with("\n"); }))
        << read_file(path("server"));
    display_ = ":" + read_file(path("number"));
    display_.pop_back();
  }

  void close_display() { server_->end(SIGTERM); }

  // Minimising needs one.
  void open_window_manager() {
    manager_ =
        std::make_unique<Process>("openbox --sm-disable", display_, path("manager_out"), path("manager_err"));
    ASSERT_TRUE(wait_until([&] { return tool("get_num_desktops") == 0; })) << read_file(path("manager_err"));
  }

  // By the keyboard and mouse of the display.
  int tool(const std::string& arguments) {
    Process xdotool("xdotool " + arguments, display_, path("tool_out"), path("tool_err"));
    return xdotool.wait();
  }

  std::string path(const std::string& name) const { return folder_.file(name); }

  void write_script(const std::string& text) { std::ofstream(path("script")) << text; }

  std::unique_ptr<Process> start_window(const std::string& arguments) {
    const std::string command = fmt::format("{} --window --output 160x90 --no-vsync --captures '{}' {}",
                                            QUINCUNX_PROGRAM, path("captures"), arguments);
    return std::make_unique<Process>(command, display_, path("stdout"), path("stderr"));
  }

  // Runs it to its end with the script written last.
  int run_window(const std::string& arguments) {
    return start_window(fmt::format("--script '{}' {}", path("script"), arguments))->wait();
  }

  std::string said() const { return read_file(path("stderr")); }

  TemporaryFolder folder_;
  std::string display_;
  std::unique_ptr<Process> server_;
  std::unique_ptr<Process> manager_;
};

}  // namespace quincunx::testing
