// SPDX-License-Identifier: MIT
// A device that fails under the copying bridge, in both of its forms: a Status in words, no exception.
#include "fault_fixture.h"
#include "host_copy.h"
#include "interop_fixture.h"

namespace quincunx::gl::testing {
namespace {

class FaultyBridge : public InteropTest {};

TEST_F(FaultyBridge, CreationFailsInWords) {
  BridgeSettings settings = all_planes(kRender, kOutput);
  settings.interop = Interop::kCopy;
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    const PretendFault fault(at, CL_OUT_OF_RESOURCES);
    const auto bridge = Bridge::create(*context_, *device_, settings);
    if (!fault.struck()) {
      EXPECT_TRUE(bridge.ok()) << bridge.status().message();
      EXPECT_GT(at, 3) << "the calls of a creation are seen";
      return;
    }
    ASSERT_FALSE(bridge.ok()) << at;
    expect_told(bridge.status(), "CL_OUT_OF_RESOURCES");
  }
  FAIL() << "every bridge met the fault";
}

// The first call of a frame's life that fails.
Status carry(Bridge& bridge) {
  if (auto targets = bridge.begin_draw(0, kRender); !targets.ok()) return targets.status();
  if (Status status = bridge.submit(0); !status.ok()) return status;
  if (auto frame = bridge.acquire(0); !frame.ok()) return frame.status();
  if (auto picture = bridge.begin_present(); !picture.ok()) return picture.status();
  return bridge.present();
}

TEST_F(FaultyBridge, AFrameFailsInWordsInBothForms) {
  for (const Transfer transfer : {Transfer::kZeroCopy, Transfer::kExplicit}) {
    if (transfer == Transfer::kZeroCopy && !device_->info().host_unified_memory) continue;
    int at = 0;
    for (bool struck = true; struck; ++at) {
      ASSERT_LT(at, kMoreThanAnyCalls);
      HostCopy bridge(*device_, all_planes(kRender, kOutput), "a test", transfer);
      ASSERT_TRUE(carry(bridge).ok());
      const PretendFault fault(at, CL_OUT_OF_RESOURCES);
      const Status status = carry(bridge);
      struck = fault.struck();
      if (struck) expect_told(status, "CL_OUT_OF_RESOURCES");
      if (!struck) {
        EXPECT_TRUE(status.ok()) << status.message();
      }
    }
    EXPECT_GT(at, 3) << "the calls of a frame are seen";
  }
}

}  // namespace
}  // namespace quincunx::gl::testing
