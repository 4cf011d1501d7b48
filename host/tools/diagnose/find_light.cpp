// SPDX-License-Identifier: MIT
// What light tells: encoded for a screen, filtered, of another exposure, or of another shot.
#include <fmt/format.h>

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

// Votes by three pixels in a row; `light`: the same decoded. Where the middle one is a mixture of both others, colours
// of linear light lie on a straight line, and encoded ones on a curve. Source: Lin, Gu, Yamazaki and Shum, "Radiometric
// Calibration from a Single Image", 2004, which looks at edges.
void add_mixture(const std::vector<Colour>& row, const std::vector<Colour>& light, std::size_t first,
                 std::size_t step, Votes& encoded) {
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
  if (straight != straight_decoded) encoded.add(straight_decoded);
}

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

// Where one surface ends before another and both are plain, votes whether only a part of the jump of light lies between
// the two pixels beside the rim: all of it does where a pixel shows one sample.
void add_rims(const DiagnosedFrame& frame, const std::vector<float>& depth, float light_scale,
              Votes& in_part) {
  constexpr float kWhole = .85f;
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
    in_part.add((light(3) - light(2)) / jump < kWhole);
  };
  const auto width = static_cast<std::size_t>(frame.render.width);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (i % width + 5 < width) look(i, 1);
    if (i + 5 * width < depth.size()) look(i, width);
  }
}

double middle(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// The mean of a frame's light where there is any, in stops.
double brightness(const DiagnosedFrame& frame) {
  double sum = 0, count = 0;
  for (const float value : frame.luminance) {
    if (value > 1e-3f && value < 1e6f) sum += std::log2(value), count += 1;
  }
  return count > 0 ? sum / count : 0;
}

// How a frame follows from the last.
struct Step {
  std::int64_t number = 0;
  double stops = 0;        // by which the places are brighter
  double overall = 0;      // by which the picture is
  double agree = 0;        // part of the places that changed the same way
  double correlation = 0;  // between the light that was foretold and that which is seen
};

std::vector<Step> steps_of(const Scene& scene) {
  constexpr std::size_t kLeastPlaces = 200;
  constexpr double kDark = .02, kBright = .98;
  std::vector<Step> steps;
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    const Pair& pair = scene.pairs[p];
    const auto light =
        foretold_light(pair, scene.planes[pair.now - 1], scene.motion.motion[p], scene.motion.shift[p]);
    std::vector<double> stops;
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double x = light[i], y = pair.places[i].light;
      if (!(x > kDark && x < kBright && y > kDark && y < kBright)) continue;
      stops.push_back(std::log2(y * y / (1 - y * y) * (1 - x * x) / (x * x)));
      n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
    if (stops.size() < kLeastPlaces) continue;
    const double change = middle(stops);
    const auto same = std::count_if(stops.begin(), stops.end(), [&](double s) { return s * change > 0; });
    const double spread = std::sqrt(std::max((aa - a * a / n) * (bb - b * b / n), 1e-12));
    steps.push_back({.number = scene.frames[pair.now].number,
                     .stops = change,
                     .overall = brightness(scene.frames[pair.now]) - brightness(scene.frames[pair.now - 1]),
                     .agree = static_cast<double>(same) / n,
                     .correlation = (ab - a * b / n) / spread});
  }
  return steps;
}

}  // namespace

Finding find_encoding(const Scene& scene) {
  constexpr std::size_t kLeast = 50;
  Finding finding = {.subject = "colour", .says = "linear"};
  Votes encoded;
  std::size_t looked = 0, stepped = 0;
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.colour.empty()) continue;
    ++looked;
    stepped += eight_bits(frame) ? 1 : 0;
    const auto width = static_cast<std::size_t>(frame.render.width);
    std::vector<Colour> light(frame.colour.size());
    std::transform(frame.colour.begin(), frame.colour.end(), light.begin(), decoded);
    for (std::size_t i = 0; i + 2 * width < frame.colour.size(); ++i) {
      add_mixture(frame.colour, light, i, width, encoded);
      if (i % width + 2 < width) add_mixture(frame.colour, light, i, 1, encoded);
    }
  }
  const bool in_steps = looked > 0 && stepped == looked;
  if (!in_steps && !encoded.agree(kLeast, .3)) return finding;
  return judged(finding, in_steps || encoded.most(), in_steps ? 1 : encoded.agreed(), "encoded",
                in_steps ? "8 bits a channel, as for a screen" : "encoded, as sRGB is", "write linear light");
}

Finding find_filter(const Scene& scene, DepthKind kind) {
  constexpr std::size_t kLeast = 100;
  Finding finding = {.subject = "picture", .says = "as sampled"};
  Votes in_part;
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.depth.empty()) continue;
    add_rims(frame, reversed_depth(frame, kind, scene.input.near_plane), scene.light_scale, in_part);
  }
  if (!in_part.agree(kLeast, .45)) return finding;
  return judged(finding, in_part.most(), in_part.agreed(), "filtered", "anti-aliased or blurred",
                "write frames before such filters");
}

void find_light(const Scene& scene, std::vector<Finding>& findings, std::vector<std::int64_t>& cuts_before) {
  constexpr double kJump = .1;                                        // stops
  constexpr double kFollows = .7, kMayFollow = .5, kIsAnother = .35;  // correlations
  const std::vector<Step> steps = steps_of(scene);
  Finding exposure = {.subject = "exposure", .says = "steady"}, cuts = {.subject = "cuts", .says = "marked"};
  std::vector<double> all, correlations;
  for (const Step& step : steps)
    all.push_back(step.stops), correlations.push_back(step.correlation);
  if (steps.size() >= 3 && middle(correlations) > kFollows) {
    exposure.verdict = cuts.verdict = Verdict::kRight;
    std::vector<std::string> jumps;
    std::vector<std::int64_t> unmarked;
    bool doubt = false;
    for (const Step& step : steps) {
      if (step.correlation < kMayFollow) cuts.verdict = Verdict::kUnknown;
      const double both = step.overall / step.stops;
      if (step.correlation < kIsAnother) {
        unmarked.push_back(step.number);
      } else if (std::abs(step.stops - middle(all)) > kJump) {
        const bool everywhere = both > .5 && both < 2 && step.agree > .65;
        doubt |= !everywhere;
        if (everywhere) jumps.push_back(fmt::format("{:+.2f} stops in frame {}", step.stops, step.number));
      }
    }
    if (doubt) exposure.verdict = Verdict::kUnknown;
    if (!jumps.empty()) {
      exposure = judged(exposure, true, 0, "jump", fmt::format("{}", fmt::join(jumps, ", ")),
                        "write light before exposure");
    }
    if (!unmarked.empty()) {
      cuts =
          judged(cuts, true, 0, "unmarked", fmt::format("a cut before frame {}", fmt::join(unmarked, ", ")),
                 fmt::format("--cuts {}", fmt::join(unmarked, ",")));
      cuts_before = unmarked;
    }
  }
  findings.push_back(exposure);
  findings.push_back(cuts);
}

}  // namespace quincunx::tools
