// SPDX-License-Identifier: MIT
// GlSharing against a stand-in for a driver that shares (cl_interposer.h): the probe, the order in which
// textures change sides, and the bytes. What a real driver makes of it has to be seen on a GPU.
#include "cl_interposer.h"
#include "gl_call_counter.h"
#include "interop_fixture.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {61, 43};
constexpr Extent kRender = {45, 31};
constexpr Extent kOutput = {52, 38};

class GlSharingTest : public InteropTest {
 protected:
  // A device whose OpenCL context was made for the GL context.
  void open_shared() {
    auto device = open_device(*context_, "", Interop::kGl);
    ASSERT_TRUE(device.ok()) << device.status().message();
    device_ = std::make_unique<Device>(std::move(device).value());
  }

  Result<std::unique_ptr<Bridge>> make(Interop interop) {
    BridgeSettings settings = all_planes(kTarget, kOutput, colour_);
    settings.interop = interop;
    return Bridge::create(*context_, *device_, settings);
  }

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
      const ImageView& view = view_of(frame, plane.kind);
      EXPECT_EQ(view.storage, Storage::kImage);
      EXPECT_EQ(view.extent, kTarget);
      const Bytes drawn = random_texels(plane.format, kTarget, seed);
      EXPECT_TRUE(bytes_in(view, kRender) == crop(drawn, kTarget, kRender, bytes_per_pixel(plane.format)))
          << "plane " << static_cast<int>(plane.kind) << " of frame " << seed;
    }
  }

  void draw_encoded() {
    colour_ = PixelFormat::kRGBA8;
    planes_ = planes_of(all_planes(kTarget, kOutput, colour_));
  }

  PixelFormat colour_ = PixelFormat::kRGBA16F;
  std::vector<Plane> planes_ = planes_of(all_planes(kTarget, kOutput));
};

// OpenCL sees the codes of encoded colour, as a view of the texture that GL encodes.
TEST_F(GlSharingTest, EncodedColourArrivesAsCodes) {
  const PretendSharing driver(false);
  open_shared();
  draw_encoded();
  {
    auto made = make(Interop::kGl);
    ASSERT_TRUE(made.ok()) << made.status().message();
    draw(*made.value(), 0, 5);
    auto frame = made.value()->acquire(0);
    ASSERT_TRUE(frame.ok()) << frame.status().message();
    EXPECT_EQ(frame->colour.format, PixelFormat::kRGBA8);
    expect_frame(frame.value(), 5);
  }
}

TEST_F(GlSharingTest, FramesArriveAndHistoryStays) {
  for (const bool with_gl_event : {false, true}) {
    const PretendSharing driver(with_gl_event);
    open_shared();
    {
      auto made = make(Interop::kAuto);
      ASSERT_TRUE(made.ok()) << made.status().message();
      Bridge& bridge = *made.value();
      EXPECT_EQ(bridge.kind(), Interop::kGl);
      EXPECT_EQ(bridge.storage(), Storage::kImage);
      std::array<SharedFrame, 3> held;
      for (std::uint32_t frame = 0; frame < 8; ++frame) {
        const std::size_t slot = frame % 3;
        draw(bridge, static_cast<int>(slot), frame);
        if (frame >= 1) expect_frame(held[(frame - 1) % 3], frame - 1);
        auto acquired = bridge.acquire(static_cast<int>(slot));
        ASSERT_TRUE(acquired.ok()) << acquired.status().message();
        held[slot] = acquired.value();
        expect_frame(held[slot], frame);
        if (frame >= 1) expect_frame(held[(frame - 1) % 3], frame - 1);
        EXPECT_EQ(acquired_textures(), frame == 0 ? 4 : 8);  // this frame's planes and the last one's
      }
    }
    EXPECT_EQ(acquired_textures(), 0) << "the bridge went and left textures with OpenCL";
  }
}

TEST_F(GlSharingTest, ThePictureComesBack) {
  const PretendSharing driver(false);
  open_shared();
  auto made = make(Interop::kGl);
  ASSERT_TRUE(made.ok()) << made.status().message();
  Bridge& bridge = *made.value();
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const Bytes picture = random_texels(PixelFormat::kRGBA8, kOutput, seed);
    auto view = bridge.begin_present();
    ASSERT_TRUE(view.ok()) << view.status().message();
    const std::array<std::size_t, 3> origin = {0, 0, 0};
    const std::array<std::size_t, 3> region = {static_cast<std::size_t>(kOutput.width),
                                               static_cast<std::size_t>(kOutput.height), 1};
    ASSERT_EQ(clEnqueueWriteImage(device_->queue(), view->memory, CL_TRUE, origin.data(), region.data(), 0, 0,
                                  picture.data(), 0, nullptr, nullptr),
              CL_SUCCESS);
    ASSERT_TRUE(bridge.present().ok());
    const std::uint8_t* pixels = bridge.presented_pixels();
    EXPECT_TRUE(Bytes(pixels, pixels + picture.size()) == picture);
    Bytes texels(picture.size());
    glGetTextureImage(bridge.presented_texture(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                      static_cast<GLsizei>(texels.size()), texels.data());
    EXPECT_TRUE(texels == picture);
  }
}

// Without cl_khr_gl_event the specification wants glFinish() before OpenCL takes a texture.
TEST_F(GlSharingTest, GlIsFinishedOnlyWhereTheDriverDoesNotSynchronise) {
  for (const bool with_gl_event : {false, true}) {
    const PretendSharing driver(with_gl_event);
    open_shared();
    auto made = make(Interop::kGl);
    ASSERT_TRUE(made.ok()) << made.status().message();
    glFinish();
    draw(*made.value(), 0, 1);
    const CallCounter<&epoxy_glFinish> finishes;
    ASSERT_TRUE(made.value()->acquire(0).ok());
    EXPECT_EQ(finishes.count(), with_gl_event ? 0 : 1);
  }
}

TEST_F(GlSharingTest, AProbeThatFailsMeansCopying) {
  const std::array flaws = {std::pair{PretendSharing::Flaw::kWrongBytes, "other bytes"},
                            std::pair{PretendSharing::Flaw::kWrongFormat, "channel order"}};
  for (const auto& [flaw, clue] : flaws) {
    const PretendSharing driver(false, flaw);
    open_shared();
    const auto refused = make(Interop::kGl);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported);
    EXPECT_NE(refused.status().message().find(clue), std::string::npos) << refused.status().message();
    const auto fallen_back = make(Interop::kAuto);
    ASSERT_TRUE(fallen_back.ok()) << fallen_back.status().message();
    EXPECT_EQ(fallen_back.value()->kind(), Interop::kCopy);
    EXPECT_NE(fallen_back.value()->reason().find(clue), std::string::npos) << fallen_back.value()->reason();
    EXPECT_EQ(acquired_textures(), 0);
  }
}

TEST_F(GlSharingTest, ADeviceThatCannotServeThisContextMeansCopying) {
  const PretendSharing driver(false, PretendSharing::Flaw::kNoContext);
  const auto refused = open_device(*context_, "", Interop::kGl);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.status().message().find("does not share with this OpenGL context"), std::string::npos)
      << refused.status().message();
  EXPECT_TRUE(open_device(*context_, "", Interop::kAuto).ok());
}

TEST_F(GlSharingTest, ADeviceOpenedWithoutTheContextIsRefused) {
  const PretendSharing driver(false);
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  device_ = std::make_unique<Device>(std::move(device).value());
  const auto refused = make(Interop::kGl);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.status().message().find("was not made for this OpenGL context"), std::string::npos)
      << refused.status().message();
}

}  // namespace
}  // namespace quincunx::gl::testing
