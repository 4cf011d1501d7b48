// SPDX-License-Identifier: MIT
// Memory of Vulkan's between OpenGL and OpenCL: on a processor lavapipe allocates it, llvmpipe imports it, and PoCL
// uses the pointer at which it is mapped.
#include <dirent.h>

#include "cl_interposer.h"
#include "external_memory.h"
#include "interop_fixture.h"
#include "quincunx/advanced/log.h"
#include "quincunx/resolve_service.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {96, 80};
constexpr Extent kOutput = {64, 48};

int open_fds() {
  int count = 0;
  DIR* const folder = opendir("/proc/self/fd");
  while (readdir(folder) != nullptr)
    ++count;
  closedir(folder);
  return count;
}

class External : public InteropTest {
 protected:
  BridgeSettings settings(Interop interop) const {
    BridgeSettings made = all_planes(kTarget, kOutput);
    made.interop = interop;
    return made;
  }

  // Whether this machine has what it takes; a driver that lies is no excuse.
  void SetUp() override {
    InteropTest::SetUp();
    try {
      VulkanDevice::open(gl_device_uuid());
    } catch (const InteropError& error) {
      QUINCUNX_SKIP(error.what());
    }
  }

  std::unique_ptr<Bridge> bridge(Interop interop) {
    auto made = Bridge::create(*context_, *device_, settings(interop));
    EXPECT_TRUE(made.ok()) << made.status().message();
    return made.ok() ? std::move(made).value() : nullptr;
  }

  // The pictures of frames of changing size, over all slots, each with a viewport of its own.
  std::vector<Bytes> pictures(Bridge& bridge, int frames) {
    const ResolvePlan plan =
        plan_for({}, {.method = Method::kQuincunx, .output_extent = kOutput, .target_extent = kTarget})
            .value();
    ResolveService service = ResolveService::create(*device_, plan).value();
    std::vector<Bytes> made;
    for (int frame = 0; frame < frames; ++frame) {
      const int slot = frame % bridge.slots();
      const Extent render = {kTarget.width - 5 * (frame % 9), 20 + 7 * (frame % 8)};
      auto targets = bridge.begin_draw(slot, render);
      EXPECT_TRUE(targets.ok()) << targets.status().message();
      for (const Plane& plane : planes_of(settings(Interop::kAuto))) {
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
                                                   .render_extent = render},
                                                  {.presented = presented.value()});
      EXPECT_TRUE(report.ok()) << report.status.message();
      const Status status = bridge.present();
      EXPECT_TRUE(status.ok()) << status.message();
      const std::uint8_t* pixels = bridge.presented_pixels();
      made.emplace_back(pixels, pixels + kOutput.area() * 4);
      Bytes texture(made.back().size());
      glGetTextureImage(bridge.presented_texture(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                        static_cast<GLsizei>(texture.size()), texture.data());
      EXPECT_TRUE(texture == made.back()) << "OpenGL's picture is the caller's";
    }
    return made;
  }
};

TEST_F(External, FramesHaveTheBitsOfCopies) {
  constexpr int kFrames = 24;
  const std::vector<Bytes> copied = pictures(*bridge(Interop::kCopy), kFrames);
  const auto external = bridge(Interop::kExternal);
  ASSERT_NE(external, nullptr);
  EXPECT_EQ(external->kind(), Interop::kExternal);
  EXPECT_NE(external->reason().find("memory of Vulkan's"), std::string::npos) << external->reason();
  const std::vector<Bytes> shared = pictures(*external, kFrames);
  for (int frame = 0; frame < kFrames; ++frame)
    EXPECT_TRUE(copied[frame] == shared[frame]) << frame;
  EXPECT_FALSE(copied[1] == copied[2]) << "the frames differ";
}

TEST_F(External, NothingIsLeftOpen) {
  bridge(Interop::kExternal).reset();  // drivers keep some files from their first use on
  const int before = open_fds();
  for (int i = 0; i < 3; ++i)
    bridge(Interop::kExternal).reset();
  EXPECT_EQ(open_fds(), before);
}

}  // namespace
}  // namespace quincunx::gl::testing
