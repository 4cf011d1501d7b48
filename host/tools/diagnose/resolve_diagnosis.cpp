// SPDX-License-Identifier: MIT
#include "tools/diagnose/resolve_diagnosis.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "embedded_diagnosis_files.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/page/page.h"
#include "tools/program/atomic_file.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kColourEvery = 4;
constexpr std::int64_t kMostPixels = 24'000'000;  // of all frames, in memory at once

// As it is taken from motion that is read, but in the channels' units.
void take_jitter(std::vector<Vec2>& velocity, const VelocityUnits& units, Extent render, Vec2 step) {
  Vec2 factors[] = {{units.offset.x + 1, units.offset.y + 1}};
  to_velocity(units, render, factors);
  for (Vec2& v : velocity) {
    if (v != Vec2{}) v = {v.x + step.x / factors[0].x, v.y + step.y / factors[0].y};
  }
}

// Returns all channels of all texels; codes as linear light.
std::vector<float> values_of(const RecordedImage& image) {
  const auto read = [&](auto sample, auto&& value_of) {
    std::vector<float> values(image.texels.size() / sizeof sample);
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::memcpy(&sample, image.texels.data() + i * sizeof sample, sizeof sample);
      values[i] = value_of(sample);
    }
    return values;
  };
  if (image.format == PixelFormat::kRGBA16F || image.format == PixelFormat::kRG16F)
    return read(std::uint16_t{}, imath_half_to_float);
  if (image.format == PixelFormat::kRGBA8)
    return read(std::uint8_t{},
                [](std::uint8_t code) { return linear_of_srgb(static_cast<float>(code) / 255); });
  return read(0.0f, [](float value) { return value; });
}

void set_colour(DiagnosedFrame& frame, const std::vector<float>& rgba, bool keeps_colour) {
  frame.luminance.resize(static_cast<std::size_t>(frame.render.area()));
  if (keeps_colour) frame.colour.resize(frame.luminance.size());
  for (std::size_t i = 0; i < frame.luminance.size(); ++i) {
    const float* c = &rgba[4 * i];
    if (keeps_colour) frame.colour[i] = {c[0], c[1], c[2]};
    frame.luminance[i] = .2126f * c[0] + .7152f * c[1] + .0722f * c[2];
  }
}

Result<DiagnosedFrame> read_file(const ResolveTask& task, const ScannedFrame& scanned, bool keeps_colour) {
  SequenceFormat format = task.format;  // the values as they are in the files
  format.units = {.convention = VelocityConvention::kScale, .offset = task.format.units.offset};
  format.depth_kind = DepthKind::kDeviceReversed;
  format.camera = {};
  const std::string path = task.input.expand(scanned.number);
  SequenceFrame read;
  if (Status status = read_frame(path, format, scanned, PixelFormat::kRGBA32F, read); !status.ok())
    return status;
  const auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const auto places = find_channels(path, reader->header(), format.channels);
  if (!places.ok()) return places.status();
  const auto attributes = frame_attributes(path, reader->header(), places->picture_part());
  if (!attributes.ok()) return attributes.status();
  DiagnosedFrame frame = {.number = scanned.number,
                          .index = attributes->index.value_or(scanned.number),
                          .render = scanned.render,
                          .reset = scanned.reset,
                          .jitter = scanned.jitter,
                          .velocity = {read.velocity().begin(), read.velocity().end()},
                          .depth = {read.depth().begin(), read.depth().end()},
                          .world_to_ndc = read.world_to_ndc};
  set_colour(frame, values_of({PixelFormat::kRGBA32F, std::move(read.texels[InputPlane::kColour])}),
             keeps_colour);
  if (task.format.units.jittered)
    take_jitter(frame.velocity, task.format.units, frame.render, scanned.jitter_since);
  return frame;
}

// Recordings: an engine's inputs, whatever its conventions.

// What makes its velocity that of the library.
VelocityUnits recorded_units(const InputConventions& given, const FrameInputs& inputs) {
  Vec2 scale = inputs.velocity_scale == Vec2{} ? Vec2{1, 1} : inputs.velocity_scale;
  const float sign = given.velocity_backward ? -1.0f : 1.0f;
  Vec2 unit = {1, 1};
  if (given.velocity_unit == VelocityUnit::kNdc) unit = {.5f, .5f};
  if (given.velocity_unit == VelocityUnit::kPixels) {
    unit = {1 / static_cast<float>(inputs.render_extent.width),
            1 / static_cast<float>(inputs.render_extent.height)};
  }
  return {.convention = VelocityConvention::kScale,
          .scale = {scale.x * unit.x * sign, scale.y * unit.y * sign * (given.velocity_up ? -1.0f : 1.0f)},
          .jittered = given.velocity_jittered};
}

bool is_reversed(DepthConvention depth) {
  return depth == DepthConvention::kReversedInfinite || depth == DepthConvention::kReversed;
}

DepthKind recorded_kind(DepthConvention depth) {
  if (depth == DepthConvention::kLinear) return DepthKind::kLinear;
  return is_reversed(depth) ? DepthKind::kDeviceReversed : DepthKind::kDevice;
}

// Depth with a far plane as if it had none.
void take_far_plane(std::vector<float>& depth, DepthConvention convention, const FrameInputs& inputs) {
  if (!needs_far_plane(convention)) return;
  const float part = inputs.near_plane / inputs.far_plane;
  for (float& d : depth) {
    const float v = is_reversed(convention) ? d : 1 - d;
    const float endless = v > 0 ? v * (1 - part) + part : 0;
    d = is_reversed(convention) ? endless : 1 - endless;
  }
}

DiagnosedFrame recorded_frame(const ResolveTask& task, const ScannedFrame& scanned, RecordedFrame recorded,
                              bool keeps_colour) {
  const InputConventions& given = task.resolve.conventions;
  const FrameInputs& inputs = recorded.inputs;
  DiagnosedFrame frame = {.number = scanned.number,
                          .index = static_cast<std::int64_t>(inputs.frame_index),
                          .render = inputs.render_extent,
                          .reset = inputs.reset,
                          .jitter = inputs.jitter};
  if (given.origin == Origin::kBottom) frame.jitter.y = -frame.jitter.y;
  for (const RecordedImage& image : recorded[FramePart::kPicture].images) {
    if (image.format == PixelFormat::kR8) continue;
    std::vector<float> values = values_of(image);
    if (image.format == PixelFormat::kR32F) {
      frame.depth = std::move(values);
      take_far_plane(frame.depth, given.depth, inputs);
    } else if (image.format == PixelFormat::kRG16F || image.format == PixelFormat::kRG32F) {
      for (std::size_t i = 0; i < values.size(); i += 2)
        frame.velocity.push_back({values[i], values[i + 1]});
    } else {
      set_colour(frame, values, keeps_colour && image.format != PixelFormat::kRGBA8);
    }
  }
  return frame;
}

// Parts of the picture.
Vec2 jitter_of(const DiagnosedFrame& frame) {
  return {frame.jitter.x / static_cast<float>(frame.render.width),
          frame.jitter.y / static_cast<float>(frame.render.height)};
}

std::string mend_of_recorded(const Finding& finding) {
  static const std::map<std::string, std::string> kMends = {
      {"velocity", "conventions.velocity_unit, _backward, _up or _jittered, or velocity_scale"},
      {"jitter", "the jitter of FrameInputs"},
      {"dilation", "conventions.drawn_velocity"}};
  const auto found = kMends.find(finding.subject);
  return found == kMends.end() ? finding.option : found->second;
}

DiagnosedInput input_of(const ResolveTask& task) {
  const InputConventions& conventions = task.resolve.conventions;
  VelocityUnits units = task.format.units;
  units.offset = {};
  return {.units = units,
          .depth_kind = task.format.depth_kind,
          .depth_range = task.format.depth_range,
          .velocity_offset = task.format.units.offset,
          .camera = task.format.camera,
          .near_plane = task.format.near_plane,
          .output = task.format.output,
          .dilated = conventions.drawn_velocity == DrawnVelocity::kDilated,
          .sky_moves = conventions.sky_motion != SkyMotion::kAsDrawn,
          .channels = task.format.channels[InputPlane::kVelocity]};
}

// What the recording says of its first frame holds for all: `inputs`.
DiagnosedInput input_of_recording(const ResolveTask& task, const FrameInputs& inputs) {
  const InputConventions& given = task.resolve.conventions;
  DiagnosedInput input = input_of(task);
  input.units = recorded_units(given, inputs);
  input.depth_kind = recorded_kind(given.depth);
  if (inputs.near_plane > 0) input.near_plane = inputs.near_plane;
  return input;
}

Status read_recording(const ResolveTask& task, const ScannedFrame& scanned, bool keeps_colour,
                      DiagnosedSequence& sequence) {
  SequenceFrame read;
  if (Status status = read_recorded(task.format.recording, scanned, task.plan, read); !status.ok())
    return status;
  if (sequence.frames.empty()) sequence.input = input_of_recording(task, read.recorded->inputs);
  DiagnosedFrame frame = recorded_frame(task, scanned, std::move(*read.recorded), keeps_colour);
  if (sequence.input.units.jittered && !sequence.frames.empty()) {
    const Vec2 now = jitter_of(frame), before = jitter_of(sequence.frames.back());
    take_jitter(frame.velocity, sequence.input.units, frame.render, {now.x - before.x, now.y - before.y});
  }
  sequence.frames.push_back(std::move(frame));
  return {};
}

// Pictures of all maps, cropped to one size about their middle.
Result<Json> pictures_json(std::span<const FailureMap> maps) {
  constexpr Extent kLargest = {960, 540};
  if (maps.empty()) return Json(nullptr);
  Extent crop = kLargest;
  for (const FailureMap& map : maps)
    crop = {std::min(crop.width, map.extent.width), std::min(crop.height, map.extent.height)};
  Json frames = Json::array();
  for (const FailureMap& map : maps) {
    Json pngs = Json::array();
    const int left = (map.extent.width - crop.width) / 2, top = (map.extent.height - crop.height) / 2;
    for (const std::vector<float>* values : {&map.light, &map.error}) {
      std::vector<std::uint8_t> codes;
      for (int y = top; y < top + crop.height; ++y) {
        const float* row = values->data() + static_cast<std::ptrdiff_t>(y) * map.extent.width + left;
        for (int x = 0; x < crop.width; ++x)
          codes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(row[x], 0.f, 1.f) * 255)));
      }
      const auto png = encode_png(crop, 1, codes);
      if (!png.ok()) return png.status();
      pngs.push_back(base64(png.value()));
    }
    frames.push_back({{"index", map.number}, {"mean", map.mean}, {"pngs", std::move(pngs)}});
  }
  const Extent full = maps.front().extent;
  return Json({{"width", crop.width},
               {"height", crop.height},
               {"x", (full.width - crop.width) / 2},
               {"y", (full.height - crop.height) / 2},
               {"frames", std::move(frames)}});
}

}  // namespace

Result<DiagnosedSequence> read_for_diagnosis(const ResolveTask& task, std::size_t most) {
  if (task.resolve.targets.shading == Shading::kCheckerboard)
    return Status::invalid("frames whose pixels are shaded by halves cannot be diagnosed");
  DiagnosedSequence sequence = {.input = input_of(task)};
  std::int64_t pixels = 0;
  for (const ScannedFrame& scanned : task.scan.frames) {
    if (!scanned.problem.empty() || !scanned.wanted) continue;
    const std::size_t read = sequence.frames.size();
    pixels += scanned.render.area();
    if (read >= most || (pixels > kMostPixels && read >= 4)) break;
    const bool keeps_colour = read % kColourEvery == 0;
    if (!task.format.recording.empty()) {
      if (Status status = read_recording(task, scanned, keeps_colour, sequence); !status.ok()) return status;
      continue;
    }
    auto frame = read_file(task, scanned, keeps_colour);
    if (!frame.ok()) return frame.status();
    sequence.frames.push_back(std::move(frame).value());
  }
  return sequence;
}

Diagnosis diagnose(const ResolveTask& task, const DiagnosedSequence& sequence) {
  Diagnosis diagnosis = diagnose(sequence.frames, sequence.input);
  for (Finding& finding : diagnosis.findings) {
    if (!task.format.recording.empty() && finding.verdict == Verdict::kWrong)
      finding.option = mend_of_recorded(finding);
  }
  return diagnosis;
}

std::string diagnosis_text(std::span<const DiagnosedFrame> frames, const Diagnosis& diagnosis) {
  const auto line = [](const std::string& a, const std::string& b, const std::string& c, const std::string& d,
                       const std::string& e, const std::string& f) {
    const std::string text = fmt::format("{:<16} {:<12} {:<16} {:>8} {:>9} {:>6}", a, b, c, d, e, f);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string text = frames.empty()
                         ? "No frame to look at\n"
                         : fmt::format("Frames {} to {}\n", frames.front().number, frames.back().number);
  text += line("", "", "input says", "margin", "certainty", "share");
  constexpr double kMost = 99;  // standard errors
  for (const Finding& finding : diagnosis.findings) {
    text += line(finding.subject, name_of(finding.verdict), finding.says,
                 finding.margin_db > 0 ? fmt::format("{:.1f} dB", finding.margin_db) : "",
                 finding.margin_db > 0 ? fmt::format("{:.0f} s.e.", std::min(finding.certainty, kMost)) : "",
                 finding.share > 0 ? fmt::format("{:.0f} %", 100 * finding.share) : "");
    if (!finding.fits.empty()) text += fmt::format("{:<16} fits: {}\n", "", finding.fits);
    if (!finding.option.empty()) text += fmt::format("{:<16} mends it: {}\n", "", finding.option);
    if (!finding.open.empty() && finding.verdict != Verdict::kUnknown)
      text += fmt::format("{:<16} not shown by these frames: {}\n", "", fmt::join(finding.open, ", "));
  }
  return text;
}

std::string diagnosis_line(const ResolveTask& task) {
  constexpr std::size_t kFew = 5;
  constexpr std::int64_t kSmall = 400'000;  // pixels
  if (task.scan.frames.size() < kFew || task.scan.target().area() > kSmall) return {};
  const auto sequence = read_for_diagnosis(task, kFew);
  if (!sequence.ok() || sequence->frames.size() < kFew) return {};
  const Diagnosis diagnosis = diagnose(task, sequence.value());
  std::vector<std::string> wrong;
  bool told = false;
  for (const Finding& finding : diagnosis.findings) {
    told |= finding.verdict == Verdict::kRight;
    if (finding.verdict == Verdict::kWrong)
      wrong.push_back(
          fmt::format("{} {} ({})", finding.subject, fmt::join(finding.faults, ", "), finding.option));
  }
  if (!told && wrong.empty()) return {};
  return fmt::format("{} in frames {} to {}",
                     wrong.empty() ? "nothing wrong" : fmt::format("{}", fmt::join(wrong, "; ")),
                     sequence->frames.front().number, sequence->frames.back().number);
}

std::string diagnosis_json(const ResolveTask& task, const Diagnosis& diagnosis) {
  Json findings = Json::array(), jitter = Json::array();
  for (const Finding& finding : diagnosis.findings) {
    findings.push_back({{"subject", finding.subject},
                        {"verdict", name_of(finding.verdict)},
                        {"faults", finding.faults},
                        {"says", finding.says},
                        {"fits", finding.fits},
                        {"not_shown", finding.open},
                        {"margin_db", finding.margin_db},
                        {"certainty", finding.certainty},
                        {"share", finding.share},
                        {"option", finding.option}});
  }
  const std::vector<ScannedFrame>& frames = task.scan.frames;
  for (const ScannedFrame& frame : frames) {
    const auto told = std::find_if(frames.begin(), frames.end(), [&](const ScannedFrame& other) {
      return other.number == frame.number + diagnosis.jitter.later;
    });
    const Vec2 fits = diagnosis.jitter.of(told == frames.end() ? frame.jitter : told->jitter);
    jitter.push_back({{"frame", frame.number}, {"jitter", {fits.x, fits.y}}});
  }
  const Json json = {{"wrong", diagnosis.wrong()}, {"findings", findings}, {"per_frame", jitter}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::string> diagnosis_page(const std::string& input, const std::string& json,
                                   std::span<const FailureMap> maps) {
  auto pictures = pictures_json(maps);
  if (!pictures.ok()) return pictures.status();
  return make_page(
      {.title = "diagnosis", .script = text_of(embedded_diagnosis_files(), "diagnosis.js")},
      {{"input", input}, {"diagnosis", Json::parse(json)}, {"pictures", std::move(pictures).value()}});
}

Status write_diagnosis(const std::string& base, const ResolveTask& task, const DiagnosedSequence& sequence,
                       const Diagnosis& diagnosis) {
  const std::string json = diagnosis_json(task, diagnosis);
  const auto page = diagnosis_page(task.input.text(), json, failure_maps(sequence.frames, sequence.input));
  if (!page.ok()) return page.status();
  if (Status status = write_text(base + ".txt", diagnosis_text(sequence.frames, diagnosis)); !status.ok())
    return status;
  if (Status status = write_text(base + ".json", json); !status.ok()) return status;
  return write_text(base + ".html", page.value());
}

}  // namespace quincunx::tools
