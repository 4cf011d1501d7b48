// SPDX-License-Identifier: MIT
// quincunx-render --why: three places of a scene by three methods, beside truth.
#include "session/why_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "program_run.h"
#include "tools/image/image_io.h"

namespace quincunx::scenes {
namespace {

using ::quincunx::testing::ProgramResult;
using ::quincunx::testing::run_program;

TEST(LargestParts, AreFoundFromTheLargestDownAndApart) {
  std::vector<float> values(40 * 20, 0.f);
  const auto set = [&](int x, int y, float value) { values[static_cast<std::size_t>(y) * 40 + x] = value; };
  set(3, 3, 2.f);
  set(6, 3, 1.f);  // a part about it would overlap the last one's
  set(39, 19, 4.f);
  set(20, 10, 1.5f);
  const auto parts = largest_parts({40, 20}, values, {4, 4}, 3);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0], (Place{36, 16})) << "in the corner, and within the picture";
  EXPECT_EQ(parts[1], (Place{3, 0})) << "both points are in it; the first such part counts";
  EXPECT_EQ(parts[2], (Place{17, 7}));
}

TEST(LargestParts, AreAsManyAsFit) {
  const std::vector<float> values(20 * 10, 0.f);
  EXPECT_EQ(largest_parts({20, 10}, values, {20, 10}, 3), (std::vector<Place>{{0, 0}}));
  EXPECT_EQ(largest_parts({20, 10}, values, {10, 10}, 3), (std::vector<Place>{{0, 0}, {10, 0}}));
}

class Why : public ::testing::Test {
 protected:
  ProgramResult run(const std::string& arguments) const { return run_program(folder_, arguments); }
  ::quincunx::testing::TemporaryFolder folder_;
};

// Four columns of 320 pixels with gaps of 20 and margins of 40; the parts are 80x60 pixels, 4 times as large.
TEST_F(Why, ShowsThreePlacesInFourColumns) {
  const ProgramResult result = run("-q --output 320x180 --scene wires --why '{}/why.png'");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "") << "quiet means quiet";
  const auto image = tools::read_image(folder_.file("why.png"));
  ASSERT_TRUE(image.ok()) << image.status().message();
  EXPECT_EQ(image->extent, (Extent{2 * 40 + 4 * 320 + 3 * 20, 2 * 40 + 86 + 3 * (240 + 4 + 38) + 2 * 20}));
  // Bilinear's bars are whole; temporal has the smallest error in each place, as bars tell: the accent's red is 232.
  for (int row = 0; row < 3; ++row) {
    int length[3] = {};
    for (int column = 0; column < 3; ++column) {
      for (int x = 0; x < 320; ++x) {
        const float red = image->at(40 + column * 340 + x, 40 + 86 + row * (240 + 4 + 38 + 20) + 242, 0);
        length[column] += std::abs(red * 255 - 232) < 1 ? 1 : 0;
      }
    }
    EXPECT_EQ(length[0], 320);
    EXPECT_LT(length[2], 320);
    EXPECT_GT(length[2], 0);
    EXPECT_LT(length[2], length[1]);
  }
}

TEST_F(Why, NamesWhatDoesNotFit) {
  const auto refused = [&](const std::string& arguments, int code, const std::string& words) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << arguments;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  refused("--why '{}/why.png' --output 10x40", 2,
          "--why needs an output of at least 11x11 pixels; this is 10x40");
  refused("--why '{}/why.png' --scale 0.5,0.4", 2, "--why takes one --scale for both axes, not '0.5,0.4'");
  refused("--why '{}/why.png' --scale 3", 2, "3");
  refused("--why /proc/none/why.png", 1, "/proc/none");
  refused("--why '{}/why.png' --method temporal", 2, "--why");
  refused("--why '{}/why.png' --window", 2, "--why");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("why.png")));
}

}  // namespace
}  // namespace quincunx::scenes
