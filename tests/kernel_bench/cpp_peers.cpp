// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "peers.h"
#include "stage.h"

namespace quincunx::bench {
namespace {

constexpr int kChannels = 4;

struct Picture {
  explicit Picture(Extent size, float value = 0.5f)
      : extent(size), values(static_cast<std::size_t>(size.area()) * kChannels, value) {}

  // Clamped to the edge.
  const float* at(int x, int y) const {
    const int i = std::clamp(x, 0, extent.width - 1);
    const int j = std::clamp(y, 0, extent.height - 1);
    return values.data() + (static_cast<std::size_t>(j) * extent.width + i) * kChannels;
  }

  Extent extent;
  std::vector<float> values;
};

struct Position {
  int whole;
  float fraction;
};

Position position(int pixel, float ratio, float jitter) {
  const float u = (static_cast<float>(pixel) + 0.5f) * ratio - 0.5f - jitter;
  const float whole = std::floor(u);
  return {static_cast<int>(whole), u - whole};
}

float ratio_of(int render, int output) {
  return static_cast<float>(render) / static_cast<float>(output);
}

// Calls make(x position, y position, pixel) for every pixel.
template <typename Make>
void for_each_pixel(const Picture& source, float jitter, Picture& output, const Make& make) {
  const float ratio_x = ratio_of(source.extent.width, output.extent.width);
  const float ratio_y = ratio_of(source.extent.height, output.extent.height);
  float* pixel = output.values.data();
  for (int y = 0; y < output.extent.height; ++y) {
    const Position v = position(y, ratio_y, jitter);
    for (int x = 0; x < output.extent.width; ++x, pixel += kChannels)
      make(position(x, ratio_x, jitter), v, pixel);
  }
}

void sample_bilinear(const Picture& source, Position u, Position v, float* pixel) {
  const float* p00 = source.at(u.whole, v.whole);
  const float* p10 = source.at(u.whole + 1, v.whole);
  const float* p01 = source.at(u.whole, v.whole + 1);
  const float* p11 = source.at(u.whole + 1, v.whole + 1);
  for (int c = 0; c < kChannels; ++c) {
    const float upper = p00[c] + (p10[c] - p00[c]) * u.fraction;
    const float lower = p01[c] + (p11[c] - p01[c]) * u.fraction;
    pixel[c] = upper + (lower - upper) * v.fraction;
  }
}

void bilinear(const Picture& source, Picture& output) {
  for_each_pixel(source, 0.25f, output,
                 [&](Position u, Position v, float* pixel) { sample_bilinear(source, u, v, pixel); });
}

std::array<float, 4> catmull_rom_weights(float t) {
  return {0.5f * t * (-1 + t * (2 - t)), 1 + 0.5f * t * t * (-5 + 3 * t), 0.5f * t * (1 + t * (4 - 3 * t)),
          0.5f * t * t * (t - 1)};
}

void catmull_rom(const Picture& source, Picture& output) {
  for_each_pixel(source, 0.25f, output, [&](Position u, Position v, float* pixel) {
    const std::array<float, 4> across = catmull_rom_weights(u.fraction);
    const std::array<float, 4> down = catmull_rom_weights(v.fraction);
    float sum[kChannels] = {};
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) {
        const float* tap = source.at(u.whole - 1 + i, v.whole - 1 + j);
        const float weight = across[static_cast<std::size_t>(i)] * down[static_cast<std::size_t>(j)];
        for (int c = 0; c < kChannels; ++c)
          sum[c] += weight * tap[c];
      }
    }
    std::copy_n(sum, kChannels, pixel);
  });
}

// The first two channels of `velocity0` and `velocity1` are render pixels a frame.
struct SeedInputs {
  Picture colour0, colour1, velocity0, velocity1;
};

void seed_resolve(const SeedInputs& in, Picture& output) {
  const float ratio_x = ratio_of(in.colour1.extent.width, output.extent.width);
  const float ratio_y = ratio_of(in.colour1.extent.height, output.extent.height);
  int index = 0;
  for_each_pixel(in.colour0, 0.25f, output, [&](Position u, Position v, float* pixel) {
    const int x = index % output.extent.width, y = index / output.extent.width;
    ++index;
    const Position u1 = position(x, ratio_x, -0.25f), v1 = position(y, ratio_y, -0.25f);
    const float* m0 = in.velocity0.at(u.whole + (u.fraction > 0.5f), v.whole + (v.fraction > 0.5f));
    const float* m1 = in.velocity1.at(u1.whole + (u1.fraction > 0.5f), v1.whole + (v1.fraction > 0.5f));
    const float weight = 1 / (1 + m0[0] * m0[0] + m0[1] * m0[1] + m1[0] * m1[0] + m1[1] * m1[1]);
    float c0[kChannels], c1[kChannels];
    sample_bilinear(in.colour0, u, v, c0);
    sample_bilinear(in.colour1, u1, v1, c1);
    for (int c = 0; c < kChannels; ++c)
      pixel[c] = (c0[c] + weight * c1[c]) / (1 + weight);
  });
}

}  // namespace

void add_cpp_peers(std::vector<Case>& cases, Extent output, double scale) {
  const Extent render = scaled(output, scale);
  const auto source = std::make_shared<Picture>(render);
  const auto result = std::make_shared<Picture>(output);
  const auto seed = std::make_shared<SeedInputs>(SeedInputs{Picture(render, 0.5f), Picture(render, 0.25f),
                                                            Picture(render, 0.1f), Picture(render, 0.2f)});
  const std::uint64_t bytes = bytes_of(render, PixelFormat::kRGBA32F);
  const std::uint64_t written = bytes_of(output, PixelFormat::kRGBA32F);
  const auto add = [&](const char* name, std::uint64_t read, std::function<void()> run) {
    cases.push_back({.name = fmt::format("C++ {} {:.2f}", name, scale),
                     .scale = scale,
                     .bytes = read + written,
                     .run = [run = std::move(run)] { return wall_ms(run); }});
  };
  add("bilinear", bytes, [=] { bilinear(*source, *result); });
  add("catmull-rom", bytes, [=] { catmull_rom(*source, *result); });
  add("seed resolve", 4 * bytes, [=] { seed_resolve(*seed, *result); });
}

}  // namespace quincunx::bench
