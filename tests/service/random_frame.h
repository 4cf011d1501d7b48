// SPDX-License-Identifier: MIT
// random_frame: frames in which nothing stays the same.
#pragma once

#include <cmath>
#include <random>

#include "service_fixture.h"

namespace quincunx::testing {

// A frame of any size from 1x1 to `target`, of noise with a bright spot, moving anywhere.
inline HostFrame random_frame(std::mt19937& random, Extent target) {
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  const auto unit = [&] { return static_cast<float>(random() % 4096) / 4096; };
  const auto salt = static_cast<unsigned>(random());
  const auto noise = [salt](int x, int y, int c) {
    const unsigned mixed = (static_cast<unsigned>(x) * 73856093u) ^ (static_cast<unsigned>(y) * 19349663u) ^
                           (static_cast<unsigned>(c) * 83492791u) ^ salt;
    return static_cast<float>((mixed * 2654435761u) >> 16) / 65536;
  };
  HostFrame frame;
  frame.render = {1 + below(target.width), 1 + below(target.height)};
  frame.jitter = {unit() - .5f, unit() - .5f};
  frame.colour = [=](int x, int y) {
    const float bright = noise(x, y, 3) > .995f ? 65504.f : 1.f;
    return Pixel{bright * noise(x, y, 0), noise(x, y, 1), -noise(x, y, 2), 1};
  };
  const float speed = std::ldexp(1.f, -below(20));
  frame.velocity = [=](int x, int y) { return Vec2{speed * (noise(x, y, 4) - .5f), speed * noise(x, y, 5)}; };
  frame.depth = [=](int x, int y) { return noise(x / 4, y / 4, 6); };
  frame.reactive = [=](int x, int y) { return static_cast<std::uint8_t>(noise(x, y, 7) > .8f ? 200 : 0); };
  frame.reset = below(50) == 0;
  return frame;
}

}  // namespace quincunx::testing
