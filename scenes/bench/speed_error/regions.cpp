// SPDX-License-Identifier: MIT
#include "bench/speed_error/regions.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

#include "bench/speed_error/bench_plan.h"
#include "frames/focus_path.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::bench {
namespace {

// Returns the velocity of pixel i at infinity, which only the camera's turning moves.
Vec2 background_velocity(const CameraMotion& camera, Extent extent, std::size_t i) {
  const auto width = static_cast<std::size_t>(extent.width);
  const glm::vec2 uv((static_cast<float>(i % width) + 0.5f) / static_cast<float>(extent.width),
                     (static_cast<float>(i / width) + 0.5f) / static_cast<float>(extent.height));
  const glm::vec4 now(2 * uv.x - 1, 1 - 2 * uv.y, 0, 1);
  const glm::vec4 before = glm::make_mat4(camera.clip_to_previous_clip.data()) * now;
  constexpr float kSmallestW = 1e-4f;  // behind the previous camera
  const glm::vec2 way = glm::vec2(now) - glm::vec2(before) / std::max(before.w, kSmallestW);
  return {0.5f * way.x, -0.5f * way.y};
}

struct Place {
  double x = 0;  // pixels; the centre of pixel (0, 0) is 0
  double y = 0;
};

// Where pixel i of this frame was in the frame before.
Place previous_place(const Geometry& now, std::size_t i) {
  const auto width = static_cast<std::size_t>(now.extent.width);
  return {static_cast<double>(i % width) - double{now.velocity[i].x} * now.extent.width,
          static_cast<double>(i / width) - double{now.velocity[i].y} * now.extent.height};
}

// Index of the pixel at or up and left of a place; -1 where it and its neighbours right and below are not all
// in the picture.
std::int64_t corner_of(Place place, Extent extent) {
  const double x = std::floor(place.x);
  const double y = std::floor(place.y);
  const bool inside = x >= 0 && y >= 0 && x < extent.width - 1 && y < extent.height - 1;
  return inside ? static_cast<std::int64_t>(y) * extent.width + static_cast<std::int64_t>(x) : -1;
}

constexpr int kThinBlock = 4;         // pixels: two samples each way at half scale
constexpr int kBehindReach = 4;       // pixels
constexpr int kEdgeReach = 2;         // pixels
constexpr float kOtherMotion = 0.5f;  // pixels a frame

using Values = std::vector<float>;

struct Window {
  int back;
  int ahead;
};

float least(float a, float b) {
  return std::min(a, b);
}
float greatest(float a, float b) {
  return std::max(a, b);
}

// Returns for each pixel the best value in the square window from `back` pixels before it to `ahead` after it, each
// way, as far as the picture goes.
template <typename Best>
Values best_in(Extent extent, const Values& values, Window window, const Best& best) {
  const auto pass = [&](const Values& from, std::ptrdiff_t step, const auto& place, int length) {
    Values to = from;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const int at = place(static_cast<int>(i));
      for (int k = -std::min(window.back, at); k <= std::min(window.ahead, length - 1 - at); ++k)
        to[i] = best(to[i], from[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + k * step)]);
    }
    return to;
  };
  const Values rows = pass(
      values, 1, [&](int i) { return i % extent.width; }, extent.width);
  return pass(
      rows, extent.width, [&](int i) { return i / extent.width; }, extent.height);
}

// Returns for each pixel the greatest nearness at which a surface can fill a block: the best of all blocks that hold
// the pixel, the worst within each.
Values opened(Extent extent, std::span<const float> nearest) {
  constexpr int kMargin = kThinBlock - 1;
  const Extent padded{extent.width + 2 * kMargin, extent.height + 2 * kMargin};
  const auto padded_index = [&](int x, int y) {
    return static_cast<std::size_t>(y + kMargin) * padded.width + static_cast<std::size_t>(x + kMargin);
  };
  Values values(static_cast<std::size_t>(padded.area()), std::numeric_limits<float>::infinity());
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x)
      values[padded_index(x, y)] = nearest[static_cast<std::size_t>(y) * extent.width + x];
  }
  values = best_in(padded, values, {0, kMargin}, least);
  values = best_in(padded, values, {kMargin, 0}, greatest);
  Values inside(nearest.size());
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x)
      inside[static_cast<std::size_t>(y) * extent.width + x] = values[padded_index(x, y)];
  }
  return inside;
}

std::vector<std::uint8_t> above_zero(const Values& values) {
  std::vector<std::uint8_t> mask(values.size());
  std::transform(values.begin(), values.end(), mask.begin(), [](float value) { return value > 0 ? 1 : 0; });
  return mask;
}

// Returns the path of the focus over the measured frames; nothing where the conditions have none.
Result<std::optional<scenes::FocusPath>> focus_of(const scenes::Scene& scene, const Conditions& conditions) {
  std::optional<scenes::FocusPath> none;
  if (!conditions.focus) return none;
  const auto target = scenes::FocusTarget::parse(*conditions.focus, conditions.output);
  if (!target.ok()) return target.status();
  const auto path = scenes::FocusPath::create(
      target.value(), scene, conditions.output,
      {seconds_of(conditions, conditions.warm_up), 1 / conditions.fps, conditions.frames});
  if (!path.ok()) return path.status();
  return std::optional(path.value());
}

// 1 for each pixel where it shows.
std::vector<std::uint8_t> focus_mask(const scenes::FocusPath& focus, Extent output, double seconds) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(output.area()));
  const auto place = focus.at(seconds);
  if (!place) return mask;
  const auto [x, y, width, height] = place->shown;
  for (int row = y; row < y + height; ++row)
    std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(row) * output.width + x, width, 1);
  return mask;
}

}  // namespace

bool is_nearer(float depth, float other) {
  return depth > std::max(other * kNearer, kHorizon);
}

Result<Geometry> geometry_at(scenes::Renderer& renderer, const gl::RenderTargets& targets, double seconds,
                             double previous_seconds) {
  scenes::FrameView view;
  view.render = targets.extent();
  view.seconds = seconds;
  view.previous_seconds = previous_seconds;
  if (Status status = renderer.draw(targets, view); !status.ok()) return status;
  auto read = gl::read_targets(targets, view.render);
  if (!read.ok()) return read.status();
  gl::TargetPixels& pixels = *read;
  const CameraMotion camera = renderer.camera_motion(view);
  Geometry geometry{.extent = view.render, .depth = std::move(pixels.depth), .velocity = {}};
  geometry.velocity.reserve(geometry.depth.size());
  for (std::size_t i = 0; i < geometry.depth.size(); ++i) {
    if (geometry.depth[i] > 0) {
      geometry.velocity.push_back(
          {glm::unpackHalf1x16(pixels.velocity[2 * i]), glm::unpackHalf1x16(pixels.velocity[2 * i + 1])});
    } else {
      geometry.velocity.push_back(background_velocity(camera, view.render, i));
    }
  }
  return geometry;
}

Result<std::vector<float>> nearest_depth_at(scenes::Renderer& renderer, const gl::RenderTargets& targets,
                                            double seconds) {
  constexpr float kStep = 1.0f / 3;
  std::vector<float> nearest(static_cast<std::size_t>(targets.extent().area()), 0);
  for (int sample = 0; sample < 9; ++sample) {
    scenes::FrameView view;
    view.render = targets.extent();
    view.jitter = {kStep * static_cast<float>(sample % 3 - 1), kStep * static_cast<float>(sample / 3 - 1)};
    view.seconds = view.previous_seconds = seconds;
    if (Status status = renderer.draw(targets, view); !status.ok()) return status;
    const auto pixels = gl::read_targets(targets, view.render);
    if (!pixels.ok()) return pixels.status();
    for (std::size_t i = 0; i < nearest.size(); ++i)
      nearest[i] = std::max(nearest[i], pixels->depth[i]);
  }
  return nearest;
}

std::vector<std::uint8_t> disoccluded_since(const Geometry& now, const Geometry& before) {
  std::vector<std::uint8_t> mask(now.depth.size(), 0);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::int64_t corner = corner_of(previous_place(now, i), before.extent);
    if (corner < 0) continue;
    const float* upper = before.depth.data() + corner;
    const float* lower = upper + before.extent.width;
    const float farthest = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
    mask[i] = is_nearer(farthest, now.depth[i]) ? 1 : 0;
  }
  return mask;
}

std::vector<std::uint8_t> disoccluded_within_two(const Geometry& now, std::vector<std::uint8_t> newer,
                                                 const std::vector<std::uint8_t>& older) {
  for (std::size_t i = 0; i < newer.size(); ++i) {
    const Place place = previous_place(now, i);
    const std::int64_t nearest = corner_of({std::round(place.x), std::round(place.y)}, now.extent);
    if (nearest >= 0) newer[i] |= older[static_cast<std::size_t>(nearest)];
  }
  return newer;
}

std::vector<std::uint8_t> thin_pixels(Extent extent, std::span<const float> nearest) {
  const Values blocks = opened(extent, nearest);
  std::vector<std::uint8_t> thin(nearest.size());
  for (std::size_t i = 0; i < thin.size(); ++i)
    thin[i] = is_nearer(nearest[i], blocks[i]) ? 1 : 0;
  return thin;
}

std::vector<std::uint8_t> behind_thin_pixels(Extent extent, std::span<const float> nearest,
                                             std::span<const std::uint8_t> thin) {
  Values thin_depth(nearest.size());
  for (std::size_t i = 0; i < thin_depth.size(); ++i)
    thin_depth[i] = thin[i] != 0 ? nearest[i] : 0;
  thin_depth = best_in(extent, thin_depth, {kBehindReach, kBehindReach}, greatest);
  std::vector<std::uint8_t> behind(nearest.size());
  for (std::size_t i = 0; i < behind.size(); ++i)
    behind[i] = thin[i] == 0 && is_nearer(thin_depth[i], nearest[i]) ? 1 : 0;
  return behind;
}

std::vector<std::uint8_t> edges_of_motion(const Geometry& geometry) {
  const auto width = static_cast<std::size_t>(geometry.extent.width);
  Values meets(geometry.velocity.size(), 0);
  const auto compare = [&](std::size_t i, std::size_t other) {
    const Vec2 a = geometry.velocity[i];
    const Vec2 b = geometry.velocity[other];
    const float apart = std::hypot((a.x - b.x) * static_cast<float>(geometry.extent.width),
                                   (a.y - b.y) * static_cast<float>(geometry.extent.height));
    if (apart > kOtherMotion) meets[i] = meets[other] = 1;
  };
  for (std::size_t i = 0; i < meets.size(); ++i) {
    if ((i + 1) % width != 0) compare(i, i + 1);
    if (i + width < meets.size()) compare(i, i + width);
  }
  return above_zero(best_in(geometry.extent, meets, {kEdgeReach, kEdgeReach}, greatest));
}

std::vector<Region> regions_of(const Geometry& geometry, std::span<const float> nearest,
                               std::span<const std::uint8_t> disoccluded) {
  const auto thin = thin_pixels(geometry.extent, nearest);
  const auto behind = behind_thin_pixels(geometry.extent, nearest, thin);
  const auto edge = edges_of_motion(geometry);
  std::vector<Region> regions(nearest.size(), Region::kRest);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (thin[i] != 0) {
      regions[i] = Region::kThin;
    } else if (behind[i] != 0) {
      regions[i] = Region::kBehindThin;
    } else if (disoccluded[i] != 0) {
      regions[i] = Region::kDisoccluded;
    } else if (edge[i] != 0) {
      regions[i] = Region::kEdge;
    }
  }
  return regions;
}

Result<std::vector<FrameMasks>> masks_of_frames(scenes::Renderer& renderer, const scenes::Scene& scene,
                                                const Conditions& conditions) {
  constexpr int kBack = 2;
  const auto made =
      gl::RenderTargets::create({.target_extent = conditions.output, .velocity = true, .reactive = false});
  if (!made.ok()) return made.status();
  const gl::RenderTargets& targets = *made;
  const auto focus = focus_of(scene, conditions);
  if (!focus.ok()) return focus.status();
  std::vector<FrameMasks> masks;
  Geometry before;
  std::vector<std::uint8_t> older;
  for (int frame = -kBack; frame < conditions.frames; ++frame) {
    const int index = conditions.warm_up + frame;
    const double seconds = seconds_of(conditions, index);
    const double previous = seconds_of(conditions, index - 1);
    const bool cut = scenes::is_cut(scene, previous, seconds);
    auto now = geometry_at(renderer, targets, seconds, cut ? seconds : previous);
    if (!now.ok()) return now.status();
    if (frame > -kBack) {
      const std::vector<std::uint8_t> none(now->depth.size(), 0);
      if (cut) older = none;
      std::vector<std::uint8_t> newer = cut ? none : disoccluded_since(now.value(), before);
      if (frame >= 0) {
        const auto nearest = nearest_depth_at(renderer, targets, seconds);
        if (!nearest.ok()) return nearest.status();
        FrameMasks& kept = masks.emplace_back();
        kept.disoccluded = disoccluded_within_two(now.value(), newer, older);
        kept.regions = regions_of(now.value(), nearest.value(), kept.disoccluded);
        if (focus.value()) kept.focus = focus_mask(*focus.value(), conditions.output, seconds);
      }
      older = std::move(newer);
    }
    before = std::move(now).value();
  }
  return masks;
}

}  // namespace quincunx::bench
