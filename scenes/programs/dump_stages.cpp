// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "programs/dump_session.h"
#include "tools/image/false_colour.h"

namespace quincunx::scenes {
namespace {

using tools::Canvas;
using tools::ColourMap;

constexpr std::array<const char*, kStageCount> kNames = {
    "colour", "depth",    "velocity", "reactive",  "particles", "focus", "clear", "history",
    "tiles",  "resolved", "blurred",  "displayed", "presented", "truth", "error", "flip"};

Canvas depth_picture(const StagePlanes& planes) {
  // Nearer than a millimetre or farther than a thousand kilometres is not a surface.
  const tools::ScalarScale scale =
      tools::scale_over(planes.planes[0], ColourMap::kViridis, true, {1e-3f, 1e6f});
  return tools::scalar_picture(planes.extent, planes.planes[0], scale,
                               "depth: distance along the view axis, scene units, logarithmic");
}

Canvas velocity_picture(const StagePlanes& planes) {
  std::vector<Vec2> vectors(planes.planes[0].size());
  float longest = 0;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    // Drawn as the eye follows it: where the surface goes, +y down.
    vectors[i] = {-planes.planes[0][i], planes.planes[1][i]};
    const float length = std::hypot(vectors[i].x, vectors[i].y);
    if (std::isfinite(length)) longest = std::max(longest, length);
  }
  return tools::vector_picture(planes.extent, vectors, longest > 0 ? longest : 1,
                               "velocity: this - previous position", "render px a frame");
}

Canvas clear_picture(const StagePlanes& planes) {
  static const std::array<tools::ClassColour, 2> kPalette = {
      {{"left as it was", {60, 60, 66}}, {"cleared and drawn: the viewport", {232, 163, 61}}}};
  std::vector<int> classes(planes.planes[0].begin(), planes.planes[0].end());
  return tools::class_picture(planes.extent, classes, kPalette, "partial clear of the target");
}

Canvas tile_picture(const StagePlanes& planes) {
  static const std::array<tools::ClassColour, 3> kPalette = {
      {{"copy: nothing moves", {52, 66, 92}},
       {"colour only: all moves alike", {214, 158, 62}},
       {"depth aware", {212, 72, 72}}}};
  std::vector<int> classes(planes.planes[0].begin(), planes.planes[0].end());
  return tools::class_picture(planes.extent, classes, kPalette, "tiles of the motion blur");
}

}  // namespace

const char* name_of(Stage stage) {
  const auto index = static_cast<std::size_t>(stage);
  return index < kNames.size() ? kNames[index] : "unknown";
}

bool needs_truth(Stage stage) {
  return stage == Stage::kTruth || stage == Stage::kError || stage == Stage::kFlip;
}

StagePlanes colour_planes(Extent extent, const std::vector<float>& rgba, tools::ChannelType stored) {
  StagePlanes planes{.extent = extent, .channels = {"R", "G", "B", "A"}, .planes = {}, .stored = stored};
  for (std::size_t c = 0; c < 4; ++c) {
    std::vector<float> plane(rgba.size() / 4);
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] = rgba[4 * i + c];
    planes.planes.push_back(std::move(plane));
  }
  return planes;
}

Canvas false_colour_of(Stage stage, const StagePlanes& planes) {
  switch (stage) {
    case Stage::kDepth:
      return depth_picture(planes);
    case Stage::kVelocity:
      return velocity_picture(planes);
    case Stage::kClear:
      return clear_picture(planes);
    case Stage::kTiles:
      return tile_picture(planes);
    case Stage::kReactive:
      return tools::scalar_picture(planes.extent, planes.planes[0], {.map = ColourMap::kGrey},
                                   "reactive: 0 trusts history, 1 ignores it");
    case Stage::kError:
      return tools::scalar_picture(planes.extent, planes.planes[0],
                                   tools::scale_over(planes.planes[0], ColourMap::kMagma, false, {0, 1}),
                                   "error: |resolved - truth|, tone mapped, mean of R, G and B");
    default:
      return tools::scalar_picture(planes.extent, planes.planes[0], {.map = ColourMap::kMagma},
                                   "FLIP against truth, 67 pixels a degree");
  }
}

}  // namespace quincunx::scenes
