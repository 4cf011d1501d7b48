// SPDX-License-Identifier: MIT
// Sequence scan: looks at every file of a run before anything is read or written: which frames there are,
// which of them only serve as history, how large they are, and what is wrong with them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/program/frame_pattern.h"
#include "tools/sequence/sequence_input.h"

namespace quincunx::tools {

struct ScannedFrame {
  std::int64_t number = 0;
  bool wanted = false;  // else read as history only
  Extent render = {};
  bool half_colour = true;
  bool background = true;                   // as ChannelPlaces has it
  bool dwa = false;                         // as ChannelPlaces has it
  std::optional<Matrix> world_to_ndc = {};  // as the file has it
  std::optional<Extent> output = {};        // the attribute outputSize
  float pixel_aspect = 1;                   // width over height
  Vec2 jitter = {};
  Vec2 jitter_since = {};    // less that of the frame before, in parts of the picture; 0 after a reset
  Vec2 jitter_until = {};    // the same, less that of the next frame
  bool reset = false;        // nothing of the frame before may be used: a cut, or it is not there
  bool opens = false;        // a shot: what is before, if anything, is no bad frame
  std::string problem = {};  // empty: none; else one sentence that names the file
};

// Frames that are resolved both ways come in windows of this many, by their numbers: any chunks of a sequence
// have the same ones. A backward run adds what it looks ahead, so a larger window costs less time, and more memory.
inline constexpr std::int64_t kWindowFrames = 24;

// The window of a frame's number, below 0 too.
constexpr std::int64_t window_of(std::int64_t number) {
  return (number - (number < 0 ? kWindowFrames - 1 : 0)) / kWindowFrames;
}

// A window of frames, as indices of the good ones.
struct TwoWayWindow {
  std::size_t first = 0;  // the first and the last that are wanted
  std::size_t last = 0;
  std::size_t turn = 0;  // where the backward run begins

  friend bool operator==(const TwoWayWindow&, const TwoWayWindow&) = default;
};

struct SequenceScan {
  std::vector<ScannedFrame> frames;  // to be read, ascending

  std::vector<std::int64_t> wanted() const;   // good or not
  std::vector<std::int64_t> history() const;  // read, but not wanted
  std::vector<std::int64_t> bad() const;
  Extent target() const;      // holds the largest good frame; empty: there is none
  bool half_colour() const;   // for all good frames
  bool background() const;    // for all good frames
  bool has_matrices() const;  // all good frames know worldToNDC
  Status problem() const;     // kIoFailure: the first one and how many more; ok: none
};

// Returns the frames that are asked for when none are named: from the first file of the pattern to the last, without
// gap. Errors: kInvalidArgument as of FramePattern::frames_on_disk(), kIoFailure where there is no file.
Result<std::vector<std::int64_t>> all_frames(const FramePattern& pattern);

// The wanted frames and, before each, up to `warm_up` frames of history as far as the sequence reaches back.
// Ascending. Pure.
std::vector<std::int64_t> with_history(std::span<const std::int64_t> wanted, int warm_up, std::int64_t first);

// `read` and, after each of `asked`, up to `ahead` frames as far as there are files. Ascending.
std::vector<std::int64_t> with_future(const FramePattern& pattern, std::span<const std::int64_t> asked,
                                      std::span<const std::int64_t> read, int ahead);

// The first frame of the sequence at or before `wanted`, which reaches back at most `warm_up` frames.
std::int64_t first_in_reach(const FramePattern& pattern, std::int64_t wanted, int warm_up);

// How many frames a shot's first one knows, where `ahead` are asked for: as many wherever in a window it lies.
constexpr int ahead_of_first(int ahead) {
  return static_cast<int>(kWindowFrames) - 1 + ahead;
}

// The windows with wanted frames, in order. None reaches over a reset, and none looks further ahead than `ahead` frames
// beyond its last place, unless a shot's first frame needs it. Pure.
std::vector<TwoWayWindow> two_way_windows(std::span<const ScannedFrame> good, int ahead);

// Takes away the frames that are more than `ahead` ones beyond the last that is asked for, unless the window where the
// last wanted one's shot begins sees them. Pure.
void drop_unseen(SequenceScan& scan, std::int64_t last_asked, int ahead);

// Reads the headers of `read`, and where their pixels lie, with so many threads. `wanted`: those to be resolved,
// ascending.
SequenceScan scan_sequence(const FramePattern& pattern, const SequenceFormat& format,
                           std::span<const std::int64_t> read, std::span<const std::int64_t> wanted,
                           int threads);

}  // namespace quincunx::tools
