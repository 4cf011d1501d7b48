// SPDX-License-Identifier: MIT
// Owners of what quincunx.h makes, plans of the library's own settings, pictures in host memory, and a frame that
// brings all there is.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "c_interface/c_frame.h"
#include "quincunx/image.h"
#include "quincunx/quincunx.h"

namespace quincunx::testing {

// Owns what quincunx.h makes.
struct CDestroy {
  void operator()(quincunx_device* device) const { quincunx_device_destroy(device); }
  void operator()(quincunx_plan* plan) const { quincunx_plan_destroy(plan); }
  void operator()(quincunx_service* service) const { quincunx_service_destroy(service); }
  void operator()(quincunx_memory* memory) const { quincunx_memory_destroy(memory); }
};
template <typename Object>
using COwner = std::unique_ptr<Object, CDestroy>;

// Returns a struct of the C interface that knows its size; all else is 0.
template <typename Struct>
Struct sized() {
  Struct made = {};
  made.struct_size = sizeof(made);
  return made;
}

inline COwner<quincunx_device> c_device(const char* selector = "") {
  quincunx_device* device = nullptr;
  EXPECT_EQ(quincunx_device_open(selector, &device), QUINCUNX_OK) << quincunx_last_error();
  return COwner<quincunx_device>(device);
}

inline COwner<quincunx_service> c_service(const COwner<quincunx_device>& device,
                                          const COwner<quincunx_plan>& plan) {
  quincunx_service* service = nullptr;
  EXPECT_EQ(quincunx_service_create(device.get(), plan.get(), &service), QUINCUNX_OK)
      << quincunx_last_error();
  return COwner<quincunx_service>(service);
}

// Returns the inputs of a method that reads colour alone.
inline quincunx_inputs c_inputs(const quincunx_image* colour, Extent render) {
  auto inputs = sized<quincunx_inputs>();
  inputs.colour = colour;
  inputs.render_width = render.width;
  inputs.render_height = render.height;
  return inputs;
}

inline quincunx_settings c_settings(const c::SceneSettings& of) {
  quincunx_settings settings = c::to_c(of);
  settings.struct_size = sizeof(settings);
  return settings;
}

inline COwner<quincunx_plan> c_plan(const SceneNeeds& needs, const ResolveSettings& resolve) {
  const quincunx_settings settings = c_settings({needs, resolve});
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

constexpr Extent kPicture{24, 18};
constexpr Extent kRegion{12, 8};

inline quincunx_settings good_settings() {
  auto settings = sized<quincunx_settings>();
  EXPECT_EQ(quincunx_settings_init(&settings), QUINCUNX_OK);
  settings.output_width = settings.target_width = kPicture.width;
  settings.output_height = settings.target_height = kPicture.height;
  settings.colour_format = QUINCUNX_RGBA32F;
  settings.velocity_format = QUINCUNX_RG32F;
  return settings;
}

// All that a frame can bring, in host memory, for a plan that reads all of it.
struct Everything {
  static quincunx_settings settings() {
    quincunx_settings all = good_settings();
    all.min_output_width = all.min_output_height = 8;
    all.particle_target_width = kPicture.width;
    all.particle_target_height = kPicture.height;
    all.focus_width = all.focus_target_width = kRegion.width;
    all.focus_height = all.focus_target_height = kRegion.height;
    all.focus_mask = all.measures_content = all.fades = 1;
    all.sky_motion = QUINCUNX_BY_CAMERA;
    all.depth_convention = QUINCUNX_REVERSED;
    return all;
  }

  Everything() {
    frame.struct_size = sizeof(frame);
    frame.colour = colour.image();
    frame.depth = depth.image();
    frame.velocity = velocity.image();
    frame.reactive = reactive.image();
    frame.exposure_image = exposure.image();
    frame.render_width = frame.output_width = kPicture.width;
    frame.render_height = frame.output_height = kPicture.height;
    frame.near_plane = 1;
    frame.far_plane = 100;
    frame.particles = &particles;
    frame.focus = &focus;
    frame.fade = &fade;
    frame.sync = &sync;
    region = frame;
    region.exposure_image = nullptr;
    region.particles = nullptr;
    region.focus = nullptr;
    region.fade = nullptr;
    region.sync = nullptr;
    region.render_width = region.output_width = kRegion.width;
    region.render_height = region.output_height = kRegion.height;
  }
  Everything(const Everything&) = delete;
  Everything& operator=(const Everything&) = delete;

  HostPicture colour{kPicture, PixelFormat::kRGBA32F}, depth{kPicture, PixelFormat::kR32F},
      velocity{kPicture, PixelFormat::kRG32F}, reactive{kPicture, PixelFormat::kR8},
      exposure{{1, 1}, PixelFormat::kR32F}, other{kPicture, PixelFormat::kRGBA32F},
      mask{kRegion, PixelFormat::kR8}, linear{kPicture, PixelFormat::kRGBA32F},
      presented{kPicture, PixelFormat::kRGBA8};
  quincunx_particles particles = {sizeof(particles), colour.image(), depth.image(),
                                  reactive.image(),  kPicture.width, kPicture.height};
  quincunx_rectangle rectangles[4] = {{4, 4, 6, 4}, {5, 5, 3, 2}, {4, 4, 1, 1}, {6, 4, 2, 2}};
  quincunx_inputs frame = {};
  quincunx_inputs region = {};
  quincunx_focus focus = {sizeof(focus), &region, 3, 2, rectangles, 2, 2, mask.image()};
  quincunx_fade fade = {sizeof(fade), other.image(), 0.5f, 0};
  void* done = nullptr;
  quincunx_sync sync = {sizeof(sync), nullptr, 0, 0, nullptr, nullptr, nullptr, 0, 0};
  quincunx_outputs outputs = {sizeof(outputs), linear.image(), presented.image()};
};

}  // namespace quincunx::testing
