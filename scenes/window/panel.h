// SPDX-License-Identifier: MIT
// The panel and what else lies over the picture: labels of the split view, the pixel under the cursor, help.
// By Dear ImGui, between the beginning and the end of one of its frames.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "window/frame_graph.h"
#include "window/window_settings.h"

namespace quincunx::scenes {

struct PickedPixel {
  int x = 0;
  int y = 0;
  std::array<std::uint8_t, 4> rgba = {};
};

// The facts that the panel shows; the values that it changes are in the settings.
struct PanelFacts {
  std::vector<std::string> scenes;
  std::int64_t frame = 0;
  Extent render = {};
  Extent made = {};  // the picture's, before it is scaled to `output`
  Extent output = {};
  std::string crossing;              // how the frame came to OpenCL and back
  double target_ms = 0;              // 0: none
  std::string method;                // that a controller chose; empty: that of the settings
  std::string reasons;               // why, lines of text; empty: no controller chose it
  std::string motion;                // what frames say of velocity; empty: nobody asks
  std::optional<PickedPixel> pixel;  // under the cursor, where the picture is enlarged
  std::string message;               // the latest news for the user; may be empty
};

void draw_panel(WindowSettings& settings, const FrameTrace& trace, const PanelFacts& facts);

}  // namespace quincunx::scenes
