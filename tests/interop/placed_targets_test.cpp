// SPDX-License-Identifier: MIT
// Placed targets: images of just the viewport's size in one allocation, at another size in every frame.
#include <CL/cl.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include "cl_interposer.h"
#include "gl_call_counter.h"
#include "host_copy.h"
#include "interop_fixture.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kLargest = {61, 43};
constexpr Extent kOutput = {16, 16};

BridgeSettings placed(Extent largest, int slots) {
  BridgeSettings settings = all_planes(largest, kOutput);
  settings.targets = Targets::kPlaced;
  settings.slots = slots;
  return settings;
}

Extent random_extent(std::uint32_t& state, Extent largest) {
  const auto side = [&](int most) {
    return 1 + static_cast<int>(next_random(state) % static_cast<std::uint32_t>(most));
  };
  const int width = side(largest.width);
  return {width, side(largest.height)};
}

// As in validate(): an image ends within 2^31 channels of its buffer's beginning.
TEST(FrameLayout, PlanesOfTheLargestTargetEndWhereKernelsReach) {
  constexpr Extent kTarget = {16384, 16384};
  for (const PixelFormat colour : {PixelFormat::kRGBA8, PixelFormat::kRGBA16F, PixelFormat::kRGBA32F}) {
    BridgeSettings settings = all_planes(kTarget, kOutput);
    settings.colour = colour;
    const std::vector<Plane> planes = planes_of(settings);
    ASSERT_EQ(planes.size(), 4u);
    for (const Targets targets : {Targets::kViewport, Targets::kPlaced}) {
      FrameLayout layout = lay_out(planes, kTarget, targets, 1);
      for (const Plane& plane : planes) {
        const ImageView& view = view_of(layout.views, plane.kind);
        const std::size_t bytes_of_a_channel = static_cast<std::size_t>(names_of(view.format).bits[0]) / 8;
        EXPECT_LE((view.offset + view.pitch * 16384) / bytes_of_a_channel, std::size_t{1} << 31)
            << name_of(view.format);
      }
    }
  }
}

class PlacedTargetsTest : public InteropTest {
 protected:
  // Draws a frame of its own random texels and hands it over.
  SharedFrame run_frame(Bridge& bridge, std::uint32_t frame, Extent render) {
    const int slot = static_cast<int>(frame % static_cast<std::uint32_t>(bridge.slots()));
    auto targets = bridge.begin_draw(slot, render);
    EXPECT_TRUE(targets.ok()) << targets.status().message();
    EXPECT_EQ(targets.value()->extent(), render);
    for (const Plane& plane : planes_)
      fill_plane(*targets.value(), plane, random_texels(plane.format, render, frame));
    EXPECT_TRUE(bridge.submit(slot).ok());
    auto shared = bridge.acquire(slot);
    EXPECT_TRUE(shared.ok()) << shared.status().message();
    return shared.value();
  }

  // Raw texels, also of a stand-in's image.
  Bytes texels_of(const ImageView& view, Extent render) {
    if (view.storage == Storage::kBuffer) return download(view, render);
    Bytes texels(static_cast<std::size_t>(render.area()) * bytes_per_pixel(view.format));
    const std::array<std::size_t, 3> origin = {0, 0, 0};
    const std::array<std::size_t, 3> region = {static_cast<std::size_t>(render.width),
                                               static_cast<std::size_t>(render.height), 1};
    EXPECT_EQ(clEnqueueReadImage(device_->queue(), view.memory, CL_TRUE, origin.data(), region.data(), 0, 0,
                                 texels.data(), 0, nullptr, nullptr),
              CL_SUCCESS);
    return texels;
  }

  void expect_frame(SharedFrame shared, std::uint32_t frame, Extent render) {
    for (const Plane& plane : planes_) {
      const ImageView& view = view_of(shared, plane.kind);
      EXPECT_EQ(view.extent, render);
      EXPECT_TRUE(texels_of(view, render) == random_texels(plane.format, render, frame))
          << "plane " << static_cast<int>(plane.kind) << " of frame " << frame << ", " << render.width << "x"
          << render.height;
    }
  }

  // Frames of random sizes; each is still whole when the next has been drawn beside it.
  void expect_frames_stay(Bridge& bridge) {
    std::uint32_t state = 7;
    SharedFrame before;
    Extent before_render;
    for (std::uint32_t frame = 0; frame < 60; ++frame) {
      const Extent render = frame == 20 ? kLargest : random_extent(state, kLargest);
      const SharedFrame now = run_frame(bridge, frame, render);
      expect_frame(now, frame, render);
      if (frame > 0) expect_frame(before, frame - 1, before_render);
      before = now;
      before_render = render;
    }
  }

  Bytes whole(cl_mem memory) {
    std::size_t bytes = 0;
    EXPECT_EQ(clGetMemObjectInfo(memory, CL_MEM_SIZE, sizeof(bytes), &bytes, nullptr), CL_SUCCESS);
    Bytes all(bytes);
    EXPECT_EQ(
        clEnqueueReadBuffer(device_->queue(), memory, CL_TRUE, 0, bytes, all.data(), 0, nullptr, nullptr),
        CL_SUCCESS);
    return all;
  }

  void expect_nothing_else_written(Transfer transfer);

  const std::vector<Plane> planes_ = planes_of(placed(kLargest, 3));
};

TEST_F(PlacedTargetsTest, FramesOfAnySizeArriveAndStay) {
  for (const int slots : {2, 3}) {
    for (const Transfer transfer : transfers()) {
      HostCopy bridge(*device_, placed(kLargest, slots), "test", transfer);
      EXPECT_EQ(bridge.storage(), Storage::kBuffer);
      expect_frames_stay(bridge);
    }
  }
}

// The slots are parts of one allocation; in each the images are packed tightly, at places that never move.
TEST_F(PlacedTargetsTest, ImagesArePackedInOneAllocation) {
  HostCopy bridge(*device_, placed(kLargest, 2), "test", Transfer::kZeroCopy);
  cl_mem allocation = nullptr;
  std::uint32_t state = 3;
  for (std::uint32_t frame = 0; frame < 12; ++frame) {
    const Extent render = random_extent(state, kLargest);
    SharedFrame shared = run_frame(bridge, frame, render);
    std::map<std::size_t, std::size_t> ends;  // of regions, by their offsets
    for (const Plane& plane : planes_) {
      const ImageView& view = view_of(shared, plane.kind);
      EXPECT_EQ(view.pitch, static_cast<std::size_t>(render.width) * bytes_per_pixel(plane.format));
      EXPECT_EQ(view.offset % 16, 0u);
      ends[view.offset] =
          view.offset + static_cast<std::size_t>(kLargest.area()) * bytes_per_pixel(plane.format);
      EXPECT_EQ(view.memory, shared.colour.memory);
    }
    ASSERT_EQ(ends.size(), planes_.size());
    for (auto region = ends.begin(), next = std::next(region); next != ends.end(); region = next++)
      EXPECT_GE(next->first, region->second);
    cl_mem parent = nullptr;
    ASSERT_EQ(clGetMemObjectInfo(shared.colour.memory, CL_MEM_ASSOCIATED_MEMOBJECT, sizeof(parent), &parent,
                                 nullptr),
              CL_SUCCESS);
    ASSERT_NE(parent, nullptr);
    if (frame > 0) {
      EXPECT_EQ(parent, allocation);
    }
    allocation = parent;
  }
}

void PlacedTargetsTest::expect_nothing_else_written(Transfer transfer) {
  constexpr std::uint8_t kPoison = 0x7f;
  HostCopy bridge(*device_, placed(kLargest, 2), "test", transfer);
  std::uint32_t state = 11;
  std::array<cl_mem, 2> memory = {};
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    const Extent render = random_extent(state, kLargest);
    SharedFrame shared = run_frame(bridge, frame, render);
    Bytes seen = whole(shared.colour.memory);
    for (const Plane& plane : planes_) {
      const ImageView& view = view_of(shared, plane.kind);
      const Bytes drawn = random_texels(plane.format, render, frame);
      const auto at = seen.begin() + static_cast<std::ptrdiff_t>(view.offset);
      EXPECT_TRUE(std::equal(drawn.begin(), drawn.end(), at)) << static_cast<int>(plane.kind);
      std::fill_n(at, drawn.size(), kPoison);
    }
    // From the second time on the slot was poisoned before.
    if (memory[frame % 2] != nullptr) {
      EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](std::uint8_t byte) { return byte == kPoison; }))
          << "frame " << frame << ", " << render.width << "x" << render.height;
    }
    memory[frame % 2] = shared.colour.memory;
    std::fill(seen.begin(), seen.end(), kPoison);
    ASSERT_EQ(clEnqueueWriteBuffer(device_->queue(), shared.colour.memory, CL_TRUE, 0, seen.size(),
                                   seen.data(), 0, nullptr, nullptr),
              CL_SUCCESS);
  }
}

TEST_F(PlacedTargetsTest, NothingIsWrittenBesideTheImages) {
  for (const Transfer transfer : transfers())
    expect_nothing_else_written(transfer);
}

// Images made on the buffers, by a stand-in for a driver that can: rows are padded as the device wants it.
TEST_F(PlacedTargetsTest, ImagesAreMadeOnTheBuffers) {
  const PretendImagesOnBuffers driver;
  for (const Transfer transfer : transfers()) {
    HostCopy bridge(*device_, placed(kLargest, 3), "test", transfer, {Storage::kImage, kImagePitchTexels});
    EXPECT_EQ(bridge.storage(), Storage::kImage);
    expect_frames_stay(bridge);
    // The same size again makes nothing.
    for (std::uint32_t frame = 0; frame < 3; ++frame)
      run_frame(bridge, frame, {30, 20});
    cl_counts() = {};
    for (std::uint32_t frame = 3; frame < 9; ++frame)
      expect_frame(run_frame(bridge, frame, {30, 20}), frame, {30, 20});
    EXPECT_EQ(cl_counts().creations, 0);
  }
}

TEST_F(PlacedTargetsTest, TheDeviceTellsWhetherItMakesImagesOnBuffers) {
  const PretendImagesOnBuffers driver;
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  EXPECT_EQ(device->info().image_pitch_texels, kImagePitchTexels);
}

TEST(PlacedForm, IsImagesOnlyWhereTheyHelp) {
  DeviceInfo gpu;
  gpu.kind = DeviceKind::kGpu;
  gpu.images = gpu.two_channel_images = true;
  gpu.image_pitch_texels = 64;
  EXPECT_EQ(placed_form_for(gpu).storage, Storage::kImage);
  EXPECT_EQ(placed_form_for(gpu).row_texels, 64);
  DeviceInfo other = gpu;
  other.kind = DeviceKind::kCpu;
  EXPECT_EQ(placed_form_for(other).storage, Storage::kBuffer);
  other = gpu;
  other.two_channel_images = false;
  EXPECT_EQ(placed_form_for(other).storage, Storage::kBuffer);
  other = gpu;
  other.image_pitch_texels = 0;
  EXPECT_EQ(placed_form_for(other).storage, Storage::kBuffer);
  EXPECT_EQ(placed_form_for(other).row_texels, 1);
}

TEST_F(PlacedTargetsTest, SizesThatComeBackAllocateNothing) {
  constexpr std::array kSizes = {Extent{30, 20}, Extent{41, 27}, Extent{9, 43}};
  HostCopy bridge(*device_, placed(kLargest, 3), "test", Transfer::kZeroCopy);
  for (std::uint32_t frame = 0; frame < 4; ++frame)
    run_frame(bridge, frame, kSizes[frame % 3]);
  const CallCounter<&epoxy_glCreateTextures> textures;
  const CallCounter<&epoxy_glTextureStorage2D> storages;
  const CallCounter<&epoxy_glCreateFramebuffers> framebuffers;
  cl_counts() = {};
  for (std::uint32_t frame = 4; frame < 24; ++frame) {
    run_frame(bridge, frame, kSizes[frame % 3]);
    EXPECT_GT(bridge.traffic().resize_us, 0);
  }
  EXPECT_EQ(textures.count() + storages.count() + framebuffers.count(), 0);
  EXPECT_EQ(cl_counts().creations, 0);
}

// New sizes make textures, but never an OpenCL object; a size that stays makes nothing, and costs nothing.
TEST_F(PlacedTargetsTest, NewSizesAllocateNoOpenClMemory) {
  HostCopy bridge(*device_, placed(kLargest, 3), "test", Transfer::kZeroCopy);
  const Bridge::Memory first = bridge.memory();
  const std::uint64_t largest = kLargest.area() * std::uint64_t{17};  // bytes of a texel in all four planes
  EXPECT_GE(first.opencl_bytes, 3 * largest);
  cl_counts() = {};
  std::uint32_t state = 5;
  for (std::uint32_t frame = 0; frame < 40; ++frame) {
    run_frame(bridge, frame, random_extent(state, kLargest));
    EXPECT_EQ(bridge.memory().opencl_bytes, first.opencl_bytes);
    EXPECT_LE(bridge.memory().gl_bytes, 2 * largest);
  }
  EXPECT_EQ(cl_counts().creations, 0);
  for (std::uint32_t frame = 40; frame < 44; ++frame)
    run_frame(bridge, frame, {33, 21});
  EXPECT_EQ(bridge.traffic().resize_us, 0);
}

TEST_F(PlacedTargetsTest, TheOldestTargetsGoFirst) {
  TargetPool pool({.target_extent = {10, 10}});
  const RenderTargets* const wide = &pool.at({10, 5});
  pool.at({5, 10});
  const RenderTargets* const half = &pool.at({10, 6});
  EXPECT_EQ(&pool.at({10, 5}), wide);  // 160 texels of at most 200
  pool.at({9, 9});                     // 241: the oldest, 5x10, goes
  const std::uint64_t texel = wide->bytes() / 50;
  EXPECT_EQ(pool.bytes(), (81 + 50 + 60) * texel);
  EXPECT_EQ(&pool.at({10, 6}), half);
  EXPECT_EQ(&pool.at({10, 5}), wide);
  pool.at({10, 10});
  EXPECT_LE(pool.bytes(), 200 * texel);
  EXPECT_EQ(&pool.at({10, 5}), wide);
}

TEST_F(PlacedTargetsTest, SharedTexturesAreRefused) {
  BridgeSettings settings = placed(kLargest, 3);
  settings.interop = Interop::kGl;
  const auto refused = Bridge::create(*context_, *device_, settings);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(refused.status().message().find("use 'copy' or 'auto', or viewport targets"), std::string::npos);
  settings.interop = Interop::kAuto;
  const auto bridge = Bridge::create(*context_, *device_, settings);
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  EXPECT_EQ(bridge.value()->kind(), Interop::kCopy);
}

}  // namespace
}  // namespace quincunx::gl::testing
