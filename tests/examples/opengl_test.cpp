// SPDX-License-Identifier: MIT
// docs/examples/opengl.cpp on a display of its own: it runs, and its picture is what the library is for.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "picture_file.h"
#include "program_run.h"
#include "skip.h"
#include "xvfb.h"

namespace quincunx::testing {
namespace {

class OpenglExample : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed("Xvfb")) QUINCUNX_SKIP("Xvfb is not installed");
    server_ = std::make_unique<Xvfb>(folder_);
  }

  ProgramResult run(const std::string& arguments) {
    return run_program(
        folder_, arguments,
        ("env -u WAYLAND_DISPLAY DISPLAY=" + server_->name() + " " + QUINCUNX_OPENGL_EXAMPLE).c_str());
  }

  // The texels of the last of 30 frames at a scale.
  std::string picture(const std::string& scale, const std::string& method) {
    const ProgramResult result = run("30 {}/picture.ppm " + scale + " " + method);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ppm_texels(read_file(folder_.file("picture.ppm")), {960, 540});
  }

  TemporaryFolder folder_;
  std::unique_ptr<Xvfb> server_;
};

// Four samples a pixel are the truth. Measured: 102 against 333 codes squared.
TEST_F(OpenglExample, ItsPictureHasHalfTheErrorOfBilinearAtMost) {
  const std::string truth = picture("2", "bilinear");
  const std::string bilinear = picture("0.5", "bilinear");
  const std::string temporal = picture("0.5", "temporal");
  EXPECT_GT(mean_square_error(truth, std::string(truth.size(), '\0')), 1000) << "the picture is black";
  EXPECT_LT(mean_square_error(temporal, truth), 0.5 * mean_square_error(bilinear, truth));
}

TEST_F(OpenglExample, TheControllerChoosesItsViewports) {
  const ProgramResult result = run("30");
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(OpenglExample, WithoutADisplayItSaysSo) {
  server_->close();
  const ProgramResult result = run("1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("GLFW finds no display"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace quincunx::testing
