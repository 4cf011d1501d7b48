// SPDX-License-Identifier: MIT
#include "method_choice.h"

#include <algorithm>

namespace quincunx {
namespace {

constexpr std::uint64_t kYoungFrames = 12;  // of a shot, in which history is worth little
constexpr int kVotes = 4;                   // frames in a row that want the same method
constexpr int kVotesYoung = 2;

}  // namespace

bool MethodChoice::young() const {
  return since_cut_ < kYoungFrames && !changed_in_shot_;
}

bool MethodChoice::wants_change(const Situation& now) {
  const bool wants = now.best != method_ && (now.must || now.gain > settings_.hysteresis);
  votes_ = !wants || now.held ? 0 : now.best == wanted_ ? votes_ + 1 : 1;
  wanted_ = now.best;
  if (votes_ < (young() ? kVotesYoung : kVotes)) return false;
  return now.must || young() || since_change_ms_ >= settings_.rest_ms;
}

void MethodChoice::follow_fade(std::uint64_t next_frame) {
  const double done = static_cast<double>(next_frame - fade_start_ + 1) / (settings_.fade_frames + 1.0);
  weight_ = std::min(1.0, done);
  if (weight_ == 1) from_.reset();
}

void MethodChoice::advance(const Situation& now) {
  const std::uint64_t frames = now.next_frame - std::min(now.next_frame, last_frame_);
  last_frame_ = now.next_frame;
  since_change_ms_ += static_cast<double>(frames) * now.frame_ms;
  since_cut_ += frames;
  if (now.cut) {
    since_cut_ = 0;
    changed_in_shot_ = false;
    from_.reset();
    weight_ = 1;
  }
  if (from_) return follow_fade(now.next_frame);
  if (!wants_change(now)) return;
  const bool fades = settings_.fade_frames > 0 && !young() && !now.masked && now.both_fit;
  changed_in_shot_ = changed_in_shot_ || young();
  since_change_ms_ = 0;
  votes_ = 0;
  if (fades) {
    from_ = method_;
    fade_start_ = now.next_frame;
  }
  method_ = now.best;
  if (fades) follow_fade(now.next_frame);
}

}  // namespace quincunx
