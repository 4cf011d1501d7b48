// SPDX-License-Identifier: MIT
// RenderOptions: what the command line of quincunx-render asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "programs/pacing_options.h"
#include "programs/picture_options.h"

namespace quincunx::scenes {

struct RenderOptions : PictureOptions {
  PacingOptions pacing;

  int truth = 0;       // 0: off; N: N x N samples a pixel
  double shutter = 0;  // of truth: part of a frame's time that the shutter is open

  int score = 0;  // 0: off; N: frames are measured against N x N samples a pixel

  std::string out;              // pattern; empty: no frames are written
  std::string contact_sheet;    // empty: none
  std::int64_t exr_frame = -1;  // this frame's targets are written beside `out`; -1: none
  std::string report;           // base name of .txt and .json; empty: none
  bool overlap = true;
  bool explain = false;
  bool json = false;

  bool window = false;           // show the frames in a window; `frames` 0: until it is closed
  std::string script;            // file of keys for the window; empty: none
  std::string captures = "out";  // folder of the window's screenshots and dumps
  bool show_ui = true;
  bool vsync = true;

  std::string command_line;  // as typed, for the report
};

// Reads a command line. On --help, --version or a usage error it prints and gives the exit code (0 or 2)
// instead.
std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options);

}  // namespace quincunx::scenes
