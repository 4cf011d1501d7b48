// SPDX-License-Identifier: MIT
// The frames of a run before they are drawn: what each is (FrameSequence: time, viewport, jitter, texture bias), the
// render scale that is wanted in each (ScalePath), and the output's resolution where that changes, too (OutputPath).
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "quincunx/advanced/extent.h"
#include "quincunx/control/dynamic_viewport.h"
#include "quincunx/control/output_follower.h"
#include "quincunx/status.h"
#include "render/renderer.h"
#include "tools/program/jitter.h"

namespace quincunx::scenes {

// The render scale wanted in each frame of a sequence. Pure: the same path, seed and frame give the same scale. A
// value; thread-safe.
class ScalePath {
 public:
  // Makes a path with the same scale in every frame, per axis.
  static Result<ScalePath> fixed(Vec2 scale);

  // "sweep": 0.5 -> 1 over the first half, then -> 0.71; "sweep:A,B,C": the same with these scales.
  // "ramp": 0.5 -> 1; "ramp:A,B". "random": uniform in [0.5, 1] on each axis in every frame; "random:A,B".
  // Errors: kInvalidArgument for another name, a scale outside [0.01, 2], or a wrong number of them.
  static Result<ScalePath> parse(const std::string& text, std::uint64_t seed);

  // Scale of frame `index` of `count`, 0 <= index < count.
  Vec2 at(std::int64_t index, std::int64_t count) const;

  float largest() const;  // the largest scale on either axis

 private:
  enum class Kind : std::uint8_t { kFixed, kSweep, kRamp, kRandom };

  Kind kind_ = Kind::kFixed;
  float a_ = 1;
  float b_ = 1;
  float c_ = 1;
  std::uint64_t seed_ = 0;
};

// The output's resolution in each frame of a sequence, where it is dynamic, too ("dual"). Pure but for what it
// remembers of earlier frames; one thread.
class OutputPath {
 public:
  // "auto": as OutputFollower has it; "random": each axis at random from half of the display's on, another one in every
  // frame; a number in [0.1, 1]: that scale of the display in every frame. Errors: kInvalidArgument, naming --dual.
  static Result<OutputPath> parse(const std::string& text, Extent display, std::uint64_t seed);

  // Returns the output of the next frame, which is drawn at `render`.
  Extent next(Extent render);

  Extent min_output() const;  // the smallest there may be

 private:
  OutputPath(Extent display, std::uint64_t seed) : display_(display), random_(seed) {}

  Extent display_;
  std::optional<Extent> fixed_;
  std::optional<OutputFollower> follower_;
  std::mt19937_64 random_;
};

using tools::Jitter;
using tools::jitter_of;

// How much sharper textures are sampled than a pixel of one frame alone would bear.
struct TextureDetail {
  float lod_bias = 0;       // levels
  float follows_scale = 0;  // this times texture_lod_bias() is added; from 0 to 1 while a method fades

  friend auto operator<=>(const TextureDetail&, const TextureDetail&) = default;
};

struct SequenceSettings {
  Extent output;
  ScalePath scale_path;
  std::optional<OutputPath> outputs;  // absent: always `output`
  Jitter jitter = Jitter::kNone;
  Shading shading = Shading::kFull;
  std::int64_t frames = 1;
  double fps = 60;
  double start_seconds = 0;  // scene time of frame 0
  TextureDetail detail = {};
  bool backwards =
      false;  // frame 0 is the last one, and time runs back from there; one scale, no checkerboard
};

// Pure but for the viewport it holds; one thread.
class FrameSequence {
 public:
  // Errors: kInvalidArgument for an empty output, no frames, or a rate that is not a positive number.
  static Result<FrameSequence> create(const SequenceSettings& settings);

  std::int64_t size() const { return settings_.frames; }
  Extent target() const { return viewport_.target(); }  // holds the largest viewport
  Extent output() const { return settings_.output; }

  // From the next frame on.
  void set_sampling(Jitter jitter, TextureDetail detail) {
    settings_.jitter = jitter;
    settings_.detail = detail;
  }

  // Frame `index` in [0, size()). Its previous_seconds is one frame earlier (backwards: later), also for frame 0.
  FrameView at(std::int64_t index);

  // Returns the same at another viewport than the path's, within the target, and for any index that is not negative.
  FrameView at(std::int64_t index, Extent render);

 private:
  FrameSequence(const SequenceSettings& settings, const DynamicViewport& viewport)
      : settings_(settings), viewport_(viewport) {}

  SequenceSettings settings_;
  DynamicViewport viewport_;
};

}  // namespace quincunx::scenes
