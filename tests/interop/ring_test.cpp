// SPDX-License-Identifier: MIT
// The ring of slots: its bookkeeping, and frames in flight.
#include <CL/cl.h>
#include <gtest/gtest.h>

#include "interop_fixture.h"
#include "slot_ring.h"

namespace quincunx::gl::testing {
namespace {

void run_frame(SlotRing& ring, int slot) {
  ASSERT_TRUE(ring.begin_draw(slot, {4, 4}).ok());
  ASSERT_TRUE(ring.submit(slot).ok());
  ASSERT_TRUE(ring.acquire(slot).ok());
}

TEST(SlotRing, HistoryIsHeldAndTheOneBeforeIsRetired) {
  SlotRing ring(3, {8, 8});
  run_frame(ring, 0);
  EXPECT_FALSE(ring.is_retired(0));
  run_frame(ring, 1);
  EXPECT_FALSE(ring.is_retired(0));
  EXPECT_FALSE(ring.is_retired(1));
  run_frame(ring, 2);
  EXPECT_TRUE(ring.is_retired(0));
  EXPECT_FALSE(ring.is_retired(1));
  EXPECT_FALSE(ring.is_retired(2));
}

TEST(SlotRing, AnyOrderOfSlotsKeepsHistory) {
  SlotRing ring(3, {8, 8});
  for (const int slot : {0, 2, 1, 0, 2})
    run_frame(ring, slot);
  EXPECT_FALSE(ring.is_retired(2));
  EXPECT_FALSE(ring.is_retired(0));
  EXPECT_TRUE(ring.is_retired(1));
}

TEST(SlotRing, TwoSlotsNeverRetire) {
  SlotRing ring(2, {8, 8});
  for (const int slot : {0, 1, 0, 1, 0}) {
    run_frame(ring, slot);
    EXPECT_FALSE(ring.is_retired(0));
    EXPECT_FALSE(ring.is_retired(1));
  }
}

TEST(SlotRing, ASlotThatIsDrawnAgainIsNotRetired) {
  SlotRing ring(3, {8, 8});
  for (const int slot : {0, 1, 2})
    run_frame(ring, slot);
  ASSERT_TRUE(ring.begin_draw(0, {4, 4}).ok());
  EXPECT_FALSE(ring.is_retired(0));
}

TEST(SlotRing, CallsOutOfTurnSayWhatComesFirst) {
  SlotRing ring(3, {8, 8});
  EXPECT_NE(ring.submit(1).message().find("begin_draw(1"), std::string::npos);
  EXPECT_NE(ring.acquire(1).message().find("submit(1)"), std::string::npos);
  ASSERT_TRUE(ring.begin_draw(1, {4, 4}).ok());
  EXPECT_FALSE(ring.acquire(1).ok());
  ASSERT_TRUE(ring.submit(1).ok());
  ASSERT_TRUE(ring.acquire(1).ok());
  EXPECT_FALSE(ring.acquire(1).ok());
}

TEST(SlotRing, BadSlotsAndViewportsAreNamed) {
  SlotRing ring(3, {8, 6});
  EXPECT_NE(ring.begin_draw(3, {4, 4}).message().find("slot is 3; it must be 0 to 2"), std::string::npos);
  EXPECT_EQ(ring.begin_draw(-1, {4, 4}).code(), StatusCode::kInvalidArgument);
  for (const Extent bad : {Extent{0, 4}, Extent{4, 0}, Extent{9, 6}, Extent{8, 7}, Extent{-1, -1}}) {
    const Status status = ring.begin_draw(0, bad);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("8x6"), std::string::npos) << status.message();
  }
  EXPECT_TRUE(ring.begin_draw(0, {8, 6}).ok());
}

// The ring: frame n + 1 is drawn while n and n - 1 are read; a slot that is drawn again was given back first.

constexpr Extent kTarget = {61, 43};
constexpr Extent kRender = {45, 31};

class RingTest : public InteropTest {
 protected:
  void draw(Bridge& bridge, int slot, std::uint32_t seed) {
    auto targets = bridge.begin_draw(slot, kRender);
    ASSERT_TRUE(targets.ok()) << targets.status().message();
    for (const Plane& plane : planes_) {
      fill_plane(*targets.value(), plane, random_texels(plane.format, kTarget, seed));
    }
    ASSERT_TRUE(bridge.submit(slot).ok());
  }

  void expect_frame(SharedFrame frame, std::uint32_t seed) {
    for (const Plane& plane : planes_) {
      const Bytes drawn = random_texels(plane.format, kTarget, seed);
      EXPECT_TRUE(download(view_of(frame, plane.kind), kRender) ==
                  crop(drawn, kTarget, kRender, bytes_per_pixel(plane.format)))
          << "plane " << static_cast<int>(plane.kind) << " of frame " << seed;
    }
  }

  void run_ring(Bridge& bridge);

  const BridgeSettings settings_ = all_planes(kTarget, {16, 16});
  const std::vector<Plane> planes_ = planes_of(settings_);
};

void RingTest::run_ring(Bridge& bridge) {
  std::vector<SharedFrame> held(static_cast<std::size_t>(bridge.slots()));
  const std::uint32_t slots = static_cast<std::uint32_t>(bridge.slots());
  for (std::uint32_t frame = 0; frame < 3 * slots; ++frame) {
    const int slot = static_cast<int>(frame % slots);
    draw(bridge, slot, frame);
    if (frame >= 1) expect_frame(held[(frame - 1) % slots], frame - 1);  // while `frame` is with GL
    if (frame >= 2) expect_frame(held[(frame - 2) % slots], frame - 2);
    auto acquired = bridge.acquire(slot);
    ASSERT_TRUE(acquired.ok()) << acquired.status().message();
    held[frame % slots] = acquired.value();
    expect_frame(held[frame % slots], frame);
    if (frame >= 1) expect_frame(held[(frame - 1) % slots], frame - 1);
  }
}

TEST_F(RingTest, FramesStayIntactWhileTheNextIsDrawn) {
  for (const int slots : {3, 4}) {
    BridgeSettings settings = settings_;
    settings.slots = slots;
    auto bridge = Bridge::create(*context_, *device_, settings);
    ASSERT_TRUE(bridge.ok()) << bridge.status().message();
    run_ring(*bridge.value());
  }
}

TEST_F(RingTest, FramesStayIntactWithCopiesToTheDevice) {
  HostCopy bridge(*device_, settings_, "test", Transfer::kExplicit);
  run_ring(bridge);
}

// A reader that starts late stands for a slow dispatch: its command waits for a user event.
class HeldQueue {
 public:
  explicit HeldQueue(const Device& device) {
    cl_int code = CL_SUCCESS;
    gate_ = ClEvent::adopt(clCreateUserEvent(device.context(), &code));
    EXPECT_EQ(code, CL_SUCCESS);
    const cl_event gate = gate_.get();
    EXPECT_EQ(clEnqueueBarrierWithWaitList(device.queue(), 1, &gate, nullptr), CL_SUCCESS);
  }
  ~HeldQueue() { open(); }
  HeldQueue(const HeldQueue&) = delete;
  HeldQueue& operator=(const HeldQueue&) = delete;
  void open() {
    if (open_) return;
    EXPECT_EQ(clSetUserEventStatus(gate_.get(), CL_COMPLETE), CL_SUCCESS);
    open_ = true;
  }

 private:
  ClEvent gate_;
  bool open_ = false;
};

// Frame 3 goes into the slot of frame 0 while the dispatch of frame 2 has not even begun. begin_draw() must
// return (it needs the dispatch of frame 1 only), and frames 1 and 2 must be whole when that dispatch runs.
TEST_F(RingTest, TheNextFrameIsDrawnWhileADispatchIsStillQueued) {
  for (const Transfer transfer : transfers()) {
    HostCopy bridge(*device_, settings_, "test", transfer);
    std::array<SharedFrame, 3> frames;
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      draw(bridge, static_cast<int>(frame), frame);
      auto acquired = bridge.acquire(static_cast<int>(frame));
      ASSERT_TRUE(acquired.ok()) << acquired.status().message();
      frames[frame] = acquired.value();
    }
    HeldQueue dispatch_of_frame_2(*device_);
    draw(bridge, 0, 3);
    dispatch_of_frame_2.open();
    expect_frame(frames[2], 2);
    expect_frame(frames[1], 1);
    ASSERT_TRUE(bridge.acquire(0).ok());
    expect_frame(frames[0], 3);
    expect_frame(frames[2], 2);
  }
}

// The bridge may go while OpenCL still has commands that use its memory.
TEST_F(RingTest, TheBridgeMayGoWithWorkInTheQueue) {
  auto copy = device_->allocate(kRender, PixelFormat::kRGBA16F);
  ASSERT_TRUE(copy.ok()) << copy.status().message();
  {
    HostCopy bridge(*device_, settings_, "test", Transfer::kZeroCopy);
    draw(bridge, 0, 5);
    auto frame = bridge.acquire(0);
    ASSERT_TRUE(frame.ok());
    const std::array<std::size_t, 3> from = {0, frame->colour.offset / frame->colour.pitch, 0};
    const std::array<std::size_t, 3> to = {0, 0, 0};
    const std::array<std::size_t, 3> region = {kRender.width * std::size_t{8},
                                               kRender.height * std::size_t{1}, 1};
    ASSERT_EQ(clEnqueueCopyBufferRect(device_->queue(), frame->colour.memory, copy->view().memory,
                                      from.data(), to.data(), region.data(), frame->colour.pitch, 0,
                                      copy->view().row_pitch(), 0, 0, nullptr, nullptr),
              CL_SUCCESS);
  }
  const Bytes drawn = random_texels(PixelFormat::kRGBA16F, kTarget, 5);
  EXPECT_TRUE(download(copy->view(), kRender) == crop(drawn, kTarget, kRender, 8));
}

}  // namespace

}  // namespace quincunx::gl::testing
