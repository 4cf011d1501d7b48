// SPDX-License-Identifier: MIT
// PictureOptions: what the command lines of all programs that draw have in common: scene, size, scale, method, frames,
// parts with a resolution of their own, devices.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "frames/frame_source.h"
#include "frames/part_scales.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"
#include "quincunx_gl/bridge.h"
#include "tools/program/command_line.h"
#include "tools/program/resolve_settings_options.h"

namespace quincunx::scenes {

struct PartOption {
  bool automatic = false;  // a controller chooses the scale
  float scale = 1;
  double budget_ms = 0;  // the controller's budget; 0: not given
};

struct PartOptions {
  PartOption shadow;
  std::optional<PartOption> particles;  // absent: drawn with everything else
};

// "0.5" or "auto", as --shadow-scale takes it. From such a text; one that is neither gives the whole.
std::string text_of(const PartOption& part);
PartOption part_option(const std::string& text, double budget_ms);

// `fps`: frames a second that are made, of which a tenth is each budget that is not given.
PartsSettings parts_for(const PartOptions& options, double fps);

struct PictureOptions {
  std::string scene;  // name or file; empty: the default scene
  std::uint64_t seed = 0;
  Extent output = {1280, 720};
  std::string scale = "1";  // "S" or "SX,SY"
  std::string scale_path;   // empty: `scale` in every frame
  PartOptions parts;
  std::string dual;         // empty: the output is `output` in every frame; else as of OutputPath
  ResolveSettings resolve;  // sizes and storage are left to FrameSource::connect()
  std::string focus;        // as FocusTarget::parse() takes it; empty: none
  float focus_scale = 1;
  std::optional<Jitter> jitter;  // absent: quincunx for that method, else none
  std::int64_t frames = 1;
  double fps = 60;
  double start = 0;

  std::string device;
  gl::Interop interop = gl::Interop::kAuto;
  gl::Platform platform = gl::Platform::kAuto;
  gl::Api api = gl::Api::kGl45;
  float exposure = 0;  // 0: the scene's own

  bool list_scenes = false;
  bool list_devices = false;
  bool quiet = false;
  int verbosity = 0;
};

// Scene, size, scale, method, jitter, tone map, frames and their times.
void add_picture_options(tools::CommandLine& line, PictureOptions& options,
                         const tools::MethodOptions& about_method = {});

// Devices, lists and how much is said.
void add_machine_options(tools::CommandLine& line, PictureOptions& options);

// Prints what --list-scenes or --list-devices ask for.
void print_scenes();
void print_devices(const PictureOptions& options);

// The jitter that suits a method, and the texture detail that suits both.
Jitter jitter_for(Method method);
TextureDetail texture_detail_for(Method method, Jitter jitter);

Jitter jitter_for(const PictureOptions& options);

// Frames that are drawn before the first one that is looked at, to fill the history of a method that accumulates:
// after these what moves gains nothing any more, and what stands still little.
inline constexpr int kWarmUpFrames = 24;

// The frames that the options describe. Errors: kInvalidArgument, naming the option.
Result<FrameSourceSettings> source_settings_for(const PictureOptions& options);

}  // namespace quincunx::scenes
