// SPDX-License-Identifier: MIT
// docs/examples/vulkan.cpp, on lavapipe where there is no GPU: its picture is what the library is for.
#include <gtest/gtest.h>

#include <string>

#include "picture_file.h"
#include "program_run.h"

namespace quincunx::testing {
namespace {

std::string picture(const TemporaryFolder& folder, const std::string& scale, const std::string& method) {
  const ProgramResult result =
      run_program(folder, "30 {}/picture.ppm " + scale + " " + method, QUINCUNX_VULKAN_EXAMPLE);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("as a probe has shown"), std::string::npos) << result.out;
  return ppm_texels(read_file(folder.file("picture.ppm")), {960, 540});
}

// Four samples a pixel are the truth. Measured: 191 against 522 codes squared.
TEST(VulkanExample, ItsPictureHasHalfTheErrorOfBilinearAtMost) {
  const TemporaryFolder folder;
  const std::string truth = picture(folder, "2", "bilinear");
  const std::string bilinear = picture(folder, "0.5", "bilinear");
  const std::string temporal = picture(folder, "0.5", "temporal");
  EXPECT_GT(mean_square_error(truth, std::string(truth.size(), '\0')), 1000) << "the picture is black";
  EXPECT_LT(mean_square_error(temporal, truth), 0.5 * mean_square_error(bilinear, truth));
}

}  // namespace
}  // namespace quincunx::testing
