// SPDX-License-Identifier: MIT
// How well one frame foretells the next.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

constexpr int kWantedPlaces = 4000;
constexpr float kLeastGradient = .01f;  // of light in a pixel
constexpr int kBlocks = 6;              // of a picture's side

float clean(float value) {
  return value > 0 && value < 1e6f ? value : 0;
}

// The middle of what is not black.
float middle(const std::vector<float>& values) {
  std::vector<float> lit;
  for (std::size_t i = 0; i < values.size(); i += 7)
    if (clean(values[i]) > 0) lit.push_back(values[i]);
  if (lit.empty()) return 1;
  std::nth_element(lit.begin(), lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2), lit.end());
  return lit[lit.size() / 2];
}

float at(const Plane& plane, int x, int y) {
  const int cx = std::clamp(x, 0, plane.extent.width - 1), cy = std::clamp(y, 0, plane.extent.height - 1);
  return plane.values[static_cast<std::size_t>(cy) * static_cast<std::size_t>(plane.extent.width) +
                      static_cast<std::size_t>(cx)];
}

Plane plane_of(const std::vector<float>& values, Extent extent, float scale) {
  Plane sharp = {extent, std::vector<float>(values.size())};
  for (std::size_t i = 0; i < sharp.values.size(); ++i) {
    const float value = clean(values[i]) * scale;
    sharp.values[i] = std::sqrt(value / (1 + value));
  }
  // 1 2 1 along rows, then along columns; borders go on.
  const auto width = static_cast<std::size_t>(extent.width), height = static_cast<std::size_t>(extent.height);
  Plane across = sharp, soft = sharp;
  const auto mix = [](const float* from, const float* last, const float* next) {
    return .5f * *from + .25f * (*last + *next);
  };
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const float* from = &sharp.values[y * width + x];
      across.values[y * width + x] = mix(from, x > 0 ? from - 1 : from, x + 1 < width ? from + 1 : from);
    }
  }
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const float* from = &across.values[y * width + x];
      soft.values[y * width + x] =
          mix(from, y > 0 ? from - width : from, y + 1 < height ? from + width : from);
    }
  }
  return soft;
}

std::array<float, 4> catmull_rom(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {.5f * (-t + 2 * t2 - t3), .5f * (2 - 5 * t2 + 3 * t3), .5f * (t + 4 * t2 - 3 * t3),
          .5f * (t3 - t2)};
}

// At texel coordinates within the plane, which are not negative.
float sample(const Plane& plane, float x, float y) {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const auto wx = catmull_rom(x - static_cast<float>(x0)), wy = catmull_rom(y - static_cast<float>(y0));
  const bool inside = x0 >= 1 && y0 >= 1 && x0 + 2 < plane.extent.width && y0 + 2 < plane.extent.height;
  std::array<float, 4> columns = {};
  for (int j = 0; j < 4; ++j) {
    const float weight = wy[static_cast<std::size_t>(j)];
    if (inside) {
      const float* texels =
          &plane.values[static_cast<std::size_t>(y0 + j - 1) * static_cast<std::size_t>(plane.extent.width) +
                        static_cast<std::size_t>(x0 - 1)];
      for (std::size_t i = 0; i < 4; ++i)
        columns[i] += weight * texels[i];
    } else {
      for (int i = 0; i < 4; ++i)
        columns[static_cast<std::size_t>(i)] += weight * at(plane, x0 + i - 1, y0 + j - 1);
    }
  }
  return wx[0] * columns[0] + wx[1] * columns[1] + wx[2] * columns[2] + wx[3] * columns[3];
}

float gradient(const Plane& plane, int x, int y) {
  return std::max(std::abs(at(plane, x + 1, y) - at(plane, x - 1, y)),
                  std::abs(at(plane, x, y + 1) - at(plane, x, y - 1))) /
         2;
}

// Whether a pixel moves as its neighbours do, in whatever unit: at rims and on thin things colours of two surfaces are
// mixed, and no motion foretells those.
bool moves_alike(const DiagnosedFrame& frame, int x, int y) {
  if (frame.velocity.empty()) return true;
  const Vec2 own = frame.velocity[pixel_of(frame, x, y)];
  const float room = .1f * std::max(std::abs(own.x), std::abs(own.y));
  for (int j = y - 2; j <= y + 2; ++j) {
    for (int i = x - 2; i <= x + 2; ++i) {
      const Vec2 off = difference(frame.velocity[pixel_of(frame, i, j)], own);
      if (!(std::abs(off.x) <= room && std::abs(off.y) <= room)) return false;
    }
  }
  return true;
}

// The place with the largest gradient of each cell of the picture, of those that count.
template <typename Counts>
std::vector<Place> places_of(const Plane& plane, Counts counts) {
  const int cell =
      std::max(2, static_cast<int>(std::sqrt(static_cast<double>(plane.extent.area()) / kWantedPlaces)));
  std::vector<Place> places;
  for (int top = 2; top + cell < plane.extent.height - 2; top += cell) {
    for (int left = 2; left + cell < plane.extent.width - 2; left += cell) {
      Place best;
      float most = kLeastGradient;
      for (int y = top; y < top + cell; ++y) {
        for (int x = left; x < left + cell; ++x) {
          const float here = gradient(plane, x, y);
          if (here > most && counts(x, y)) most = here, best = {.x = x, .y = y, .light = at(plane, x, y)};
        }
      }
      if (most > kLeastGradient) places.push_back(best);
    }
  }
  return places;
}

// The earlier frame's light where a place was; -1 where that is out of the picture.
float light_before(const Pair& pair, const Plane& before, const Motion& motion, Vec2 shift, std::size_t i) {
  const Place& place = pair.places[i];
  const float x = (static_cast<float>(place.x) + .5f - motion[i].x) * pair.ratio.x - .5f + shift.x;
  const float y = (static_cast<float>(place.y) + .5f - motion[i].y) * pair.ratio.y - .5f + shift.y;
  const bool inside = x >= 0 && y >= 0 && x <= static_cast<float>(before.extent.width - 1) &&
                      y <= static_cast<float>(before.extent.height - 1);
  return inside ? std::max(sample(before, x, y), 0.0f) : -1;
}

float square_error(const Pair& pair, const Plane& before, const Motion& motion, Vec2 shift, std::size_t i) {
  const float light = light_before(pair, before, motion, shift, i);
  const float error = light < 0 ? kMostError : std::min(std::abs(light - pair.places[i].light), kMostError);
  return error * error;
}

// Gives a pair's places their channels.
void take_velocity(Frames frames, Pair& pair) {
  const Extent now = frames[pair.now].render;
  for (Place& place : pair.places) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = pair.now + k - 1;
      if (from >= frames.size() || frames[from].velocity.empty() || frames[from].render != now) continue;
      const Vec2 v = frames[from].velocity[pixel_of(frames[from], place.x, place.y)];
      if (std::isfinite(v.x) && std::isfinite(v.y)) place.velocity[k] = v;
    }
  }
}

// Whether two guesses differ in how long a step of the jitter is. Shapes cannot tell that: their rims leap a pixel or
// stay, and the shorter step is right the more often.
bool differ_in_length(const Foretold& one, const Foretold& other) {
  constexpr float kOther = 1.2f;  // of the squares
  for (std::size_t p = 0; p < std::min(one.errors.size(), other.errors.size()); ++p) {
    if (one.errors[p].empty() || other.errors[p].empty()) continue;
    const float a = square(one.shift[p]), b = square(other.shift[p]);
    if (std::max(a, b) > kOther * std::min(a, b)) return true;
  }
  return false;
}

Comparison compare_alike(std::span<const Pair> pairs, Frames frames, const Foretold& one,
                         const Foretold& other) {
  Comparison result;
  double sum_one = 0, sum_other = 0, sum = 0, squares = 0;
  std::size_t blocks = 0, better = 0, counted = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (one.errors.empty() || other.errors.empty()) break;
    if (one.errors[p].empty() || other.errors[p].empty()) continue;
    const Extent extent = frames[pairs[p].now].render;
    struct Block {
      double gain = 0;
      int places = 0;
    };
    std::vector<Block> grid(kBlocks * kBlocks);
    double pair_gain = 0;
    std::size_t in_pair = 0;
    for (std::size_t i = 0; i < pairs[p].places.size(); ++i) {
      const Vec2 moved = product(difference((*other.motion)[p][i], (*one.motion)[p][i]), pairs[p].ratio);
      const float x = moved.x + one.shift[p].x - other.shift[p].x;
      const float y = moved.y + one.shift[p].y - other.shift[p].y;
      if (std::abs(x) < one.apart && std::abs(y) < one.apart) continue;
      const Place& place = pairs[p].places[i];
      Block& block = grid[static_cast<std::size_t>(place.y * kBlocks / extent.height * kBlocks +
                                                   place.x * kBlocks / extent.width)];
      const double gain = other.errors[p][i] - one.errors[p][i];
      block.gain += gain;
      ++block.places;
      pair_gain += gain;
      ++in_pair;
      sum_one += one.errors[p][i];
      sum_other += other.errors[p][i];
    }
    for (const Block& block : grid) {
      if (block.places < 3) continue;
      const double gain = block.gain / block.places;
      sum += gain;
      squares += gain * gain;
      ++blocks;
    }
    result.places += in_pair;
    if (in_pair < 20) continue;
    ++counted;
    better += pair_gain > 0 ? 1 : 0;
  }
  constexpr double kFloor = 1e-9;  // of a squared error, so that perfect ones can be compared
  const double floor = kFloor * static_cast<double>(result.places) + 1e-12;
  result.margin_db = 10 * std::log10((sum_other + floor) / (sum_one + floor));
  if (blocks > 1) {
    const double mean = sum / static_cast<double>(blocks);
    const double variance = std::max(squares / static_cast<double>(blocks) - mean * mean, 0.0);
    result.certainty = mean / (std::sqrt(variance / static_cast<double>(blocks)) + 1e-12);
  }
  result.share = counted > 0 ? static_cast<double>(better) / static_cast<double>(counted) : 0;
  return result;
}

}  // namespace

float light_scale(Frames frames) {
  return frames.empty() ? 1 : .5f / middle(frames.front().luminance);
}

std::vector<Plane> planes_of(Frames frames) {
  std::vector<Plane> planes;
  const float scale = light_scale(frames);
  for (const DiagnosedFrame& frame : frames)
    planes.push_back(plane_of(frame.luminance, frame.render, scale));
  return planes;
}

bool follows(Frames frames, std::size_t i) {
  return i > 0 && i < frames.size() && frames[i].number == frames[i - 1].number + 1 && !frames[i].reset;
}

Pair pair_of(Frames frames, std::size_t now) {
  const Extent extent = frames[now].render, before = frames[now - 1].render;
  return {.now = now,
          .before = now - 1,
          .ratio = {static_cast<float>(before.width) / static_cast<float>(extent.width),
                    static_cast<float>(before.height) / static_cast<float>(extent.height)},
          .has_next = follows(frames, now + 1),
          .has_second = follows(frames, now - 1),
          .places = {}};
}

std::vector<Pair> pairs_of(Frames frames, const std::vector<Plane>& planes) {
  std::vector<Pair> pairs;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!follows(frames, i)) continue;
    pairs.push_back(pair_of(frames, i));
    pairs.back().places = places_of(planes[i], [&](int x, int y) { return moves_alike(frames[i], x, y); });
    take_velocity(frames, pairs.back());
  }
  return pairs;
}

std::vector<Pair> add_shapes(Frames frames, const DiagnosedInput& input, std::vector<Plane>& planes) {
  constexpr float kNearer = 1.1f;
  const std::size_t first = planes.size();
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const DiagnosedFrame& frame = frames[i];
    const std::vector<float> depth = reversed_depth(frame, input.depth_kind, input.near_plane);
    planes.push_back(plane_of(depth, depth.empty() ? Extent{} : frame.render, .5f / middle(depth)));
    if (!follows(frames, i) || depth.empty() || frames[i - 1].depth.empty()) continue;
    const auto is_near = [&](int x, int y) {
      const std::size_t at = pixel_of(frame, x, y), width = pixel_of(frame, 0, 1);
      const float least = std::min({depth[at - 1], depth[at + 1], depth[at - width], depth[at + width]});
      return depth[at] > kNearer * least;
    };
    pairs.push_back(pair_of(frames, i));
    pairs.back().before = first + i - 1;
    pairs.back().places = places_of(planes.back(), is_near);
    take_velocity(frames, pairs.back());
  }
  return pairs;
}

std::vector<Motion> at_rest(const std::vector<Pair>& pairs) {
  std::vector<Motion> rest;
  for (const Pair& pair : pairs)
    rest.emplace_back(pair.places.size());
  return rest;
}

std::vector<float> reversed_depth(const DiagnosedFrame& frame, DepthKind kind, float near_plane) {
  std::vector<float> depth = frame.depth;
  to_reversed_depth(kind, near_plane, depth);
  return depth;
}

std::vector<float> foretold_light(const Pair& pair, const Plane& before, const Motion& motion, Vec2 shift) {
  std::vector<float> light(pair.places.size());
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = light_before(pair, before, motion, shift, i);
  return light;
}

std::vector<float> foretell(const Pair& pair, const Plane& before, const Motion& motion, Vec2 shift,
                            std::size_t stride) {
  std::vector<float> errors;
  errors.reserve(pair.places.size() / stride + 1);
  for (std::size_t i = 0; i < pair.places.size(); i += stride)
    errors.push_back(square_error(pair, before, motion, shift, i));
  return errors;
}

double least_error(const Pair& pair, const Plane& before, const Motion& motion) {
  constexpr std::size_t kEnough = 250;
  const std::size_t stride = std::max<std::size_t>(pair.places.size() / kEnough, 1);
  Vec2 best;
  double least = -1;
  const auto search = [&](Vec2 centre, float step, int reach) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const Vec2 shift = {centre.x + step * static_cast<float>(i), centre.y + step * static_cast<float>(j)};
        double sum = 0;
        for (std::size_t p = 0; p < pair.places.size() && (least < 0 || sum < least); p += stride)
          sum += square_error(pair, before, motion, shift, p);
        if (least < 0 || sum < least) least = sum, best = shift;
      }
    }
  };
  search({}, .5f, 2);
  search(best, .25f, 1);
  return least;
}

Comparison compare(std::span<const Pair> pairs, Frames frames, const Foretold& one, const Foretold& other) {
  const auto shapes = std::find_if_not(pairs.begin(), pairs.end(), is_of_light);
  const Comparison light = compare_alike({pairs.begin(), shapes}, frames, one, other);
  if (shapes == pairs.end() || differ_in_length(one, other)) return light;
  const Comparison both = compare_alike(pairs, frames, one, other);
  return clear(both) && (!clear(light) || both.margin_db > light.margin_db) ? both : light;
}

void weigh(Finding& finding, const Comparison& comparison) {
  finding.margin_db = comparison.margin_db;
  finding.certainty = comparison.certainty;
  finding.share = comparison.share;
}

Finding judged(Finding finding, bool wrong, double share, const std::string& fault, const std::string& fits,
               const std::string& option) {
  finding.verdict = wrong ? Verdict::kWrong : Verdict::kRight;
  finding.share = share;
  if (wrong) finding.faults = {fault}, finding.fits = fits, finding.option = option;
  return finding;
}

bool clear(const Comparison& comparison, double least_db) {
  if (comparison.places < 60) return false;
  const double least = least_db + 100.0 / static_cast<double>(comparison.places);
  return comparison.margin_db >= least && comparison.certainty >= 6 && comparison.share >= .75;
}

std::size_t choose(std::span<const Pair> pairs, Frames frames, const std::vector<Candidate>& candidates) {
  constexpr std::size_t kMostFaults = 5;
  std::size_t chosen = 0;
  for (std::size_t faults = 1; faults <= kMostFaults; ++faults) {
    double most = 0;
    std::size_t best = chosen;
    for (std::size_t c = 1; c < candidates.size(); ++c) {
      if (candidates[c].faults != faults) continue;
      const Comparison compared = compare(pairs, frames, candidates[c].foretold, candidates[chosen].foretold);
      const double gain = compared.margin_db * static_cast<double>(compared.places);
      const bool same = candidates[c].motion == candidates[chosen].motion;
      if (clear(compared, same ? kLeastDb : kLeastMotionDb) && gain > most * 1.001) most = gain, best = c;
    }
    chosen = best;
  }
  const bool moved = candidates[chosen].motion != candidates[0].motion;
  const auto against = compare(pairs, frames, candidates[chosen].foretold, candidates[0].foretold);
  if (!clear(against, moved ? kLeastMotionDb : kLeastDb)) return 0;
  // None is believed where another jitter, as simple, may be it as well.
  for (const Candidate& other : candidates) {
    if (other.faults != candidates[chosen].faults || other.motion != candidates[chosen].motion) continue;
    const auto over_other = compare_alike(pairs, frames, candidates[chosen].foretold, other.foretold);
    if (over_other.places > 0 && over_other.margin_db < kLeastDb) return 0;
  }
  // A fault more that is not needed goes again: one with fewer may do almost as well, yet have been no clear gain.
  constexpr double kAlmost = .7;
  const auto over = [&](std::size_t one, std::size_t other) {
    return compare(pairs, frames, candidates[one].foretold, candidates[other].foretold);
  };
  for (std::size_t faults = 1; faults < candidates[chosen].faults; ++faults) {
    for (std::size_t c = 1; c < candidates.size(); ++c) {
      if (candidates[c].faults != faults || clear(over(chosen, c))) continue;
      if (over(c, 0).margin_db > kAlmost * over(chosen, 0).margin_db) return c;
    }
  }
  return chosen;
}

void Rivals::add(const Comparison& compared, const std::vector<std::string>& faults) {
  const std::string name = fmt::format("{}", fmt::join(faults, " and "));
  if (!clear(compared)) {
    if (std::find(open.begin(), open.end(), name) == open.end()) open.push_back(name);
  } else if (beaten++ == 0 || compared.margin_db < nearest.margin_db) {
    nearest = compared;
  }
}

void Rivals::judge(Finding& finding) const {
  finding.verdict = beaten > 0 ? Verdict::kRight : Verdict::kUnknown;
  weigh(finding, nearest);
  finding.open = open;
}

}  // namespace quincunx::tools
