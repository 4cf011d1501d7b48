// SPDX-License-Identifier: MIT
// The resources that passes read and write, and a table of the images that a frame brings.
//
// A new input is an enumerator and a row of kInputs; see "Adding an input" in docs/pipeline.md. Another resource is an
// enumerator and a row of kOwnResources in pass_spec.cpp. All else follows from these and from the passes' uses.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>

#include "quincunx/c/frame.h"
#include "quincunx/frame.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// A resource that a pass of the plan writes belongs to the service; the others are the caller's. A name that begins
// with kPrevious is the frame before's: the service keeps two of its own resources and exchanges them after each frame.
enum class Resource : std::uint8_t {
  // The rendered images as passes read them, in the order of kInputs.
  kColour,
  kVelocity,
  kDepth,
  kReactive,
  kParticleColour,
  kParticleDepth,
  kParticleReactive,
  kInputCount,
  // The caller's velocity, where the service makes kVelocity from it: dilated becomes drawn where both are.
  kDilatedVelocity = kInputCount,
  kDrawnVelocity,
  // The caller's images where half of the pixels are shaded; the service fills the ones above from them.
  kShadedColour,
  kShadedVelocity,
  kShadedDepth,
  kShadedReactive,
  // The caller's images where particles have a viewport of their own: without the particles.
  kBareColour,
  kBareReactive,
  kGiven,                            // given_of() of each input
  kPrevious = kGiven + kInputCount,  // previous_of() of each input
  kPreviousColour = kPrevious,
  kPreviousVelocity,
  kPreviousDepth,
  kPreviousReactive,
  kExposure = kPrevious + kInputCount,
  kPreviousExposure,
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
  kLayeredTileList,
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

constexpr std::size_t index_of(Resource resource) {
  return static_cast<std::size_t>(resource);
}
constexpr std::size_t kResourceCount = index_of(Resource::kPresented) + 1;

// The structs in which a caller of the C interface gives a frame's images.
struct CInputs {
  quincunx_inputs frame = {};
  quincunx_particles particles = {};
  quincunx_fade fade = {};
};

// An image of FrameInputs.
struct InputImage {
  const char* name;  // the field's: "particle_colour"
  ImageView FrameInputs::*image;
  // The part of it that counts. Null: it was not rendered; the pass that reads it takes it from the frame, and its
  // extent and format are checked apart.
  Extent FrameInputs::*viewport = nullptr;
  PixelFormat format = PixelFormat::kNone;         // kNone: as `chosen` says
  PixelFormat ResolveSettings::*chosen = nullptr;  // the setting that names its format
  std::array<const char*, 4> channels = {};        // its values in a file of the exchange format
  const char* c_name = nullptr;  // the field of the C interface, where that has another name
  const quincunx_image* (*in_c)(const CInputs&) = nullptr;

  const char* name_in_c() const { return c_name != nullptr ? c_name : name; }
};

// A row for each image of FrameInputs: rendered ones first, in the order of Resource.
inline constexpr InputImage kInputs[] = {
    {.name = "colour",
     .image = &FrameInputs::colour,
     .viewport = &FrameInputs::render_extent,
     .chosen = &ResolveSettings::colour,
     .channels = {"R", "G", "B", "A"},
     .in_c = [](const CInputs& c) { return c.frame.colour; }},
    {.name = "velocity",
     .image = &FrameInputs::velocity,
     .viewport = &FrameInputs::render_extent,
     .chosen = &ResolveSettings::velocity,
     .channels = {"velocity.u", "velocity.v"},  // as given, in whatever unit
     .in_c = [](const CInputs& c) { return c.frame.velocity; }},
    {.name = "depth",
     .image = &FrameInputs::depth,
     .viewport = &FrameInputs::render_extent,
     .format = PixelFormat::kR32F,
     .channels = {"Z"},
     .in_c = [](const CInputs& c) { return c.frame.depth; }},
    {.name = "reactive",
     .image = &FrameInputs::reactive,
     .viewport = &FrameInputs::render_extent,
     .format = PixelFormat::kR8,
     .channels = {"reactive.mask"},
     .in_c = [](const CInputs& c) { return c.frame.reactive; }},
    {.name = "particle_colour",
     .image = &FrameInputs::particle_colour,
     .viewport = &FrameInputs::particle_render_extent,
     .chosen = &ResolveSettings::colour,
     .channels = {"R", "G", "B", "A"},
     .c_name = "particles.colour",
     .in_c = [](const CInputs& c) { return c.particles.colour; }},
    {.name = "particle_depth",
     .image = &FrameInputs::particle_depth,
     .viewport = &FrameInputs::particle_render_extent,
     .format = PixelFormat::kR32F,
     .channels = {"Z"},
     .c_name = "particles.depth",
     .in_c = [](const CInputs& c) { return c.particles.depth; }},
    {.name = "particle_reactive",
     .image = &FrameInputs::particle_reactive,
     .viewport = &FrameInputs::particle_render_extent,
     .format = PixelFormat::kR8,
     .channels = {"reactive.mask"},
     .c_name = "particles.reactive",
     .in_c = [](const CInputs& c) { return c.particles.reactive; }},
    {.name = "exposure_image",
     .image = &FrameInputs::exposure_image,
     .in_c = [](const CInputs& c) { return c.frame.exposure_image; }},
    {.name = "fading_from",
     .image = &FrameInputs::fading_from,
     .channels = {"R", "G", "B", "A"},
     .c_name = "fade.from",
     .in_c = [](const CInputs& c) { return c.fade.from; }},
};

// Returns the resource as which passes read an input; nothing where that was not rendered.
constexpr std::optional<Resource> resource_of(const InputImage& input) {
  if (input.viewport == nullptr) return std::nullopt;
  return static_cast<Resource>(&input - kInputs);
}

struct ResourceInfo {
  const char* name = nullptr;
  const char* state = nullptr;  // goes before the name
  // The image that is bound to it unless a pass writes it. Whoever makes it, it has the plan's storage. Null: it is the
  // service's, in a buffer.
  const InputImage* input = nullptr;
  std::optional<Resource> previous = {};  // its name in the next frame, where a pass of that may read it
  bool is_previous = false;
};
const ResourceInfo& info_of(Resource resource);

// Returns the input as it comes, where convert_inputs has to make from it what passes read.
constexpr Resource given_of(Resource input) {
  return static_cast<Resource>(index_of(Resource::kGiven) + index_of(input));
}

std::string name_of(Resource resource);  // "particle colour of the previous frame"
// Returns what `resource` is to the next frame; itself where no pass of the next frame can read it.
inline Resource previous_of(Resource resource) {
  return info_of(resource).previous.value_or(resource);
}
inline bool is_previous(Resource resource) {
  return info_of(resource).is_previous;
}

// Whether a frame has to bring this buffer of its plan, as which input. The previous frame's are not among them.
inline bool is_input(const PlannedBuffer& buffer) {
  return buffer.input != nullptr && buffer.scaling != Scaling::kHistory;
}
// Returns the buffer as which a frame of the plan has to bring an input; null: the plan does not read it.
inline const PlannedBuffer* planned_for(const ResolvePlan& plan, const InputImage& input) {
  const auto found = std::find_if(plan.buffers.begin(), plan.buffers.end(), [&](const PlannedBuffer& buffer) {
    return is_input(buffer) && buffer.input == input.image;
  });
  return found != plan.buffers.end() ? &*found : nullptr;
}
// Returns the row of a buffer that the caller brings.
constexpr const InputImage& input_of(const PlannedBuffer& buffer) {
  return *std::find_if(std::begin(kInputs), std::end(kInputs),
                       [&](const InputImage& input) { return input.image == buffer.input; });
}

}  // namespace quincunx
