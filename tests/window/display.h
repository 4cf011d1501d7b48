// SPDX-License-Identifier: MIT
// A display of its own for each test (Xvfb), and programs that run on it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>

#include "program_run.h"
#include "quincunx/image.h"
#include "skip.h"
#include "xvfb.h"

namespace quincunx::testing {

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
    server_ = std::make_unique<Xvfb>(folder_);
    display_ = server_->name();
  }

  void close_display() { server_->close(); }

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
  std::unique_ptr<Xvfb> server_;
  std::unique_ptr<Process> manager_;
};

}  // namespace quincunx::testing
