// SPDX-License-Identifier: MIT
#include "quincunx_gl/frame_timer.h"

#include "interop_fixture.h"
#include "quincunx_gl/handle.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

class FrameTimerTest : public InteropTest, public ::testing::WithParamInterface<TimerMethod> {
 protected:
  void SetUp() override {
    InteropTest::SetUp();
    if (HasFatalFailure()) return;
    Result<FrameTimer> made = FrameTimer::create(GetParam());
    ASSERT_TRUE(made.ok()) << made.status().message();
    timer_ = std::make_unique<FrameTimer>(std::move(made).value());
    texture_ = Texture::create();
    framebuffer_ = Framebuffer::create();
    glTextureStorage2D(texture_.get(), 1, GL_RGBA16F, 512, 512);
    glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, texture_.get(), 0);
  }
  void TearDown() override {
    timer_.reset();
    framebuffer_ = {};
    texture_ = {};
    InteropTest::TearDown();
  }

  void draw() const {
    const std::array<GLfloat, 4> colour = {1, 2, 3, 4};
    glClearNamedFramebufferfv(framebuffer_.get(), GL_COLOR, 0, colour.data());
  }

  std::unique_ptr<FrameTimer> timer_;
  Texture texture_;
  Framebuffer framebuffer_;
};

TEST_P(FrameTimerTest, FramesComeBackInOrderWithTheirExtent) {
  EXPECT_EQ(timer_->method(), GetParam());
  EXPECT_FALSE(timer_->poll().has_value());
  for (std::uint64_t frame = 1; frame <= 3; ++frame) {
    ASSERT_TRUE(timer_->begin(frame, {64 + static_cast<int>(frame), 32}));
    draw();
    timer_->end();
  }
  glFinish();
  for (std::uint64_t frame = 1; frame <= 3; ++frame) {
    const std::optional<TimedFrame> timed = timer_->poll();
    ASSERT_TRUE(timed.has_value()) << frame;
    EXPECT_EQ(timed->frame, frame);
    EXPECT_EQ(timed->render, (Extent{64 + static_cast<int>(frame), 32}));
    EXPECT_GT(timed->gpu_ms, 0);
  }
  EXPECT_FALSE(timer_->poll().has_value());
}

TEST_P(FrameTimerTest, FullRingLeavesFramesUntimedAndGoesOn) {
  for (std::uint64_t frame = 0; frame < FrameTimer::kRing + 4; ++frame) {
    EXPECT_EQ(timer_->begin(frame, {8, 8}), frame < FrameTimer::kRing) << frame;
    draw();
    timer_->end();
  }
  glFinish();
  for (std::uint64_t frame = 0; frame < FrameTimer::kRing; ++frame) {
    const std::optional<TimedFrame> timed = timer_->poll();
    ASSERT_TRUE(timed.has_value());
    EXPECT_EQ(timed->frame, frame);
  }
  EXPECT_FALSE(timer_->poll().has_value());
  EXPECT_TRUE(timer_->begin(99, {8, 8}));
  timer_->end();
  glFinish();
  EXPECT_EQ(timer_->poll()->frame, 99u);
}

TEST_P(FrameTimerTest, NestedAndStrayCallsDoNothing) {
  timer_->end();
  EXPECT_FALSE(timer_->poll().has_value());
  ASSERT_TRUE(timer_->begin(1, {8, 8}));
  EXPECT_FALSE(timer_->begin(2, {8, 8}));
  timer_->end();
  timer_->end();
  glFinish();
  EXPECT_EQ(timer_->poll()->frame, 1u);
  EXPECT_FALSE(timer_->poll().has_value());
}

INSTANTIATE_TEST_SUITE_P(Both, FrameTimerTest, ::testing::Values(TimerMethod::kQuery, TimerMethod::kFence),
                         [](const auto& method) {
                           return method.param == TimerMethod::kQuery ? "Query" : "Fence";
                         });

class FrameTimerChoice : public InteropTest {};

TEST_F(FrameTimerChoice, SoftwareRenderersAreTimedByFences) {
  if (!context_->info().software) QUINCUNX_SKIP("a renderer whose queries may be right");
  const Result<FrameTimer> timer = FrameTimer::create();
  ASSERT_TRUE(timer.ok()) << timer.status().message();
  EXPECT_EQ(timer.value().method(), TimerMethod::kFence);
}

}  // namespace
}  // namespace quincunx::gl::testing
