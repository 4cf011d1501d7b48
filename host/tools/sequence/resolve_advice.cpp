// SPDX-License-Identifier: MIT
#include "tools/sequence/resolve_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

namespace quincunx::tools {
namespace {

constexpr float kSamePlace = .01f;
constexpr std::size_t kFewPlaces = 3;

// How far a distance is from half a pixel, or one and a half.
float from_half(float distance) {
  return std::abs(distance - std::floor(distance) - .5f);
}

std::string on_motion(const ResolveTask& task) {
  if (task.plan.velocity != VelocitySource::kNone) return {};
  const std::string remedy =
      task.scan.has_matrices() ? "--velocity, or --velocity camera if only the camera moves" : "--velocity";
  if (task.plan.keeps_previous_frame())
    return fmt::format("no motion is known ({}): frames are taken together as if nothing moved", remedy);
  if (task.plan.settings.blur.shutter > 0)
    return fmt::format("no motion is known ({}): nothing is blurred", remedy);
  return {};
}

std::string on_jitter(const ResolveTask& task, const std::vector<ScannedFrame>& frames) {
  const bool reads_history = std::any_of(frames.begin(), frames.end(), [&](const ScannedFrame& frame) {
    return !frame.reset && task.plan.reads_history(frame.render);
  });
  if (!reads_history) return {};
  std::vector<Vec2> jitters;
  for (const ScannedFrame& frame : frames)
    jitters.push_back(frame.jitter);
  const std::string method = name_of(variant_of(task.plan.settings));
  const JitterKind kind = kind_of(jitters);
  if (kind == JitterKind::kNone) {
    return fmt::format(
        "no jitter is known (--jitter): to {} all frames have their samples at the same places, and "
        "together they tell little more than one",
        method);
  }
  if (task.plan.accumulates()) {
    if (kind == JitterKind::kMany || frames.size() < 4) return {};
    return fmt::format(
        "the jitter has but two or three places, which {} has soon seen; render with one of many, as "
        "halton",
        method);
  }
  if (alternates(jitters)) return {};
  return fmt::format(
      "the jitter of most frames is not half a pixel from that of the frame before, as {} wants it; "
      "render with that of quincunx, or say --method temporal",
      method);
}

std::string on_compression(const ResolveTask& task, const std::vector<ScannedFrame>& frames) {
  const auto lossy = std::find_if(frames.begin(), frames.end(), [](const auto& frame) { return frame.dwa; });
  if (lossy == frames.end()) return {};
  const bool data =
      task.format.channels.has(InputPlane::kVelocity) || task.format.channels.has(InputPlane::kDepth);
  return fmt::format("'{}' is compressed with DWA, which loses something of colour{}; render with ZIP",
                     task.input.expand(lossy->number),
                     data ? ", and of motion and depth whose channels end in the letters of colour" : "");
}

// Sizes that nobody planned: not those that the frames ask for.
std::vector<ScannedFrame> sized_by_hand(const ResolveTask& task, std::vector<ScannedFrame> frames) {
  std::erase_if(frames, [&](const ScannedFrame& frame) { return frame.output == task.format.output; });
  return frames;
}

std::string on_shape(const ResolveTask& task, const std::vector<ScannedFrame>& frames) {
  const Extent output = task.format.output;
  for (const ScannedFrame& frame : sized_by_hand(task, frames)) {
    const float aspect = frame.pixel_aspect, made = output_aspect(aspect, frame.render, output);
    if (made == aspect || made == 1) continue;
    const auto size = [&](double wider) {
      const double height =
          output.width * static_cast<double>(frame.render.height) / (frame.render.width * wider);
      return fmt::format("{}x{}", output.width, std::max(std::lround(height), 1L));
    };
    const std::string square = aspect == 1 ? "" : fmt::format(", {} with square pixels", size(aspect));
    return fmt::format(
        "frame {} is {}x{} pixels{} and the output {}x{}: the picture is stretched; {} would keep its "
        "shape{}",
        frame.number, frame.render.width, frame.render.height,
        aspect == 1 ? "" : fmt::format(" of aspect {:.4g}", aspect), output.width, output.height, size(1),
        square);
  }
  return {};
}

std::string on_size(const ResolveTask& task, const std::vector<ScannedFrame>& frames) {
  const Extent output = task.format.output;
  for (const ScannedFrame& frame : sized_by_hand(task, frames)) {
    if (frame.render.width <= output.width && frame.render.height <= output.height) continue;
    return fmt::format("the output, {}x{}, is smaller than frame {}, {}x{}: pixels are thrown away",
                       output.width, output.height, frame.number, frame.render.width, frame.render.height);
  }
  return {};
}

std::string on_attributes(const ResolveTask& task) {
  if (task.format.ignored.empty()) return {};
  return fmt::format(
      "the frames' attribute '{}' does not hold what it would here: it is ignored, as another program's",
      fmt::join(task.format.ignored, "' and '"));
}

// A history that does not reach back to the sequence's first frame, or to a cut, is another one.
std::string on_history(const ResolveTask& task) {
  const auto there = task.input.frames_on_disk();
  if (!task.plan.accumulates() || !there.ok() || there->empty()) return {};
  std::int64_t begin = there->front(), last = begin - 1;
  for (const ScannedFrame& frame : task.scan.frames) {
    if (last + 1 != frame.number)
      begin = frame.number;
    else if (frame.opens)
      begin = there->front();
    last = frame.number;
    if (!frame.wanted || begin <= there->front()) continue;
    const std::int64_t before = frame.number - there->front();
    return fmt::format(
        "frame {} has a history of {} frames, and in a run in one go of {}: its pixels, and later ones, "
        "differ a little; --warm-up {} makes them the same",
        frame.number, frame.number - begin, before, before);
  }
  return {};
}

// Returns the first part of a list ("a, b; c") that another one has not.
std::string difference(const std::string& text, const std::string& other) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= text.size(); ++i) {
    const bool ends = i == text.size() || (text[i] == ' ' && (text[i - 1] == ',' || text[i - 1] == ';'));
    if (!ends) continue;
    const std::string part = text.substr(begin, (i == text.size() ? i : i - 1) - begin);
    if (other.find(part) == std::string::npos) return part;
    begin = i + 1;
  }
  return "nothing";
}

// A chunk of a farm whose frames are read otherwise than those of another one makes a seam.
std::string on_neighbours(const ResolveTask& task) {
  if (!task.output || task.asked.empty()) return {};
  for (const std::int64_t frame : {task.asked.front() - 1, task.asked.back() + 1}) {
    const std::string there = task.output->settings_in(frame), &here = task.output->settings;
    if (there.empty() || there == here) continue;
    return fmt::format("'{}', beside the frames of this run, was made otherwise: '{}' there, '{}' here",
                       task.output->path(frame), difference(there, here), difference(here, there));
  }
  return {};
}

// Whoever names its files one by one reads them as any renderer's.
std::string on_recording(const ResolveTask& task) {
  const std::string folder = std::filesystem::path(task.input.text()).parent_path().string();
  if (!is_recording(folder)) return {};
  return fmt::format("'{}' holds a recording: give the folder alone, and all is as it was recorded", folder);
}

}  // namespace

JitterKind kind_of(std::span<const Vec2> jitters) {
  std::vector<Vec2> places;
  for (const Vec2 jitter : jitters) {
    const bool known = std::any_of(places.begin(), places.end(), [&](Vec2 place) {
      return std::abs(place.x - jitter.x) <= kSamePlace && std::abs(place.y - jitter.y) <= kSamePlace;
    });
    if (!known) places.push_back(jitter);
  }
  if (jitters.size() == 1) return jitters[0] == Vec2{} ? JitterKind::kNone : JitterKind::kFew;
  if (places.size() <= 1) return JitterKind::kNone;
  return places.size() <= kFewPlaces ? JitterKind::kFew : JitterKind::kMany;
}

bool alternates(std::span<const Vec2> jitters) {
  constexpr float kTolerance = .15f;
  std::size_t good = 0;
  for (std::size_t i = 1; i < jitters.size(); ++i) {
    const bool apart = from_half(jitters[i].x - jitters[i - 1].x) <= kTolerance &&
                       from_half(jitters[i].y - jitters[i - 1].y) <= kTolerance;
    good += apart ? 1 : 0;
  }
  return jitters.size() > 1 && 2 * good > jitters.size() - 1;
}

std::vector<Vec2> jitters_about(const FramePattern& pattern, const SequenceFormat& format,
                                std::int64_t number) {
  constexpr std::int64_t kReach = 6;
  std::vector<Vec2> jitters;
  for (std::int64_t n = number - kReach; n <= number + kReach; ++n) {
    const std::string path = pattern.expand(n);
    const auto reader = ImageReader::open(path);
    if (!reader.ok()) continue;
    const auto places = find_channels(path, reader->header(), format.channels);
    const int part = places.ok() ? places->picture_part() : 0;
    const auto attributes = frame_attributes(path, reader->header(), part);
    if (!attributes.ok()) continue;
    const Extent render = reader->header().parts[part].display.extent;
    const auto jitter = format.jitter.at(path, n, attributes.value(), render, format.output);
    if (jitter.ok()) jitters.push_back(jitter.value());
  }
  return jitters;
}

MethodDefault default_method(const SequenceFormat& format, JitterKind jitter,
                             const ResolveSettings& settings) {
  const bool moves = format.motion != MotionSource::kNone;
  if (!moves) return {{.method = Method::kCatmullRom}, "no motion is known, so frames stay apart"};
  const bool needs_depth = format.motion == MotionSource::kCamera ||
                           settings.conventions.sky_motion != SkyMotion::kAsDrawn ||
                           settings.conventions.drawn_velocity == DrawnVelocity::kDilated;
  if (format.channels.has(InputPlane::kDepth) || needs_depth) {
    if (jitter == JitterKind::kNone)
      return {{.method = Method::kQuincunx, .form = TwoFrameForm::kReprojected},
              "motion and depth are known, but no jitter"};
    return {{.method = Method::kTemporal}, "motion, depth and a jitter are known"};
  }
  if (jitter == JitterKind::kNone)
    return {{.method = Method::kCatmullRom}, "neither depth nor a jitter is known"};
  return {{.method = Method::kQuincunx}, "motion and a jitter are known, but no depth"};
}

std::vector<std::string> advice_on(const ResolveTask& task) {
  if (!task.format.recording.empty()) return {};  // what was, was
  std::vector<ScannedFrame> frames = task.scan.frames;
  std::erase_if(frames, [](const ScannedFrame& frame) { return !frame.problem.empty(); });
  if (frames.empty()) return {};
  std::vector<std::string> advice = {
      on_motion(task),        on_jitter(task, frames), on_compression(task, frames),
      on_shape(task, frames), on_size(task, frames),   on_history(task),
      on_neighbours(task),    on_recording(task),      on_attributes(task)};
  std::erase(advice, "");
  return advice;
}

}  // namespace quincunx::tools
