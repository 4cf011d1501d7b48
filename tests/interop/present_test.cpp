// SPDX-License-Identifier: MIT
// What OpenCL writes into the output arrives in GL's texture and at the caller byte for byte.
#include <cstring>

#include "interop_fixture.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

class PresentTest : public InteropTest {
 protected:
  void expect_exact(Extent output, Transfer transfer);
};

Bytes read_texture(GLuint texture, Extent extent) {
  Bytes texels(static_cast<std::size_t>(extent.area()) * 4);
  glGetTextureImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(texels.size()),
                    texels.data());
  return texels;
}

void PresentTest::expect_exact(Extent output, Transfer transfer) {
  HostCopy bridge(*device_, {.target = {8, 8}, .output = output}, "test", transfer);
  ImageView first;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    auto view = bridge.begin_present();
    ASSERT_TRUE(view.ok()) << view.status().message();
    EXPECT_EQ(view->extent, output);
    EXPECT_EQ(view->format, PixelFormat::kRGBA8);
    if (seed == 1) first = view.value();
    EXPECT_EQ(view->memory, first.memory);
    EXPECT_EQ(view->row_pitch(), static_cast<std::size_t>(output.width) * 4);
    const Bytes picture = random_texels(PixelFormat::kRGBA8, output, seed);
    // A device copy that is only enqueued, as a dispatch is: present() has to wait for it.
    auto source = device_->allocate(output, PixelFormat::kRGBA8);
    ASSERT_TRUE(source.ok()) << source.status().message();
    upload(source->view(), picture);
    ASSERT_EQ(clEnqueueCopyBuffer(device_->queue(), source->view().memory, view->memory, 0, view->offset,
                                  picture.size(), 0, nullptr, nullptr),
              CL_SUCCESS);
    const Status status = bridge.present();
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(std::memcmp(bridge.presented_pixels(), picture.data(), picture.size()), 0);
    EXPECT_TRUE(read_texture(bridge.presented_texture(), output) == picture);
    EXPECT_EQ(bridge.traffic().bytes_out, picture.size());
  }
}

constexpr std::array<Extent, 5> kOutputs = {Extent{1, 1}, Extent{7, 5}, Extent{257, 129}, Extent{1280, 720},
                                            Extent{1279, 719}};

TEST_F(PresentTest, HostMemoryInPlace) {
  if (!device_->info().host_unified_memory) QUINCUNX_SKIP("this device's memory is not the host's");
  for (const Extent output : kOutputs)
    expect_exact(output, Transfer::kZeroCopy);
}

TEST_F(PresentTest, CopiedFromTheDevice) {
  for (const Extent output : kOutputs)
    expect_exact(output, Transfer::kExplicit);
}

TEST_F(PresentTest, WithoutABeginningIsRefused) {
  auto bridge = Bridge::create(*context_, *device_, {.target = {8, 8}, .output = {8, 8}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  const Status status = bridge.value()->present();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("begin_present()"), std::string::npos) << status.message();
  ASSERT_TRUE(bridge.value()->begin_present().ok());
  EXPECT_TRUE(bridge.value()->present().ok());
  EXPECT_FALSE(bridge.value()->present().ok());
}

}  // namespace
}  // namespace quincunx::gl::testing
