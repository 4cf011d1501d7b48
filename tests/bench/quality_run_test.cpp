// SPDX-License-Identifier: MIT
// The promises of the quality controller on scripted loads, pictures and machines.
#include "bench/traces/trace_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace quincunx::traces {
namespace {

const QualityRun& headline() {
  static const QualityRun run = [] {
    QualityRunSettings settings;
    settings.seeds = {1};
    return run_quality(settings);
  }();
  return run;
}

struct Group {
  std::string traces;
  std::string machine;
};

class Groups : public ::testing::TestWithParam<Group> {
 protected:
  static std::vector<QualityResult> results() {
    std::vector<QualityResult> list;
    for (const QualityResult& result : headline().results) {
      if (result.traces == GetParam().traces && result.machine == GetParam().machine) list.push_back(result);
    }
    return list;
  }
  static QualityResult result_of(const std::string& controller) {
    for (const QualityResult& result : results()) {
      if (result.controller == controller) return result;
    }
    throw std::out_of_range(controller);
  }
};

TEST_P(Groups, QualityIsNearTheOracle) {
  EXPECT_GE(result_of("quality").flip_over_oracle, 1);
  EXPECT_LE(result_of("quality").flip_over_oracle, 1.05);
  EXPECT_LE(result_of("quality, built-in front").flip_over_oracle, 1.2);
}

TEST_P(Groups, QualityErrsLessThanEveryFixedMethod) {
  const double ours = result_of("quality").score.flip;
  for (const QualityResult& result : results()) {
    const bool fixed =
        result.controller.rfind("predictive", 0) == 0 || result.controller.rfind("scale 1", 0) == 0;
    if (fixed) {
      EXPECT_LT(ours, result.score.flip) << result.controller;
    }
  }
}

// 27,840 frames.
TEST_P(Groups, QualityDropsAsFewFramesAsPredictive) {
  EXPECT_LE(result_of("quality").score.dropped, 2);
  EXPECT_LE(result_of("quality, built-in front").score.dropped, 2);
}

TEST_P(Groups, MethodsChangeOnceASecondAtMost) {
  EXPECT_GT(result_of("quality").score.changes_per_second, 0.01);
  EXPECT_LT(result_of("quality").score.changes_per_second, 1);
}

INSTANTIATE_TEST_SUITE_P(All, Groups,
                         ::testing::Values(Group{"development", "strong"}, Group{"development", "weak"},
                                           Group{"held-out", "strong"}, Group{"held-out", "weak"}),
                         [](const auto& group) {
                           return std::string(group.param.traces == "held-out" ? "HeldOut" : "Development") +
                                  (group.param.machine == "weak" ? "Weak" : "Strong");
                         });

TEST(QualityRun, ReportsHoldTheFigures) {
  const nlohmann::json json = nlohmann::json::parse(json_of(headline()));
  ASSERT_EQ(json["results"].size(), headline().results.size());
  EXPECT_EQ(json["results"][0]["controller"], "oracle");
  EXPECT_EQ(json["results"][1]["flip"], headline().results[1].score.flip);
  const std::string csv = csv_of(headline());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<long>(headline().results.size()));
  EXPECT_NE(text_of(headline()).find("held-out traces, weak machine"), std::string::npos);
}

// A trace and a machine of which everything is known beforehand.
class Worked : public ::testing::Test {
 protected:
  Worked() {
    trace_.load.frames.assign(400, {.fixed = 0.2, .scaling = 0.4});
    trace_.content.assign(400, {SceneMix::only(SceneClass::kPan)});
  }
  QualityStage stage() const { return {.trace = &trace_, .machine = &ErrorFront::built_in(), .display = {}}; }
  ResolutionLadder ladder_ =
      ResolutionLadder::create({.output_extent = {64, 64}}).value();  // passes take next to nothing
  ContentTrace trace_;
  static constexpr MethodVariant kPlain = {.method = Method::kBilinear};
};

TEST_F(Worked, AFrameThatFitsErrsAsTheFrontSays) {
  const QualityScore score = replay_fixed(stage(), ladder_, nullptr, kPlain);
  EXPECT_EQ(score.dropped, 0);
  EXPECT_EQ(score.pixels, 1);
  EXPECT_NEAR(score.flip, ErrorFront::built_in().flip(SceneMix::only(SceneClass::kPan), kPlain, 1).value(),
              1e-12);
}

// Every frame takes two refreshes: each second one repeats the picture before.
TEST_F(Worked, ADroppedFrameIsAnError) {
  for (FrameLoad& load : trace_.load.frames)
    load.scaling = 1.5;
  const QualityScore score = replay_fixed(stage(), ladder_, nullptr, kPlain);
  const double flip = ErrorFront::built_in().flip(SceneMix::only(SceneClass::kPan), kPlain, 1).value();
  EXPECT_NEAR(score.dropped, 0.7 * score.frames, 0.01 * score.frames + 1);
  EXPECT_GT(score.flip, flip * 1.2);
}

TEST_F(Worked, TheOracleIsTheLeastOfAllMethods) {
  double least = 1;
  for (const MethodVariant& method : ErrorFront::built_in().methods()) {
    least = std::min(least, ErrorFront::built_in().flip(SceneMix::only(SceneClass::kPan), method, 1).value());
  }
  EXPECT_NEAR(oracle(stage(), ladder_).flip, least, 1e-12);
}

TEST(ContentTraces, AreTheSameOnEveryMachineAndValid) {
  const auto first = content_traces(Split::kHeldOut, 3);
  const auto second = content_traces(Split::kHeldOut, 3);
  ASSERT_EQ(first.size(), 16u);
  for (std::size_t trace = 0; trace < first.size(); ++trace) {
    ASSERT_GE(first[trace].content.size(), first[trace].load.frames.size());
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
      const FrameContent& content = first[trace].content[frame];
      ASSERT_TRUE(content.mix.valid());
      ASSERT_EQ(content.mix.share, second[trace].content[frame].mix.share);
      const SceneMix told_mix = mix_of(told(content, 1, frame));
      ASSERT_TRUE(told_mix.valid());
      for (std::size_t i = 0; i < kSceneClasses; ++i)
        ASSERT_NEAR(told_mix.share[i], content.mix.share[i], 0.26);  // five shares, each .05 wrong at most
    }
  }
}

}  // namespace
}  // namespace quincunx::traces
