// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>

#include "tools/image/display_light.h"
#include "tools/image/image_reader.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/work_queue.h"

namespace quincunx::tools {
namespace {

bool exists(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) || error;  // or the folder does not tell: opening it says why
}

std::string missing_text(const ScannedFrame& frame, const std::string& path) {
  if (frame.wanted) return fmt::format("frame {} is missing: there is no '{}'", frame.number, path);
  return fmt::format(
      "frame {} is missing, the history of the one after it: there is no '{}' (--warm-up 0 starts without)",
      frame.number, path);
}

Status check_size(const std::string& path, Extent extent, const FrameAttributes& attributes) {
  if (extent.width < 1 || extent.height < 1 || extent.width > kLargestSide || extent.height > kLargestSide) {
    return Status::io(fmt::format("'{}' is {}x{} pixels; both sides must lie in [1, {}]", path, extent.width,
                                  extent.height, kLargestSide));
  }
  if (attributes.render && *attributes.render != extent) {
    return Status::io(fmt::format("'{}' is {}x{} pixels, but its attribute 'quincunx:renderSize' says {}x{}",
                                  path, extent.width, extent.height, attributes.render->width,
                                  attributes.render->height));
  }
  return {};
}

Status scan_frame(const std::string& path, const SequenceFormat& format, ScannedFrame& frame) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const auto places = find_channels(path, reader->header(), format.channels);
  if (!places.ok()) return places.status();
  if (format.two_way > 0) {
    const auto next = find_channels(path, reader->header(), backward_format(format).channels);
    if (!next.ok()) return next.status();
  }
  const int part = places->picture_part();
  const auto attributes = frame_attributes(path, reader->header(), part);
  if (!attributes.ok()) return attributes.status();
  frame.render = places->display.extent;
  const auto colour = InputColour::of(path, reader->header().parts[part], format.colour_space);
  if (!colour.ok()) return colour.status();
  frame.half_colour = places->half_colour && colour->is_light();
  frame.background = places->background;
  frame.dwa = places->dwa;
  frame.world_to_ndc = attributes->world_to_ndc;
  frame.output = attributes->output;
  frame.pixel_aspect = reader->header().parts[part].pixel_aspect;
  frame.reset = attributes->reset.value_or(false) ||
                std::binary_search(format.cuts.begin(), format.cuts.end(), frame.number);
  if (Status status = check_size(path, frame.render, attributes.value()); !status.ok()) return status;
  if (format.reactive_files) {
    const auto mask = open_mask(format.reactive_files->expand(frame.number), frame.render, format.view);
    if (!mask.ok()) return mask.status();
  }
  if (Status status = check_whole(path); !status.ok()) return status;
  if (format.needs_camera && !attributes->world_to_ndc) {
    return Status::io(
        fmt::format("'{}' has no attribute 'worldToNDC', which {} needs", path,
                    format.motion == MotionSource::kCamera ? "--velocity camera" : "--sky-motion camera"));
  }
  const auto jitter = format.jitter.at(path, frame.number, attributes.value(), frame.render, format.output);
  if (!jitter.ok()) return jitter.status();
  frame.jitter = jitter.value();
  return {};
}

template <typename Keep>
std::vector<std::int64_t> numbers_of(const std::vector<ScannedFrame>& frames, Keep keep) {
  std::vector<std::int64_t> numbers;
  for (const ScannedFrame& frame : frames) {
    if (keep(frame)) numbers.push_back(frame.number);
  }
  return numbers;
}

// What a shot's first frame asks for, if a window begins with one.
std::int64_t farthest_of_first(const ScannedFrame& begin, int ahead) {
  return begin.opens ? begin.number + ahead_of_first(ahead) : begin.number;
}

template <typename Fact>
bool all_good(const std::vector<ScannedFrame>& frames, Fact ScannedFrame::*fact) {
  return std::all_of(frames.begin(), frames.end(), [&](const ScannedFrame& frame) {
    return static_cast<bool>(frame.*fact) || !frame.problem.empty();
  });
}

std::string camera_problem(const std::string& path, const Matrix& matrix) {
  return fmt::format("'{}' has an attribute 'worldToNDC' {}", path,
                     is_orthographic(matrix)
                         ? "of an orthographic camera that turns, whose motion does not follow from depth; "
                           "render motion, and name it with --velocity"
                         : "that cannot be inverted");
}

}  // namespace

std::vector<std::int64_t> SequenceScan::wanted() const {
  return numbers_of(frames, [](const ScannedFrame& frame) { return frame.wanted; });
}

std::vector<std::int64_t> SequenceScan::history() const {
  return numbers_of(frames, [](const ScannedFrame& frame) { return !frame.wanted; });
}

std::vector<std::int64_t> SequenceScan::bad() const {
  return numbers_of(frames, [](const ScannedFrame& frame) { return !frame.problem.empty(); });
}

Extent SequenceScan::target() const {
  Extent target;
  for (const ScannedFrame& frame : frames) {
    if (!frame.problem.empty()) continue;
    target.width = std::max(target.width, frame.render.width);
    target.height = std::max(target.height, frame.render.height);
  }
  return target;
}

bool SequenceScan::half_colour() const {
  return all_good(frames, &ScannedFrame::half_colour);
}

bool SequenceScan::background() const {
  return all_good(frames, &ScannedFrame::background);
}

bool SequenceScan::has_matrices() const {
  return all_good(frames, &ScannedFrame::world_to_ndc);
}

Status SequenceScan::problem() const {
  const auto first = std::find_if(frames.begin(), frames.end(),
                                  [](const ScannedFrame& frame) { return !frame.problem.empty(); });
  if (first == frames.end()) return {};
  const std::size_t others = bad().size() - 1;
  return Status::io(others == 0 ? first->problem
                                : fmt::format("{}; so have {} more frames their problems: -n lists them",
                                              first->problem, others));
}

Result<std::vector<std::int64_t>> all_frames(const FramePattern& pattern) {
  auto found = pattern.frames_on_disk();
  if (!found.ok()) return found.status();
  if (found->empty()) {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::path(pattern.text()).parent_path();
    std::filesystem::directory_iterator(folder.empty() ? "." : folder, error);
    return Status::io(fmt::format("no file is named as input pattern '{}' has it{}", pattern.text(),
                                  error ? ": " + error.message() : ""));
  }
  if (found->back() - found->front() >= kMostFrames) {
    return Status::io(fmt::format("the files of input pattern '{}' reach from frame {} to {}; say --frames",
                                  pattern.text(), found->front(), found->back()));
  }
  std::vector<std::int64_t> frames;
  for (std::int64_t number = found->front(); number <= found->back(); ++number)
    frames.push_back(number);
  return frames;
}

std::vector<std::int64_t> with_history(std::span<const std::int64_t> wanted, int warm_up,
                                       std::int64_t first) {
  std::vector<std::int64_t> read;
  for (const std::int64_t frame : wanted) {
    const std::int64_t next = read.empty() ? first : read.back() + 1;
    for (std::int64_t number = std::max(frame - warm_up, next); number <= frame; ++number)
      read.push_back(number);
  }
  return read;
}

std::vector<std::int64_t> with_future(const FramePattern& pattern, std::span<const std::int64_t> asked,
                                      std::span<const std::int64_t> read, int ahead) {
  std::set<std::int64_t> all(read.begin(), read.end());
  for (const std::int64_t frame : asked) {
    for (std::int64_t number = frame + 1; number <= frame + ahead; ++number) {
      if (!all.contains(number) && !exists(pattern.expand(number))) break;
      all.insert(number);
    }
  }
  return {all.begin(), all.end()};
}

std::int64_t first_in_reach(const FramePattern& pattern, std::int64_t wanted, int warm_up) {
  const std::int64_t farthest = wanted - warm_up;
  const auto found = pattern.frames_on_disk();
  if (found.ok() && !found->empty()) return std::clamp(found->front(), farthest, wanted);
  std::int64_t first = farthest;
  while (first < wanted && !exists(pattern.expand(first)))
    ++first;
  return first;
}

std::vector<TwoWayWindow> two_way_windows(std::span<const ScannedFrame> good, int ahead) {
  std::vector<TwoWayWindow> windows;
  for (std::size_t begin = 0, end; begin < good.size(); begin = end) {
    const auto follows = [&](std::size_t i) { return i < good.size() && !good[i].reset; };
    std::optional<TwoWayWindow> window;
    for (end = begin;
         end == begin || (follows(end) && window_of(good[end].number) == window_of(good[begin].number));
         ++end) {
      if (!good[end].wanted) continue;
      if (!window) window = TwoWayWindow{end, end, end};
      window->last = end;
    }
    if (!window) continue;
    const std::int64_t farthest = std::max((window_of(good[begin].number) + 1) * kWindowFrames - 1 + ahead,
                                           farthest_of_first(good[begin], ahead));
    for (window->turn = end - 1; follows(window->turn + 1) && good[window->turn + 1].number <= farthest;)
      ++window->turn;
    windows.push_back(*window);
  }
  return windows;
}

void drop_unseen(SequenceScan& scan, std::int64_t last_asked, int ahead) {
  std::vector<ScannedFrame>& frames = scan.frames;
  const auto is_wanted = [](const ScannedFrame& frame) { return frame.wanted; };
  const auto last = std::find_if(frames.rbegin(), frames.rend(), is_wanted);
  if (last == frames.rend()) return;
  const auto begin =
      std::find_if(last, frames.rend(), [](const ScannedFrame& frame) { return frame.reset; }).base() - 1;
  std::int64_t farthest = last_asked + ahead;
  if (window_of(std::find_if(begin, frames.end(), is_wanted)->number) == window_of(begin->number))
    farthest = std::max(farthest, farthest_of_first(*begin, ahead));
  std::erase_if(frames, [farthest](const ScannedFrame& frame) { return frame.number > farthest; });
}

SequenceScan scan_sequence(const FramePattern& pattern, const SequenceFormat& format,
                           std::span<const std::int64_t> read, std::span<const std::int64_t> wanted,
                           int threads) {
  SequenceScan scan;
  for (const std::int64_t number : read)
    scan.frames.push_back(
        {.number = number, .wanted = std::binary_search(wanted.begin(), wanted.end(), number)});
  const auto look_at = [&](std::size_t i) -> Status {
    const std::string path = pattern.expand(scan.frames[i].number);
    return exists(path) ? scan_frame(path, format, scan.frames[i])
                        : Status::io(missing_text(scan.frames[i], path));
  };
  for_each_index(scan.frames.size(), threads, [&](std::size_t i) {
    scan.frames[i].problem = run_job([&] { return look_at(i); }).message();
  });
  for (std::size_t i = 0; i < scan.frames.size(); ++i) {
    ScannedFrame& frame = scan.frames[i];
    const ScannedFrame* before = i > 0 ? &scan.frames[i - 1] : nullptr;
    frame.opens = frame.reset || before == nullptr || before->number + 1 != frame.number;
    frame.reset = frame.opens || !before->problem.empty();
    if (frame.reset) continue;
    if (format.needs_camera && frame.problem.empty()) {
      const Matrix now = to_screen(*frame.world_to_ndc, format.camera);
      if (!camera_motion(now, to_screen(*before->world_to_ndc, format.camera), format.near_plane))
        frame.problem = camera_problem(pattern.expand(frame.number), now);
    }
    const auto parts = [](const ScannedFrame& one) {
      return Vec2{one.jitter.x / static_cast<float>(one.render.width),
                  one.jitter.y / static_cast<float>(one.render.height)};
    };
    const Vec2 now = parts(frame), last = parts(*before);
    frame.jitter_since = {now.x - last.x, now.y - last.y};
    scan.frames[i - 1].jitter_until = {last.x - now.x, last.y - now.y};
  }
  return scan;
}

}  // namespace quincunx::tools
