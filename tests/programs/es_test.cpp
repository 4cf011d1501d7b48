// SPDX-License-Identifier: MIT
// The same pictures through OpenGL ES, whatever of its extensions a driver has, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "program_run.h"
#include "skip.h"
#include "tools/image/image_reader.h"

namespace quincunx {
namespace {

using testing::ProgramResult;
using testing::run_program;

// The renderer with a setting of its environment, which Mesa reads and other drivers do not know.
std::string program_with(const std::string& setting) {
  return (setting.empty() ? "" : "env '" + setting + "' ") + QUINCUNX_PROGRAM;
}

class OpenGlEs : public ::testing::Test {
 protected:
  tools::LoadedImage draw(const std::string& options, const std::string& setting = "") {
    const ProgramResult result = run_program(
        folder_, "-q --output 160x90 --frames 3 --scale 0.71 --no-dither --out '{}/f.%04d.png' " + options,
        program_with(setting).c_str());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "") << options;
    auto loaded = tools::read_image(folder_.file("f.0002.png"));
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.ok() ? loaded.value() : tools::LoadedImage();
  }

  // At most one value in 200 by more than two codes: a sample at the very edge of a triangle may fall on its other
  // side.
  void expect_alike(const std::string& scene, const std::string& options, const std::string& setting = "") {
    static std::map<std::string, tools::LoadedImage> desktop;
    if (!desktop.contains(scene)) desktop[scene] = draw(scene);
    const tools::LoadedImage& wanted = desktop[scene];
    const tools::LoadedImage actual = draw(scene + " --gl es3 " + options, setting);
    ASSERT_EQ(wanted.pixels.size(), actual.pixels.size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < wanted.pixels.size(); ++i)
      differ += std::abs(wanted.pixels[i] - actual.pixels[i]) > 2.5f / 255 ? 1 : 0;
    EXPECT_LE(differ, wanted.pixels.size() / 200) << scene << " " << options << setting;
  }

  testing::TemporaryFolder folder_;
};

// Shadows that move, velocity from depth, particles with reactive values, cut-out leaves and mirrored parts; 8-bit
// colour in full and of a checkerboard.
const char* const kScenes[] = {"--scene courtyard", "--scene pan", "--scene particles --method temporal",
                               "--scene wheel --colour rgba8 --blur 0.5",
                               "--scene pan --colour rgba8 --shading checkerboard"};

TEST_F(OpenGlEs, DrawsTheSamePictures) {
  for (const char* scene : kScenes) {
    expect_alike(scene, "--egl-platform surfaceless");
    expect_alike(scene, "--egl-platform device");
  }
}

TEST_F(OpenGlEs, DrawsThemWithoutExtensions) {
  for (const char* scene : kScenes) {
    expect_alike(scene, "",
                 "MESA_EXTENSION_OVERRIDE=-GL_EXT_clip_control -GL_EXT_depth_clamp -GL_EXT_buffer_storage "
                 "-GL_EXT_disjoint_timer_query");
  }
}

TEST_F(OpenGlEs, DrawsThemWithVersion31) {
  for (const char* scene : kScenes)
    expect_alike(scene, "", "MESA_GLES_VERSION_OVERRIDE=3.1");
}

TEST_F(OpenGlEs, RefusesADriverThatLacksTooMuch) {
  if (run_program(folder_, "--list-devices --gl es3").out.find("Mesa") == std::string::npos)
    QUINCUNX_SKIP("the driver is not Mesa");
  const std::string program =
      "env MESA_EXTENSION_OVERRIDE='-GL_EXT_draw_buffers_indexed -GL_OES_draw_buffers_indexed' " +
      program_with("MESA_GLES_VERSION_OVERRIDE=3.1");
  const ProgramResult result = run_program(folder_, "--gl es3 --out '{}/f.png'", program.c_str());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("offers OpenGL ES 3.1 without GL_EXT_draw_buffers_indexed; 3.2 has it"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST_F(OpenGlEs, RefusesOtherVersions) {
  const ProgramResult result = run_program(folder_, "--gl es2 --out '{}/f.png'");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--gl: 'es2' is none of 4.5, es3"), std::string::npos) << result.err;
}

TEST_F(OpenGlEs, TruthIsTheSame) {
  for (const char* api : {"4.5", "es3"}) {
    const ProgramResult result =
        run_program(folder_, std::string("-q --scene wires --output 64x36 --truth 2 --out '{}/") + api +
                                 ".exr' --gl " + api);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  const auto desktop = tools::read_image(folder_.file("4.5.exr"));
  const auto es = tools::read_image(folder_.file("es3.exr"));
  ASSERT_TRUE(desktop.ok() && es.ok());
  double difference = 0;
  for (std::size_t i = 0; i < desktop->pixels.size(); ++i)
    difference += std::abs(double{desktop->pixels[i]} - double{es->pixels[i]});
  EXPECT_LE(difference / static_cast<double>(desktop->pixels.size()), 1e-3);
}

}  // namespace
}  // namespace quincunx
