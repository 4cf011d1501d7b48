// SPDX-License-Identifier: MIT
// PassSpec: a pass described as data. Each pass_*.cpp makes its own; all else follows from the list of them: the
// plan's text, bytes and buffers, allocation, what validate() asks for, what is left out, warm-up, the loop that
// runs a frame, events and reports.
//
// To add a pass, see "Adding a pass" in docs/pipeline.md.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "motion/blur_params.h"
#include "plan_facts.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class Pass;
struct PassSpec;
struct PassSetup;

// Whatever a pass reads or writes. A resource that a pass of the plan writes belongs to the service; the others
// are the caller's. A name that begins with kPrevious is the frame before's: the service keeps two of its own
// resources and exchanges them after each frame.
enum class Resource : std::uint8_t {
  kColour,
  kVelocity,
  kDepth,
  kReactive,
  // The caller's, where kVelocity is what the service makes of it; the first is made into the second where both are.
  kDilatedVelocity,
  kDrawnVelocity,
  // The caller's where half of the pixels are shaded; the ones above are then what the service fills.
  kShadedColour,
  kShadedVelocity,
  kShadedDepth,
  kShadedReactive,
  // The caller's where particles are drawn into a viewport of their own: what they are laid over, and they.
  kBareColour,
  kBareReactive,
  kParticleColour,
  kParticleDepth,
  kParticleReactive,
  kPreviousColour,
  kPreviousVelocity,
  kPreviousDepth,
  kPreviousReactive,
  kContentSums,
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
  // Of the second layer of history.
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
constexpr int kResources = static_cast<int>(Resource::kPresented) + 1;

// The velocity that undilate_velocity writes, and that resolve_checkerboard does.
inline Resource drawn_velocity_of(const PlanFacts& facts) {
  return facts.moves_far() ? Resource::kDrawnVelocity : Resource::kVelocity;
}
inline Resource filled_velocity_of(const PlanFacts& facts) {
  return facts.undilates_velocity() ? Resource::kDilatedVelocity : drawn_velocity_of(facts);
}

// The picture that the method makes, before sharpening.
inline Resource picture_of(const PlanFacts& facts) {
  return facts.sharpens() ? Resource::kUnsharpened : Resource::kResolved;
}

// The picture of the history, before the preset `quality` refines it.
inline Resource shown_history_of(const PlanFacts& facts) {
  return facts.refines() ? Resource::kUnrefined : picture_of(facts);
}

// The picture with all that is made of it, in the output's size, and the one that is shown.
inline Resource finished_of(const PlanFacts& facts) {
  return facts.blurs() ? Resource::kBlurred : Resource::kResolved;
}
inline Resource shown_of(const PlanFacts& facts) {
  return facts.is_dual() ? Resource::kDisplayed : finished_of(facts);
}

const char* name_of(Resource resource);  // "colour of the previous frame"
// What `resource` is to the next frame; itself where no pass of the next frame can read it.
Resource previous_of(Resource resource);
bool is_previous(Resource resource);

enum class Access : std::uint8_t {
  kRead,
  kWrite,
  kAccumulate,  // set to zero before the pass, which adds to it
  kUpdate,      // some elements are read and written
};

// Which part of a resource a pass touches.
enum class Area : std::uint8_t {
  kViewport,          // of this frame, within the target
  kPreviousViewport,  // of the previous frame, within the target
  kParticles,         // the particles' viewport of this frame, within their target
  kOutput,            // of this frame, within the largest one
  kPreviousOutput,    // of the history, where that has another size
  kDisplay,           // the largest output: what is shown
  kFocus,             // the focus's region, within what is shown
  kFarCells,          // one element for each cell of kFarCell^2 samples of the viewport
  kTiles,             // one element for each tile of kTemporalTile^2 output pixels
  kPreviousTiles,     // the same of the history, where that has another size
  kBlurTiles,         // one element for each tile of kTileSide^2 output pixels
  kWhole,             // one element
};

struct Use {
  Resource resource;
  Access access;
  Area area;
  PixelFormat format = PixelFormat::kNone;
  std::size_t record_bytes = 0;  // of one element, where it is no pixel

  std::size_t element_bytes() const { return record_bytes != 0 ? record_bytes : bytes_per_pixel(format); }
};

// The frames that a pass takes part in.
enum class Frames : std::uint8_t {
  kAll,
  kWithHistory,     // the previous frame counts
  kWithoutHistory,  // the first frame and those after a reset
  kSparse,          // is_dense() does not hold
  kDense,
  kResized,       // kSparse, with a history of another size than the output
  kScaledOutput,  // the picture is not shown in the size in which it is made
  kWithFocus,     // a focus is given
  kFading,        // a picture to fade from is given
  kOnRequest,     // none: a call of its own runs it
};

// Which viewports it serves: those for which widens() holds or does not hold, or all.
enum class Viewports : std::uint8_t { kAll, kNotWider, kWider };

using MakePass = std::unique_ptr<Pass> (*)(const PassSetup& setup, const PassSpec& spec);

struct PassSpec {
  const char* kernel = "";  // static
  std::string options;      // -D options of the variant
  std::string reason;       // why the plan has it
  std::vector<Use> uses;
  MakePass make = nullptr;
  Frames frames = Frames::kAll;
  Viewports viewports = Viewports::kAll;
};

// Adds to a pass's uses that it reads an input of this frame and of the previous one.
void read_both_frames(std::vector<Use>& uses, Resource resource, PixelFormat format);

// The extents that uses follow.
struct FrameExtents {
  Extent render, previous_render, output;
  Extent particles = {}, previous_output = {}, display = {}, focus = {};
};

// Those of a plan's largest frame.
FrameExtents largest_extents(const ResolveSettings& settings);

Extent extent_of(Area area, const FrameExtents& extents);

// Bytes read and written in a frame: each element counts once, or twice where it is both.
std::uint64_t bytes_of(const PassSpec& spec, const FrameExtents& extents);

// The passes of a plan in the order in which they run, and why the others are not in it. Pure.
struct PassList {
  std::vector<PassSpec> passes;
  std::vector<LeftOut> left_out;
};
PassList list_passes(const PlanFacts& facts);

// A resource of a plan, over all passes that use it.
struct ResourceUse {
  Resource resource;
  Use largest;           // the use with the largest area
  bool written = false;  // by a pass: it belongs to the service
};
std::vector<ResourceUse> resources_of(const std::vector<PassSpec>& passes);

}  // namespace quincunx
