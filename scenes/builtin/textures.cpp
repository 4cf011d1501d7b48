// SPDX-License-Identifier: MIT
#include "builtin/textures.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "random.h"

namespace quincunx::scenes {

namespace {

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

float hash_unit(int x, int y, std::uint64_t seed) {
  const std::uint64_t place =
      (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
  return static_cast<float>(Random::mix(place * 0x9e3779b97f4a7c15u + seed) >> 40) * 0x1p-24f;
}

float smooth(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

int wrapped(int value, int period) {
  if (value >= 0 && value < period) return value;
  return ((value % period) + period) % period;
}

struct Texel {
  glm::vec3 colour{0};
  float height = 0;
  float roughness = 1;
};

template <typename Rule>
Surface make_surface(int size, const Rule& rule) {
  Surface surface;
  surface.size = size;
  const std::size_t count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  surface.colour.reserve(count);
  surface.height.reserve(count);
  surface.roughness.reserve(count);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Texel texel = rule((glm::vec2(x, y) + 0.5f) / static_cast<float>(size));
      surface.colour.push_back(texel.colour);
      surface.height.push_back(texel.height);
      surface.roughness.push_back(texel.roughness);
    }
  }
  return surface;
}

Texture blank_texture(int width, int height, bool srgb) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  texture.srgb = srgb;
  texture.rgba.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  return texture;
}

void append(Texture& texture, glm::vec4 value) {
  for (int i = 0; i < 4; ++i)
    texture.rgba.push_back(to_byte(value[i]));
}

// Asks `rule`, which gives RGBA, at the middle of each texel; places lie in [0, 1] x [0, 1].
template <typename Rule>
Texture make_texture(int width, int height, bool srgb, const Rule& rule) {
  Texture texture = blank_texture(width, height, srgb);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      append(texture, rule((glm::vec2(x, y) + 0.5f) / glm::vec2(width, height)));
  }
  return texture;
}

// The place of a point in a course of blocks: which block, and how far from the nearest joint, in units of the
// course height.
struct Block {
  int row = 0;
  int column = 0;
  float edge = 0;
};

Block stretcher_bond(glm::vec2 at, int columns, int rows) {
  const float y = at.y * static_cast<float>(rows);
  const int row = static_cast<int>(y);
  const float x = at.x * static_cast<float>(columns) + (row % 2 == 0 ? 0.0f : 0.5f);
  const int column = wrapped(static_cast<int>(std::floor(x)), columns);
  const glm::vec2 inside(x - std::floor(x), y - static_cast<float>(row));
  const float aspect = static_cast<float>(rows) / static_cast<float>(columns);
  const glm::vec2 to_edge = glm::min(inside, 1.0f - inside) * glm::vec2(aspect, 1);
  return {row, column, std::min(to_edge.x, to_edge.y)};
}

}  // namespace

FractalNoise::FractalNoise(glm::ivec2 cells, int octaves, std::uint64_t seed) {
  float sum = 0;
  float weight = 1;
  for (int k = 0; k < octaves; ++k) {
    Octave octave{cells * (1 << k), weight, {}};
    for (int y = 0; y < octave.cells.y; ++y) {
      for (int x = 0; x < octave.cells.x; ++x) {
        octave.values.push_back(hash_unit(x, y, seed + static_cast<std::uint64_t>(k)));
      }
    }
    octaves_.push_back(std::move(octave));
    sum += weight;
    weight *= 0.55f;
  }
  for (Octave& octave : octaves_)
    octave.weight /= sum;
}

float FractalNoise::operator()(glm::vec2 at) const {
  float sum = 0;
  for (const Octave& octave : octaves_) {
    const glm::vec2 scaled = at * glm::vec2(octave.cells);
    // Conversion truncates: cheaper than floor, which is a call.
    const glm::ivec2 cell = glm::ivec2(scaled) - glm::ivec2(scaled.x < 0, scaled.y < 0);
    const glm::vec2 f = scaled - glm::vec2(cell);
    const glm::vec2 w = f * f * (3.0f - 2.0f * f);
    const int x0 = wrapped(cell.x, octave.cells.x);
    const int y0 = wrapped(cell.y, octave.cells.y);
    const int x1 = x0 + 1 < octave.cells.x ? x0 + 1 : 0;
    const int y1 = y0 + 1 < octave.cells.y ? y0 + 1 : 0;
    const auto value = [&](int x, int y) {
      return octave.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(octave.cells.x) +
                           static_cast<std::size_t>(x)];
    };
    sum += octave.weight * glm::mix(glm::mix(value(x0, y0), value(x1, y0), w.x),
                                    glm::mix(value(x0, y1), value(x1, y1), w.x), w.y);
  }
  return sum;
}

Surface brick_surface(int size, std::uint64_t seed) {
  const FractalNoise wobbles(16, 3, seed + 40);
  const FractalNoise grains(64, 3, seed + 20);
  constexpr int kColumns = 8;
  constexpr int kRows = 24;
  return make_surface(size, [&](glm::vec2 at) {
    const float wobble = wobbles(at) - 0.5f;
    const Block block = stretcher_bond(at, kColumns, kRows);
    const float tone = hash_unit(block.column, block.row, seed);
    const float burnt = hash_unit(block.column, block.row, seed + 9) > 0.86f ? 1.0f : 0.0f;
    const float grain = grains(at);
    const float face = smooth(0.05f, 0.15f, block.edge + wobble * 0.06f);
    glm::vec3 brick = glm::mix(glm::vec3(0.60f, 0.31f, 0.21f), glm::vec3(0.76f, 0.47f, 0.32f), tone);
    brick = glm::mix(brick, glm::vec3(0.42f, 0.24f, 0.20f), burnt * 0.7f);
    brick *= 0.84f + 0.3f * grain;
    const glm::vec3 mortar = glm::vec3(0.74f, 0.68f, 0.58f) * (0.8f + 0.3f * grain);
    const float height = face * (2.2f + 0.5f * tone) + grain * 0.7f;
    return Texel{glm::mix(mortar, brick, face), height, 0.92f};
  });
}

Surface ashlar_surface(int size, std::uint64_t seed) {
  const FractalNoise stains(4, 5, seed + 3);
  const FractalNoise grains(48, 3, seed + 20);
  constexpr int kColumns = 3;
  constexpr int kRows = 6;
  return make_surface(size, [&](glm::vec2 at) {
    const Block block = stretcher_bond(at, kColumns, kRows);
    const float tone = hash_unit(block.column, block.row, seed);
    const float stain = stains(at);
    const float grain = grains(at);
    const float face = smooth(0.012f, 0.04f, block.edge);
    glm::vec3 stone = glm::mix(glm::vec3(0.78f, 0.70f, 0.57f), glm::vec3(0.88f, 0.81f, 0.69f), tone);
    stone *= 0.80f + 0.16f * stain + 0.16f * grain;
    return Texel{stone * glm::mix(0.66f, 1.0f, face), face * 2.0f + grain * 1.2f, 0.85f};
  });
}

Surface plaster_surface(int size, std::uint64_t seed) {
  const FractalNoise clouds(3, 5, seed);
  const FractalNoise grains(64, 3, seed + 20);
  const FractalNoise patches(5, 5, seed + 50);
  return make_surface(size, [&](glm::vec2 at) {
    const float cloud = clouds(at);
    const float grain = grains(at);
    const float patch = smooth(0.56f, 0.64f, patches(at));
    glm::vec3 wash = glm::mix(glm::vec3(0.84f, 0.63f, 0.38f), glm::vec3(0.93f, 0.77f, 0.54f), cloud);
    wash = glm::mix(wash, glm::vec3(0.86f, 0.78f, 0.66f), patch * 0.6f);
    return Texel{wash * (0.90f + 0.14f * grain), grain * 1.2f - patch * 1.5f, 0.95f};
  });
}

Surface paving_surface(int size, std::uint64_t seed) {
  const FractalNoise stains(4, 5, seed + 3);
  const FractalNoise grains(48, 3, seed + 20);
  const FractalNoise wears(3, 4, seed + 77);
  constexpr int kFlags = 4;  // a repeat holds 4 x 4 flags, two fives of a die each way
  return make_surface(size, [&](glm::vec2 at) {
    const glm::vec2 scaled = at * static_cast<float>(kFlags);
    const glm::vec2 cell = glm::floor(scaled);
    const glm::vec2 inside = scaled - cell;
    const glm::vec2 to_corner = glm::min(inside, 1.0f - inside);
    const glm::vec2 nearest = glm::floor(scaled + 0.5f);
    // Diamonds on every second corner, as the pips of fives that share their corner pips.
    const bool pip_here = wrapped(static_cast<int>(nearest.x) + static_cast<int>(nearest.y), 2) == 0;
    const float diamond = to_corner.x + to_corner.y;
    const float pip = pip_here ? 1 - smooth(0.200f, 0.215f, diamond) : 0;
    const float joint_of_pip = pip_here ? std::abs(diamond - 0.22f) : 1.0f;
    const float joint = std::min(std::min(to_corner.x, to_corner.y) + pip, joint_of_pip);
    const float face = smooth(0.006f, 0.022f, joint);
    const float tone = hash_unit(static_cast<int>(cell.x), static_cast<int>(cell.y), seed);
    const float stain = stains(at);
    const float grain = grains(at);
    glm::vec3 flag = glm::mix(glm::vec3(0.58f, 0.51f, 0.42f), glm::vec3(0.71f, 0.62f, 0.51f), tone);
    flag = glm::mix(flag, glm::vec3(0.34f, 0.27f, 0.25f), pip);
    flag *= 0.78f + 0.22f * stain + 0.14f * grain;
    const float wear = smooth(0.45f, 0.65f, wears(at));
    return Texel{flag * glm::mix(0.6f, 1.0f, face), face * 2.5f + grain * 0.9f, glm::mix(0.8f, 0.48f, wear)};
  });
}

Surface plank_surface(int size, std::uint64_t seed) {
  const FractalNoise warps(4, 3, seed + 5);
  const FractalNoise fibres({128, 8}, 1, seed + 20);
  constexpr int kBoards = 6;
  return make_surface(size, [&](glm::vec2 at) {
    const float x = at.x * kBoards;
    const int board = static_cast<int>(x);
    const float inside = x - static_cast<float>(board);
    const float face = smooth(0.02f, 0.07f, std::min(inside, 1 - inside));
    const float tone = hash_unit(board, 0, seed);
    const float warp = warps(at);
    const float rings = 0.5f + 0.5f * std::sin(glm::two_pi<float>() * (3 * at.x + 2.5f * warp + tone) * 3);
    const float fibre = fibres(at);
    glm::vec3 wood = glm::mix(glm::vec3(0.33f, 0.20f, 0.12f), glm::vec3(0.50f, 0.33f, 0.20f), tone);
    wood *= 0.8f + 0.16f * rings + 0.2f * fibre;
    return Texel{wood * glm::mix(0.45f, 1.0f, face), face * 3 + fibre * 0.8f, 0.7f};
  });
}

Surface stone_surface(int size, std::uint64_t seed) {
  const FractalNoise clouds(3, 5, seed);
  const FractalNoise grains(32, 3, seed + 20);
  return make_surface(size, [&](glm::vec2 at) {
    const float cloud = clouds(at);
    const float grain = grains(at);
    const glm::vec3 stone = glm::mix(glm::vec3(0.80f, 0.73f, 0.62f), glm::vec3(0.90f, 0.85f, 0.75f), cloud);
    return Texel{stone * (0.88f + 0.16f * grain), grain * 0.9f + cloud, 0.8f};
  });
}

Surface grass_surface(int size, std::uint64_t seed) {
  const FractalNoise meadow(3, 4, seed);
  const FractalNoise blades({96, 48}, 2, seed + 20);
  return make_surface(size, [&](glm::vec2 at) {
    const float dry = smooth(0.35f, 0.75f, meadow(at));
    const glm::vec3 grass = glm::mix(glm::vec3(0.36f, 0.42f, 0.20f), glm::vec3(0.47f, 0.48f, 0.25f), dry);
    return Texel{grass * (0.62f + 0.6f * blades(at)), 0, 1};
  });
}

Texture colour_texture(const Surface& surface) {
  Texture texture = blank_texture(surface.size, surface.size, true);
  for (const glm::vec3 colour : surface.colour)
    append(texture, glm::vec4(colour, 1));
  return texture;
}

Texture normal_texture(const Surface& surface, float strength) {
  Texture texture = blank_texture(surface.size, surface.size, false);
  const int size = surface.size;
  const auto height = [&](int x, int y) {
    return surface.height[static_cast<std::size_t>(wrapped(y, size)) * static_cast<std::size_t>(size) +
                          static_cast<std::size_t>(wrapped(x, size))];
  };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::vec2 slope(height(x + 1, y) - height(x - 1, y), height(x, y + 1) - height(x, y - 1));
      const glm::vec3 normal = glm::normalize(glm::vec3(-slope.x * strength / 2, slope.y * strength / 2, 1));
      append(texture, glm::vec4(normal * 0.5f + 0.5f, 1));
    }
  }
  return texture;
}

Texture roughness_texture(const Surface& surface) {
  Texture texture = blank_texture(surface.size, surface.size, false);
  for (const float roughness : surface.roughness)
    append(texture, {1, roughness, 0, 1});
  return texture;
}

Texture leaf_texture(int size, std::uint64_t seed) {
  constexpr int kLeaves = 15;
  struct Leaf {
    glm::vec2 base;
    glm::vec2 along;
    float length;
    float tone;
  };
  Random random(seed, 31);
  std::vector<Leaf> leaves;
  for (int i = 0; i < kLeaves; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(kLeaves - 1);
    const float turn =
        (i % 2 == 0 ? 1.0f : -1.0f) * glm::mix(1.25f, 0.1f, t * t) + 0.25f * random.signed_unit();
    const glm::vec2 base(0.5f + 0.03f * random.signed_unit(), 0.96f - 0.62f * t);
    leaves.push_back({base,
                      {std::sin(turn), -std::cos(turn)},
                      random.range(0.30f, 0.40f) * (1.1f - 0.3f * t),
                      random.unit()});
  }
  Texture texture = make_texture(size, size, true, [&](glm::vec2 at) {
    glm::vec4 texel(0.24f, 0.36f, 0.13f, 0);
    const float stem = std::abs(at.x - 0.5f);
    if (stem < 0.009f && at.y > 0.3f) texel = {0.30f, 0.26f, 0.14f, 1};
    for (const Leaf& leaf : leaves) {
      const glm::vec2 to = at - leaf.base;
      const float along = glm::dot(to, leaf.along) / leaf.length;
      if (along < 0 || along > 1) continue;
      const float across = (to.x * leaf.along.y - to.y * leaf.along.x) / leaf.length;
      const float half_width = 0.55f * std::sqrt(along) * (1 - along) * 0.95f;
      if (std::abs(across) > half_width) continue;
      const float vein = smooth(0.0f, 0.02f, std::abs(across));
      const float side = across > 0 ? 1.0f : 0.86f;
      const glm::vec3 green =
          glm::mix(glm::vec3(0.20f, 0.36f, 0.11f), glm::vec3(0.42f, 0.55f, 0.18f), leaf.tone);
      texel = glm::vec4(green * side * (0.78f + 0.22f * vein) * (0.85f + 0.2f * along), 1);
    }
    return texel;
  });
  texture.wrap_u = texture.wrap_v = Wrap::kClamp;
  return texture;
}

Texture water_normal_texture(int size, std::uint64_t seed) {
  const FractalNoise swell(6, 4, seed);
  Surface surface = make_surface(size, [&](glm::vec2 at) {
    const glm::vec2 from_centre = at - 0.5f;
    const float radius = glm::length(from_centre);
    const float noise = swell(at);
    const float ripple = std::sin(radius * 90 + noise * 5) * std::exp(-radius * 3);
    return Texel{glm::vec3(0), 2.4f * ripple + 6 * noise, 0.1f};
  });
  return normal_texture(surface);
}

Texture cloud_texture(int width, int height, std::uint64_t seed) {
  const FractalNoise shapes({5, 6}, 6, seed);
  const FractalNoise bends({3, 2}, 3, seed + 90);
  Texture texture = make_texture(width, height, true, [&](glm::vec2 at) {
    const glm::vec2 bent = at + glm::vec2(0, 0.16f * bends(at));
    const float density = smooth(0.50f, 0.78f, shapes(bent));
    const float below = smooth(0.50f, 0.78f, shapes(bent - glm::vec2(0.006f, 0.03f)));
    const float ends = smooth(0.0f, 0.25f, at.y) * smooth(1.0f, 0.8f, at.y);
    const glm::vec3 colour =
        glm::mix(glm::vec3(1.0f, 0.93f, 0.85f), glm::vec3(0.72f, 0.70f, 0.74f), 0.8f * below);
    return glm::vec4(colour, 0.85f * density * ends);
  });
  texture.wrap_v = Wrap::kClamp;
  return texture;
}

}  // namespace quincunx::scenes
