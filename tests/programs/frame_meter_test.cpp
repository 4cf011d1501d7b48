// SPDX-License-Identifier: MIT
#include "programs/frame_meter.h"

#include <gtest/gtest.h>

namespace quincunx::scenes {
namespace {

TEST(FrameMeter, MeasuresNoDeviceWhosePassesHaveNoEvents) {
  for (const PassTimer passes : {PassTimer::kHostClock, PassTimer::kNone}) {
    const auto chosen = FrameMeter::create(FrameCost::kAuto, passes);
    ASSERT_TRUE(chosen.ok()) << chosen.status().message();
    EXPECT_FALSE(chosen->measures_device());
    const auto refused = FrameMeter::create(FrameCost::kDevice, passes);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported);
    EXPECT_NE(refused.status().message().find("--frame-cost"), std::string::npos);
  }
}

}  // namespace
}  // namespace quincunx::scenes
