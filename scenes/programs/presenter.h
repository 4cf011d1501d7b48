// SPDX-License-Identifier: MIT
// Presenter: brings linear pictures from host memory to 8 bits with the same present pass as every frame.
#pragma once

#include <cstdint>
#include <vector>

#include "quincunx/device.h"
#include "quincunx/resolve_service.h"

namespace quincunx::scenes {

// One extent, one exposure. Not thread-safe; blocks.
class Presenter {
 public:
  // `exposure` > 0 multiplies linear colour.
  static Result<Presenter> create(const Device& device, Extent extent, ToneMap tone_map, bool dither,
                                  float exposure);

  // Linear RGBA, tightly packed, to RGBA8: tone mapped, sRGB encoded.
  Result<std::vector<std::uint8_t>> present(const std::vector<float>& rgba);

 private:
  Presenter(const Device& device, ResolveService service, Image linear, Image encoded, float exposure)
      : device_(device),
        service_(std::move(service)),
        linear_(std::move(linear)),
        encoded_(std::move(encoded)),
        exposure_(exposure) {}

  Device device_;
  ResolveService service_;
  Image linear_;
  Image encoded_;
  float exposure_;
};

}  // namespace quincunx::scenes
