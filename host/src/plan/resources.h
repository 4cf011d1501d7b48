// SPDX-License-Identifier: MIT
// The resources that passes read and write, and a table of all that is known of each.
//
// A new resource is an enumerator and a row of kResources; all else follows from these and from the passes' uses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>

#include "plan/plan_facts.h"
#include "quincunx/frame.h"
#include "quincunx/image.h"

namespace quincunx {

// A resource that a pass of the plan writes belongs to the service; the others are the caller's. A name that begins
// with kPrevious is the frame before's: the service keeps two of its own resources and exchanges them after each frame.
enum class Resource : std::uint8_t {
  kColour,
  kVelocity,
  kDepth,
  kReactive,
  // The caller's velocity, where the service makes kVelocity from it: dilated becomes drawn where both are.
  kDilatedVelocity,
  kDrawnVelocity,
  // The caller's images where half of the pixels are shaded; the service fills the ones above from them.
  kShadedColour,
  kShadedVelocity,
  kShadedDepth,
  kShadedReactive,
  // The caller's images where particles have a viewport of their own: without the particles, and the particles.
  kBareColour,
  kBareReactive,
  kParticleColour,
  kParticleDepth,
  kParticleReactive,
  // The caller's images where convert_inputs makes from them what stands for them above.
  kGivenColour,
  kGivenVelocity,
  kGivenDepth,
  kGivenReactive,
  kGivenParticleColour,
  kGivenParticleDepth,
  kGivenParticleReactive,
  kPreviousColour,
  kPreviousVelocity,
  kPreviousDepth,
  kPreviousReactive,
  kContentSums,
  kMotionSums,
  kFarSums,
  kFarMotion,
  kPreviousFarMotion,
  kFarMatch,
  kReprojection,
  kPreviousReprojection,
  kTileReprojection,
  kPreviousTileReprojection,
  kTileEvidence,
  kTileLight,
  kPreviousTileLight,
  kTotalLight,
  kHistory,
  kPreviousHistory,
  // The second layer of history.
  kOpenTrust,
  kRecordKeys,
  kPreviousRecordKeys,
  kRecords,
  kPreviousRecords,
  kSplits,
  kSplitMarks,
  kLayerTiles,
  kPreviousLayerTiles,
  kNearHistory,
  kPreviousNearHistory,
  kLayerStates,
  kPreviousLayerStates,
  kHistoryAlpha,
  kPreviousHistoryAlpha,
  // Histories of both directions (facts.two_way): this one's picture, the other one, and both merged.
  kCentred,
  kCentredTiles,
  kOtherHistory,
  kOtherAlpha,
  kMergedHistory,
  kMergedAlpha,
  kNoisy,
  kUnrefined,
  kUnsharpened,
  kResolved,
  kStreaks,
  kLongestStreak,
  kTileBlurs,
  kBlurred,
  kDisplayed,
  kFocus,
  kFocusMask,
  kFadingFrom,
  kPresented,
};

// An image that the caller brings with a frame.
struct InputImage {
  const char* field;  // "particle_colour"
  ImageView FrameInputs::*image;
  Resource given;  // it, where it has to be converted
  Extent FrameInputs::*viewport = &FrameInputs::render_extent;
};

inline constexpr InputImage kColourInput = {"colour", &FrameInputs::colour, Resource::kGivenColour};
inline constexpr InputImage kVelocityInput = {"velocity", &FrameInputs::velocity, Resource::kGivenVelocity};
inline constexpr InputImage kDepthInput = {"depth", &FrameInputs::depth, Resource::kGivenDepth};
inline constexpr InputImage kReactiveInput = {"reactive", &FrameInputs::reactive, Resource::kGivenReactive};
inline constexpr InputImage kParticleColourInput = {"particle_colour", &FrameInputs::particle_colour,
                                                    Resource::kGivenParticleColour,
                                                    &FrameInputs::particle_render_extent};
inline constexpr InputImage kParticleDepthInput = {"particle_depth", &FrameInputs::particle_depth,
                                                   Resource::kGivenParticleDepth,
                                                   &FrameInputs::particle_render_extent};
inline constexpr InputImage kParticleReactiveInput = {"particle_reactive", &FrameInputs::particle_reactive,
                                                      Resource::kGivenParticleReactive,
                                                      &FrameInputs::particle_render_extent};

inline constexpr const InputImage* kInputImages[] = {
    &kColourInput,         &kVelocityInput,      &kDepthInput,           &kReactiveInput,
    &kParticleColourInput, &kParticleDepthInput, &kParticleReactiveInput};

struct ResourceInfo {
  Resource resource;
  const char* name;
  // The image that is bound to it unless a pass writes it: of the frame, or of the one before. Whoever makes it, it
  // has the plan's storage. Null: it is the service's, in a buffer.
  const InputImage* input = nullptr;
  std::optional<Resource> previous = {};  // its name in the next frame, where a pass of that may read it
};

// A row for each, in the order of the enumerators, in which plans list them.
inline constexpr ResourceInfo kResources[] = {
    {Resource::kColour, "colour", &kColourInput, Resource::kPreviousColour},
    {Resource::kVelocity, "velocity", &kVelocityInput, Resource::kPreviousVelocity},
    {Resource::kDepth, "depth", &kDepthInput, Resource::kPreviousDepth},
    {Resource::kReactive, "reactive", &kReactiveInput, Resource::kPreviousReactive},
    {Resource::kDilatedVelocity, "dilated velocity", &kVelocityInput},
    {Resource::kDrawnVelocity, "drawn velocity", &kVelocityInput},
    {Resource::kShadedColour, "shaded colour", &kColourInput},
    {Resource::kShadedVelocity, "shaded velocity", &kVelocityInput},
    {Resource::kShadedDepth, "shaded depth", &kDepthInput},
    {Resource::kShadedReactive, "shaded reactive", &kReactiveInput},
    {Resource::kBareColour, "bare colour", &kColourInput},
    {Resource::kBareReactive, "bare reactive", &kReactiveInput},
    {Resource::kParticleColour, "particle colour", &kParticleColourInput},
    {Resource::kParticleDepth, "particle depth", &kParticleDepthInput},
    {Resource::kParticleReactive, "particle reactive", &kParticleReactiveInput},
    {Resource::kGivenColour, "given colour", &kColourInput},
    {Resource::kGivenVelocity, "given velocity", &kVelocityInput},
    {Resource::kGivenDepth, "given depth", &kDepthInput},
    {Resource::kGivenReactive, "given reactive", &kReactiveInput},
    {Resource::kGivenParticleColour, "given particle colour", &kParticleColourInput},
    {Resource::kGivenParticleDepth, "given particle depth", &kParticleDepthInput},
    {Resource::kGivenParticleReactive, "given particle reactive", &kParticleReactiveInput},
    {Resource::kPreviousColour, "colour of the previous frame", &kColourInput},
    {Resource::kPreviousVelocity, "velocity of the previous frame", &kVelocityInput},
    {Resource::kPreviousDepth, "depth of the previous frame", &kDepthInput},
    {Resource::kPreviousReactive, "reactive of the previous frame", &kReactiveInput},
    {Resource::kContentSums, "content sums"},
    {Resource::kMotionSums, "motion sums"},
    {Resource::kFarSums, "far sums"},
    {Resource::kFarMotion, "far motion", nullptr, Resource::kPreviousFarMotion},
    {Resource::kPreviousFarMotion, "far motion of the previous frame"},
    {Resource::kFarMatch, "far match"},
    {Resource::kReprojection, "reprojection", nullptr, Resource::kPreviousReprojection},
    {Resource::kPreviousReprojection, "reprojection of the previous frame"},
    {Resource::kTileReprojection, "tile reprojection", nullptr, Resource::kPreviousTileReprojection},
    {Resource::kPreviousTileReprojection, "tile reprojection of the previous frame"},
    {Resource::kTileEvidence, "tile evidence"},
    {Resource::kTileLight, "tile light", nullptr, Resource::kPreviousTileLight},
    {Resource::kPreviousTileLight, "tile light of the previous frame"},
    {Resource::kTotalLight, "total light"},
    {Resource::kHistory, "history", nullptr, Resource::kPreviousHistory},
    {Resource::kPreviousHistory, "history of the previous frame"},
    {Resource::kOpenTrust, "open trust"},
    {Resource::kRecordKeys, "record keys", nullptr, Resource::kPreviousRecordKeys},
    {Resource::kPreviousRecordKeys, "record keys of the previous frame"},
    {Resource::kRecords, "records", nullptr, Resource::kPreviousRecords},
    {Resource::kPreviousRecords, "records of the previous frame"},
    {Resource::kSplits, "splits"},
    {Resource::kSplitMarks, "split marks"},
    {Resource::kLayerTiles, "layer tiles", nullptr, Resource::kPreviousLayerTiles},
    {Resource::kPreviousLayerTiles, "layer tiles of the previous frame"},
    {Resource::kNearHistory, "near history", nullptr, Resource::kPreviousNearHistory},
    {Resource::kPreviousNearHistory, "near history of the previous frame"},
    {Resource::kLayerStates, "layer states", nullptr, Resource::kPreviousLayerStates},
    {Resource::kPreviousLayerStates, "layer states of the previous frame"},
    {Resource::kHistoryAlpha, "history alpha", nullptr, Resource::kPreviousHistoryAlpha},
    {Resource::kPreviousHistoryAlpha, "history alpha of the previous frame"},
    {Resource::kCentred, "centred"},
    {Resource::kCentredTiles, "centred tiles"},
    {Resource::kOtherHistory, "other history"},
    {Resource::kOtherAlpha, "other history alpha"},
    {Resource::kMergedHistory, "merged history"},
    {Resource::kMergedAlpha, "merged history alpha"},
    {Resource::kNoisy, "noisy"},
    {Resource::kUnrefined, "unrefined"},
    {Resource::kUnsharpened, "unsharpened"},
    {Resource::kResolved, "resolved"},
    {Resource::kStreaks, "streaks"},
    {Resource::kLongestStreak, "longest streak"},
    {Resource::kTileBlurs, "blur tiles"},
    {Resource::kBlurred, "blurred"},
    {Resource::kDisplayed, "displayed"},
    {Resource::kFocus, "focus"},
    {Resource::kFocusMask, "focus mask"},
    {Resource::kFadingFrom, "fading from"},
    {Resource::kPresented, "presented"},
};
constexpr std::size_t kResourceCount = std::size(kResources);

constexpr std::size_t index_of(Resource resource) {
  return static_cast<std::size_t>(resource);
}
constexpr const ResourceInfo& info_of(Resource resource) {
  return kResources[index_of(resource)];
}
constexpr const char* name_of(Resource resource) {
  return info_of(resource).name;
}
// Returns what `resource` is to the next frame; itself where no pass of the next frame can read it.
constexpr Resource previous_of(Resource resource) {
  return info_of(resource).previous.value_or(resource);
}
bool is_previous(Resource resource);

// Returns the plan's storage for inputs, whoever makes them, and for the presented picture; all else is in buffers.
Storage storage_of(Resource resource, const PlanFacts& facts);

// The velocity that undilate_velocity writes, and that resolve_checkerboard does.
inline Resource drawn_velocity_of(const PlanFacts& facts) {
  return facts.moves_sky() ? Resource::kDrawnVelocity : Resource::kVelocity;
}
inline Resource filled_velocity_of(const PlanFacts& facts) {
  return facts.undilates_velocity() ? Resource::kDilatedVelocity : drawn_velocity_of(facts);
}

// The picture that the method makes, before sharpening.
inline Resource picture_of(const PlanFacts& facts) {
  return facts.sharpens() ? Resource::kUnsharpened : Resource::kResolved;
}

// The picture of the history, before the preset `quality` refines it, and before it is denoised.
inline Resource denoised_of(const PlanFacts& facts) {
  return facts.refines() ? Resource::kUnrefined : picture_of(facts);
}
inline Resource shown_history_of(const PlanFacts& facts) {
  return facts.denoises() ? Resource::kNoisy : denoised_of(facts);
}

// The picture of this direction's history alone, and the history that is shown.
inline Resource centred_of(const PlanFacts& facts) {
  return facts.two_way ? Resource::kCentred : shown_history_of(facts);
}
inline Resource displayed_history_of(const PlanFacts& facts) {
  return facts.two_way ? Resource::kMergedHistory : Resource::kHistory;
}

// The picture with all that is made of it, in the output's size, and the one that is shown.
inline Resource finished_of(const PlanFacts& facts) {
  return facts.blurs() ? Resource::kBlurred : Resource::kResolved;
}
inline Resource shown_of(const PlanFacts& facts) {
  return facts.is_dual() ? Resource::kDisplayed : finished_of(facts);
}

}  // namespace quincunx
