// SPDX-License-Identifier: MIT
// resolve_checkerboard: a pixel between four shaded ones.
//   colour   t0 h0 + (1 - t0) (t1 h1 + (1 - t1) s)
//   t0, t1   trust in the nearest and in the farthest surface of the neighbours: clamp(3 - 2 |z' - z| / e) of its
//            depth z and the previous depth z' at the place where it was, bilinear;
//            e = .02 z + .5 (z_nearest - z_farthest) + 1e-9;
//            1 inside the previous viewport, 0 a pixel away from it; times 1 - the neighbours' largest reactive value
//   h0, h1   the previous colour at those places, bilinear, clamped to the range of neighbours and s
//   s        (b a_mean + a b_mean) / (a + b): a, b the squared differences of left and right, above and below, + 1e-30;
//            the plain mean of both where one has a neighbour only
// It shows the nearest surface where t0 >= .5, the farthest where (1 - t0) t1 >= .5, else the nearer one of the pair
// whose depths are closer. Of equal ones the first of left, right, above, below counts.
#include "resolve_checkerboard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace quincunx::reference {
namespace {

constexpr double kLargestMotion = 65504;
constexpr double kLargestDifference = 1e18;  // largest difference of colours, in the weight of a pair
constexpr double kLeastDifference = 1e-30;

struct Place {
  int x = 0, y = 0;
};

// Left, right, above, below.
std::array<Place, 4> around(int x, int y) {
  return {{{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}};
}

bool is_inside(const Frame& frame, Place at) {
  return at.x >= 0 && at.y >= 0 && at.x < frame.width && at.y < frame.height;
}

double depth_at(const Frame& frame, Place at) {
  return frame.depth[index_of(frame.width, at.x, at.y)];
}

// ---- Surfaces.

bool is_surface(const Frame& frame, Place at) {
  return is_inside(frame, at) && std::isfinite(depth_at(frame, at));
}

// Returns the first place that no other exceeds among those that are surfaces; else the first that is inside.
template <typename Exceeds>
Place first_of(const Frame& frame, const std::array<Place, 4>& places, Exceeds exceeds) {
  std::optional<Place> found;
  for (const Place& place : places) {
    if (is_surface(frame, place) && (!found || exceeds(depth_at(frame, place), depth_at(frame, *found))))
      found = place;
  }
  if (found) return *found;
  return *std::find_if(places.begin(), places.end(), [&](Place place) { return is_inside(frame, place); });
}

Place nearest_of(const Frame& frame, const std::array<Place, 4>& places) {
  return first_of(frame, places, [](double a, double b) { return a > b; });
}

Place farthest_of(const Frame& frame, const std::array<Place, 4>& places) {
  return first_of(frame, places, [](double a, double b) { return a < b; });
}

template <typename Real>
Place likely_surface(const Frame& frame, const std::array<Place, 4>& places) {
  const auto [left, right, above, below] = places;
  const bool across = is_surface(frame, left) && is_surface(frame, right);
  const bool down = is_surface(frame, above) && is_surface(frame, below);
  const auto nearer = [&](Place a, Place b) { return depth_at(frame, b) > depth_at(frame, a) ? b : a; };
  if (!across && !down) return nearest_of(frame, places);
  if (!across) return nearer(above, below);
  if (!down) return nearer(left, right);
  const Real apart_across = abs(Real(depth_at(frame, left)) - depth_at(frame, right));
  const Real apart_down = abs(Real(depth_at(frame, above)) - depth_at(frame, below));
  return apart_across <= apart_down ? nearer(left, right) : nearer(above, below);
}

// ---- Where a surface was.

template <typename Real>
struct Past {
  std::array<Real, 2> at = {};
  Real trust = 0;
};

template <typename Real>
Real previous_place(int i, int size, double jitter, int previous_size, double previous_jitter) {
  const double step = static_cast<double>(previous_size) / size;
  return i * Real(step) + ((.5 + jitter) * step - .5 - previous_jitter);
}

template <typename Real>
Real inside(const Real& at, int size, double jitter) {
  const Real edge = -.5 - jitter;
  return clamp(1 - max(edge - at, at - (edge + size)), 0, 1);
}

// The texels on both sides of a place, clamped to the edge; one and the same where it is a texel's.
template <typename Real>
struct Between {
  int low = 0, high = 0;
  Real fraction = 0;
};

template <typename Real>
Between<Real> texels_at(const Real& at, int size) {
  const Split<Real> place = split(at);
  const int beyond = place.fraction > 0 ? 1 : 0;
  return {std::clamp(place.whole, 0, size - 1), std::clamp(place.whole + beyond, 0, size - 1),
          place.fraction};
}

template <typename Real, typename Value>
Real bilinear(const Between<Real>& column, const Between<Real>& row, Value value) {
  const auto mix = [](const Real& a, const Real& b, const Real& part) { return a + (b - a) * part; };
  return mix(mix(value(column.low, row.low), value(column.high, row.low), column.fraction),
             mix(value(column.low, row.high), value(column.high, row.high), column.fraction), row.fraction);
}

double value_of(double number) {
  return number;
}
double value_of(const Bounded& number) {
  return number.value;
}

template <typename Real>
std::array<Real, 2> motion_of(const CheckerboardInputs& in, Place surface, Place pixel, bool is_near) {
  const auto& camera = is_near ? in.nearest_motion : in.farthest_motion;
  if (!camera.empty()) {
    const auto& motion = camera[index_of(in.current.width, pixel.x, pixel.y)];
    if constexpr (std::is_same_v<Real, double>)
      return {motion[0].value, motion[1].value};
    else
      return motion;
  }
  if (!in.moves) return {0, 0};
  const auto& motion = in.current.velocity[index_of(in.current.width, surface.x, surface.y)];
  return {motion[0], motion[1]};
}

template <typename Real>
Past<Real> past_of(const CheckerboardInputs& in, Place surface, Place pixel, bool is_near, const Real& range,
                   const Real& whole) {
  Past<Real> past;
  if (!in.has_history || !is_surface(in.current, surface)) return past;
  const std::array<Real, 2> motion = motion_of<Real>(in, surface, pixel, is_near);
  if (!std::isfinite(value_of(motion[0])) || !std::isfinite(value_of(motion[1]))) return past;
  const Frame& now = in.current;
  const Frame& before = in.previous;
  const auto moved = [&](const Real& velocity, double scale) {
    return clamp(-velocity * Real(scale), -kLargestMotion, kLargestMotion);
  };
  past.at = {previous_place<Real>(pixel.x, now.width, now.jitter_x, before.width, before.jitter_x) +
                 moved(motion[0], now.velocity_scale[0] * before.width),
             previous_place<Real>(pixel.y, now.height, now.jitter_y, before.height, before.jitter_y) +
                 moved(motion[1], now.velocity_scale[1] * before.height)};
  const auto column = texels_at(past.at[0], before.width), row = texels_at(past.at[1], before.height);
  const Real held = bilinear(column, row, [&](int x, int y) { return Real(depth_at(before, {x, y})); });
  if (!std::isfinite(value_of(held))) return past;
  const double depth = depth_at(now, surface);
  const Real tolerance = .02 * Real(std::abs(depth)) + .5 * range + 1e-9;
  const Real agreement = clamp(3 - 2 * abs(held - depth) / tolerance, 0, 1);
  past.trust = agreement * whole * inside(past.at[0], before.width, before.jitter_x) *
               inside(past.at[1], before.height, before.jitter_y);
  return past;
}

double largest_reactive(const Frame& frame, const std::array<Place, 4>& places) {
  double largest = 0;
  for (const Place& place : places) {
    if (is_inside(frame, place))
      largest =
          std::max(largest, std::nearbyint(255 * frame.reactive[index_of(frame.width, place.x, place.y)]));
  }
  return largest;
}

// ---- Colour.

bool is_finite(const Pixel& pixel) {
  return std::all_of(pixel.begin(), pixel.end(), [](double value) { return std::isfinite(value); });
}

// A pair of neighbours.
template <typename Real>
struct Pair {
  PixelOf<Real> mean = {};
  Real difference = 0;  // squared, + 1e-30
  int count = 0;
};

template <typename Real>
Pair<Real> pair_of(const std::optional<Pixel>& a, const std::optional<Pixel>& b) {
  Pair<Real> pair;
  pair.count = (a ? 1 : 0) + (b ? 1 : 0);
  for (std::size_t c = 0; c < 4; ++c) {
    const Real first = a ? (*a)[c] : 0, second = b ? (*b)[c] : 0;
    pair.mean[c] = (first + second) * (pair.count == 2 ? .5 : 1.);
    const Real apart = clamp(first - second, -kLargestDifference, kLargestDifference);
    pair.difference += apart * apart;
  }
  pair.difference += kLeastDifference;
  return pair;
}

template <typename Real>
PixelOf<Real> mean_along_edge(const Pair<Real>& across, const Pair<Real>& down) {
  if (across.count == 0) return down.mean;
  if (down.count == 0) return across.mean;
  Real part = .5;
  if (across.count == 2 && down.count == 2) part = down.difference / (down.difference + across.difference);
  PixelOf<Real> mean;
  for (std::size_t c = 0; c < 4; ++c)
    mean[c] = across.mean[c] * part + down.mean[c] * (1 - part);
  return mean;
}

template <typename Real>
PixelOf<Real> over_rest(const CheckerboardInputs& in, const Past<Real>& past, const PixelOf<Real>& low,
                        const PixelOf<Real>& high, const PixelOf<Real>& rest) {
  if (value_of(past.trust) <= 0) return rest;
  const auto column = texels_at(past.at[0], in.previous.width),
             row = texels_at(past.at[1], in.previous.height);
  for (const int y : {row.low, row.high}) {
    for (const int x : {column.low, column.high}) {
      if (!is_finite(texel_at(in.previous, x, y))) return rest;
    }
  }
  PixelOf<Real> out;
  for (std::size_t c = 0; c < 4; ++c) {
    const Real history =
        bilinear(column, row, [&](int x, int y) { return Real(texel_at(in.previous, x, y)[c]); });
    out[c] = clamp(history, low[c], high[c]) * past.trust + rest[c] * (1 - past.trust);
  }
  return out;
}

template <typename Real>
PixelOf<Real> filled_colour(const CheckerboardInputs& in, const std::array<Place, 4>& places,
                            const Past<Real>& near, const Past<Real>& far) {
  std::array<std::optional<Pixel>, 4> samples;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!is_inside(in.current, places[i])) continue;
    const Pixel& pixel = texel_at(in.current, places[i].x, places[i].y);
    if (is_finite(pixel)) samples[i] = pixel;
  }
  const PixelOf<Real> mean =
      mean_along_edge(pair_of<Real>(samples[0], samples[1]), pair_of<Real>(samples[2], samples[3]));
  PixelOf<Real> low = mean, high = mean;  // which lies between them, so that this adds nothing
  for (const auto& sample : samples) {
    for (std::size_t c = 0; sample && c < 4; ++c) {
      low[c] = min(low[c], (*sample)[c]);
      high[c] = max(high[c], (*sample)[c]);
    }
  }
  // Where the nearest surface is trusted wholly the farthest one does not stand in for a colour that is lost.
  const PixelOf<Real> rest = near.trust < 1 ? over_rest(in, far, low, high, mean) : mean;
  return over_rest(in, near, low, high, rest);
}

}  // namespace

template <typename Real>
FilledPixel<Real> resolve_checkerboard(const CheckerboardInputs& in, int x, int y) {
  const std::array<Place, 4> places = around(x, y);
  const Place nearest = nearest_of(in.current, places), farthest = farthest_of(in.current, places);
  const bool surfaces = is_surface(in.current, nearest);
  const Real range =
      surfaces ? Real(depth_at(in.current, nearest)) - depth_at(in.current, farthest) : Real(0);
  const Real whole = in.reactive ? 1 - largest_reactive(in.current, places) * Real(1. / 255) : Real(1);
  const Past<Real> near = past_of<Real>(in, nearest, {x, y}, true, range, whole);
  const Past<Real> far = past_of<Real>(in, farthest, {x, y}, false, range, whole);
  Place shown = likely_surface<Real>(in.current, places);
  if ((1 - near.trust) * far.trust >= .5) shown = farthest;
  if (near.trust >= .5) shown = nearest;
  return {filled_colour<Real>(in, places, near, far), shown.x, shown.y, near.trust, far.trust};
}

template FilledPixel<double> resolve_checkerboard(const CheckerboardInputs&, int, int);
template FilledPixel<Bounded> resolve_checkerboard(const CheckerboardInputs&, int, int);

void move_camera(CheckerboardInputs& in, double error) {
  const auto motion = [&](auto surface_of) {
    Frame frame = in.current;
    for (int y = 0; y < frame.height; ++y) {
      for (int x = (y + in.parity + 1) % 2; x < frame.width; x += 2) {
        const Place surface = surface_of(in.current, around(x, y));
        frame.depth[index_of(frame.width, x, y)] = depth_at(in.current, surface);
      }
    }
    std::vector<std::array<Bounded, 2>> all;
    for (const CameraVelocity& velocity : velocity_from_depth(frame)) {
      const double off = error * velocity.condition;
      if (std::abs(velocity.w_part) < error) {  // whether it was before the camera is not certain
        all.push_back(
            {Bounded(velocity.velocity[0], 2 * kLargestMotion), {velocity.velocity[1], 2 * kLargestMotion}});
        continue;
      }
      all.push_back({Bounded(velocity.velocity[0], off), {velocity.velocity[1], off}});
    }
    return all;
  };
  in.nearest_motion =
      motion([](const Frame& frame, const auto& places) { return nearest_of(frame, places); });
  in.farthest_motion =
      motion([](const Frame& frame, const auto& places) { return farthest_of(frame, places); });
}

}  // namespace quincunx::reference
