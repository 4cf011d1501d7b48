// SPDX-License-Identifier: MIT
// WindowSession: the window, what is in it, and the loop between them.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "session/paced_loop.h"
#include "session/render_options.h"
#include "window/frame_graph.h"
#include "window/key_bindings.h"
#include "window/live_picture.h"
#include "window/panel.h"
#include "window/screen.h"
#include "window/window.h"
#include "window/window_settings.h"

namespace quincunx::scenes {

class WindowSession {
 public:
  // Errors: kUnsupported where there is no display; else of any part, as that part words them.
  static Result<std::unique_ptr<WindowSession>> create(const RenderOptions& options);
  ~WindowSession();

  // Shows frames until the window is closed or `options.frames` are shown. The program ends when the display is lost:
  // see window.h.
  Status run();

 private:
  explicit WindowSession(const RenderOptions& options) : options_(options) {}
  Status open();

  Status turn();
  void take_input();
  void move_view();
  Status update_picture();
  Status update_pacing();
  Status show_next();
  Status show_again(LivePicture::Keep keep);
  FrameView next_view();
  FrameView view_again(std::int64_t index);
  void show_on_screen();
  Status write_files();
  Vec2 pointed_pixel() const;
  PanelFacts facts();
  void say(std::string message);

  RenderOptions options_;
  Script script_;
  WindowSettings settings_;
  WindowSettings shown_;  // those that the picture was made by
  Extent shown_output_;

  // In the order in which they are made; each needs those before it.
  std::unique_ptr<Window> window_;
  std::optional<Screen> screen_;
  std::unique_ptr<Ui> ui_;
  std::unique_ptr<LivePicture> picture_;

  std::optional<PacedLoop> paced_;
  FrameTrace trace_;
  FrameView view_;                                         // view of the frame that is shown
  std::deque<std::pair<std::int64_t, FrameView>> recent_;  // the last ones by number, oldest first
  std::int64_t frame_ = -1;                                // its number; -1: none yet
  std::int64_t shown_count_ = 0;  // pictures on the screen so far, a frozen frame each time
  std::int64_t turn_ = 0;
  PointerUse pointer_;
  std::string message_;
  std::chrono::steady_clock::time_point said_;
};

}  // namespace quincunx::scenes
