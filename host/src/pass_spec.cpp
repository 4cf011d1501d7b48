// SPDX-License-Identifier: MIT
#include "pass_spec.h"

#include <algorithm>

#include "motion/far_params.h"
#include "temporal/temporal_params.h"

namespace quincunx {
namespace {

Extent tiles_of(Extent output, int side) {
  return {(output.width + side - 1) / side, (output.height + side - 1) / side};
}

// The previous frame's resources, each after its own.
constexpr struct {
  Resource now, before;
} kKept[] = {
    {Resource::kColour, Resource::kPreviousColour},
    {Resource::kVelocity, Resource::kPreviousVelocity},
    {Resource::kDepth, Resource::kPreviousDepth},
    {Resource::kReactive, Resource::kPreviousReactive},
    {Resource::kFarMotion, Resource::kPreviousFarMotion},
    {Resource::kReprojection, Resource::kPreviousReprojection},
    {Resource::kTileReprojection, Resource::kPreviousTileReprojection},
    {Resource::kTileLight, Resource::kPreviousTileLight},
    {Resource::kHistory, Resource::kPreviousHistory},
    {Resource::kRecordKeys, Resource::kPreviousRecordKeys},
    {Resource::kRecords, Resource::kPreviousRecords},
    {Resource::kLayerTiles, Resource::kPreviousLayerTiles},
    {Resource::kNearHistory, Resource::kPreviousNearHistory},
    {Resource::kLayerStates, Resource::kPreviousLayerStates},
    {Resource::kHistoryAlpha, Resource::kPreviousHistoryAlpha},
};

std::int64_t rank(Area area) {
  // Only viewports share a resource with other areas, and the largest viewport may exceed the output.
  return area == Area::kViewport || area == Area::kPreviousViewport ? 1 : 0;
}

}  // namespace

const char* name_of(Resource resource) {
  switch (resource) {
    case Resource::kColour:
      return "colour";
    case Resource::kVelocity:
      return "velocity";
    case Resource::kDepth:
      return "depth";
    case Resource::kReactive:
      return "reactive";
    case Resource::kDilatedVelocity:
      return "dilated velocity";
    case Resource::kDrawnVelocity:
      return "drawn velocity";
    case Resource::kShadedColour:
      return "shaded colour";
    case Resource::kShadedVelocity:
      return "shaded velocity";
    case Resource::kShadedDepth:
      return "shaded depth";
    case Resource::kShadedReactive:
      return "shaded reactive";
    case Resource::kBareColour:
      return "bare colour";
    case Resource::kBareReactive:
      return "bare reactive";
    case Resource::kParticleColour:
      return "particle colour";
    case Resource::kParticleDepth:
      return "particle depth";
    case Resource::kParticleReactive:
      return "particle reactive";
    case Resource::kPreviousColour:
      return "colour of the previous frame";
    case Resource::kPreviousVelocity:
      return "velocity of the previous frame";
    case Resource::kPreviousDepth:
      return "depth of the previous frame";
    case Resource::kPreviousReactive:
      return "reactive of the previous frame";
    case Resource::kContentSums:
      return "content sums";
    case Resource::kFarSums:
      return "far sums";
    case Resource::kFarMotion:
      return "far motion";
    case Resource::kPreviousFarMotion:
      return "far motion of the previous frame";
    case Resource::kFarMatch:
      return "far match";
    case Resource::kReprojection:
      return "reprojection";
    case Resource::kPreviousReprojection:
      return "reprojection of the previous frame";
    case Resource::kTileReprojection:
      return "tile reprojection";
    case Resource::kPreviousTileReprojection:
      return "tile reprojection of the previous frame";
    case Resource::kTileEvidence:
      return "tile evidence";
    case Resource::kTileLight:
      return "tile light";
    case Resource::kPreviousTileLight:
      return "tile light of the previous frame";
    case Resource::kTotalLight:
      return "total light";
    case Resource::kHistory:
      return "history";
    case Resource::kPreviousHistory:
      return "history of the previous frame";
    case Resource::kOpenTrust:
      return "open trust";
    case Resource::kRecordKeys:
      return "record keys";
    case Resource::kPreviousRecordKeys:
      return "record keys of the previous frame";
    case Resource::kRecords:
      return "records";
    case Resource::kPreviousRecords:
      return "records of the previous frame";
    case Resource::kSplits:
      return "splits";
    case Resource::kSplitMarks:
      return "split marks";
    case Resource::kLayerTiles:
      return "layer tiles";
    case Resource::kPreviousLayerTiles:
      return "layer tiles of the previous frame";
    case Resource::kNearHistory:
      return "near history";
    case Resource::kPreviousNearHistory:
      return "near history of the previous frame";
    case Resource::kLayerStates:
      return "layer states";
    case Resource::kPreviousLayerStates:
      return "layer states of the previous frame";
    case Resource::kHistoryAlpha:
      return "history alpha";
    case Resource::kPreviousHistoryAlpha:
      return "history alpha of the previous frame";
    case Resource::kUnrefined:
      return "unrefined";
    case Resource::kUnsharpened:
      return "unsharpened";
    case Resource::kResolved:
      return "resolved";
    case Resource::kStreaks:
      return "streaks";
    case Resource::kLongestStreak:
      return "longest streak";
    case Resource::kTileBlurs:
      return "blur tiles";
    case Resource::kBlurred:
      return "blurred";
    case Resource::kDisplayed:
      return "displayed";
    case Resource::kFocus:
      return "focus";
    case Resource::kFocusMask:
      return "focus mask";
    case Resource::kFadingFrom:
      return "fading from";
    case Resource::kPresented:
      return "presented";
  }
  return "unknown";
}

Resource previous_of(Resource resource) {
  for (const auto& [now, before] : kKept) {
    if (now == resource) return before;
  }
  return resource;
}

bool is_previous(Resource resource) {
  return std::any_of(std::begin(kKept), std::end(kKept),
                     [resource](const auto& kept) { return kept.before == resource; });
}

void read_both_frames(std::vector<Use>& uses, Resource resource, PixelFormat format) {
  uses.push_back({resource, Access::kRead, Area::kViewport, format});
  uses.push_back({previous_of(resource), Access::kRead, Area::kPreviousViewport, format});
}

FrameExtents largest_extents(const ResolveSettings& settings) {
  const Extent output = settings.output;
  return {settings.target, settings.target,      output, settings.particle_target, output,
          output,          settings.focus.extent};
}

Extent extent_of(Area area, const FrameExtents& extents) {
  switch (area) {
    case Area::kViewport:
      return extents.render;
    case Area::kPreviousViewport:
      return extents.previous_render;
    case Area::kParticles:
      return extents.particles;
    case Area::kOutput:
      return extents.output;
    case Area::kPreviousOutput:
      return extents.previous_output;
    case Area::kDisplay:
      return extents.display;
    case Area::kFocus:
      return extents.focus;
    case Area::kFarCells:
      return tiles_of(extents.render, kFarCell);
    case Area::kTiles:
      return tiles_of(extents.output, kTemporalTile);
    case Area::kPreviousTiles:
      return tiles_of(extents.previous_output, kTemporalTile);
    case Area::kBlurTiles:
      return tiles_of(extents.output, kTileSide);
    case Area::kWhole:
      return {1, 1};
  }
  return {};
}

std::uint64_t bytes_of(const PassSpec& spec, const FrameExtents& extents) {
  std::uint64_t bytes = 0;
  for (const Use& use : spec.uses) {
    const bool both = use.access == Access::kAccumulate || use.access == Access::kUpdate;
    const std::uint64_t times = both ? 2 : 1;
    bytes += times * static_cast<std::uint64_t>(extent_of(use.area, extents).area()) * use.element_bytes();
  }
  return bytes;
}

std::vector<ResourceUse> resources_of(const std::vector<PassSpec>& passes) {
  std::vector<ResourceUse> found;
  const auto entry = [&found](Resource resource) {
    return std::find_if(found.begin(), found.end(),
                        [resource](const ResourceUse& use) { return use.resource == resource; });
  };
  for (const PassSpec& pass : passes) {
    if (pass.frames == Frames::kOnRequest) continue;
    for (const Use& use : pass.uses) {
      auto known = entry(use.resource);
      if (known == found.end()) known = found.insert(found.end(), {use.resource, use, false});
      if (rank(use.area) > rank(known->largest.area)) known->largest = use;
      known->written |= use.access != Access::kRead;
    }
  }
  for (const auto& [now, before] : kKept) {
    if (const auto of_now = entry(now), of_before = entry(before);
        of_now != found.end() && of_before != found.end())
      of_before->written = of_now->written;
  }
  std::sort(found.begin(), found.end(),
            [](const ResourceUse& a, const ResourceUse& b) { return a.resource < b.resource; });
  return found;
}

}  // namespace quincunx
