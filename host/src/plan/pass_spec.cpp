// SPDX-License-Identifier: MIT
#include "plan/pass_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "layers/layer.h"
#include "motion/velocity_params.h"
#include "params.h"
#include "picture_params.h"
#include "temporal/temporal_params.h"
#include "temporal/tile.h"

namespace quincunx {
namespace {

bool method_reads_velocity(const ResolveSettings& settings) {
  if (settings.method == Method::kTemporal) return true;
  return settings.method == Method::kQuincunx && settings.quincunx.form != TwoFrameForm::kMean;
}

VelocitySource velocity_source(const SceneNeeds& needs, const ResolveSettings& settings) {
  const bool fills = settings.targets.shading == Shading::kCheckerboard;
  if (!method_reads_velocity(settings) && settings.blur.shutter == 0 && !fills &&
      !settings.control.measures_content)
    return VelocitySource::kNone;
  if (needs.moving_objects) return VelocitySource::kTarget;
  return needs.camera_motion ? VelocitySource::kCamera : VelocitySource::kNone;
}

}  // namespace

PlanFacts::PlanFacts(const SceneNeeds& scene_needs, const ResolveSettings& resolve_settings)
    : needs(scene_needs), settings(resolve_settings), velocity(velocity_source(needs, settings)) {
  if (settings.output.min_extent == Extent{}) settings.output.min_extent = settings.output_extent;
}

bool PlanFacts::may_widen() const {
  return widens(settings.target_extent, settings.output.min_extent);
}

bool PlanFacts::may_be_dense() const {
  return is_dense(settings.target_extent, settings.output.min_extent);
}

bool PlanFacts::reads_velocity() const {
  return has_velocity() &&
         (method_reads_velocity(settings) || settings.blur.shutter > 0 || settings.control.measures_content);
}

bool is_dense(Extent render, Extent output) {
  constexpr double kDense = .64;  // output pixels a sample
  return static_cast<double>(output.area()) < kDense * static_cast<double>(render.area());
}

bool widens(Extent render, Extent output) {
  return render.width > output.width || render.height > output.height;
}

std::size_t alpha_bytes(const ResolveSettings& settings) {
  return bytes_per_pixel(settings.temporal.history) / 4;
}

namespace {

Extent tiles_of(Extent output, int side) {
  return {(output.width + side - 1) / side, (output.height + side - 1) / side};
}

std::int64_t rank(Area area) {
  // Only viewports share a resource with other areas, and the largest viewport may exceed the output.
  return area == Area::kViewport || area == Area::kPreviousViewport ? 1 : 0;
}

// What the caller gives in place of an input where a pass makes that from it.
struct EarlierInput {
  Resource resource;
  const char* state;
  Resource input;
};

constexpr EarlierInput kEarlierInputs[] = {
    {Resource::kDilatedVelocity, "dilated", Resource::kVelocity},
    {Resource::kDrawnVelocity, "drawn", Resource::kVelocity},
    {Resource::kShadedColour, "shaded", Resource::kColour},
    {Resource::kShadedVelocity, "shaded", Resource::kVelocity},
    {Resource::kShadedDepth, "shaded", Resource::kDepth},
    {Resource::kShadedReactive, "shaded", Resource::kReactive},
    {Resource::kBareColour, "bare", Resource::kColour},
    {Resource::kBareReactive, "bare", Resource::kReactive},
};

// An element of a resource: a pixel of a format that settings name or that is always the same, or a record.
struct Element {
  enum Kind : std::uint8_t { kFixed, kLinear, kHistory, kAlpha };
  Kind kind = kFixed;
  PixelFormat format = PixelFormat::kNone;
  std::size_t bytes = 0;
};

// A resource that no frame brings.
struct OwnResource {
  Resource resource;
  const char* name;
  Area area;
  Element element;
  std::optional<Resource> previous = {};
};

constexpr OwnResource kOwnResources[] = {
    {Resource::kExposure, "exposure", Area::kWhole, {.bytes = sizeof(Exposure)}, Resource::kPreviousExposure},
    {Resource::kContentSums, "content sums", Area::kWhole, {.bytes = sizeof(ContentSums)}},
    {Resource::kMotionSums, "motion sums", Area::kWhole, {.bytes = sizeof(MotionSums)}},
    {Resource::kFarSums, "far sums", Area::kFarCells, {.bytes = sizeof(FarSums)}},
    {Resource::kFarMotion,
     "far motion",
     Area::kWhole,
     {.bytes = sizeof(FarModel)},
     Resource::kPreviousFarMotion},
    {Resource::kFarMatch, "far match", Area::kWhole, {.bytes = sizeof(FarMatch)}},
    {Resource::kReprojection,
     "reprojection",
     Area::kViewport,
     {.format = PixelFormat::kRGBA32F},
     Resource::kPreviousReprojection},
    {Resource::kTileReprojection,
     "tile reprojection",
     Area::kTiles,
     {.bytes = sizeof(TileReprojection)},
     Resource::kPreviousTileReprojection},
    {Resource::kTileEvidence, "tile evidence", Area::kTiles, {.bytes = sizeof(TileEvidence)}},
    {Resource::kTileLight,
     "tile light",
     Area::kTiles,
     {.bytes = sizeof(TileLight)},
     Resource::kPreviousTileLight},
    {Resource::kTotalLight, "total light", Area::kWhole, {.bytes = sizeof(TotalLight)}},
    {Resource::kHistory, "history", Area::kOutput, {Element::kHistory}, Resource::kPreviousHistory},
    {Resource::kOpenTrust, "open trust", Area::kViewport, {.bytes = sizeof(cl_float)}},
    {Resource::kRecordKeys,
     "record keys",
     Area::kViewport,
     {.bytes = sizeof(cl_uint)},
     Resource::kPreviousRecordKeys},
    {Resource::kRecords,
     "records",
     Area::kViewport,
     {.bytes = sizeof(LayerRecord)},
     Resource::kPreviousRecords},
    {Resource::kSplits, "splits", Area::kViewport, {.bytes = sizeof(LayerSplit)}},
    {Resource::kSplitMarks, "split marks", Area::kTiles, {.bytes = sizeof(cl_int)}},
    {Resource::kLayerTiles,
     "layer tiles",
     Area::kTiles,
     {.bytes = sizeof(LayerTile)},
     Resource::kPreviousLayerTiles},
    {Resource::kLayeredTileList, "list of layered tiles", Area::kTiles, {.bytes = sizeof(cl_int)}},
    {Resource::kNearHistory,
     "near history",
     Area::kOutput,
     {Element::kHistory},
     Resource::kPreviousNearHistory},
    {Resource::kLayerStates,
     "layer states",
     Area::kOutput,
     {.bytes = 4 * sizeof(cl_half)},
     Resource::kPreviousLayerStates},
    {Resource::kHistoryAlpha,
     "history alpha",
     Area::kOutput,
     {Element::kAlpha},
     Resource::kPreviousHistoryAlpha},
    {Resource::kCentred, "centred", Area::kOutput, {Element::kLinear}},
    {Resource::kCentredTiles, "centred tiles", Area::kTiles, {.bytes = sizeof(TileReprojection)}},
    {Resource::kOtherHistory, "other history", Area::kOutput, {Element::kHistory}},
    {Resource::kOtherAlpha, "other history alpha", Area::kOutput, {Element::kAlpha}},
    {Resource::kMergedHistory, "merged history", Area::kOutput, {Element::kHistory}},
    {Resource::kMergedAlpha, "merged history alpha", Area::kOutput, {Element::kAlpha}},
    {Resource::kNoisy, "noisy", Area::kOutput, {Element::kLinear}},
    {Resource::kUnrefined, "unrefined", Area::kOutput, {Element::kLinear}},
    {Resource::kUnsharpened, "unsharpened", Area::kOutput, {Element::kLinear}},
    {Resource::kResolved, "resolved", Area::kOutput, {Element::kLinear}},
    {Resource::kStreaks, "streaks", Area::kBlurTiles, {.bytes = sizeof(TileStreaks)}},
    {Resource::kLongestStreak, "longest streak", Area::kWhole, {.bytes = sizeof(cl_int)}},
    {Resource::kTileBlurs, "blur tiles", Area::kBlurTiles, {.bytes = sizeof(TileBlur)}},
    {Resource::kBlurred, "blurred", Area::kOutput, {Element::kLinear}},
    {Resource::kDisplayed, "displayed", Area::kDisplay, {Element::kLinear}},
    {Resource::kFocus, "focus", Area::kFocus, {Element::kLinear}},
    {Resource::kFocusMask, "focus mask", Area::kFocus, {.format = PixelFormat::kR8}},
    {Resource::kFadingFrom, "fading from", Area::kDisplay, {Element::kLinear}},
    {Resource::kPresented, "presented", Area::kDisplay, {.format = PixelFormat::kRGBA8}},
};

// In the order of the enumerators, in which plans list them.
constexpr auto kResources = [] {
  std::array<ResourceInfo, kResourceCount> all = {};
  const auto add = [&all](Resource resource, ResourceInfo info) {
    all[index_of(resource)] = info;
    if (info.previous) all[index_of(*info.previous)] = {info.name, nullptr, info.input, {}, true};
  };
  for (const InputImage& input : kInputs) {
    const std::optional<Resource> resource = resource_of(input);
    if (!resource) continue;
    const auto before = static_cast<Resource>(index_of(Resource::kPrevious) + index_of(*resource));
    add(*resource, {input.name, nullptr, &input, before});
    add(given_of(*resource), {input.name, "given", &input});
  }
  for (const EarlierInput& earlier : kEarlierInputs) {
    const ResourceInfo& input = all[index_of(earlier.input)];
    add(earlier.resource, {input.name, earlier.state, input.input});
  }
  for (const OwnResource& own : kOwnResources)
    add(own.resource, {own.name, nullptr, nullptr, own.previous});
  return all;
}();
static_assert(std::all_of(std::begin(kInputs), std::end(kInputs),
                          [](const InputImage& input) {
                            return (input.viewport != nullptr) ==
                                   (&input - kInputs < static_cast<std::ptrdiff_t>(Resource::kInputCount));
                          }),
              "rendered inputs go first, each with an enumerator");
static_assert(std::all_of(kResources.begin(), kResources.end(),
                          [](const ResourceInfo& info) { return info.name != nullptr; }),
              "each enumerator of Resource needs a row");

Use own_use(const OwnResource& own, const ResolveSettings& settings) {
  switch (own.element.kind) {
    case Element::kFixed:
      break;
    case Element::kLinear:
      return {own.resource, Access::kRead, own.area, settings.output.linear};
    case Element::kHistory:
      return {own.resource, Access::kRead, own.area, settings.temporal.history};
    case Element::kAlpha:
      return {own.resource, Access::kRead, own.area, {}, alpha_bytes(settings)};
  }
  return {own.resource, Access::kRead, own.area, own.element.format, own.element.bytes};
}

}  // namespace

const ResourceInfo& info_of(Resource resource) {
  return kResources[index_of(resource)];
}

std::string name_of(Resource resource) {
  const ResourceInfo& info = info_of(resource);
  std::string name = info.state != nullptr ? fmt::format("{} {}", info.state, info.name) : info.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return info.is_previous ? name + " of the previous frame" : name;
}

Storage storage_of(Resource resource, const PlanFacts& facts) {
  if (resource == Resource::kPresented) return facts.presented_storage();
  return info_of(resource).input != nullptr ? facts.settings.targets.storage : Storage::kBuffer;
}

Use use(Resource resource, const ResolveSettings& settings, Access access) {
  const ResourceInfo& info = info_of(resource);
  Use made = {resource, access, Area::kViewport};
  if (info.input != nullptr) {
    const InputImage& input = *info.input;
    made.format = input.chosen != nullptr ? settings.*input.chosen : input.format;
    if (input.viewport == &FrameInputs::particle_render_extent) made.area = Area::kParticles;
  } else {
    const auto* own = std::find_if(
        std::begin(kOwnResources), std::end(kOwnResources),
        [resource](const OwnResource& row) { return row.resource == resource || row.previous == resource; });
    made = own_use(*own, settings);
    made.resource = resource;
    made.access = access;
  }
  if (info.is_previous && made.area == Area::kViewport) made.area = Area::kPreviousViewport;
  return made;
}

std::vector<Use> uses_of(const ResolveSettings& settings, const Touched& touched) {
  std::vector<Use> uses;
  const auto add = [&](const std::vector<Resource>& resources, Access access) {
    for (const Resource resource : resources) {
      Use& made = uses.emplace_back(use(resource, settings, access));
      if (!touched.resizes || !is_previous(resource)) continue;
      if (made.area == Area::kOutput) made.area = Area::kPreviousOutput;
      if (made.area == Area::kTiles) made.area = Area::kPreviousTiles;
    }
  };
  add(touched.reads, Access::kRead);
  add(touched.writes, Access::kWrite);
  add(touched.updates, Access::kUpdate);
  add(touched.sums, Access::kAccumulate);
  return uses;
}

void PassSpec::add_options(const std::string& more) {
  if (!options.empty()) options += ' ';
  options += more;
}

void PassSpec::add_where(bool wanted, const char* name, const ResolveSettings& settings,
                         const Touched& touched) {
  add_options(fmt::format("-D {}={}", name, wanted ? 1 : 0));
  if (!wanted) return;
  const std::vector<Use> more = uses_of(settings, touched);
  uses.insert(uses.end(), more.begin(), more.end());
}

FrameExtents largest_extents(const ResolveSettings& settings) {
  const Extent output = settings.output_extent;
  return {settings.target_extent,
          settings.target_extent,
          output,
          settings.targets.particle_extent,
          output,
          output,
          settings.focus.extent};
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
  for (ResourceUse& use : found) {
    const auto before = entry(previous_of(use.resource));
    if (before != found.end() && before->resource != use.resource) before->written = use.written;
  }
  std::sort(found.begin(), found.end(),
            [](const ResourceUse& a, const ResourceUse& b) { return a.resource < b.resource; });
  return found;
}

bool reads(const std::vector<ResourceUse>& used, Resource input) {
  return std::any_of(used.begin(), used.end(), [input](const ResourceUse& use) {
    return !use.written && info_of(use.resource).input == info_of(input).input;
  });
}

std::optional<Resource> unresized(const std::vector<PassSpec>& passes) {
  const auto is_resized = [&passes](const Use& kept) {
    return std::any_of(passes.begin(), passes.end(), [&kept](const PassSpec& pass) {
      return pass.frames == Frames::kResized &&
             std::any_of(pass.uses.begin(), pass.uses.end(), [&kept](const Use& use) {
               return previous_of(use.resource) == kept.resource && use.access != Access::kRead &&
                      use.area == kept.area;
             });
    });
  };
  for (const PassSpec& pass : passes) {
    for (const Use& use : pass.uses) {
      const bool follows_output =
          use.area == Area::kOutput || use.area == Area::kTiles || use.area == Area::kBlurTiles;
      if (is_previous(use.resource) && follows_output && !is_resized(use)) return use.resource;
    }
  }
  return std::nullopt;
}

namespace {

// In the order in which they run.
constexpr void (*kPlanners[])(const PlanFacts&, PassList&) = {
    // The previous frame's remains, before any other pass: PassChain::run() exchanges them after these.
    plan_resize_history,
    plan_resize_tiles,
    plan_resize_layers,
    plan_resize_records,
    // The frame, completed.
    plan_overlay_particles,
    plan_resolve_checkerboard,
    plan_exposure,
    plan_velocity_from_depth,
    plan_undilate_velocity,
    plan_far_motion,
    plan_far_velocity,
    plan_check_motion,
    plan_reproject,
    // The picture: from many frames, from two, or from one.
    plan_layer_records,
    plan_turn_records,
    plan_advect_records,
    plan_layer_split,
    plan_temporal_tiles,
    plan_temporal_light,
    plan_measure_content,
    plan_resolve_temporal,
    plan_resolve_layers,
    plan_temporal_display,
    plan_display_layers,
    plan_merge_histories,
    plan_temporal_denoise,
    plan_temporal_refine,
    plan_resolve_quincunx,
    plan_resolve_reprojected,
    plan_scale,
    plan_scale_filter,
    // The picture, finished.
    plan_sharpen,
    plan_motion_tiles,
    plan_motion_neighbours,
    plan_motion_blur,
    plan_scale_to_display,
    plan_lay_focus,
    plan_cross_fade,
    plan_present,
    plan_clear_region,
};

// Notes the caller's images that nobody reads.
void note_unused_inputs(const PlanFacts& facts, const std::vector<ResourceUse>& used,
                        std::vector<LeftOut>& left_out) {
  const auto note = [&left_out](const char* what, const char* why) { left_out.push_back({what, why}); };
  const bool several = facts.keeps_previous_frame();
  if (!several && !facts.fills()) note("the previous frame", "the method uses one frame only");
  if (facts.velocity == VelocitySource::kCamera) {
    note("velocity target", "nothing but the camera moves: velocity comes from depth and the camera");
  } else if (!reads(used, Resource::kVelocity)) {
    note("velocity", !several && !facts.fills()            ? "the method uses one frame only"
                     : facts.has_form(TwoFrameForm::kMean) ? "the form is the plain mean"
                                                           : "nothing moves: all frames count alike");
  }
  if (!reads(used, Resource::kDepth)) note("depth", "no pass reads it");
  if (!reads(used, Resource::kReactive))
    note("reactive values",
         facts.needs.transparents ? "the method uses one frame only" : "the scene has no transparents");
}

}  // namespace

PassList list_passes(const PlanFacts& facts) {
  PassList planned;
  for (const auto plan : kPlanners)
    plan(facts, planned);
  plan_convert_inputs(facts, planned);  // of what the others read
  PassList list{std::move(planned.passes), {}};
  note_unused_inputs(facts, resources_of(list.passes), list.left_out);
  for (LeftOut& left : planned.left_out)
    list.left_out.push_back(std::move(left));
  return list;
}

}  // namespace quincunx
