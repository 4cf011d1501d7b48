// SPDX-License-Identifier: MIT
// A steady frame makes nothing new and never waits for the whole queue, whatever the viewport does.
#include "cl_interposer.h"
#include "gl_call_counter.h"
#include "interop_fixture.h"

namespace quincunx::gl::testing {
namespace {

class SteadyFrameTest : public InteropTest {
 protected:
  static void run_frame(Bridge& bridge, int frame) {
    const int slot = frame % bridge.slots();
    const Extent render = {20 + frame % 40, 50 - frame % 30};
    auto targets = bridge.begin_draw(slot, render);
    ASSERT_TRUE(targets.ok()) << targets.status().message();
    targets.value()->clear(render);
    ASSERT_TRUE(bridge.submit(slot).ok());
    auto inputs = bridge.acquire(slot);
    ASSERT_TRUE(inputs.ok()) << inputs.status().message();
    ASSERT_TRUE(bridge.begin_present().ok());
    ASSERT_TRUE(bridge.present().ok());
  }
};

TEST_F(SteadyFrameTest, AllocatesNothingAndDrainsNoQueue) {
  for (const Transfer transfer : {Transfer::kZeroCopy, Transfer::kExplicit}) {
    HostCopy bridge(*device_, all_planes({64, 64}, {48, 40}), "test", transfer);
    for (int frame = 0; frame < 4; ++frame)
      run_frame(bridge, frame);
    glFinish();
    const CallCounter<&epoxy_glCreateBuffers> buffers;
    const CallCounter<&epoxy_glBufferStorage> storages;
    const CallCounter<&epoxy_glMapBufferRange> maps;
    const CallCounter<&epoxy_glCreateTextures> textures;
    const CallCounter<&epoxy_glTexStorage2D> texture_storages;
    const CallCounter<&epoxy_glCreateFramebuffers> framebuffers;
    const CallCounter<&epoxy_glFinish> finishes;
    cl_counts() = {};
    constexpr int kFrames = 60;
    for (int frame = 4; frame < 4 + kFrames; ++frame)
      run_frame(bridge, frame);
    EXPECT_EQ(buffers.count() + storages.count() + maps.count(), 0);
    EXPECT_EQ(textures.count() + texture_storages.count() + framebuffers.count(), 0);
    EXPECT_EQ(finishes.count(), 0);
    EXPECT_EQ(cl_counts().creations, 0);
    EXPECT_EQ(cl_counts().blocking_waits, 0);
  }
}

// The counters themselves: a bridge that is made does count.
TEST_F(SteadyFrameTest, MakingABridgeIsCounted) {
  { const HostCopy warm(*device_, all_planes({8, 8}, {8, 8}), "test", Transfer::kZeroCopy); }
  const CallCounter<&epoxy_glBufferStorage> storages;
  const CallCounter<&epoxy_glTexStorage2D> textures;
  cl_counts() = {};
  const HostCopy bridge(*device_, all_planes({8, 8}, {8, 8}), "test", Transfer::kZeroCopy);
  EXPECT_EQ(storages.count(), bridge.slots() + 1);  // one for each slot, one for the picture
  EXPECT_EQ(textures.count(), 5);                   // four targets, one picture
  EXPECT_EQ(cl_counts().creations, bridge.slots() + 1);
}

}  // namespace
}  // namespace quincunx::gl::testing
