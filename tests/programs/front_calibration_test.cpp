// SPDX-License-Identifier: MIT
// quincunx-render --calibrate: what methods err and cost in one scene.
#include "session/calibration.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "program_run.h"
#include "tools/own_cache.h"

namespace quincunx::scenes {
namespace {

using ::quincunx::testing::ProgramResult;
using ::quincunx::testing::read_file;
using ::quincunx::testing::run_program;

TEST(FrontReference, TruthHasAsManySamplesAsThereIsTimeFor) {
  EXPECT_EQ(truth_samples(0.01, 4), 8);  // 64 draws in .64 s
  EXPECT_EQ(truth_samples(0.0625, 4), 8);
  EXPECT_EQ(truth_samples(0.0626, 4), 6);
  EXPECT_EQ(truth_samples(0.2, 4), 4);
  EXPECT_EQ(truth_samples(0.3, 4), 0) << "16 draws take 4.8 s";
  EXPECT_EQ(truth_samples(0.001, 0), 0);
}

TEST(PictureCrop, LiesInTheMiddleAtThePicturesDensity) {
  const PictureCrop crop = PictureCrop::middle_of({1280, 720}, {320, 180});
  EXPECT_EQ(crop.extent, (Extent{320, 180}));
  EXPECT_DOUBLE_EQ(crop.window.size.x, 0.25);
  EXPECT_DOUBLE_EQ(crop.window.size.y, 0.25);
  EXPECT_DOUBLE_EQ(crop.window.corner.x, 480.0 / 1280);
  EXPECT_DOUBLE_EQ(crop.window.corner.y, 270.0 / 720);
  EXPECT_FLOAT_EQ(crop.aspect, 16.f / 9);
  // At a whole pixel, also where what is left over is odd; and never more than there is.
  EXPECT_DOUBLE_EQ(PictureCrop::middle_of({101, 50}, {40, 60}).window.corner.x, 30.0 / 101);
  EXPECT_EQ(PictureCrop::middle_of({101, 50}, {40, 60}).extent, (Extent{40, 50}));
}

// With a cache folder of its own, where fronts are kept.
class FrontCalibrationRun : public ::testing::Test {
 protected:
  ProgramResult run(const std::string& arguments) const { return run_program(folder_, arguments); }

  // The one that is kept.
  ErrorFront kept() const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.file("cache"))) {
      if (entry.path().filename().string().starts_with("front-")) files.push_back(entry.path().string());
    }
    EXPECT_EQ(files.size(), 1u);
    auto front = ErrorFront::from_json(read_file(files.at(0)));
    EXPECT_TRUE(front.ok()) << front.status().message();
    return std::move(front).value();
  }

 private:
  ::quincunx::testing::TemporaryFolder folder_;
  ::quincunx::testing::OwnCache cache_{folder_.file("cache")};
};

constexpr MethodVariant kBilinear = {.method = Method::kBilinear};
constexpr MethodVariant kBest = {.method = Method::kTemporal, .preset = TemporalPreset::kQuality};
constexpr SceneMix kHeld = SceneMix::only(SceneClass::kStill);
constexpr SceneMix kMoving = SceneMix::only(SceneClass::kObjects);

TEST_F(FrontCalibrationRun, KeepsTheScenesFrontAndExplainsIt) {
  EXPECT_NE(run("--explain --scene wheel").out.find("Error front    built in"), std::string::npos);
  const ProgramResult calibrated =
      run("--output 128x72 --scene wheel --calibrate '{}/costs.json' --truth-seconds 3600");
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.err;
  EXPECT_NE(calibrated.out.find("samples a pixel of 128x72 pixels in the middle"), std::string::npos)
      << calibrated.out;
  const ErrorFront front = kept();
  EXPECT_EQ(front.source().scene, "wheel");
  EXPECT_EQ(front.source().output_extent, (Extent{128, 72}));
  ASSERT_EQ(front.methods().size(), front_variants().size());
  for (std::size_t i = 0; i < front_variants().size(); ++i)
    EXPECT_EQ(front.methods()[i], front_variants()[i]);
  EXPECT_EQ(front.points().size(), kSceneClasses * front_variants().size() * 3) << "at 0.5, 0.75 and 1";
  EXPECT_LT(front.flip(kHeld, kBest, 0.5).value(), front.flip(kHeld, kBilinear, 0.5).value());
  EXPECT_LT(front.flip(kHeld, kBest, 0.5).value(), front.flip(kMoving, kBest, 0.5).value());
  EXPECT_LT(front.flip(kMoving, kBilinear, 1).value(), front.flip(kMoving, kBilinear, 0.5).value());
  EXPECT_EQ(front.flip(kMoving, kBest, 0.75), front.flip(SceneMix::only(SceneClass::kPan), kBest, 0.75));

  const std::string own = run("--explain --scene wheel").out;
  EXPECT_NE(own.find("for scene wheel; "), std::string::npos) << own;
  const std::string other = run("--explain --scene chart").out;
  EXPECT_NE(other.find("Error front    built in"), std::string::npos) << other;
}

TEST(FrontCalibration, TheErrorOfWhatMovesIsThatOfTheRest) {
  EXPECT_DOUBLE_EQ(error_of_moving(0.05, 0.03, 0), 0.05) << "nothing stands still";
  EXPECT_DOUBLE_EQ(error_of_moving(0.05, 0.03, 0.5), 0.07) << "half of 0.03 and half of 0.07";
  EXPECT_DOUBLE_EQ(error_of_moving(0.05, 0.05, 0.8), 0.05) << "all errs alike";
  EXPECT_DOUBLE_EQ(error_of_moving(0.05, 0.09, 0.5), 0.025) << "0.01 would be noise";
}

TEST_F(FrontCalibrationRun, WhereTruthIsTooDearTheBestMethodStandsForIt) {
  const ProgramResult calibrated =
      run("--output 64x36 --scene pan --calibrate '{}/costs.json' --truth-seconds 0 --min-scale 1");
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.err;
  const ErrorFront front = kept();
  EXPECT_EQ(front.source().truth,
            "temporal:quality at scale 1 of 64x36 pixels in the middle, as truth takes too long");
  EXPECT_EQ(front.flip(kMoving, kBest, 1), 0) << "it is held against itself";
  EXPECT_GT(front.flip(kMoving, kBilinear, 1).value(), 0);
  EXPECT_EQ(front.points().size(), kSceneClasses * front_variants().size());
}

TEST_F(FrontCalibrationRun, WhatCannotBeMeasuredIsRefused) {
  const ProgramResult alone = run("--scene pan --truth-seconds 2");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("--calibrate"), std::string::npos) << alone.err;
  const ProgramResult tiny = run("--output 8x8 --scene pan --calibrate '{}/costs.json'");
  EXPECT_EQ(tiny.exit_code, 2) << tiny.err;
  EXPECT_NE(tiny.err.find("--calibrate"), std::string::npos) << tiny.err;
}

}  // namespace
}  // namespace quincunx::scenes
