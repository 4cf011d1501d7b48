// SPDX-License-Identifier: MIT
// How the window ends: closed, without a display, with its display lost.
#include <algorithm>

#include "display.h"

namespace quincunx::testing {
namespace {

class WindowEnd : public OnDisplay {
 protected:
  void expect_one_sentence(const std::string& part) const {
    EXPECT_NE(said().find(part), std::string::npos) << said();
    const std::string text = said();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }

  // A window that has shown something.
  std::unique_ptr<Process> start() {
    auto window = start_window("--scene chart -q --script '" + path("script") + "'");
    EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(path("captures")) || !window->runs(); }));
    EXPECT_TRUE(window->runs()) << said();
    return window;
  }
};

TEST_F(WindowEnd, ClosedByTheWindowManager) {
  open_window_manager();
  write_script("5 key s\n");
  const auto window = start();
  ASSERT_EQ(tool("search --sync --onlyvisible --name Quincunx windowfocus --sync key alt+F4"), 0);
  EXPECT_EQ(window->wait(), 0) << said();
  EXPECT_EQ(said(), "");
}

TEST_F(WindowEnd, DisplayLost) {
  write_script("5 key s\n");
  for (int round = 0; round < 3; ++round) {
    if (round > 0) open_display();
    std::filesystem::remove_all(path("captures"));
    const auto window = start();
    // At another moment of a frame each time.
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + 37 * round));
    close_display();
    EXPECT_EQ(window->wait(), 1) << said();
    expect_one_sentence("the display was lost");
  }
}

TEST_F(WindowEnd, DisplayLostWhileFrozenAndMinimised) {
  open_window_manager();
  write_script("5 key s\n6 key space\n8 minimise\n");
  const auto window = start();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  close_display();
  EXPECT_EQ(window->wait(), 1) << said();
  expect_one_sentence("the display was lost");
}

TEST_F(WindowEnd, NoDisplay) {
  close_display();
  // Not the number that has just become free: a server of another test may take it.
  display_ = ":50000";
  write_script("");
  EXPECT_EQ(run_window("-q"), 1);
  expect_one_sentence("no window could be opened: X11: Failed to open display");
  display_.clear();
  EXPECT_EQ(run_window("-q"), 1);
  expect_one_sentence("DISPLAY");
}

TEST_F(WindowEnd, WrongUsage) {
  write_script("1 key m\n2 key nothing\n");
  EXPECT_EQ(run_window("-q"), 2);
  expect_one_sentence("line 2: no key is called 'nothing'");
  write_script("");
  EXPECT_EQ(run_window("-q --out a.png"), 2);
  EXPECT_EQ(run_window("-q --truth 2"), 2);
}

}  // namespace
}  // namespace quincunx::testing
