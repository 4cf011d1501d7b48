// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

#include "plan/pass_spec.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {
namespace {

// Kernels count the channels of an image's texels, four at most, in `int`.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 29;
// The keys of records (kernels/include/layers/records.h) count samples in 28 bits.
constexpr std::int64_t kMostRecords = std::int64_t{1} << 28;

bool has_usable_sides(Extent extent) {
  return extent.width >= 1 && extent.height >= 1 && extent.width <= kLargestSide &&
         extent.height <= kLargestSide;
}

bool usable(Extent extent) {
  return has_usable_sides(extent) && extent.area() <= kMostTexels;
}

// Collects complaints so that one message names every bad field.
class Complaints {
 public:
  void add(std::string text) { text_ += (text_.empty() ? "" : "; ") + std::move(text); }

  // Checks a value of an enum that counts from 0 to `last`.
  template <typename Value>
  void check_named(const char* field, Value value, Value last) {
    const int number = static_cast<int>(value), highest = static_cast<int>(last);
    if (number >= 0 && number <= highest) return;
    add(fmt::format("settings.{} is {}; it must lie in [0, {}]", field, number, highest));
  }

  Status status() const { return text_.empty() ? Status() : Status::invalid(text_); }

 private:
  std::string text_;
};

void check_extent(Complaints& complaints, const char* field, Extent extent) {
  if (usable(extent)) return;
  if (has_usable_sides(extent)) {
    complaints.add(fmt::format("settings.{} is {}x{}; it must have at most {} pixels, as many as 32768x16384",
                               field, extent.width, extent.height, kMostTexels));
    return;
  }
  complaints.add(fmt::format("settings.{} is {}x{}; both sides must lie in [1, {}]", field, extent.width,
                             extent.height, kLargestSide));
}

void check_min_output_extent(Complaints& complaints, const ResolveSettings& settings) {
  const Extent least = settings.output.min_extent;
  const Extent most = settings.output_extent;
  if (least == Extent{} || !usable(most)) return;
  if (least.width >= 1 && least.height >= 1 && least.width <= most.width && least.height <= most.height)
    return;
  complaints.add(
      fmt::format("settings.output.min_extent is {}x{}; it must lie within 1x1 and the output's {}x{}",
                  least.width, least.height, most.width, most.height));
}

void check_format(Complaints& complaints, const char* field, PixelFormat format, PixelFormat half,
                  PixelFormat full) {
  if (format == half || format == full) return;
  complaints.add(fmt::format("settings.{} is {}; it must be {} or {}", field, name_of(format), name_of(half),
                             name_of(full)));
}

void check_focus(Complaints& complaints, const ResolveSettings& settings) {
  const FocusSettings& focus = settings.focus;
  if (focus.extent == Extent{}) return;
  if (focus.extent.width < 1 || focus.extent.height < 1 ||
      focus.extent.width > settings.output_extent.width ||
      focus.extent.height > settings.output_extent.height) {
    complaints.add(
        fmt::format("settings.focus.extent is {}x{}; it must lie within 1x1 and the output's {}x{}, or be "
                    "0x0 for no focus",
                    focus.extent.width, focus.extent.height, settings.output_extent.width,
                    settings.output_extent.height));
  }
  if (focus.target_extent != Extent{}) check_extent(complaints, "focus.target_extent", focus.target_extent);
}

// Formats are checked apart: few of them suit a field.
void check_named_values(Complaints& complaints, const ResolveSettings& settings) {
  complaints.check_named("method", settings.method, Method::kTemporal);
  const InputConventions& given = settings.conventions;
  complaints.check_named("conventions.depth", given.depth, DepthConvention::kLinear);
  complaints.check_named("conventions.clip_space", given.clip_space, ClipSpace::kVulkan);
  complaints.check_named("conventions.velocity_unit", given.velocity_unit, VelocityUnit::kNdc);
  complaints.check_named("conventions.origin", given.origin, Origin::kBottom);
  complaints.check_named("conventions.drawn_velocity", given.drawn_velocity, DrawnVelocity::kDilated);
  complaints.check_named("conventions.sky_motion", given.sky_motion, SkyMotion::kEvidence);
  complaints.check_named("targets.storage", settings.targets.storage, Storage::kImage);
  complaints.check_named("targets.placement", settings.targets.placement, Targets::kPlaced);
  complaints.check_named("targets.shading", settings.targets.shading, Shading::kCheckerboard);
  complaints.check_named("output.tone_map", settings.output.tone_map, ToneMap::kAces);
  complaints.check_named("quincunx.form", settings.quincunx.form, TwoFrameForm::kReprojected);
  complaints.check_named("quincunx.sampling", settings.quincunx.sampling, Sampling::kBilinear);
  complaints.check_named("temporal.preset", settings.temporal.preset, TemporalPreset::kQuality);
  complaints.check_named("temporal.view", settings.temporal.view, TemporalView::kFar);
}

Status check(const ResolveSettings& settings) {
  Complaints complaints;
  check_named_values(complaints, settings);
  check_extent(complaints, "output_extent", settings.output_extent);
  check_extent(complaints, "target_extent", settings.target_extent);
  check_min_output_extent(complaints, settings);
  if (settings.colour != PixelFormat::kRGBA8 && settings.colour != PixelFormat::kRGBA16F &&
      settings.colour != PixelFormat::kRGBA32F) {
    complaints.add(
        fmt::format("settings.colour is {}; it must be RGBA8, RGBA16F or RGBA32F", name_of(settings.colour)));
  }
  if (settings.targets.particle_extent != Extent()) {
    const Extent particles = settings.targets.particle_extent;
    if (particles.width < 1 || particles.height < 1 || particles.width > settings.target_extent.width ||
        particles.height > settings.target_extent.height) {
      complaints.add(fmt::format(
          "settings.targets.particle_extent is {}x{}; it must lie within 1x1 and the target's {}x{}, or be "
          "0x0",
          particles.width, particles.height, settings.target_extent.width, settings.target_extent.height));
    }
    if (settings.colour == PixelFormat::kRGBA8)
      complaints.add(
          "settings.colour is RGBA8; with particles of their own it must be RGBA16F or RGBA32F, which are "
          "linear");
  }
  check_format(complaints, "velocity", settings.velocity, PixelFormat::kRG16F, PixelFormat::kRG32F);
  check_format(complaints, "output.linear", settings.output.linear, PixelFormat::kRGBA16F,
               PixelFormat::kRGBA32F);
  check_format(complaints, "temporal.history", settings.temporal.history, PixelFormat::kRGBA16F,
               PixelFormat::kRGBA32F);
  const auto check_weight = [&](const char* field, float weight) {
    if (weight >= 0 && std::isfinite(weight)) return;
    complaints.add(
        fmt::format("settings.quincunx.{} is {}; it must be finite and at least 0", field, weight));
  };
  check_weight("velocity_weight", settings.quincunx.velocity_weight);
  check_weight("residual_weight", settings.quincunx.residual_weight);
  if (!(settings.filter.grain >= 0 && settings.filter.grain <= 1)) {
    complaints.add(fmt::format("settings.filter.grain is {}; it must lie in [0, 1]", settings.filter.grain));
  }
  if (!(settings.blur.shutter >= 0 && settings.blur.shutter <= 2)) {
    complaints.add(fmt::format("settings.blur.shutter is {}; it must lie in [0, 2]", settings.blur.shutter));
  }
  if (!(settings.sharpness >= 0 && settings.sharpness <= 1)) {
    complaints.add(fmt::format("settings.sharpness is {}; it must lie in [0, 1]", settings.sharpness));
  }
  if (!(settings.temporal.noise >= 0 && settings.temporal.noise <= 1)) {
    complaints.add(
        fmt::format("settings.temporal.noise is {}; it must lie in [0, 1]", settings.temporal.noise));
  }
  check_focus(complaints, settings);
  const int samples = settings.blur.samples;
  if (samples < 4 || samples > 64 || !std::has_single_bit(static_cast<unsigned>(samples))) {
    complaints.add(fmt::format("settings.blur.samples is {}; it must be 4, 8, 16, 32 or 64", samples));
  }
  return complaints.status();
}

// Checks the samples of the picture and of the focus, whose plan has layers where this one has.
Status check_records(const PlanFacts& facts) {
  if (!facts.has_layers()) return {};
  const FocusSettings& focus = facts.settings.focus;
  const bool sized = focus.target_extent != Extent{};
  for (const auto& [field, extent] : {std::pair{"target_extent", facts.settings.target_extent},
                                      std::pair{sized ? "focus.target_extent" : "focus.extent",
                                                sized ? focus.target_extent : focus.extent}}) {
    if (extent.area() <= kMostRecords) continue;
    return Status::invalid(
        fmt::format("settings.{} is {}x{}; with two layers of history it must have at most {} samples, as "
                    "many as 16384x16384; "
                    "settings.temporal.preset fast has one layer",
                    field, extent.width, extent.height, kMostRecords));
  }
  return {};
}

Scaling scaling_of(Area area, const PlanFacts& facts) {
  switch (area) {
    case Area::kViewport:
    case Area::kFarCells:
      return Scaling::kScales;
    case Area::kParticles:
      return Scaling::kOwn;
    case Area::kPreviousViewport:
    case Area::kPreviousOutput:
    case Area::kPreviousTiles:
      return Scaling::kHistory;
    case Area::kOutput:
    case Area::kTiles:
    case Area::kBlurTiles:
      return facts.is_dual() ? Scaling::kScales : Scaling::kFixed;
    case Area::kDisplay:
    case Area::kFocus:
    case Area::kWhole:
      break;
  }
  return Scaling::kFixed;
}

PlannedBuffer planned(const ResourceUse& use, const PlanFacts& facts, const FrameExtents& largest) {
  const Extent extent = extent_of(use.largest.area, largest);
  const bool owned =
      (use.written && use.resource != Resource::kPresented) || use.resource == Resource::kFocus;
  const InputImage* input = info_of(use.resource).input;
  return {.name = name_of(use.resource),
          .extent = extent,
          .format = use.largest.format,
          .scaling = scaling_of(use.largest.area, facts),
          .bytes = static_cast<std::uint64_t>(extent.area()) * use.largest.element_bytes(),
          .owned = owned,
          .input = input != nullptr && !owned ? input->image : nullptr};
}

}  // namespace

Result<ResolvePlan> plan_for(const SceneNeeds& needs, const ResolveSettings& settings) {
  if (Status status = check(settings); !status.ok()) return status;
  const PlanFacts facts(needs, settings);
  if (facts.views_layers() && !facts.has_layers()) {
    return Status::invalid(fmt::format(
        "settings.temporal.view is {}, but there is one layer of history only; two have balanced and "
        "quality where something moves and nothing is transparent",
        name_of(settings.temporal.view)));
  }
  if (Status status = check_records(facts); !status.ok()) return status;
  if (const auto kept = facts.is_dual() ? unresized(list_passes(facts).passes) : std::nullopt) {
    return Status::unsupported(
        fmt::format("{} is read, but no pass resizes it where the output is dynamic", name_of(*kept)));
  }
  return plan_of(facts);
}

ResolvePlan plan_of(const PlanFacts& facts) {
  PassList list = list_passes(facts);
  const FrameExtents largest = largest_extents(facts.settings);
  ResolvePlan plan;
  plan.needs = facts.needs;
  plan.settings = facts.settings;
  plan.velocity = facts.velocity;
  for (const PassSpec& spec : list.passes)
    plan.passes.push_back({spec.kernel, spec.options, spec.reason, bytes_of(spec, largest)});
  const std::vector<ResourceUse> used = resources_of(list.passes);
  for (const ResourceUse& use : used)
    plan.buffers.push_back(planned(use, facts, largest));
  plan.reads_depth = reads(used, Resource::kDepth);
  plan.reads_reactive = reads(used, Resource::kReactive);
  plan.left_out = std::move(list.left_out);
  return plan;
}

bool ResolvePlan::accumulates() const {
  return settings.method == Method::kTemporal;
}

bool ResolvePlan::keeps_previous_frame() const {
  const bool copies =
      settings.targets.storage == Storage::kImage && settings.conventions.origin == Origin::kBottom;
  return uses_earlier_frames(settings.method) && settings.targets.shading == Shading::kFull && !copies;
}

bool ResolvePlan::is_dual() const {
  return PlanFacts(needs, settings).is_dual();
}

bool ResolvePlan::reads_history(Extent render, Extent output) const {
  if (accumulates()) return !is_dense(render, output == Extent{} ? settings.output_extent : output);
  return uses_earlier_frames(settings.method) || settings.targets.shading == Shading::kCheckerboard;
}

bool ResolvePlan::has_focus() const {
  return PlanFacts(needs, settings).has_focus();
}

std::optional<ResolvePlan> ResolvePlan::focus_plan() const {
  if (!has_focus()) return std::nullopt;
  ResolveSettings region = settings;
  region.output_extent = settings.focus.extent;
  region.output.min_extent = {};
  region.target_extent =
      settings.focus.target_extent != Extent{} ? settings.focus.target_extent : settings.focus.extent;
  region.targets.shading = Shading::kFull;
  region.output.present = false;
  region.targets.clear = false;
  region.targets.particle_extent = {};  // those of the region are drawn with the rest of it
  region.focus = {};
  region.control.measures_content = region.control.fades = region.checks_motion = false;
  return plan_for(needs, region).value();  // what it asks has been asked of the picture's settings
}

bool ResolvePlan::undilates_velocity() const {
  return PlanFacts(needs, settings).undilates_velocity();
}

bool ResolvePlan::moves_sky() const {
  return PlanFacts(needs, settings).moves_sky();
}

bool ResolvePlan::reads_camera() const {
  return velocity == VelocitySource::kCamera ||
         (moves_sky() && settings.conventions.sky_motion == SkyMotion::kCamera);
}

Storage ResolvePlan::presented_storage() const {
  return PlanFacts(needs, settings).presented_storage();
}

std::uint64_t ResolvePlan::frame_bytes() const {
  std::uint64_t bytes = 0;
  for (const PlannedBuffer& buffer : buffers) {
    if (!buffer.owned && (buffer.scaling == Scaling::kScales || buffer.scaling == Scaling::kOwn))
      bytes += buffer.bytes;
  }
  return bytes;
}

bool ResolvePlan::blurs() const {
  return PlanFacts(needs, settings).blurs();
}

// A plan in words.

namespace {

// Says who makes the picture's light out of the scene's.
std::string colour_text(const ResolveSettings& settings) {
  const char* curve = name_of(settings.output.tone_map);
  if (settings.colour == PixelFormat::kRGBA8)
    return fmt::format("RGBA8, sRGB encoded; the renderer exposes and tone maps ({})", curve);
  if (!settings.output.present) return fmt::format("{}, linear light", name_of(settings.colour));
  return fmt::format("{}, linear light; the present pass exposes and tone maps ({})",
                     name_of(settings.colour), curve);
}

std::string conventions_text(const InputConventions& given) {
  return fmt::format("depth {}; velocity in {}, {}, +y {}{}; {} row first; clip space of {}",
                     name_of(given.depth), name_of(given.velocity_unit),
                     given.velocity_backward ? "previous - this" : "this - previous",
                     given.velocity_up ? "up" : "down", given.velocity_jittered ? ", jittered" : "",
                     name_of(given.origin), name_of(given.clip_space));
}

std::string size_text(std::uint64_t bytes) {
  return fmt::format("{:.2f} MiB", static_cast<double>(bytes) / (1 << 20));
}

std::string targets_text(const ResolvePlan& plan) {
  const Extent largest = plan.settings.target_extent;
  if (plan.settings.targets.placement == Targets::kViewport) {
    return fmt::format("viewport: each frame is the top left part of images of {}x{}; {} a frame",
                       largest.width, largest.height, size_text(plan.frame_bytes()));
  }
  return fmt::format(
      "placed: images have exactly the viewport's size, made again in unused memory where it changes; up to "
      "{}x{}, {} a frame",
      largest.width, largest.height, size_text(plan.frame_bytes()));
}

std::string output_text(const ResolvePlan& plan) {
  const Extent least = plan.settings.output.min_extent;
  const Extent most = plan.settings.output_extent;
  if (!plan.is_dual()) return fmt::format("always {}x{}", most.width, most.height);
  const char* history = plan.accumulates() ? "; history is resized where it changes" : "";
  return fmt::format("dynamic: {}x{} to {}x{}, shown in {}x{}{}", least.width, least.height, most.width,
                     most.height, most.width, most.height, history);
}

std::string focus_text(const FocusSettings& focus) {
  return fmt::format("{}x{} pixels of the picture, drawn again and resolved on their own{}",
                     focus.extent.width, focus.extent.height, focus.mask ? "; a mask is given" : "");
}

// Returns the name that stands at the value's place; an enumerator that was made up has none.
template <typename Enum, std::size_t N>
const char* name_in(const char* const (&names)[N], Enum value) {
  const auto place = static_cast<std::size_t>(value);
  return place < N ? names[place] : "unknown";
}

}  // namespace

const char* name_of(DepthConvention depth) {
  return name_in({"reversed infinite", "reversed", "infinite", "forward", "linear"}, depth);
}

const char* name_of(ClipSpace clip_space) {
  return name_in({"Direct3D", "OpenGL", "Vulkan"}, clip_space);
}

const char* name_of(VelocityUnit unit) {
  return name_in({"uv", "pixels", "ndc"}, unit);
}

const char* name_of(Origin origin) {
  return name_in({"top", "bottom"}, origin);
}

const char* name_of(Targets targets) {
  return name_in({"viewport", "placed"}, targets);
}

const char* name_of(VelocitySource source) {
  return name_in({"none", "target", "depth and camera"}, source);
}

const char* name_of(Scaling scaling) {
  return name_in({"scales", "its own", "last frame's", "fixed"}, scaling);
}

const char* name_of(SkyMotion motion) {
  return name_in({"as-drawn", "camera", "evidence"}, motion);
}

const char* name_of(DrawnVelocity drawn) {
  return name_in({"own", "dilated"}, drawn);
}

MethodVariant variant_of(const ResolveSettings& settings) {
  return {.method = settings.method,
          .form = settings.quincunx.form,
          .sampling = settings.quincunx.sampling,
          .preset = settings.temporal.preset};
}

void apply(const MethodVariant& variant, ResolveSettings& settings) {
  settings.method = variant.method;
  if (variant.method == Method::kTemporal) settings.temporal.preset = variant.preset;
  if (variant.method != Method::kQuincunx) return;
  settings.quincunx.form = variant.form;
  if (variant.form != TwoFrameForm::kReprojected) settings.quincunx.sampling = variant.sampling;
}

std::string ResolvePlan::explain() const {
  std::string text;
  const auto out = std::back_inserter(text);
  const auto yes = [](bool value) { return value ? "yes" : "no"; };
  fmt::format_to(
      out, "Scene needs    moving objects {}, camera motion {}, transparents {}, covering background {}\n",
      yes(needs.moving_objects), yes(needs.camera_motion), yes(needs.transparents), yes(needs.background));
  std::string form;
  if (settings.method == Method::kQuincunx) form = fmt::format(":{}", name_of(settings.quincunx.form));
  if (accumulates()) form = fmt::format(":{}", name_of(settings.temporal.preset));
  fmt::format_to(out,
                 "Settings       {}{}, output {}x{}, target {}x{}, {} storage, sharpness {}, dither {}\n",
                 name_of(settings.method), form, settings.output_extent.width, settings.output_extent.height,
                 settings.target_extent.width, settings.target_extent.height,
                 settings.targets.storage == Storage::kImage ? "image" : "buffer", settings.sharpness,
                 yes(settings.output.dither));
  fmt::format_to(out, "Colour         {}\n", colour_text(settings));
  const InputConventions& given = settings.conventions;
  if (given != InputConventions{.drawn_velocity = given.drawn_velocity,
                                .sky_motion = given.sky_motion})  // told by passes
    fmt::format_to(out, "Conventions    {}\n", conventions_text(given));
  fmt::format_to(out, "Output         {}\n", output_text(*this));
  fmt::format_to(out, "Targets        {}\n", targets_text(*this));
  const std::optional<ResolvePlan> region = focus_plan();
  if (region) fmt::format_to(out, "Focus          {}\n", focus_text(settings.focus));
  fmt::format_to(out, "Velocity       {}\n\nPasses, with bytes a frame at the largest viewport\n",
                 name_of(velocity));
  for (const PlannedPass& pass : passes) {
    fmt::format_to(out, "  {:<19} {:>11}  {}\n  {:<19} {:>11}  {}\n", pass.kernel, size_text(pass.bytes),
                   pass.reason, "", "", pass.options);
  }
  text += "\nBuffers\n";
  for (const PlannedBuffer& buffer : buffers) {
    fmt::format_to(out, "  {:<40} {:>5}x{:<5} {:<8} {:<12} {:>11}  {}\n", buffer.name, buffer.extent.width,
                   buffer.extent.height, name_of(buffer.format), name_of(buffer.scaling),
                   size_text(buffer.bytes), buffer.owned ? "the service's" : "the caller's");
  }
  text += "\nLeft out\n";
  for (const LeftOut& left : left_out)
    fmt::format_to(out, "  {:<40} {}\n", left.what, left.why);
  if (region) fmt::format_to(out, "\nThe focus's region\n{}", region->explain());
  return text;
}

std::string name_of(const PassReport& pass) {
  return (pass.in_focus ? "focus: " : "") + std::string(pass.kernel);
}

}  // namespace quincunx
