// SPDX-License-Identifier: MIT
// ErrorFront: the measured error of each method's picture at each scale, and the measured cost of the resolve.
//
// A point is one class of scenes, one method and one scale. quincunx-bench --front and quincunx-render --calibrate
// measure points; a built-in table serves until then. A controller that chooses the method as well as the scale needs
// it. All types here are values without clock or device; a const ErrorFront may be used from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/advanced/method.h"
#include "quincunx/status.h"

namespace quincunx {

// Kind of motion or change in a picture that makes methods err differently. docs/control.md says which scenes stand for
// each.
enum class SceneClass : std::uint8_t {
  kStill,    // nothing moves
  kPan,      // the camera moves, everything else stands
  kObjects,  // objects move before others: parts of the picture move apart
  kThin,     // things thinner than four pixels move before something else
  kLight,    // what changes has no velocity: shadows, highlights, particles
  kZoom,     // everything grows or shrinks
};
inline constexpr std::size_t kSceneClasses = 6;
QUINCUNX_API const char* name_of(SceneClass scene_class);  // "still"

// How much of a picture is of each class: at least 0 each, 1 together.
struct SceneMix {
  std::array<double, kSceneClasses> share{};

  static constexpr SceneMix only(SceneClass scene_class) {
    SceneMix mix;
    mix.share[static_cast<std::size_t>(scene_class)] = 1;
    return mix;
  }
  QUINCUNX_API bool valid() const;  // to within 1e-6
};

// Errors are against supersampled truth, exposed and tone mapped, as docs/bench.md defines them. A spread is the
// standard deviation between what a mean was taken over: the scenes of the class, or the frames of one scene.
struct FrontPoint {
  SceneClass scene_class = SceneClass::kStill;
  MethodVariant method = {};
  double scale = 1;  // per axis, in (0, 1]
  double flip = 0;   // mean FLIP, [0, 1]
  double flip_spread = 0;
  double psnr_db = 0;  // at most kMaxPsnr, which stands for no error
  double psnr_spread = 0;
  double ms_per_megapixel = 0;  // time per megapixel of the output: all resolve passes but present, above 0
  double ms_spread = 0;

  static constexpr double kMaxPsnr = 100;
  friend bool operator==(const FrontPoint&, const FrontPoint&) = default;
};

// Where points come from.
struct FrontSource {
  std::string device;    // OpenCL platform and device: "Portable Computing Language pthread-..."
  std::string driver;    // version of the driver
  std::string scene;     // the one scene that it holds for; empty: points of classes, for any scene
  std::string date;      // UTC, "2026-11-22 21:03 UTC"
  std::string command;   // that measured it
  std::string truth;     // what errors are against: "64 samples a pixel"
  Extent output_extent;  // whose resolves were timed

  friend bool operator==(const FrontSource&, const FrontSource&) = default;
};

class QUINCUNX_API ErrorFront {
 public:
  static constexpr int kFormat = 1;  // version of the JSON; a reader refuses others

  // Creates a front of points in any order. Each method needs at least one point in every class, and one at most at a
  // scale of a class. Errors: kInvalidArgument, naming the point.
  static Result<ErrorFront> create(FrontSource source, std::vector<FrontPoint> points);

  // Returns the table that was measured on PoCL and is compiled in. Its errors hold for any device. Its times only
  // order the methods by cost.
  static const ErrorFront& built_in();

  // Convert to JSON text, a line a point, its figures to six significant digits, and back. Errors of from_json():
  // kInvalidArgument for text that to_json() does not write; the message is one sentence that begins with "error front:
  // ".
  std::string to_json() const;
  static Result<ErrorFront> from_json(const std::string& text);

  bool is_built_in() const { return built_in_; }
  const FrontSource& source() const { return source_; }
  std::string summary() const;  // one clause: the source of its figures and their date

  std::span<const FrontPoint> points() const { return points_; }  // by class, method and scale
  // Returns each method once, in the order of growing effort.
  std::span<const MethodVariant> methods() const { return methods_; }

  // Returns the points of a class that no other of it dominates. A point dominates another if its scale (so its cost of
  // drawing), its milliseconds and its FLIP are at most the other's, and one of them is less.
  std::vector<FrontPoint> front(SceneClass scene_class) const;

  // Returns the expected mean FLIP of such a picture, linear between measured scales and constant beyond them; nothing
  // for a method without points, an invalid mix, or a scale that is not above 0.
  std::optional<double> flip(const SceneMix& mix, const MethodVariant& method, double scale) const;

  static constexpr double kMaxMegapixels = 1e-6 * kLargestSide * kLargestSide;
  // Returns the same of the resolve passes' milliseconds, the mean over the classes, for an output of so many
  // megapixels (10^6 pixels), in (0, kMaxMegapixels].
  std::optional<double> resolve_ms(const MethodVariant& method, double scale, double output_megapixels) const;

 private:
  ErrorFront(FrontSource source, std::vector<FrontPoint> points);
  std::span<const FrontPoint> curve(SceneClass scene_class, const MethodVariant& method) const;

  FrontSource source_;
  std::vector<FrontPoint> points_;
  std::vector<MethodVariant> methods_;
  bool built_in_ = false;
};

}  // namespace quincunx
