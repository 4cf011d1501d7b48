// SPDX-License-Identifier: MIT
// InteropTest: a GL context and an OpenCL device, and patterns that tell every byte apart.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "frame_layout.h"
#include "host_copy.h"
#include "quincunx/frame.h"
#include "quincunx_gl/bridge.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl::testing {

using Bytes = std::vector<std::uint8_t>;

inline std::uint32_t next_random(std::uint32_t& state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

// Any bits for halves and bytes, NaN payloads, infinities and denormals among them. Depth is within [0, 1],
// as GL stores no other, with both ends and denormals.
inline Bytes random_texels(PixelFormat format, Extent extent, std::uint32_t seed) {
  Bytes bytes(static_cast<std::size_t>(extent.area()) * bytes_per_pixel(format));
  std::uint32_t state = seed * 2654435761u + 1;
  for (std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>(next_random(state) >> 11);
  if (format != PixelFormat::kR32F) return bytes;
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    constexpr std::uint32_t kOne = 0x3f800000u;
    std::uint32_t bits = next_random(state) % (kOne + 1);
    if (i % 64 == 0) bits = kOne;
    if (i % 64 == 4) bits = 0;
    for (std::size_t k = 0; k < 4; ++k)
      bytes[i + k] = static_cast<std::uint8_t>(bits >> (8 * k));
  }
  return bytes;
}

// The same without NaN and infinity among halves and floats.
inline Bytes finite_texels(PixelFormat format, Extent extent, std::uint32_t seed) {
  Bytes bytes = random_texels(format, extent, seed);
  const bool halves = format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F;
  for (std::size_t top = 1; halves && top < bytes.size(); top += 2) {
    if ((bytes[top] & 0x7c) == 0x7c) bytes[top] = static_cast<std::uint8_t>(bytes[top] & ~0x40);
  }
  const bool floats = format == PixelFormat::kRGBA32F || format == PixelFormat::kRG32F;
  for (std::size_t top = 3; floats && top < bytes.size(); top += 4) {
    if ((bytes[top] & 0x7f) == 0x7f) bytes[top] = static_cast<std::uint8_t>(bytes[top] & ~0x40);
  }
  return bytes;
}

// The top left `part` of tightly packed texels.
inline Bytes crop(const Bytes& texels, Extent extent, Extent part, std::size_t texel) {
  Bytes out;
  out.reserve(static_cast<std::size_t>(part.area()) * texel);
  for (int y = 0; y < part.height; ++y) {
    const auto row = texels.begin() + static_cast<std::ptrdiff_t>(y * extent.width * texel);
    out.insert(out.end(), row, row + static_cast<std::ptrdiff_t>(part.width * texel));
  }
  return out;
}

// `outside`, with the top left `part` taken from `inside`.
inline Bytes overlay(Bytes outside, const Bytes& inside, Extent extent, Extent part, std::size_t texel) {
  for (int y = 0; y < part.height; ++y) {
    for (std::size_t i = 0; i < part.width * texel; ++i) {
      const std::size_t at = static_cast<std::size_t>(y) * extent.width * texel + i;
      outside[at] = inside[at];
    }
  }
  return outside;
}

inline GLuint texture_of(const RenderTargets& targets, PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kDepth:
      return targets.depth();
    case PlaneKind::kVelocity:
      return targets.velocity();
    case PlaneKind::kReactive:
      return targets.reactive();
    case PlaneKind::kColour:
      break;
  }
  return targets.colour();
}

inline void fill_plane(const RenderTargets& targets, const Plane& plane, const Bytes& texels) {
  const GlFormat names = gl_format(plane.format);
  const GLenum format = plane.kind == PlaneKind::kDepth ? GLenum{GL_DEPTH_COMPONENT} : names.format;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  texture_write(texture_of(targets, plane.kind), 0, targets.extent(), format, names.type, texels.data());
}

inline Bytes read_plane(const RenderTargets& targets, const Plane& plane) {
  const GlFormat names = gl_format(plane.format);
  const GLenum format = plane.kind == PlaneKind::kDepth ? GLenum{GL_DEPTH_COMPONENT} : names.format;
  Bytes texels(static_cast<std::size_t>(targets.extent().area()) * bytes_per_pixel(plane.format));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture_of(targets, plane.kind), 0, format, names.type,
                    static_cast<GLsizei>(texels.size()), texels.data());
  return texels;
}

inline BridgeSettings all_planes(Extent target, Extent output, PixelFormat colour = PixelFormat::kRGBA16F) {
  return {.target_extent = target,
          .output_extent = output,
          .depth = true,
          .velocity = true,
          .reactive = true,
          .colour = colour};
}

inline FrameInputs inputs_of(const SharedFrame& frame, Extent render) {
  return {.colour = frame.colour,
          .depth = frame.depth,
          .velocity = frame.velocity,
          .reactive = frame.reactive,
          .render_extent = render};
}

// Whether Vulkan has the device that OpenGL draws on.
inline bool has_vulkan() {
  try {
    VulkanDevice::open(gl_device_uuid());
    return true;
  } catch (const InteropError&) {
    return false;
  }
}

class InteropTest : public ::testing::Test {
 protected:
  virtual Api api() const { return Api::kGl45; }

  void SetUp() override {
    auto context = Context::create(Platform::kAuto, api());
    ASSERT_TRUE(context.ok()) << context.status().message();
    context_ = std::make_unique<Context>(std::move(context).value());
    auto device = open_device(*context_, "", Interop::kCopy);
    ASSERT_TRUE(device.ok()) << device.status().message();
    device_ = std::make_unique<Device>(std::move(device).value());
  }

  void TearDown() override {
    if (context_ != nullptr) {
      EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
  }

  // The ways that a bridge may choose on some device with this one's memory. In place only where that is the host's:
  // elsewhere a map that overwrites leaves the bytes that nobody writes undefined (1.2, 5.4.3), so that the host's old
  // ones arrive beside the images, and a bridge copies.
  std::vector<Transfer> transfers() const {
    if (device_->info().host_unified_memory) return {Transfer::kZeroCopy, Transfer::kExplicit};
    return {Transfer::kExplicit};
  }

  Bytes download(const ImageView& view, Extent extent) {
    Bytes texels(static_cast<std::size_t>(extent.area()) * bytes_per_pixel(view.format));
    const Status status = device_->download(view, extent, texels.data());
    EXPECT_TRUE(status.ok()) << status.message();
    return texels;
  }

  // Raw texels; of an image Device::download would ask for the stand-in's own formats.
  Bytes bytes_in(const ImageView& view, Extent extent) {
    if (view.storage == Storage::kBuffer) return download(view, extent);
    Bytes texels(static_cast<std::size_t>(extent.area()) * bytes_per_pixel(view.format));
    const std::array<std::size_t, 3> origin = {0, 0, 0};
    const std::array<std::size_t, 3> region = {static_cast<std::size_t>(extent.width),
                                               static_cast<std::size_t>(extent.height), 1};
    EXPECT_EQ(clEnqueueReadImage(device_->queue(), view.memory, CL_TRUE, origin.data(), region.data(), 0, 0,
                                 texels.data(), 0, nullptr, nullptr),
              CL_SUCCESS);
    return texels;
  }

  void upload(const ImageView& view, const Bytes& texels) {
    const Status status = device_->upload(view, view.extent, texels.data());
    ASSERT_TRUE(status.ok()) << status.message();
  }

  std::unique_ptr<Context> context_;
  std::unique_ptr<Device> device_;
};

}  // namespace quincunx::gl::testing
