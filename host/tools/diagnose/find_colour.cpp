// SPDX-License-Identifier: MIT
// What colours tell of themselves: encoded for a screen, or filtered.
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/diagnose/findings.h"
#include "tools/image/display_light.h"

namespace quincunx::tools {
namespace {

using Colour = std::array<float, 3>;

Colour decoded(const Colour& colour) {
  return {linear_of_srgb(colour[0]), linear_of_srgb(colour[1]), linear_of_srgb(colour[2])};
}

// How far `b` lies from the line from `a` to `c`, in lengths of that line; nothing where it lies beyond its middle.
float apart(const Colour& a, const Colour& b, const Colour& c) {
  float along = 0, length = 0, distance = 0;
  for (std::size_t k = 0; k < 3; ++k)
    along += (b[k] - a[k]) * (c[k] - a[k]), length += (c[k] - a[k]) * (c[k] - a[k]);
  if (!(length > 0)) return -1;
  along /= length;
  for (std::size_t k = 0; k < 3; ++k) {
    const float off = b[k] - a[k] - along * (c[k] - a[k]);
    distance += off * off;
  }
  return along > .1f && along < .9f ? std::sqrt(distance / length) : -1;
}

bool within_screen(const Colour& colour) {
  return std::all_of(colour.begin(), colour.end(), [](float v) { return v >= 0 && v <= 1; });
}

// What three pixels in a row say: where the middle one is a mixture of both others, colours of linear light lie on a
// straight line, and encoded ones on a curve. Source: Lin, Gu, Yamazaki and Shum, "Radiometric Calibration from a
// Single Image", 2004, which looks at edges.
struct Mixtures {
  std::size_t linear = 0;
  std::size_t encoded = 0;

  // Three of a row of colours, and the same decoded.
  void add(const std::vector<Colour>& row, const std::vector<Colour>& light, std::size_t first,
           std::size_t step) {
    constexpr float kLeastBend = .03f, kStraight = .3f;
    const Colour &a = row[first], &b = row[first + step], &c = row[first + 2 * step];
    if (!within_screen(a) || !within_screen(b) || !within_screen(c)) return;
    const float as_is = apart(a, b, c);
    if (as_is < 0) return;
    const Colour &da = light[first], &db = light[first + step], &dc = light[first + 2 * step];
    const float as_decoded = apart(da, db, dc);
    const Colour middle = {(a[0] + c[0]) / 2, (a[1] + c[1]) / 2, (a[2] + c[2]) / 2};
    const float bend = apart(da, decoded(middle), dc);
    if (as_decoded < 0 || bend < kLeastBend) return;
    const bool straight = as_is < kStraight * bend, straight_decoded = as_decoded < kStraight * bend;
    if (straight == straight_decoded) return;
    ++(straight ? linear : encoded);
  }
};

// Whether all values are those of 8 bits.
bool eight_bits(const DiagnosedFrame& frame) {
  constexpr float kRoom = .08f;  // of a step: values may have been stored as halves
  std::array<bool, 256> levels = {};
  std::size_t off = 0;
  for (const Colour& colour : frame.colour) {
    for (const float value : colour) {
      const float level = std::round(value * 255);
      if (!(level >= 0 && level <= 255 && std::abs(value * 255 - level) < kRoom)) {
        ++off;
      } else {
        levels[static_cast<std::size_t>(level)] = true;
      }
    }
  }
  return off * 1000 < frame.colour.size() && std::count(levels.begin(), levels.end(), true) >= 24;
}

// Which parts of a jump of light, where one surface ends before another and both are plain, lie between the two pixels
// beside the rim: all of it where a pixel shows one sample.
void add_rim_parts(const DiagnosedFrame& frame, const std::vector<float>& depth, float light_scale,
                   std::vector<float>& parts) {
  constexpr float kOther = 1.2f, kAlike = 1.05f;  // depths
  constexpr float kLeastJump = .15f, kFlat = .06f;
  const auto look = [&](std::size_t at, std::size_t step) {
    const auto z = [&](std::size_t i) { return depth[at + i * step]; };
    const auto alike = [&](std::size_t i, std::size_t j) {
      return z(i) <= kAlike * z(j) && z(j) <= kAlike * z(i);
    };
    if (!(z(2) > kOther * z(3) || z(3) > kOther * z(2))) return;
    if (!alike(0, 1) || !alike(1, 2) || !alike(3, 4) || !alike(4, 5)) return;
    const auto light = [&](std::size_t i) {
      const float value = frame.luminance[at + i * step] * light_scale;
      return value > 0 ? std::sqrt(value / (1 + value)) : 0;
    };
    const float jump = light(4) - light(1);
    if (!(std::abs(jump) > kLeastJump) || std::abs(light(1) - light(0)) > kFlat * std::abs(jump) ||
        std::abs(light(5) - light(4)) > kFlat * std::abs(jump))
      return;
    parts.push_back((light(3) - light(2)) / jump);
  };
  const auto width = static_cast<std::size_t>(frame.render.width);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (i % width + 5 < width) look(i, 1);
    if (i + 5 * width < depth.size()) look(i, width);
  }
}

}  // namespace

Finding find_encoding(const Scene& scene) {
  constexpr std::size_t kLeast = 50;
  Finding finding = {.subject = "colour", .says = "linear"};
  Mixtures mixtures;
  std::size_t looked = 0, stepped = 0;
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.colour.empty()) continue;
    ++looked;
    stepped += eight_bits(frame) ? 1 : 0;
    const auto width = static_cast<std::size_t>(frame.render.width);
    std::vector<Colour> light(frame.colour.size());
    std::transform(frame.colour.begin(), frame.colour.end(), light.begin(), decoded);
    for (std::size_t i = 0; i + 2 * width < frame.colour.size(); ++i) {
      mixtures.add(frame.colour, light, i, width);
      if (i % width + 2 < width) mixtures.add(frame.colour, light, i, 1);
    }
  }
  const std::size_t all = mixtures.linear + mixtures.encoded;
  const double share = all > 0 ? static_cast<double>(mixtures.encoded) / static_cast<double>(all) : 0;
  const bool in_steps = looked > 0 && stepped == looked;
  if (!in_steps && (all < kLeast || (share > .3 && share < .8))) return finding;
  const bool encoded = in_steps || share >= .8;
  finding.verdict = encoded ? Verdict::kWrong : Verdict::kRight;
  finding.share = in_steps ? 1 : encoded ? share : 1 - share;
  if (!encoded) return finding;
  finding.faults = {"encoded"};
  finding.fits = in_steps ? "8 bits a channel, as for a screen" : "encoded, as sRGB is";
  finding.option = "write linear light";
  return finding;
}

Finding find_filter(const Scene& scene, DepthKind kind) {
  constexpr float kWhole = .85f;  // of a jump between two pixels
  constexpr std::size_t kLeast = 100;
  Finding finding = {.subject = "picture", .says = "as sampled"};
  std::vector<float> parts;
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.depth.empty()) continue;
    std::vector<float> depth = frame.depth;
    to_reversed_depth(kind, scene.input.near_plane, depth);
    add_rim_parts(frame, depth, scene.light_scale, parts);
  }
  if (parts.size() < kLeast) return finding;
  const auto part = std::count_if(parts.begin(), parts.end(), [](float p) { return p < kWhole; });
  const double share = static_cast<double>(part) / static_cast<double>(parts.size());
  if (share > .45 && share < .8) return finding;
  finding.verdict = share >= .8 ? Verdict::kWrong : Verdict::kRight;
  finding.share = finding.verdict == Verdict::kWrong ? share : 1 - share;
  if (finding.verdict == Verdict::kRight) return finding;
  finding.faults = {"filtered"};
  finding.fits = "anti-aliased or blurred";
  finding.option = "write frames before such filters";
  return finding;
}

}  // namespace quincunx::tools
