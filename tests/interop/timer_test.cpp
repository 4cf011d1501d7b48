// SPDX-License-Identifier: MIT
#include "interop_fixture.h"
#include "quincunx_gl/frame_timer.h"
#include "quincunx_gl/handle.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

// Draws something that takes time.
class TimedDraws : public InteropTest, public ::testing::WithParamInterface<TimerMethod> {
 protected:
  void SetUp() override {
    InteropTest::SetUp();
    if (HasFatalFailure()) return;
    texture_ = Texture::create();
    framebuffer_ = Framebuffer::create();
    glTextureStorage2D(texture_.get(), 1, GL_RGBA16F, 512, 512);
    glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, texture_.get(), 0);
  }
  void TearDown() override {
    framebuffer_ = {};
    texture_ = {};
    InteropTest::TearDown();
  }

  void draw() const {
    const std::array<GLfloat, 4> colour = {1, 2, 3, 4};
    glClearNamedFramebufferfv(framebuffer_.get(), GL_COLOR, 0, colour.data());
  }

 private:
  Texture texture_;
  Framebuffer framebuffer_;
};

std::string name_of_method(const ::testing::TestParamInfo<TimerMethod>& method) {
  return method.param == TimerMethod::kQuery ? "Query" : "Fence";
}

class FrameTimerTest : public TimedDraws {
 protected:
  void SetUp() override {
    TimedDraws::SetUp();
    if (HasFatalFailure()) return;
    Result<FrameTimer> made = FrameTimer::create(GetParam());
    ASSERT_TRUE(made.ok()) << made.status().message();
    timer_ = std::make_unique<FrameTimer>(std::move(made).value());
  }
  void TearDown() override {
    timer_.reset();
    TimedDraws::TearDown();
  }

  std::unique_ptr<FrameTimer> timer_;
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
    EXPECT_EQ(timed->render_extent, (Extent{64 + static_cast<int>(frame), 32}));
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
                         name_of_method);

class FrameTimerChoice : public InteropTest {};

TEST_F(FrameTimerChoice, SoftwareRenderersAreTimedByFences) {
  if (!context_->info().software) QUINCUNX_SKIP("a renderer whose queries may be right");
  const Result<FrameTimer> timer = FrameTimer::create();
  ASSERT_TRUE(timer.ok()) << timer.status().message();
  EXPECT_EQ(timer.value().method(), TimerMethod::kFence);
}

class PartTimerTest : public TimedDraws {
 protected:
  static PartTimer timer(int every = 1) {
    Result<PartTimer> made = PartTimer::create(GetParam(), every);
    if (!made.ok()) throw std::runtime_error(made.status().message());
    return std::move(made).value();
  }
};

TEST_P(PartTimerTest, PartsComeBackInOrderWithTheirExtentInsideATimedFrame) {
  PartTimer part = timer();
  Result<FrameTimer> whole = FrameTimer::create(GetParam());
  ASSERT_TRUE(whole.ok()) << whole.status().message();
  EXPECT_FALSE(part.poll().has_value());
  for (std::uint64_t frame = 1; frame <= 3; ++frame) {
    ASSERT_TRUE(whole->begin(frame, {8, 8}));
    draw();
    part.begin(frame, {64 + static_cast<int>(frame), 32});
    draw();
    part.end();
    whole->end();
  }
  glFinish();
  for (std::uint64_t frame = 1; frame <= 3; ++frame) {
    const std::optional<TimedFrame> timed = part.poll();
    ASSERT_TRUE(timed.has_value()) << frame;
    EXPECT_EQ(timed->frame, frame);
    EXPECT_EQ(timed->render_extent, (Extent{64 + static_cast<int>(frame), 32}));
    EXPECT_GT(timed->gpu_ms, 0);
    ASSERT_TRUE(whole->poll().has_value()) << frame;
  }
  EXPECT_FALSE(part.poll().has_value());
}

TEST_P(PartTimerTest, FullRingAndStrayCallsDoNoHarm) {
  PartTimer part = timer();
  part.end();
  for (std::uint64_t frame = 0; frame < PartTimer::kRing + 4; ++frame) {
    part.begin(frame, {8, 8});
    part.begin(99, {8, 8});
    draw();
    part.end();
    part.end();
  }
  glFinish();
  for (std::uint64_t frame = 0; frame < PartTimer::kRing; ++frame) {
    const std::optional<TimedFrame> timed = part.poll();
    ASSERT_TRUE(timed.has_value());
    EXPECT_EQ(timed->frame, frame);
  }
  EXPECT_FALSE(part.poll().has_value());
}

TEST_P(PartTimerTest, WhereTimesNeedAWaitOneOfSeveralPartsIsTimed) {
  PartTimer part = timer(4);
  std::vector<std::uint64_t> timed;
  for (std::uint64_t frame = 0; frame < 8; ++frame) {
    part.begin(frame, {8, 8});
    draw();
    part.end();
    glFinish();
    while (const auto found = part.poll())
      timed.push_back(found->frame);
  }
  const std::vector<std::uint64_t> each = {0, 1, 2, 3, 4, 5, 6, 7}, fourth = {0, 4};
  EXPECT_EQ(timed, GetParam() == TimerMethod::kFence ? fourth : each);
}

TEST_P(PartTimerTest, OneOfNoneIsRefused) {
  const Result<PartTimer> made = PartTimer::create(GetParam(), 0);
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.status().message().find("every is 0"), std::string::npos) << made.status().message();
}

INSTANTIATE_TEST_SUITE_P(Both, PartTimerTest, ::testing::Values(TimerMethod::kQuery, TimerMethod::kFence),
                         name_of_method);

}  // namespace

}  // namespace quincunx::gl::testing
