// SPDX-License-Identifier: MIT
// The ring: frame n + 1 is drawn while n and n - 1 are read; a slot that is drawn again was given back first.
#include <CL/cl.h>

#include "interop_fixture.h"

namespace quincunx::gl::testing {
namespace {

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
  for (const Transfer transfer : {Transfer::kZeroCopy, Transfer::kExplicit}) {
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
