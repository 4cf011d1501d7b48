// SPDX-License-Identifier: MIT
// MethodChoice: when the method changes, and how. It is told each frame which method would be best, and keeps, changes
// at once or fades.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace quincunx {

class MethodChoice {
 public:
  struct Settings {
    double hysteresis = 0;
    double rest_ms = 0;
    int fade_frames = 0;
  };
  MethodChoice(const Settings& settings, std::size_t first) : settings_(settings), method_(first) {}

  // What is known when the next frame is chosen.
  struct Situation {
    std::uint64_t next_frame = 0;
    double frame_ms = 0;    // between two frames
    std::size_t best = 0;   // of all methods
    double gain = 0;        // part of the present method's error that the best one saves
    bool must = false;      // the present method does not fit, the best one does
    bool held = false;      // the times of this frame are no ground for a change
    bool masked = false;    // motion is so fast that a change is not seen
    bool both_fit = false;  // the present method and the best one in one frame
    bool cut = false;       // a shot has begun
  };
  void advance(const Situation& now);

  std::size_t method() const { return method_; }
  std::optional<std::size_t> fading_from() const { return from_; }
  double weight() const { return weight_; }  // of method(), in (0, 1]

 private:
  bool wants_change(const Situation& now);
  void follow_fade(std::uint64_t next_frame);
  bool young() const;

  Settings settings_;
  std::size_t method_;
  std::optional<std::size_t> from_;
  double weight_ = 1;
  std::uint64_t last_frame_ = 0;
  std::uint64_t fade_start_ = 0;
  double since_change_ms_ = 0;
  std::uint64_t since_cut_ = 0;   // frames
  bool changed_in_shot_ = false;  // while it was young
  std::size_t wanted_ = 0;
  int votes_ = 0;
};

}  // namespace quincunx
