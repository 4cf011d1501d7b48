// SPDX-License-Identifier: MIT
// quincunx-dump writes a sequence, quincunx-resolve resolves it: the pixels are those that quincunx-render
// makes of the same frames.
#include <gtest/gtest.h>

#include <algorithm>

#include "program_run.h"
#include "tools/image/image_io.h"

namespace quincunx {
namespace {

using testing::ProgramResult;
using testing::run_program;

constexpr int kFrames = 5;

class Exchange : public ::testing::Test {
 protected:
  void run(const char* program, const std::string& arguments) {
    const ProgramResult result = run_program(folder_, "-q " + arguments, program);
    ASSERT_EQ(result.exit_code, 0) << arguments << "\n" << result.err;
  }

  // Files dumped of `scene` go to s/, frames resolved of them to r/, both with `method` and from earlier frames alone,
  // as the renderer does it.
  void dump_and_resolve(const std::string& scene, const std::string& method, const std::string& resolving) {
    run(QUINCUNX_DUMP,
        fmt::format("{} --frames {} --device-depth --sequence '{{}}/s/f.%04d.exr'", scene, kFrames));
    run(QUINCUNX_RESOLVE, fmt::format("'{{}}/s/f.%04d.exr' --two-way 0 {} {}", method, resolving));
  }

  tools::LoadedImage image(const std::string& name) const {
    auto loaded = tools::read_image(folder_.file(name));
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.ok() ? loaded.value() : tools::LoadedImage{};
  }

  std::vector<float> channel(const tools::LoadedImage& image, const std::string& name) const {
    const int index = image.channel(name);
    EXPECT_GE(index, 0) << name;
    std::vector<float> values;
    for (std::size_t i = 0; index >= 0 && i < image.pixels.size(); i += image.channels.size())
      values.push_back(image.pixels[i + static_cast<std::size_t>(index)]);
    return values;
  }

  // The dumped values.
  int reset_of(int index) const {
    const tools::LoadedImage frame = image(fmt::format("s/f.{:04}.exr", index));
    const tools::Attribute* reset = frame.attribute("quincunx:reset");
    EXPECT_NE(reset, nullptr);
    return reset != nullptr ? std::get<int>(reset->value) : -1;
  }

  testing::TemporaryFolder folder_;
};

// Two sizes in turn, motion, reactive values; the history of the last frame is of another size.
const std::string kScene = "--scene particles --output 160x90 --scale-path ramp:0.5,0.8 --seed 3";

TEST_F(Exchange, FloatsComeBackBitForBit) {
  for (const std::string method : {"--method quincunx", "--method bilinear --jitter quincunx",
                                   "--method catmull-rom --jitter quincunx"}) {
    const std::string resolve_method = method.substr(0, method.find(" --jitter"));
    dump_and_resolve(kScene + " " + method, resolve_method, "--out '{}/r/f.%04d.exr' --store float");
    // The stages hold floats.
    run(QUINCUNX_DUMP,
        fmt::format("{} {} --frames {} --frame 4 --stages resolved --format exr --out '{{}}/d'", kScene,
                    method, kFrames));
    const auto drawn = image("d/frame.0004.output.exr");
    const auto resolved = image("r/f.0004.exr");
    ASSERT_EQ(drawn.extent, resolved.extent);
    for (const char* name : {"R", "G", "B", "A"}) {
      EXPECT_TRUE(channel(resolved, name) == channel(drawn, name)) << method << " " << name;
    }
    const auto green = channel(resolved, "G");
    const auto [least, most] = std::minmax_element(green.begin(), green.end());
    EXPECT_LT(*least, *most) << "a picture, not a constant";
  }
}

TEST_F(Exchange, EveryFrameOfTheRendererComesBack) {
  run(QUINCUNX_PROGRAM, fmt::format("{} --frames {} --out '{{}}/f.%04d.exr'", kScene, kFrames));
  dump_and_resolve(kScene, "", "--out '{}/r/f.%04d.exr'");
  for (int index = 0; index < kFrames; ++index) {
    const auto drawn = image(fmt::format("f.{:04}.exr", index));
    const auto resolved = image(fmt::format("r/f.{:04}.exr", index));
    for (const char* name : {"R", "G", "B", "A"})
      EXPECT_TRUE(channel(resolved, name) == channel(drawn, name)) << index << " " << name;
  }
}

// Tone map, dither and motion blur included; blur reads the depth, too.
TEST_F(Exchange, PresentedAndBlurredFramesComeBack) {
  const std::string blur = "--blur 0.5 --exposure 1.5";
  const std::string scene = "--scene wheel --output 160x90 --scale 0.7";
  for (const char* ending : {"png", "exr"}) {
    run(QUINCUNX_PROGRAM,
        fmt::format("{} {} --frames {} --out '{{}}/f.%04d.{}'", scene, blur, kFrames, ending));
    dump_and_resolve(scene, blur, fmt::format("--out '{{}}/r/f.%04d.{}'", ending));
    for (int index = 0; index < kFrames; ++index) {
      const auto drawn = image(fmt::format("f.{:04}.{}", index, ending));
      const auto resolved = image(fmt::format("r/f.{:04}.{}", index, ending));
      for (const char* name : {"R", "G", "B"})
        EXPECT_TRUE(channel(resolved, name) == channel(drawn, name)) << ending << " " << index << " " << name;
    }
  }
  // And the blur was there.
  run(QUINCUNX_RESOLVE, "'{}/s/f.%04d.exr' --two-way 0 --out '{}/sharp.%04d.exr'");
  EXPECT_NE(channel(image("sharp.0004.exr"), "G"), channel(image("r/f.0004.exr"), "G"));
}

// Wheels before a wall: where each sample has the velocity of the nearest of its 3x3 the picture is another, and almost
// what it was once that is said.
TEST_F(Exchange, ADilatedVelocityIsTakenBack) {
  const std::string scene = "--scene wheel --output 160x90 --scale 0.5 --start 1 --jitter halton --frames 12";
  run(QUINCUNX_DUMP, scene + " --sequence '{}/a/f.%04d.exr'");
  run(QUINCUNX_DUMP, scene + " --dilate-velocity --sequence '{}/b/f.%04d.exr'");
  const std::string resolving = " --method temporal --store float --out";
  run(QUINCUNX_RESOLVE, "'{}/a/f.%04d.exr'" + resolving + " '{}/own.%04d.exr'");
  run(QUINCUNX_RESOLVE, "'{}/b/f.%04d.exr'" + resolving + " '{}/kept.%04d.exr'");
  run(QUINCUNX_RESOLVE, "'{}/b/f.%04d.exr' --drawn-velocity dilated" + resolving + " '{}/taken.%04d.exr'");
  const auto own = channel(image("own.0011.exr"), "G");
  const auto error = [&](const std::string& name) {
    const auto other = channel(image(name), "G");
    double sum = 0;
    for (std::size_t i = 0; i < own.size(); ++i)
      sum += static_cast<double>(own[i] - other[i]) * static_cast<double>(own[i] - other[i]);
    return sum;
  };
  EXPECT_LT(error("taken.0011.exr"), .2 * error("kept.0011.exr"));
}

// The first frame of a shot knows nothing of the shot before: it is what a run that begins with it shows.
// Times are sums of powers of two, so that both runs draw the same moment.
TEST_F(Exchange, ACutTravelsWithItsFrame) {
  const std::string scene = "--scene cut --output 160x90 --scale 0.6 --fps 64";
  for (const std::string method : {"--method quincunx:reprojected", "--method temporal --jitter none"}) {
    const std::string resolving = method.substr(0, method.find(" --jitter"));
    const std::string shots = fmt::format("{} {} --start 3.9765625", scene, method);  // 1.5 frames before
    run(QUINCUNX_PROGRAM, fmt::format("{} --frames {} --out '{{}}/f.%04d.exr'", shots, kFrames));
    run(QUINCUNX_PROGRAM,
        fmt::format("{} {} --start 4.0078125 --frames 1 --out '{{}}/first.%04d.exr'", scene, method));
    dump_and_resolve(shots, resolving, "--out '{}/r/f.%04d.exr'");
    EXPECT_EQ(image("f.0002.exr").pixels, image("first.0000.exr").pixels) << method;
    for (int index = 0; index < kFrames; ++index)
      EXPECT_EQ(reset_of(index), index == 0 || index == 2 ? 1 : 0) << index;
    for (const char* name : {"R", "G", "B"})
      EXPECT_TRUE(channel(image("r/f.0002.exr"), name) == channel(image("f.0002.exr"), name)) << method;
    for (const float moved : channel(image("s/f.0002.exr"), "backward.u"))
      ASSERT_EQ(moved, 0) << "at a cut nothing has moved";
  }
}

}  // namespace
}  // namespace quincunx
