// SPDX-License-Identifier: MIT
// Owners of what quincunx.h makes, and frames in host memory for it.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "c_interface/c_settings.h"
#include "quincunx/quincunx.h"
#include "service_fixture.h"

namespace quincunx::testing {

struct CDestroy {
  void operator()(quincunx_device* device) const { quincunx_device_destroy(device); }
  void operator()(quincunx_plan* plan) const { quincunx_plan_destroy(plan); }
  void operator()(quincunx_service* service) const { quincunx_service_destroy(service); }
};
template <typename Object>
using COwner = std::unique_ptr<Object, CDestroy>;

inline COwner<quincunx_plan> c_plan(const SceneNeeds& needs, const ResolveSettings& resolve) {
  quincunx_settings settings = c::to_c({needs, resolve});
  settings.struct_size = sizeof(settings);
  quincunx_plan* plan = nullptr;
  EXPECT_EQ(quincunx_plan_create(&settings, &plan), QUINCUNX_OK) << quincunx_last_error();
  return COwner<quincunx_plan>(plan);
}

// Texels in host memory whose rows are further apart than they need be; the gaps hold poison.
class HostPicture {
 public:
  static constexpr std::size_t kGap = 24;
  static constexpr unsigned char kPoison = 0x7b;

  HostPicture(Extent extent, PixelFormat format)
      : extent_(extent), row_(extent.width * bytes_per_pixel(format)) {
    bytes_.assign((row_ + kGap) * static_cast<std::size_t>(extent.height), kPoison);
    image_ = {.struct_size = sizeof(image_),
              .place = QUINCUNX_HOST,
              .format = static_cast<int>(format),
              .width = extent.width,
              .height = extent.height,
              .offset = 0,
              .pitch = row_ + kGap,
              .memory = bytes_.data()};
  }
  HostPicture(const HostPicture&) = delete;
  HostPicture& operator=(const HostPicture&) = delete;

  template <typename Value>
  void fill(Extent part, const std::function<Value(int, int)>& value) {
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const Value texel = value(x, y);
        std::memcpy(row(y) + static_cast<std::size_t>(x) * sizeof(texel), &texel, sizeof(texel));
      }
    }
  }

  std::vector<unsigned char> texels() const {  // without the gaps
    std::vector<unsigned char> packed;
    for (int y = 0; y < extent_.height; ++y)
      packed.insert(packed.end(), row(y), row(y) + row_);
    return packed;
  }

  bool gaps_are_whole() const {
    for (int y = 0; y < extent_.height; ++y) {
      for (std::size_t i = 0; i < kGap; ++i)
        if (row(y)[row_ + i] != kPoison) return false;
    }
    return true;
  }

  quincunx_image* image() { return &image_; }

 private:
  unsigned char* row(int y) { return bytes_.data() + static_cast<std::size_t>(y) * (row_ + kGap); }
  const unsigned char* row(int y) const { return const_cast<HostPicture*>(this)->row(y); }

  Extent extent_;
  std::size_t row_;
  std::vector<unsigned char> bytes_;
  quincunx_image image_ = {};
};

// ServiceRig's twin behind the C interface, all of whose images lie in host memory.
class CRig {
 public:
  CRig(const SceneNeeds& needs, ResolveSettings settings, Extent output, Extent target)
      : settings_(settings) {
    settings_.output = output;
    settings_.target = target;
    settings_.colour = PixelFormat::kRGBA32F;
    settings_.velocity = PixelFormat::kRG32F;
    settings_.dither = false;
    plan_ = c_plan(needs, settings_);
    quincunx_device* device = nullptr;
    EXPECT_EQ(quincunx_device_open(nullptr, &device), QUINCUNX_OK) << quincunx_last_error();
    device_.reset(device);
    quincunx_service* service = nullptr;
    EXPECT_EQ(quincunx_service_create(device, plan_.get(), &service), QUINCUNX_OK) << quincunx_last_error();
    service_.reset(service);
    resolved_ = std::make_unique<HostPicture>(output, settings_.resolved);
    presented_ = std::make_unique<HostPicture>(output, PixelFormat::kRGBA8);
    outputs_ = {sizeof(outputs_), resolved_->image(), presented_->image(), nullptr};
  }

  // The frame's images are gone when it returns.
  quincunx_status resolve(const HostFrame& frame, quincunx_report* report = nullptr) {
    const Extent size = settings_.targets == Targets::kPlaced ? frame.render : settings_.target;
    HostPicture colour(size, settings_.colour), velocity(size, settings_.velocity);
    HostPicture depth(size, PixelFormat::kR32F), reactive(size, PixelFormat::kR8);
    colour.fill<Pixel>(frame.render, frame.colour);
    velocity.fill<Vec2>(frame.render, frame.velocity);
    depth.fill<float>(frame.render, frame.depth);
    reactive.fill<std::uint8_t>(frame.render, frame.reactive);
    quincunx_inputs inputs = {};
    inputs.struct_size = sizeof(inputs);
    inputs.colour = colour.image();
    inputs.depth = depth.image();
    inputs.velocity = velocity.image();
    inputs.reactive = reactive.image();
    inputs.render_width = frame.render.width;
    inputs.render_height = frame.render.height;
    inputs.jitter_x = frame.jitter.x;
    inputs.jitter_y = frame.jitter.y;
    std::memcpy(inputs.clip_to_previous_clip, frame.camera.clip_to_previous_clip.data(),
                sizeof(inputs.clip_to_previous_clip));
    inputs.reset = frame.reset;
    inputs.parity = frame.parity;
    inputs.frame_index = count_++;
    return quincunx_dispatch(service_.get(), &inputs, &outputs_, report);
  }

  quincunx_service* service() { return service_.get(); }
  quincunx_plan* plan() { return plan_.get(); }
  HostPicture& resolved() { return *resolved_; }
  HostPicture& presented() { return *presented_; }
  void leave_device() { device_.reset(); }

 private:
  ResolveSettings settings_;
  COwner<quincunx_plan> plan_;
  COwner<quincunx_device> device_;
  COwner<quincunx_service> service_;
  std::unique_ptr<HostPicture> resolved_, presented_;
  quincunx_outputs outputs_ = {};
  std::uint64_t count_ = 0;
};

}  // namespace quincunx::testing
