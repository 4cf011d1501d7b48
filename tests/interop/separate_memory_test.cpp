// SPDX-License-Identifier: MIT
// A device whose memory is not the host's: the bridge that Bridge::create() makes for it carries whole frames to the
// service and back, with the bits of a device that shares the host's memory.
#include "cl_interposer.h"
#include "interop_fixture.h"
#include "quincunx/resolve_service.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {96, 80};
constexpr Extent kOutput = {64, 48};
constexpr int kFrames = 8;

class SeparateMemory : public InteropTest {
 protected:
  // The picture of each frame of a run over all slots, every frame with another viewport.
  std::vector<Bytes> pictures(const Device& device) const {
    BridgeSettings settings = all_planes(kTarget, kOutput);
    settings.interop = Interop::kCopy;
    auto bridge = Bridge::create(*context_, device, settings);
    const ResolvePlan plan =
        plan_for({}, {.method = Method::kQuincunx, .output = kOutput, .target = kTarget}).value();
    auto service = ResolveService::create(device, plan);
    EXPECT_TRUE(bridge.ok()) << bridge.status().message();
    EXPECT_TRUE(service.ok()) << service.status().message();
    std::vector<Bytes> made;
    for (int frame = 0; frame < kFrames; ++frame)
      made.push_back(picture(*bridge.value(), service.value(), settings, frame));
    return made;
  }

 private:
  static Bytes picture(Bridge& bridge, ResolveService& service, const BridgeSettings& settings, int frame) {
    const int slot = frame % bridge.slots();
    const Extent render = {kTarget.width - 5 * frame, 20 + 7 * frame};
    auto targets = bridge.begin_draw(slot, render);
    EXPECT_TRUE(targets.ok()) << targets.status().message();
    for (const Plane& plane : planes_of(settings)) {
      const auto seed = static_cast<std::uint32_t>(10 * frame + static_cast<int>(plane.kind));
      fill_plane(*targets.value(), plane, finite_texels(plane.format, kTarget, seed));
    }
    EXPECT_TRUE(bridge.submit(slot).ok());
    const auto inputs = bridge.acquire(slot);
    EXPECT_TRUE(inputs.ok()) << inputs.status().message();
    const auto presented = bridge.begin_present();
    EXPECT_TRUE(presented.ok()) << presented.status().message();
    const FrameReport report = service.dispatch({.colour = inputs->colour,
                                                 .depth = inputs->depth,
                                                 .velocity = inputs->velocity,
                                                 .reactive = inputs->reactive,
                                                 .render = render},
                                                {.presented = presented.value()});
    EXPECT_TRUE(report.ok()) << report.status.message();
    EXPECT_EQ(report.used_previous, frame > 0);
    EXPECT_TRUE(bridge.present().ok());
    const std::uint8_t* pixels = bridge.presented_pixels();
    return {pixels, pixels + static_cast<std::size_t>(kOutput.area()) * bytes_per_pixel(PixelFormat::kRGBA8)};
  }
};

TEST_F(SeparateMemory, WholeFramesHaveTheSameBits) {
  if (!device_->info().host_unified_memory) QUINCUNX_SKIP("this device's memory is not the host's");
  cl_counts() = {};
  const std::vector<Bytes> expected = pictures(*device_);
  EXPECT_GT(cl_counts().maps, kFrames) << "in place: buffers change owner";

  const PretendSeparateMemory pretend;
  auto separate = open_device(*context_, "", Interop::kCopy);
  ASSERT_TRUE(separate.ok()) << separate.status().message();
  ASSERT_FALSE(separate->info().host_unified_memory);
  cl_counts() = {};
  const std::vector<Bytes> made = pictures(separate.value());
  EXPECT_EQ(cl_counts().maps, 0) << "copied: nothing is mapped";
  for (std::size_t frame = 0; frame < expected.size(); ++frame)
    EXPECT_TRUE(made[frame] == expected[frame]) << frame;
  EXPECT_FALSE(expected[1] == expected[2]) << "the frames differ";
}

}  // namespace
}  // namespace quincunx::gl::testing
