// SPDX-License-Identifier: MIT
// WindowSettings: everything that keys and panel change. Values only; what they do to the picture is done by
// those who read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "session/frame_pacing.h"
#include "tools/program/jitter.h"

namespace quincunx::scenes {

// The source of each frame's viewport.
enum class ResolutionMode : std::uint8_t {
  kFixed,       // the scale
  kController,  // a controller that holds the target rate
  kSweep,       // from a quarter to the whole and back, a step in every frame
  kRandom,      // another extent in every frame, each axis for itself
  kLowest,      // the smallest viewport there is: 8 x 8
};

constexpr int kResolutionModes = 5;

inline const char* name_of(ResolutionMode mode) {
  constexpr const char* kNames[kResolutionModes] = {"fixed scale", "by the controller", "sweep",
                                                    "random in each frame", "lowest"};
  return kNames[static_cast<std::size_t>(mode)];
}

constexpr float kSmallestScale = 0.02f;
constexpr float kLargestScale = 2.0f;

struct ResolutionSettings {
  ResolutionMode mode = ResolutionMode::kFixed;
  float scale = 1;               // scale with kFixed, per axis, in [kSmallestScale, kLargestScale]
  float largest_controlled = 1;  // scale of kController

  friend bool operator==(const ResolutionSettings&, const ResolutionSettings&) = default;
};

// The rate that frames are made for, and by what it is held where the mode is kController.
struct RateSettings {
  double target_fps = 60;
  ControllerKind controller = ControllerKind::kPredictive;

  friend bool operator==(const RateSettings&, const RateSettings&) = default;
};

constexpr int kControllers = 4;  // all but ControllerKind::kFixed

// The right part of a split view.
inline const std::string kCompareNothing = "";
inline const std::string kCompareTruth = "truth";

constexpr int kTargetKinds = 2;

// Scales of parts that keys and panel offer, as --shadow-scale and --particle-scale take them.
inline const std::vector<std::string> kShadowScales = {"1", "0.5", "0.25", "0.125", "auto"};
inline const std::string kParticlesInFrame = "";  // drawn with everything else
inline const std::vector<std::string> kParticleScales = {kParticlesInFrame, "1",   "0.5", "0.25",
                                                         "0.125",           "auto"};

// How the picture is made; a change of these makes passes and buffers anew.
struct LookSettings {
  std::string scene;                       // as open_scene() takes it
  std::string method;                      // a name of all_variants()
  bool chooses_method = false;             // a controller does, for each frame; follows from other settings
  std::string compared = kCompareNothing;  // that, "truth", or another method
  float shutter = 0;                       // motion blur, part of a frame's time
  int blur_samples = 8;
  ToneMap tone_map = ToneMap::kAces;
  bool dither = true;
  Targets targets = Targets::kViewport;
  Shading shading = Shading::kFull;
  std::string shadow_scale = "1";
  std::string particle_scale = kParticlesInFrame;
  std::string focus;                    // as FocusTarget::parse() takes it; empty: none
  std::string dual;                     // as --dual; empty: the output always has the window's size
  std::optional<tools::Jitter> jitter;  // absent: the one that suits the method

  bool compares_methods() const { return compared != kCompareNothing && compared != kCompareTruth; }

  friend bool operator==(const LookSettings&, const LookSettings&) = default;
};

// Switches between an output of the window's size and one that follows the viewport.
inline void switch_dual(LookSettings& look) {
  look.dual = look.dual.empty() ? "auto" : "";
}

// How the user interface comes over the picture; it always has the window's own resolution.
enum class UiDrawing : std::uint8_t {
  kOver,         // drawn over the picture in every frame
  kComposited,   // drawn into a layer of its own, which is then laid over the picture
  kEverySecond,  // the same, and the layer is drawn in every second frame only
};

constexpr int kUiDrawings = 3;

inline const char* name_of(UiDrawing drawing) {
  constexpr const char* kNames[kUiDrawings] = {"over the picture", "composited",
                                               "composited, every 2nd frame"};
  return kNames[static_cast<std::size_t>(drawing)];
}

// A part of the picture, enlarged to whole multiples.
struct ZoomSettings {
  int factor = 1;            // 1, 2, 4 ... kLargestZoom
  Vec2 centre = {.5f, .5f};  // centre of the part, as part of the picture
};

constexpr int kLargestZoom = 32;

struct WindowSettings {
  LookSettings look;
  ResolutionSettings resolution;
  RateSettings rate;
  bool real_time = false;  // the scene goes by the clock; else by equal steps

  bool frozen = false;  // the same frame again and again, with whatever settings
  float split = 0.5f;   // where the split view changes sides, part of the window's width
  ZoomSettings zoom;

  bool show_ui = true;
  bool show_help = false;
  UiDrawing drawing = UiDrawing::kComposited;

  // Wishes, fulfilled once and then taken back.
  bool screenshot = false;
  bool dump = false;
  bool close = false;
  int step = 0;  // frames to go forward or back while frozen

  // The controller `quality` does, in pictures of one size and without a focus; else it chooses the resolution alone.
  bool chooses_method() const {
    return resolution.mode == ResolutionMode::kController && rate.controller == ControllerKind::kQuality &&
           look.focus.empty() && look.dual.empty();
  }
};

}  // namespace quincunx::scenes
