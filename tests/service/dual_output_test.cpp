// SPDX-License-Identifier: MIT
// A dynamic output: the same bits as a fixed one of that size, and a history that survives its changes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

#include "service_fixture.h"
#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;
using testing::Surface;
using testing::TemporalScene;
using Pixels = std::vector<Pixel>;
using Shape = Surface::Shape;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{96, 54};

struct Dual {
  const char* name;
  ResolveSettings settings;
};

class DualOutput : public ::testing::TestWithParam<Dual> {};

// Shown in the size in which it is made, a picture is that of a plan with a fixed output.
TEST_P(DualOutput, AtItsLargestItChangesNoBit) {
  ResolveSettings settings = GetParam().settings;
  ServiceRig fixed({}, settings, kOutput, kTarget);
  settings.output.min_extent = {1, 1};
  ServiceRig dual({}, settings, kOutput, kTarget);
  const bool blurs = settings.blur.shutter > 0;  // then the displayed picture is the blurred one
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    HostFrame frame = testing::random_frame(random, kTarget);
    const Pixels expected = fixed.resolve(frame);
    frame.output = i % 2 == 0 ? kOutput : Extent{};
    const Pixels actual = dual.resolve(frame);
    if (!blurs) {
      ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0) << i;
    }
    ASSERT_EQ(fixed.presented(), dual.presented()) << i;
  }
}

// So is one in a part of a larger allocation.
TEST_P(DualOutput, ASmallerOneHasTheBitsOfAPlanOfThatSize) {
  constexpr Extent kSmall{31, 22};
  ResolveSettings settings = GetParam().settings;
  ServiceRig fixed({}, settings, kSmall, kTarget);
  settings.output.min_extent = {1, 1};
  ServiceRig dual({}, settings, kOutput, kTarget);
  std::mt19937 random(8);
  for (int i = 0; i < 60; ++i) {
    HostFrame frame = testing::random_frame(random, kTarget);
    const Pixels expected = fixed.resolve(frame);
    frame.output = kSmall;
    const FrameReport report = dual.dispatch(dual.upload(frame));
    ASSERT_TRUE(report.ok()) << report.status.message();
    EXPECT_EQ(report.output_extent, kSmall);
    Pixels actual(expected.size());
    const bool blurs = dual.service().plan().blurs();
    const ImageView picture =
        dual.service().picture(blurs ? PictureStage::kBlurred : PictureStage::kResolved);
    ASSERT_TRUE(dual.device().download(picture, kSmall, actual.data()).ok());
    ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0) << i;
  }
}

const Dual kDuals[] = {
    {"bilinear", {.method = Method::kBilinear}},
    {"lanczos3", {.method = Method::kLanczos3}},
    {"noise_offset", {.method = Method::kNoiseOffset}},
    {"velocity", {.method = Method::kQuincunx, .sharpness = .5f}},
    {"reprojected",
     {.method = Method::kQuincunx,
      .quincunx = {.form = TwoFrameForm::kReprojected},
      .blur = {.shutter = .5f}}},
    {"temporal", {.method = Method::kTemporal}},
    {"temporal_fast", {.method = Method::kTemporal, .temporal = {.preset = TemporalPreset::kFast}}},
    {"checkerboard", {.method = Method::kTemporal, .targets = {.shading = Shading::kCheckerboard}}},
};

INSTANTIATE_TEST_SUITE_P(Methods, DualOutput, ::testing::ValuesIn(kDuals),
                         [](const auto& instance) { return instance.param.name; });

TemporalScene scene_of(bool pans) {
  TemporalScene scene;
  const testing::Place motion = pans ? testing::Place(1.37, .41) : testing::Place();
  scene.surfaces = {{.shape = Shape::kDisc,
                     .half_size = 17,
                     .centre = {40, 40},
                     .velocity = motion,
                     .distance = 4,
                     .texture = testing::noise_texture(5, 20)},
                    {.shape = Shape::kRectangle,  // a post, which has two layers of history where it moves
                     .half_size = {.8, 200},
                     .centre = {90, 50},
                     .velocity = 2.0 * motion,
                     .distance = 3,
                     .texture = testing::plain_texture(.9f, .7f, .2f)},
                    {.velocity = motion, .texture = testing::noise_texture(9)}};
  return scene;
}

struct Change {
  const char* name;
  bool pans;
  Extent before, after;
};

// Courses around a change: after it; with either size all the time; with no history after it.
enum Course { kChanged, kAfter, kBefore, kReset, kRuns };

constexpr Extent kSamples{80, 48};
constexpr int kFramesBefore = 32, kFramesAfter = 16;

// Root mean square against truth, tone mapped: of the first frame after the change, and of the last.
struct Errors {
  double first = 0, last = 0;
};

double decibels(double error) {
  return -20 * std::log10(error);
}

Errors errors_of(const Change& change, Course run) {
  const TemporalScene scene = scene_of(change.pans);
  const int phases = testing::halton_phases(scene.output, kSamples);
  ServiceRig rig({.transparents = false}, {.method = Method::kTemporal, .output = {.min_extent = {1, 1}}},
                 scene.output, {160, 96});
  Errors errors;
  for (int i = 0; i < kFramesBefore + kFramesAfter; ++i) {
    HostFrame frame = scene.render(i, kSamples, testing::halton_jitter(i, phases));
    const bool is_after = run == kAfter || (run != kBefore && i >= kFramesBefore);
    frame.output = is_after ? change.after : change.before;
    frame.reset = run == kReset && i == kFramesBefore;
    const double error = std::pow(10, -testing::psnr(rig.resolve(frame), scene.truth(i)) / 20);
    if (i == kFramesBefore) errors.first = error;
    errors.last = error;
  }
  return errors;
}

class ChangeOfOutput : public ::testing::TestWithParam<Change> {};

// The figures are in docs/lab/options.md; QUINCUNX_DUAL_TABLE=1 prints them.
TEST_P(ChangeOfOutput, HistorySurvives) {
  const Change& change = GetParam();
  Errors errors[kRuns];
  for (const Course run : {kChanged, kAfter, kBefore, kReset})
    errors[run] = errors_of(change, run);
  if (std::getenv("QUINCUNX_DUAL_TABLE") != nullptr) {
    fmt::print("| {} |", change.name);
    for (const Course run : {kAfter, kChanged, kReset})
      fmt::print(" {:.2f} |", decibels(errors[run].first));
    for (const Course run : {kAfter, kChanged, kReset})
      fmt::print(" {:.2f} |", decibels(errors[run].last));
    fmt::print("\n");
  }

  // No resized history knows more than both sizes could show. Of the squared error that the history of the worse one
  // saves, at least half is saved.
  const auto squared = [](double error) { return error * error; };
  const double worse = std::max(errors[kBefore].first, errors[kAfter].first);
  EXPECT_LE(squared(errors[kChanged].first), (squared(worse) + squared(errors[kReset].first)) / 2);

  // A history of confidence c is c parts of a pixel's mean, and each frame adds as many as it has samples for a pixel.
  // So of the last picture a part of (c + n)/(c + frames n) is the first one, and the rest what is known since, which
  // the run without history shows. The error of a sum is at most the sum of errors. History is kept in halves, which
  // round each of the frames' values below 1 by at most 2^-12, independently, so by 2^-12/sqrt(3) in the root mean
  // square.
  const double added = static_cast<double>(kSamples.area()) / static_cast<double>(change.after.area());
  const bool grows = change.after.area() > change.before.area();
  const double confidence = grows ? 1 : 8;  // what resize_history leaves at most
  const double part = (confidence + added) / (confidence + kFramesAfter * added);
  const double rounding = 0x1p-12 * std::sqrt(kFramesAfter / 3.0);
  EXPECT_LE(errors[kChanged].last,
            part * errors[kChanged].first + (1 - part) * errors[kReset].last + rounding);
}

const Change kChanges[] = {
    {"still_larger", false, {128, 78}, {160, 96}},     {"still_smaller", false, {160, 96}, {128, 78}},
    {"still_much_larger", false, {80, 48}, {160, 96}}, {"still_much_smaller", false, {160, 96}, {80, 48}},
    {"moving_larger", true, {128, 78}, {160, 96}},     {"moving_smaller", true, {160, 96}, {128, 78}},
    {"moving_much_larger", true, {80, 48}, {160, 96}}, {"moving_much_smaller", true, {160, 96}, {80, 48}},
};

INSTANTIATE_TEST_SUITE_P(Changes, ChangeOfOutput, ::testing::ValuesIn(kChanges),
                         [](const auto& instance) { return instance.param.name; });

TEST(DualPlan, SaysWhatItDoes) {
  ResolveSettings settings{.method = Method::kTemporal, .output_extent = kOutput, .target_extent = kTarget};
  EXPECT_NE(plan_for({}, settings)->explain().find("Output         always 48x27"), std::string::npos);
  settings.output.min_extent = {24, 14};
  const std::string text = plan_for({}, settings)->explain();
  EXPECT_NE(text.find("Output         dynamic: 24x14 to 48x27, shown in 48x27"), std::string::npos) << text;
  for (const char* kernel :
       {"resize_history", "resize_tiles", "resize_layers", "resize_records", "scale_filter"})
    EXPECT_NE(text.find(kernel), std::string::npos) << kernel;
  settings.method = Method::kBilinear;
  EXPECT_EQ(plan_for({}, settings)->explain().find("resize_history"), std::string::npos);
}

TEST(DualPlan, RefusesOutputsOutsideItsRange) {
  ResolveSettings settings{.method = Method::kBilinear, .output_extent = kOutput, .target_extent = kTarget};
  for (const Extent least : {Extent{49, 27}, Extent{48, 0}, Extent{-1, 5}}) {
    settings.output.min_extent = least;
    const auto plan = plan_for({}, settings);
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.status().message().find("settings.output.min_extent is"), std::string::npos);
  }
  const auto refused = [](ServiceRig& rig, Extent output) {
    HostFrame frame;
    frame.render = {9, 9};
    frame.output = output;
    const FrameReport report = rig.dispatch(rig.upload(frame));
    EXPECT_EQ(report.status.code(), StatusCode::kInvalidArgument);
    return std::string(report.status.message());
  };
  ServiceRig fixed({}, {.method = Method::kBilinear}, kOutput, kTarget);
  EXPECT_NE(refused(fixed, {24, 14}).find("output_extent is 24x14; the plan has always 48x27"),
            std::string::npos);
  ServiceRig dual({}, {.method = Method::kBilinear, .output = {.min_extent = {24, 14}}}, kOutput, kTarget);
  EXPECT_NE(
      refused(dual, {23, 20}).find("output_extent is 23x20; it must lie within the plan's 24x14 and 48x27"),
      std::string::npos);
  EXPECT_NE(refused(dual, {49, 20}).find("output_extent is 49x20"), std::string::npos);
}

}  // namespace
}  // namespace quincunx
