// SPDX-License-Identifier: MIT
// RenderOptions: what the command line of quincunx-render asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "frame_source.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"
#include "quincunx_gl/bridge.h"

namespace quincunx::scenes {

struct RenderOptions {
  std::string scene;  // name or file; empty: the default scene
  std::uint64_t seed = 0;
  Extent output = {1280, 720};
  std::string scale = "1";  // "S" or "SX,SY"
  std::string scale_path;   // empty: `scale` in every frame
  Method method = Method::kQuincunx;
  std::optional<Jitter> jitter;  // absent: quincunx for that method, else none
  std::int64_t frames = 1;
  double fps = 60;
  double start = 0;
  int truth = 0;       // 0: off; N: N x N samples a pixel
  double shutter = 0;  // of truth: part of a frame's time that the shutter is open

  std::string out;              // pattern; empty: no frames are written
  std::string contact_sheet;    // empty: none
  std::int64_t exr_frame = -1;  // this frame's targets are written beside `out`; -1: none
  std::string report;           // base name of .txt and .json; empty: none

  std::string device;
  gl::Interop interop = gl::Interop::kAuto;
  gl::Platform platform = gl::Platform::kAuto;
  ToneMap tone_map = ToneMap::kAces;
  float exposure = 0;  // 0: the scene's own
  bool dither = true;
  bool overlap = true;

  bool list_scenes = false;
  bool list_devices = false;
  bool explain = false;
  bool json = false;
  bool quiet = false;
  int verbosity = 0;

  std::string command_line;  // as typed, for the report
};

// Reads a command line. On --help, --version or a usage error it prints and gives the exit code (0 or 2)
// instead.
std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options);

// The frames that the options describe. Errors: kInvalidArgument, naming the option.
Result<FrameSourceSettings> source_settings_for(const RenderOptions& options);

// What the options say of the resolve; sizes and storage are left to FrameSource::connect().
ResolveSettings resolve_settings_for(const RenderOptions& options);

// The scale path that the options describe. Errors: kInvalidArgument.
Result<ScalePath> scale_path_for(const RenderOptions& options);

Jitter jitter_for(const RenderOptions& options);

}  // namespace quincunx::scenes
