// SPDX-License-Identifier: MIT
// PassSpec: a pass described as data. Each pass_*.cpp makes its own; all else follows from the list of them: the
// plan's text, bytes and buffers, allocation, what validate() asks for, what is left out, warm-up, the loop that
// runs a frame, events and reports.
//
// To add a pass, see "Adding a pass" in docs/pipeline.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "motion/blur_params.h"
#include "plan/plan_facts.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class Pass;
struct PassSpec;
struct PassSetup;

// The contract of a pass, for its author:
// - Its uses are bound when it runs; an input that it does not use is not. All is used on one in-order queue.
// - Memory: records (elements without a format) begin as zeros, pixels hold anything. Where a method accumulates and a
//   frame has no history, all that the service keeps of the previous frame is set to zero; other passes are told by
//   PassFrame::has_history, and then read the present frame as the previous one.
// - Layout: pixels lie as layout_of(view) says. Records, the history and what belongs to tiles lie row after row in the
//   extent that their area has in this frame.
// - kPrevious*: as the last frame left it. The service exchanges the two after each frame; no pass copies or swaps.
// - Extents: what is kept over kOutput or kTiles must have a pass with Frames::kResized that writes it in the new
//   extent, from the area kPreviousOutput or kPreviousTiles; unresized() finds what has none. After those passes it is
//   the previous frame's, as though the output had always had this size.
// - A pass whose results nobody needs in a frame is left out. So everything that it writes must be among its uses.

enum class Access : std::uint8_t {
  kRead,
  kWrite,       // without reading it first; elements left out stay as an earlier pass of the frame wrote them
  kAccumulate,  // set to zero before the pass, which adds to it
  kUpdate,      // some elements are read and written
};

// Which part of a resource a pass touches.
enum class Area : std::uint8_t {
  kViewport,          // this frame's, within the target
  kPreviousViewport,  // the previous frame's, within the target
  kParticles,         // the particles' viewport of this frame, within their target
  kOutput,            // this frame's, within the largest one
  kPreviousOutput,    // the history's, where that has another size
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
  std::size_t record_bytes = 0;  // size of one element, where it is no pixel

  std::size_t element_bytes() const { return record_bytes != 0 ? record_bytes : bytes_per_pixel(format); }
};

// Returns the use of a resource where its row of the table has it, in the format that its row or the settings name.
Use use(Resource resource, const ResolveSettings& settings, Access access = Access::kRead);

// Returns the bytes of a value of the history's alpha.
std::size_t alpha_bytes(const ResolveSettings& settings);

// The resources that a pass uses, by access.
struct Touched {
  std::vector<Resource> reads = {}, writes = {}, updates = {};
  std::vector<Resource> sums = {};  // kAccumulate
  bool resizes = false;             // those of the previous frame lie over kPreviousOutput and kPreviousTiles
};
std::vector<Use> uses_of(const ResolveSettings& settings, const Touched& touched);

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
  const char* kernel = "";   // static
  std::string options = {};  // -D options of the variant
  std::string reason = {};   // why the plan has it
  std::vector<Use> uses;
  MakePass make = nullptr;
  Frames frames = Frames::kAll;
  Viewports viewports = Viewports::kAll;
  // A work-item's at most, where the driver takes such a limit: fewer of them, and more items at work at once, are
  // faster (docs/lab/devices.md). 0: as many as the compiler likes.
  int registers = 0;

  // Adds the option "-D NAME=1" and these uses where they are wanted; else "-D NAME=0" alone, and the pass binds
  // stand-ins for them.
  void add_where(bool wanted, const char* name, const ResolveSettings& settings, const Touched& touched);
  void add_options(const std::string& more);
};

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

// Returns the plan in the caller's words. `facts` are those of needs and settings that plan_for() takes. Pure.
ResolvePlan plan_of(const PlanFacts& facts);

// A resource of a plan, over all passes that use it.
struct ResourceUse {
  Resource resource;
  Use largest;           // the use with the largest area
  bool written = false;  // by a pass: it belongs to the service
};
std::vector<ResourceUse> resources_of(const std::vector<PassSpec>& passes);

// Whether the caller has to bring this input.
bool reads(const std::vector<ResourceUse>& used, Resource input);

// Returns a resource that passes keep for two frames over the output or its tiles and that no pass of the list resizes
// where the output's size changes; nothing where there is none, as there must be if that is dynamic.
std::optional<Resource> unresized(const std::vector<PassSpec>& passes);

// The planners, in pass_*.cpp beside the pass itself: each adds its pass where the facts ask for it, else says why not.
// Goes last, and puts its passes before those that read what it makes.
void plan_convert_inputs(const PlanFacts& facts, PassList& list);
void plan_overlay_particles(const PlanFacts& facts, PassList& list);
void plan_resolve_checkerboard(const PlanFacts& facts, PassList& list);
void plan_exposure(const PlanFacts& facts, PassList& list);
void plan_velocity_from_depth(const PlanFacts& facts, PassList& list);
void plan_undilate_velocity(const PlanFacts& facts, PassList& list);
void plan_far_motion(const PlanFacts& facts, PassList& list);
void plan_far_velocity(const PlanFacts& facts, PassList& list);
void plan_reproject(const PlanFacts& facts, PassList& list);
void plan_resize_history(const PlanFacts& facts, PassList& list);
void plan_resize_tiles(const PlanFacts& facts, PassList& list);
void plan_resize_layers(const PlanFacts& facts, PassList& list);
void plan_resize_records(const PlanFacts& facts, PassList& list);
void plan_layer_records(const PlanFacts& facts, PassList& list);
void plan_turn_records(const PlanFacts& facts, PassList& list);
void plan_advect_records(const PlanFacts& facts, PassList& list);
void plan_layer_split(const PlanFacts& facts, PassList& list);
void plan_temporal_tiles(const PlanFacts& facts, PassList& list);
void plan_temporal_light(const PlanFacts& facts, PassList& list);
void plan_resolve_temporal(const PlanFacts& facts, PassList& list);
void plan_resolve_layers(const PlanFacts& facts, PassList& list);
void plan_temporal_display(const PlanFacts& facts, PassList& list);
void plan_display_layers(const PlanFacts& facts, PassList& list);
void plan_merge_histories(const PlanFacts& facts, PassList& list);
void plan_resolve_quincunx(const PlanFacts& facts, PassList& list);
void plan_resolve_reprojected(const PlanFacts& facts, PassList& list);
void plan_scale(const PlanFacts& facts, PassList& list);
void plan_scale_filter(const PlanFacts& facts, PassList& list);
void plan_measure_content(const PlanFacts& facts, PassList& list);
void plan_check_motion(const PlanFacts& facts, PassList& list);
void plan_cross_fade(const PlanFacts& facts, PassList& list);
void plan_temporal_denoise(const PlanFacts& facts, PassList& list);
void plan_temporal_refine(const PlanFacts& facts, PassList& list);
void plan_sharpen(const PlanFacts& facts, PassList& list);
void plan_motion_tiles(const PlanFacts& facts, PassList& list);
void plan_motion_neighbours(const PlanFacts& facts, PassList& list);
void plan_motion_blur(const PlanFacts& facts, PassList& list);
void plan_scale_to_display(const PlanFacts& facts, PassList& list);
void plan_lay_focus(const PlanFacts& facts, PassList& list);
void plan_present(const PlanFacts& facts, PassList& list);
void plan_clear_region(const PlanFacts& facts, PassList& list);

}  // namespace quincunx
