// SPDX-License-Identifier: MIT
#include "frames/frame_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace quincunx::scenes {
namespace {

SequenceSettings settings(const std::string& path = "sweep") {
  SequenceSettings result;
  result.output = {1280, 720};
  result.scale_path = ScalePath::parse(path, 0).value();
  result.jitter = Jitter::kQuincunx;
  result.frames = 240;
  return result;
}

TEST(FrameSequence, TimeGoesByTheFrameRate) {
  FrameSequence sequence = FrameSequence::create(settings()).value();
  EXPECT_DOUBLE_EQ(sequence.at(0).seconds, 0);
  EXPECT_DOUBLE_EQ(sequence.at(30).seconds, 0.5);
  EXPECT_DOUBLE_EQ(sequence.at(30).previous_seconds, 29.0 / 60);
  EXPECT_DOUBLE_EQ(sequence.at(0).previous_seconds, -1.0 / 60);
}

TEST(FrameSequence, BackwardsItHasTheSameFramesFromTheLastOneOn) {
  SequenceSettings both = settings("ramp:0.5,0.5");
  both.jitter = Jitter::kHalton;
  FrameSequence forwards = FrameSequence::create(both).value();
  both.backwards = true;
  FrameSequence backwards = FrameSequence::create(both).value();
  for (const int index : {0, 1, 100, 239}) {
    const FrameView view = backwards.at(index), same = forwards.at(239 - index);
    EXPECT_DOUBLE_EQ(view.seconds, same.seconds);
    EXPECT_EQ(view.jitter, same.jitter);
    EXPECT_DOUBLE_EQ(view.previous_seconds, same.seconds + 1.0 / 60);
  }
}

TEST(FrameSequence, ACheckerboardAlternatesAndItsPairsShareALongJitter) {
  SequenceSettings whole = settings();
  whole.scale_path = ScalePath::fixed({1, 1}).value();
  whole.jitter = Jitter::kHalton;
  SequenceSettings half = whole;
  half.shading = Shading::kCheckerboard;
  FrameSequence frames = FrameSequence::create(whole).value(), halves = FrameSequence::create(half).value();
  for (int i = 0; i < 8; ++i) {
    EXPECT_FALSE(frames.at(i).parity);
    EXPECT_EQ(halves.at(i).parity, i % 2);
    EXPECT_EQ(halves.at(i).jitter, frames.at(i / 2).jitter) << i;
  }
}

TEST(FrameSequence, AViewportOfTheLadderAndTheAspectOfThePicture) {
  FrameSequence sequence = FrameSequence::create(settings()).value();
  EXPECT_EQ(sequence.at(0).render, (Extent{640, 360}));
  EXPECT_EQ(sequence.at(239).render, (Extent{908, 512}));
  EXPECT_FLOAT_EQ(sequence.at(239).aspect, 1280.0f / 720);
  EXPECT_EQ(sequence.target(), (Extent{1280, 720}));
  EXPECT_EQ(FrameSequence::create(settings("ramp:0.5,1.5")).value().target(), (Extent{1920, 1080}));
}

TEST(FrameSequence, TextureDetailFollowsTheScaleOfEachFrame) {
  SequenceSettings fixed = settings(), following = settings();
  fixed.detail = {.lod_bias = -0.5f};
  following.detail = {.follows_scale = 1};
  FrameSequence same = FrameSequence::create(fixed).value(), other = FrameSequence::create(following).value();
  for (const Extent render : {Extent{640, 360}, {1280, 720}, {1280, 180}}) {
    EXPECT_EQ(same.at(0, render).lod_bias, -0.5f);
    EXPECT_EQ(other.at(0, render).lod_bias, texture_lod_bias(render, {1280, 720}));
  }
}

TEST(FrameSequence, AnotherViewportThanThePaths) {
  FrameSequence sequence = FrameSequence::create(settings()).value();
  const FrameView view = sequence.at(30, {1001, 555});
  EXPECT_EQ(view.render, (Extent{1001, 555}));
  EXPECT_EQ(view.seconds, 0.5);
  EXPECT_EQ(sequence.at(0).render, (Extent{640, 360})) << "the path is as it was";
}

TEST(FrameSequence, QuincunxJitterIsSymmetricAndAlternates) {
  for (std::int64_t index = 0; index < 10; ++index) {
    const Vec2 now = jitter_of(Jitter::kQuincunx, index, {1, 1}, {1, 1});
    const Vec2 next = jitter_of(Jitter::kQuincunx, index + 1, {1, 1}, {1, 1});
    EXPECT_EQ(now.x + next.x, 0);
    EXPECT_EQ(std::abs(now.x - next.x), 0.5f) << "half a pixel apart";
    EXPECT_EQ(now.x, now.y);
  }
}

TEST(FrameSequence, QuincunxHalfIsHalfAPixelApart) {
  EXPECT_EQ(jitter_of(Jitter::kQuincunxHalf, 6, {1, 1}, {1, 1}), (Vec2{0, 0}));
  EXPECT_EQ(jitter_of(Jitter::kQuincunxHalf, 7, {1, 1}, {1, 1}), (Vec2{0.5f, 0.5f}));
}

TEST(FrameSequence, HaltonIsTheLibrarys) {
  for (std::int64_t index = 0; index < 50; ++index)
    EXPECT_EQ(jitter_of(Jitter::kHalton, index, {640, 360}, {1280, 720}),
              jitter(static_cast<std::uint64_t>(index), {640, 360}, {1280, 720}));
}

TEST(FrameSequence, BadSettingsAreNamed) {
  const auto message = [](SequenceSettings bad) { return FrameSequence::create(bad).status().message(); };
  SequenceSettings bad = settings();
  bad.frames = 0;
  EXPECT_NE(message(bad).find("frames"), std::string::npos);
  bad = settings();
  bad.fps = 0;
  EXPECT_NE(message(bad).find("fps"), std::string::npos);
  bad = settings();
  bad.output = {0, 0};
  EXPECT_NE(message(bad).find("output"), std::string::npos);
}

ScalePath path(const std::string& text, std::uint64_t seed = 0) {
  auto result = ScalePath::parse(text, seed);
  EXPECT_TRUE(result.ok()) << result.status().message();
  return result.value();
}

TEST(ScalePath, SweepGoesUpAndDown) {
  const ScalePath sweep = path("sweep");
  EXPECT_FLOAT_EQ(sweep.at(0, 241).x, 0.5f);
  EXPECT_FLOAT_EQ(sweep.at(60, 241).x, 0.75f);
  EXPECT_FLOAT_EQ(sweep.at(120, 241).x, 1.0f);
  EXPECT_FLOAT_EQ(sweep.at(240, 241).y, 0.71f);
  EXPECT_FLOAT_EQ(sweep.largest(), 1.0f);
}

TEST(ScalePath, RampIsLinear) {
  const ScalePath ramp = path("ramp:2,0.5");
  EXPECT_FLOAT_EQ(ramp.at(0, 4).x, 2.0f);
  EXPECT_FLOAT_EQ(ramp.at(1, 4).x, 1.5f);
  EXPECT_FLOAT_EQ(ramp.at(3, 4).x, 0.5f);
  EXPECT_FLOAT_EQ(ramp.largest(), 2.0f);
  EXPECT_FLOAT_EQ(ramp.at(0, 1).x, 2.0f) << "a run of one frame shows the start";
}

TEST(ScalePath, RandomIsBoundedFreePerAxisAndRepeatable) {
  const ScalePath random = path("random:0.3,0.9", 5);
  std::set<float> seen;
  for (int i = 0; i < 1000; ++i) {
    const Vec2 scale = random.at(i, 1000);
    EXPECT_GE(std::min(scale.x, scale.y), 0.3f);
    EXPECT_LE(std::max(scale.x, scale.y), 0.9f);
    EXPECT_EQ(scale, path("random:0.3,0.9", 5).at(i, 1000));
    seen.insert(scale.x);
    seen.insert(scale.y);
  }
  EXPECT_GT(seen.size(), 1900u);
  EXPECT_NE(random.at(3, 1000), path("random:0.3,0.9", 6).at(3, 1000));
}

TEST(ScalePath, BadTextIsRefusedWithWhatWouldBeRight) {
  for (const char* text : {"", "swep", "sweep:", "sweep:1,2", "ramp:0,1", "ramp:0.5,3", "ramp:a,b",
                           "ramp:.5,nan", "random:0.5,0.6,0.7", "random:0.5;0.6"}) {
    const auto result = ScalePath::parse(text, 0);
    ASSERT_FALSE(result.ok()) << text;
    EXPECT_EQ(result.status().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(result.status().message().find("scale"), std::string::npos) << result.status().message();
  }
  EXPECT_FALSE(ScalePath::fixed({0, 1}).ok());
  EXPECT_FALSE(ScalePath::fixed({1, 2.5f}).ok());
}

}  // namespace
}  // namespace quincunx::scenes
