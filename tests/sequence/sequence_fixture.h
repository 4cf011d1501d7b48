// SPDX-License-Identifier: MIT
// Synthetic sequences: frames of seeded noise that moves, in any size, type and convention, and what comes of
// them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program_run.h"
#include "tools/image/image_io.h"

namespace quincunx::testing {

struct FrameFile {
  Extent extent = {24, 14};
  std::uint32_t seed = 1;
  bool alpha = true;
  bool velocity = true;
  std::vector<std::string> velocity_names = {"backward.u", "backward.v"};
  bool depth = false;
  bool sky = false;  // everywhere: infinitely far away, and drawn without motion
  bool reactive = false;
  tools::ChannelType colour = tools::ChannelType::kHalf;  // in the file
  std::vector<tools::Attribute> attributes;
};

// Values in [0, 1) that depend on nothing but their place.
inline float noise(std::uint32_t seed, std::uint32_t channel, std::uint32_t index) {
  std::uint32_t h = seed * 0x9e3779b9u ^ channel * 0x85ebca6bu ^ index * 0xc2b2ae35u;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return static_cast<float>((h ^ h >> 15) >> 8) * 0x1p-24f;
}

inline std::vector<float> plane(const FrameFile& frame, std::uint32_t channel, float scale, float offset) {
  std::vector<float> values;
  for (std::int64_t i = 0; i < frame.extent.area(); ++i)
    values.push_back(noise(frame.seed, channel, static_cast<std::uint32_t>(i)) * scale + offset);
  return values;
}

// Colour up to 4, a few pixels of motion, distances of 1 to 9.
inline void write_frame(const std::string& path, const FrameFile& frame) {
  std::vector<std::vector<float>> planes;
  std::vector<tools::Channel> channels;
  const auto add = [&](const std::string& name, float scale, float offset, tools::ChannelType stored) {
    planes.push_back(plane(frame, static_cast<std::uint32_t>(planes.size()), scale, offset));
    channels.push_back({.name = name, .type = tools::ChannelType::kFloat, .stored = stored});
  };
  for (const char* name : {"R", "G", "B"})
    add(name, 4, 0, frame.colour);
  if (frame.alpha) add("A", 1, 0, frame.colour);
  if (frame.velocity) {
    for (const std::string& name : frame.velocity_names)
      add(name, frame.sky ? 0 : 2, frame.sky ? 0 : -1, tools::ChannelType::kFloat);
  }
  if (frame.depth) add("Z", frame.sky ? 0 : 8, frame.sky ? 1e10f : 1, tools::ChannelType::kFloat);
  if (frame.reactive) add("reactive.mask", 1, 0, tools::ChannelType::kHalf);
  for (std::size_t i = 0; i < channels.size(); ++i)
    channels[i].data = planes[i].data();
  const Status status = tools::write_exr(path, frame.extent, channels, frame.attributes);
  ASSERT_TRUE(status.ok()) << status.message();
}

inline Vec2 quincunx_jitter(int number) {
  return number % 2 == 0 ? Vec2{-0.25f, -0.25f} : Vec2{0.25f, 0.25f};
}

// A folder with frames f.0001.exr ... and the program that resolves them to u.0001.exr ...
class SequenceTest : public ::testing::Test {
 protected:
  static constexpr Extent kOutput = {34, 20};

  std::string input(int number) const { return folder_.file(fmt::format("f.{:04}.exr", number)); }
  std::string output(int number, const std::string& name = "u") const {
    return folder_.file(fmt::format("{}.{:04}.exr", name, number));
  }

  static FrameFile frame(int number) {
    FrameFile file;
    file.seed = static_cast<std::uint32_t>(number);
    file.attributes = {{"quincunx:jitter", quincunx_jitter(number)},
                       {"quincunx:outputSize", Vec2{kOutput.width, kOutput.height}}};
    return file;
  }

  void write_frames(int first, int last) {
    for (int number = first; number <= last; ++number)
      write_frame(input(number), frame(number));
  }

  ProgramResult resolve(const std::string& arguments) { return run_program(folder_, arguments); }

  // From f to `name`, with more arguments; it must succeed.
  void resolve_to(const std::string& name, const std::string& arguments) {
    const ProgramResult result =
        resolve(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/{}.%04d.exr' -q {}", name, arguments));
    ASSERT_EQ(result.exit_code, 0) << arguments << "\n" << result.err;
  }

  // One line on stderr that holds `part`, this exit code, nothing on stdout, and no file more than before.
  void expect_refused(const std::string& arguments, int code, const std::string& part) {
    const int before = files();
    const ProgramResult result = resolve(arguments);
    EXPECT_EQ(result.exit_code, code) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(files(), before) << arguments;
  }

  // But for what run_program() captures.
  int files() const {
    int count = folder_.entries();
    for (const char* name : {"stdout", "stderr"})
      count -= std::filesystem::exists(folder_.file(name)) ? 1 : 0;
    return count;
  }

  tools::LoadedImage image(const std::string& path) const {
    auto loaded = tools::read_image(path);
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.ok() ? loaded.value() : tools::LoadedImage{};
  }

  TemporaryFolder folder_;
};

}  // namespace quincunx::testing
