// SPDX-License-Identifier: MIT
// Every method on a second OpenCL, rusticl: it compiles all kernels that the renderer asks for, and makes the pictures
// that PoCL makes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include "program_run.h"
#include "quincunx/advanced/method.h"
#include "skip.h"
#include "tools/image/image_reader.h"

namespace quincunx {
namespace {

namespace fs = std::filesystem;
using testing::ProgramResult;
using testing::run_program;

class SecondOpenCl : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::string_view(QUINCUNX_RUSTICL_ICD).empty())
      QUINCUNX_SKIP("rusticl is not installed; install the package mesa-opencl-icd");
    // A folder with this driver alone; kernels that it has compiled are kept for the next method.
    fs::create_directory(folder_.file("drivers"));
    fs::copy_file(QUINCUNX_RUSTICL_ICD, folder_.file("drivers/rusticl.icd"));
    rusticl_ = "env RUSTICL_ENABLE=llvmpipe OCL_ICD_VENDORS=" + folder_.file("drivers/") +
               " MESA_SHADER_CACHE_DIR=" + folder_.file("cache ") + QUINCUNX_PROGRAM;
  }

  tools::LoadedImage draw(const std::string& program, const std::string& options) {
    const ProgramResult result = run_program(
        folder_, "-q --output 160x90 --frames 4 --scale 0.71 --no-dither --out '{}/f.%04d.png' " + options,
        program.c_str());
    EXPECT_EQ(result.exit_code, 0) << options << ": " << result.err;
    auto loaded = tools::read_image(folder_.file("f.0003.png"));
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.ok() ? loaded.value() : tools::LoadedImage();
  }

  // At most one value in 1000 by more than a code: a rounding may turn a decision of the temporal upscaler.
  void expect_alike(const std::string& options) {
    const tools::LoadedImage wanted = draw(QUINCUNX_PROGRAM, options), actual = draw(rusticl_, options);
    ASSERT_EQ(wanted.pixels.size(), actual.pixels.size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < wanted.pixels.size(); ++i)
      differ += std::abs(wanted.pixels[i] - actual.pixels[i]) > 1.5f / 255 ? 1 : 0;
    EXPECT_LE(differ, wanted.pixels.size() / 1000) << options;
  }

  testing::TemporaryFolder folder_;
  std::string rusticl_;
};

TEST_F(SecondOpenCl, MakesTheSamePictures) {
  for (const VariantInfo& variant : all_variants())
    expect_alike("--scene wires --method " + variant.name);
  expect_alike("--scene wires --shading checkerboard");
  expect_alike("--scene wires --blur 0.5");
}

}  // namespace
}  // namespace quincunx
