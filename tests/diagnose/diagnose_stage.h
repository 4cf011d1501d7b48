// SPDX-License-Identifier: MIT
// Columns before a wall, both textured, under a camera that slides, drawn by one ray a pixel; as frames and as files.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "diagnose_faults.h"
#include "sequence/sequence_fixture.h"
#include "tools/program/jitter.h"

namespace quincunx::testing {

using tools::DiagnosedFrame;
using tools::DiagnosedInput;
using tools::Diagnosis;
using tools::Finding;
using tools::Verdict;

inline constexpr Extent kRender = {160, 90};
inline constexpr Extent kOutput = {320, 180};
inline constexpr float kNear = .1f;

struct Shot {
  int frames = 10;
  std::uint32_t seed = 1;
  bool moves = true;
  bool textured = true;
  bool only_across = false;
  tools::Jitter jitter = tools::Jitter::kHalton;
  float noise = 0;
  bool plate = false;  // coloured; the columns are plain, and so is a plate that moves by itself before them
  bool rods = false;   // in place of the plate, three of little more than a pixel
};

// A smooth pattern with waves from some four pixels on.
inline float texture(std::uint32_t seed, double x, double y, double finest) {
  double sum = 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double angle = 6.2832 * noise(seed, 1, i), phase = 6.2832 * noise(seed, 2, i);
    const double wave = finest * (1 + 3 * noise(seed, 3, i));
    sum += std::sin(6.2832 / wave * (x * std::cos(angle) + y * std::sin(angle)) + phase);
  }
  return static_cast<float>(.4 + .12 * sum);
}

class Stage {
 public:
  explicit Stage(const Shot& shot) : shot_(shot) {}

  Frames frames() const {
    Frames frames;
    for (int n = 0; n < shot_.frames; ++n)
      frames.push_back(frame(n));
    return frames;
  }

 private:
  static constexpr double kFocal = 1.4;  // half the picture's width, at distance 1
  static constexpr double kWall = 10, kColumns = 5, kPlate = 3;
  static constexpr double kPlateMoves = .2;  // a frame

  // Slides, slower and faster.
  Vec2 camera(int n) const {
    if (!shot_.moves) return {};
    const auto t = static_cast<float>(n);
    return {.11f * t + .06f * std::sin(1.1f * t),
            shot_.only_across ? 0 : .07f * t - .05f * std::cos(.9f * t)};
  }

  // From pixels to places at distance 1, y down, and back.
  static double across(double pixel) { return (pixel - kRender.width / 2.0) / (kFocal * kRender.width / 2); }
  static double down(double pixel) { return (pixel - kRender.height / 2.0) / (kFocal * kRender.width / 2); }
  static double pixels(double distance) { return distance * kFocal * kRender.width / 2; }

  DiagnosedFrame frame(int n) const {
    DiagnosedFrame frame = {.number = n + 1, .index = n, .render = kRender};
    frame.jitter = tools::jitter_of(shot_.jitter, n, kRender, kOutput);
    const Vec2 now = camera(n), before = camera(n - 1);
    for (int y = 0; y < kRender.height; ++y) {
      for (int x = 0; x < kRender.width; ++x) {
        const double u = across(x + .5 + frame.jitter.x), v = down(y + .5 + frame.jitter.y);
        const bool column = std::sin(2.2 * (u * kColumns + now.x)) > .3;
        const double plate_x = u * kPlate + now.x - kPlateMoves * n + 1.5;
        const bool within = shot_.rods ? plate_x < 2.1 && std::fmod(plate_x, .7) < .032 : plate_x < 1.2;
        const bool plate = shot_.plate && plate_x > 0 && within && std::abs(v) < .3;
        const double z = plate ? kPlate : column ? kColumns : kWall;
        const double size = z / pixels(1);  // of a pixel there
        float light = .3f;
        if (shot_.plate && (plate || column)) {
          light = plate ? .9f : .05f;
        } else if (shot_.textured)
          light = texture(shot_.seed + (column ? 7 : 0), u * z + now.x, v * z + now.y, 4 * size);
        light += shot_.noise *
                 (noise(static_cast<std::uint32_t>(n), 5, static_cast<std::uint32_t>(y * kRender.width + x)) -
                  .5f);
        frame.luminance.push_back(std::max(light, 0.0f));
        if (shot_.plate) {
          const float blue = std::clamp(light, 0.0f, 1.0f);
          frame.colour.push_back({.9f - .8f * blue, blue, blue});
          frame.luminance.back() = .2126f * (.9f - .8f * blue) + .7874f * blue;
        }
        frame.depth.push_back(static_cast<float>(z));
        // Things move against the camera. As nuke has it: previous - this place, v up.
        const double own = plate ? kPlateMoves : 0;
        frame.velocity.push_back({static_cast<float>(pixels((now.x - before.x - own) / z)),
                                  static_cast<float>(-pixels((now.y - before.y) / z))});
      }
    }
    const auto focal = static_cast<float>(kFocal);
    const float tall = focal * kRender.width / kRender.height;
    frame.world_to_ndc =
        tools::Matrix{focal, 0, 0, 0, 0, -tall, 0, 0, 0, 0, 0, 1, -focal * now.x, tall * now.y, kNear, 0};
    return frame;
  }

  Shot shot_;
};

inline const DiagnosedInput kInput = {.near_plane = kNear, .output = kOutput};

inline Diagnosis diagnosis_of(const Frames& frames) {
  return tools::diagnose(frames, kInput);
}

inline const Finding& finding(const Diagnosis& diagnosis, const std::string& subject) {
  static const Finding kMissing;
  for (const Finding& one : diagnosis.findings)
    if (one.subject == subject) return one;
  ADD_FAILURE() << "no finding about " << subject;
  return kMissing;
}

inline bool is_open(const Finding& one, const std::string& fault) {
  return std::find(one.open.begin(), one.open.end(), fault) != one.open.end();
}

class DiagnoseProgram : public SequenceTest {
 protected:
  void write(const Frames& frames) {
    for (const DiagnosedFrame& frame : frames) {
      std::vector<tools::Channel> channels;
      const auto add = [&](const char* name, const float* data, std::size_t stride) {
        channels.push_back({.name = name,
                            .type = tools::ChannelType::kFloat,
                            .data = data,
                            .pixel_stride = stride,
                            .row_stride = stride * kRender.width,
                            .stored = tools::ChannelType::kFloat});
      };
      for (const char* name : {"R", "G", "B"})
        add(name, frame.luminance.data(), sizeof(float));
      add("backward.u", &frame.velocity[0].x, sizeof(Vec2));
      add("backward.v", &frame.velocity[0].y, sizeof(Vec2));
      add("Z", frame.depth.data(), sizeof(float));
      const std::vector<tools::Attribute> attributes = {
          {"quincunx:jitter", frame.jitter},
          {"quincunx:outputSize",
           Vec2{static_cast<float>(kOutput.width), static_cast<float>(kOutput.height)}},
          {"quincunx:near", kNear},
          {"worldToNDC", *frame.world_to_ndc}};
      const Status status =
          tools::write_exr(input(static_cast<int>(frame.number)), kRender, channels, attributes);
      ASSERT_TRUE(status.ok()) << status.message();
    }
  }

  ProgramResult diagnose(const std::string& arguments) {
    return resolve("'{}/f.%04d.exr' --diagnose " + arguments);
  }
};

}  // namespace quincunx::testing
