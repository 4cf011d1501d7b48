// SPDX-License-Identifier: MIT
#include "tools/diagnose/resolve_diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {

namespace {

// As it is taken from motion that is read, but in the channels' units.
void take_jitter(std::vector<Vec2>& velocity, const VelocityUnits& units, const ScannedFrame& scanned) {
  Vec2 factors[] = {{1, 1}};
  to_velocity(units, scanned.render, factors);
  for (Vec2& v : velocity) {
    if (v != Vec2{})
      v = {v.x + scanned.jitter_since.x / factors[0].x, v.y + scanned.jitter_since.y / factors[0].y};
  }
}

}  // namespace

DiagnosedInput diagnosed_input(const ResolveTask& task) {
  const InputConventions& conventions = task.resolve.conventions;
  return {.units = task.format.units,
          .depth_kind = task.format.depth_kind,
          .near_plane = task.format.near_plane,
          .output = task.format.output,
          .dilated = conventions.drawn_velocity == DrawnVelocity::kDilated,
          .sky_moves = conventions.sky_motion != SkyMotion::kAsDrawn,
          .channels = task.format.channels.velocity};
}

Result<std::vector<DiagnosedFrame>> read_for_diagnosis(const ResolveTask& task) {
  constexpr std::size_t kEnoughFrames = 16, kColourEvery = 4;
  constexpr std::int64_t kMostPixels = 24'000'000;  // of all frames, in memory at once
  SequenceFormat format = task.format;              // the values as they are in the files
  format.units = {VelocityConvention::kScale, {1, 1}};
  format.depth_kind = DepthKind::kDeviceReversed;
  std::vector<DiagnosedFrame> frames;
  std::int64_t pixels = 0;
  SequenceFrame read;
  for (const ScannedFrame& scanned : task.scan.frames) {
    if (!scanned.problem.empty() || !scanned.wanted) continue;
    pixels += scanned.render.area();
    if (frames.size() >= kEnoughFrames || (pixels > kMostPixels && frames.size() >= 4)) break;
    const std::string path = task.input.expand(scanned.number);
    if (Status status = read_frame(path, format, scanned, PixelFormat::kRGBA32F, read); !status.ok())
      return status;
    const auto reader = ImageReader::open(path);
    if (!reader.ok()) return reader.status();
    const auto attributes = frame_attributes(path, reader->header());
    if (!attributes.ok()) return attributes.status();
    DiagnosedFrame frame = {.number = scanned.number,
                            .index = std::max<std::int64_t>(attributes->index.value_or(scanned.number), 0),
                            .render = scanned.render,
                            .reset = scanned.reset,
                            .jitter = scanned.jitter,
                            .luminance = std::vector<float>(static_cast<std::size_t>(scanned.render.area())),
                            .velocity = read.velocity,
                            .depth = read.depth,
                            .world_to_ndc = read.world_to_ndc};
    if (frames.size() % kColourEvery == 0) frame.colour.resize(frame.luminance.size());
    if (task.format.units.jittered) take_jitter(frame.velocity, task.format.units, scanned);
    for (std::size_t i = 0; i < frame.luminance.size(); ++i) {
      float rgba[4];
      std::memcpy(rgba, read.colour.data() + i * sizeof rgba, sizeof rgba);
      if (!frame.colour.empty()) frame.colour[i] = {rgba[0], rgba[1], rgba[2]};
      frame.luminance[i] = .2126f * rgba[0] + .7152f * rgba[1] + .0722f * rgba[2];
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::string diagnosis_text(std::span<const DiagnosedFrame> frames, const Diagnosis& diagnosis) {
  const auto line = [](const std::string& a, const std::string& b, const std::string& c, const std::string& d,
                       const std::string& e) {
    const std::string text = fmt::format("{:<16} {:<12} {:<16} {:>8} {:>6}", a, b, c, d, e);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string text = frames.empty()
                         ? "No frame to look at\n"
                         : fmt::format("Frames {} to {}\n", frames.front().number, frames.back().number);
  text += line("", "", "input says", "margin", "share");
  for (const Finding& finding : diagnosis.findings) {
    text += line(finding.subject, name_of(finding.verdict), finding.says,
                 finding.margin_db > 0 ? fmt::format("{:.1f} dB", finding.margin_db) : "",
                 finding.share > 0 ? fmt::format("{:.0f} %", 100 * finding.share) : "");
    if (!finding.fits.empty()) text += fmt::format("{:<16} fits: {}\n", "", finding.fits);
    if (!finding.option.empty()) text += fmt::format("{:<16} mends it: {}\n", "", finding.option);
    if (!finding.open.empty() && finding.verdict != Verdict::kUnknown)
      text += fmt::format("{:<16} not shown by these frames: {}\n", "", fmt::join(finding.open, ", "));
  }
  return text;
}

std::string diagnosis_json(const ResolveTask& task, const Diagnosis& diagnosis) {
  using Json = nlohmann::ordered_json;
  Json findings = Json::array(), jitter = Json::array();
  for (const Finding& finding : diagnosis.findings) {
    findings.push_back({{"subject", finding.subject},
                        {"verdict", name_of(finding.verdict)},
                        {"faults", finding.faults},
                        {"says", finding.says},
                        {"fits", finding.fits},
                        {"not_shown", finding.open},
                        {"margin_db", finding.margin_db},
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

}  // namespace quincunx::tools
