// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

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
      exposure.verdict = Verdict::kWrong;
      exposure.faults = {"jump"};
      exposure.fits = fmt::format("{}", fmt::join(jumps, ", "));
      exposure.option = "write light before exposure";
    }
    if (!unmarked.empty()) {
      cuts.verdict = Verdict::kWrong;
      cuts.faults = {"unmarked"};
      cuts.fits = fmt::format("a cut before frame {}", fmt::join(unmarked, ", "));
      cuts.option = fmt::format("--cuts {}", fmt::join(unmarked, ","));
      cuts_before = unmarked;
    }
  }
  findings.push_back(exposure);
  findings.push_back(cuts);
}

}  // namespace quincunx::tools
