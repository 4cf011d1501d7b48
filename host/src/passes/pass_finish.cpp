// SPDX-License-Identifier: MIT
// The passes that are made of the finished picture: sharpen, lay_focus, cross_fade, present; and exposure.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "passes/pass.h"
#include "picture_params.h"
#include "plan/pass_spec.h"

namespace quincunx {

// sharpen: the resolved picture made crisper.

namespace {

class SharpenPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const SharpenParams params{.width = frame.output.width,
                               .height = frame.output.height,
                               .source = layout_of(frame[Resource::kUnsharpened]),
                               .output = layout_of(frame[Resource::kResolved]),
                               .columns_per_item = columns_per_item(shape(), frame.output.width),
                               .sharpness = settings().sharpness};
    bind(frame, params, Resource::kUnsharpened, Resource::kResolved, Resource::kExposure);
    launch(frame, frame.output, params.columns_per_item, event);
  }
};

}  // namespace

void plan_sharpen(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!facts.sharpens()) {
    list.left_out.push_back(
        {"sharpen", settings.sharpness > 0 ? "the view is no picture" : "sharpness is 0"});
    return;
  }
  list.passes.push_back({.kernel = "sharpen",
                         .options = fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}",
                                                precision_of(settings.output.linear)),
                         .reason = "sharpness is wanted: contrast between neighbours, within their range",
                         .uses = uses_of(settings, {.reads = {Resource::kUnsharpened, Resource::kExposure},
                                                    .writes = {Resource::kResolved}}),
                         .make = make_pass<SharpenPass>});
}

// lay_focus: the focus's picture over the picture, within its rectangles.

namespace {

static_assert(kMostFocusRectangles == FocusInputs::kMaxRectangles);

// Beyond any picture, so that no distance to such an edge is the least.
constexpr float kFarAway = 1 << 20;
constexpr int kFeathersInSide = 4;

// In pixels of the region. A side that is the picture's own has no neighbour that a seam could show against.
FocusRectangle rectangle_in(const FocusInputs& focus, const Rectangle& where, Extent output) {
  const auto from = [](int edge, int origin, bool open, float away) {
    return open ? away : static_cast<float>(edge - origin);
  };
  const int right = where.x + where.width;
  const int bottom = where.y + where.height;
  const float feather = focus.feather > 0 ? focus.feather : FocusInputs::kDefaultFeather;
  const float longest = static_cast<float>(std::min(where.width, where.height)) / kFeathersInSide;
  return {.left = from(where.x, focus.x, where.x == 0, -kFarAway),
          .top = from(where.y, focus.y, where.y == 0, -kFarAway),
          .right = from(right, focus.x, right == output.width, kFarAway),
          .bottom = from(bottom, focus.y, bottom == output.height, kFarAway),
          .rate = 1 / std::min(feather, longest)};
}

// Returns the rectangle that holds both.
Rectangle around(const Rectangle& a, const Rectangle& b) {
  const int left = std::min(a.x, b.x);
  const int top = std::min(a.y, b.y);
  return {left, top, std::max(a.x + a.width, b.x + b.width) - left,
          std::max(a.y + a.height, b.y + b.height) - top};
}

// The focus to be laid over: its rectangles, and the part of the picture that holds them.
struct Laid {
  Rectangle part;
  int count = 0;
  std::array<FocusRectangle, kMostFocusRectangles> rectangles = {};
};

Laid laid_by(const FocusInputs& focus, Extent region, Extent output) {
  const Rectangle whole = {focus.x, focus.y, region.width, region.height};
  const std::span<const Rectangle> given = focus.rectangle_count > 0
                                               ? std::span<const Rectangle>(focus.rectangles)
                                                     .first(static_cast<std::size_t>(focus.rectangle_count))
                                               : std::span<const Rectangle>(&whole, 1);
  Laid laid{.part = given.front()};
  for (const Rectangle& where : given) {
    laid.rectangles[static_cast<std::size_t>(laid.count++)] = rectangle_in(focus, where, output);
    laid.part = around(laid.part, where);
  }
  return laid;
}

class LayFocusPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const FocusInputs& focus = *frame.focus;
    const ImageView& picture = frame[shown_of(facts())];
    const Laid laid = laid_by(focus, frame.focus_extent, frame.display);
    TexelLayout output = layout_of(picture);
    output.offset += focus.y * output.pitch + focus.x;
    FocusParams params{.left = laid.part.x - focus.x,
                       .top = laid.part.y - focus.y,
                       .width = laid.part.width,
                       .height = laid.part.height,
                       .focus = layout_of(frame[Resource::kFocus]),
                       .mask = layout_of(frame[Resource::kFocusMask]),
                       .output = output,
                       .columns_per_item = columns_per_item(shape(), laid.part.width),
                       .rectangle_count = laid.count,
                       .rectangles = {}};
    std::copy(laid.rectangles.begin(), laid.rectangles.end(), params.rectangles);
    bind(frame, params, Resource::kFocus, Resource::kFocusMask, picture);
    launch(frame, {params.width, params.height}, params.columns_per_item, event);
  }
};

}  // namespace

void plan_lay_focus(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!facts.has_focus()) {
    list.left_out.push_back(
        {"lay_focus", settings.focus.extent != Extent{} ? "the view is no picture" : "no part is in focus"});
    return;
  }
  PassSpec spec{.kernel = "lay_focus",
                .reason = "a part is in focus: its own picture is laid over",
                .uses = {{Resource::kFocus, Access::kRead, Area::kFocus, settings.output.linear},
                         {shown_of(facts), Access::kUpdate, Area::kFocus, settings.output.linear}},
                .make = make_pass<LayFocusPass>,
                .frames = Frames::kWithFocus};
  spec.add_where(settings.focus.mask, "MASK", settings, {.reads = {Resource::kFocusMask}});
  spec.add_options(
      fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}", precision_of(settings.output.linear)));
  list.passes.push_back(std::move(spec));
}

// cross_fade: the picture mixed with that of another service, while one method gives way to another.

namespace {

class CrossFadePass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ImageView& picture = frame[shown_of(facts())];
    const ImageView& other = frame[Resource::kFadingFrom];
    const CrossFadeParams params{.width = frame.display.width,
                                 .height = frame.display.height,
                                 .other = layout_of(other),
                                 .output = layout_of(picture),
                                 .columns_per_item = columns_per_item(shape(), frame.display.width, 1),
                                 .weight = frame.inputs.fade_weight};
    bind(frame, params, other, picture);
    launch(frame, frame.display, params.columns_per_item, event);
  }
};

}  // namespace

void plan_cross_fade(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!settings.control.fades) return;
  list.passes.push_back(
      {.kernel = "cross_fade",
       .options =
           fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}", precision_of(settings.output.linear)),
       .reason = "a change of method is faded: the picture of the other one is mixed in",
       .uses = {{Resource::kFadingFrom, Access::kRead, Area::kDisplay, settings.output.linear},
                {shown_of(facts), Access::kUpdate, Area::kDisplay, settings.output.linear}},
       .make = make_pass<CrossFadePass>,
       .frames = Frames::kFading});
}

// The factor of a frame's exposure_image, where kernels read it.

namespace {

class ExposureFactor {
 public:
  explicit ExposureFactor(const PassSetup& setup)
      : none_(setup.device.context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof(float), &zero_),
        given_(setup.device.context, CL_MEM_READ_ONLY, sizeof(float)) {}

  // Copied, so that one kernel serves buffers and images. 0 where there is none.
  const cl::Buffer& of(const PassFrame& frame, const PlanFacts& facts) const {
    const ImageView& image = frame.inputs.exposure_image;
    if (!image || facts.is_display_referred()) return none_;
    if (image.storage == Storage::kImage) {
      frame.queue.enqueueCopyImageToBuffer(borrow<cl::Image2D>(image.memory), given_, {0, 0, 0}, {1, 1, 1},
                                           0);
    } else {
      frame.queue.enqueueCopyBuffer(borrow<cl::Buffer>(image.memory), given_, image.offset, 0, sizeof(float));
    }
    return given_;
  }

 private:
  float zero_ = 0;
  cl::Buffer none_;
  cl::Buffer given_;
};

}  // namespace

// exposure: what makes exposed light of the frame's.

namespace {

class ExposurePass : public Pass {
 public:
  ExposurePass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec), image_(setup) {}

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const ExposureParams params{
        .width = render.width,
        .height = render.height,
        .texels_x = std::clamp(render.width / kExposureColumns, 1, int{kExposureTexels}),
        .texels_y = std::clamp(render.height / kExposureRows, 1, int{kExposureTexels}),
        .colour = layout_of(frame[Resource::kColour]),
        .given = facts().is_display_referred() ? 1 : frame.inputs.exposure,
        .follows = facts().accumulates() ? 1 : 0};
    bind(frame, params, Resource::kColour, image_.of(frame, facts()), Resource::kPreviousExposure,
         Resource::kExposure);
    launch_group(frame, event);
  }

 private:
  ExposureFactor image_;
};

}  // namespace

void plan_exposure(const PlanFacts& facts, PassList& list) {
  if (!facts.exposes()) return;
  PassSpec spec{
      .kernel = "exposure",
      .options = colour_options(facts.settings),
      .reason = "how bright the scene is: rules of light are those of exposed light",
      .uses = uses_of(facts.settings, {.reads = {Resource::kColour}, .writes = {Resource::kExposure}}),
      .make = make_pass<ExposurePass>};
  // Other methods keep nothing in exposed light, and a chunk of their frames is as the whole run has it.
  if (facts.accumulates()) spec.uses.push_back(use(Resource::kPreviousExposure, facts.settings));
  list.passes.push_back(std::move(spec));
}

// present: the picture as 8-bit sRGB: exposed, tone mapped, dithered.

namespace {

class PresentPass : public Pass {
 public:
  PresentPass(const PassSetup& setup, const PassSpec& spec) : Pass(setup, spec), image_(setup) {}

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ImageView& source = frame[shown_of(facts())];
    const ImageView& presented = frame[Resource::kPresented];
    const float exposure = facts().is_display_referred() ? 1 : frame.inputs.exposure;
    const PresentParams params{
        .width = frame.display.width,
        .height = frame.display.height,
        .source = layout_of(source),
        .output = rows_of(presented, frame.display.height, settings().conventions.origin),
        .counter = frame.counter.index,
        .columns_per_item = columns_per_item(shape(), frame.display.width, 1),
        .exposure = exposure == 0 ? 1 : exposure};
    bind(frame, params, source, image_.of(frame, facts()), presented, frame.counter);
    launch(frame, frame.display, params.columns_per_item, event);
  }

 private:
  ExposureFactor image_;
};

const char* curve(ToneMap tone_map) {
  switch (tone_map) {
    case ToneMap::kClamp:
      return "TONE_CLAMP";
    case ToneMap::kReinhard:
      return "TONE_REINHARD";
    case ToneMap::kAces:
      return "TONE_ACES";
  }
  return "TONE_CLAMP";
}

}  // namespace

void plan_present(const PlanFacts& facts, PassList& list) {
  const ResolveSettings& settings = facts.settings;
  if (!settings.output.present) {
    list.left_out.push_back({"present", "no 8-bit picture is wanted"});
    return;
  }
  const bool tone_maps = !facts.is_display_referred();
  if (!tone_maps)
    list.left_out.push_back({"exposure and tone map", "RGBA8 colour has both when it is drawn"});
  list.passes.push_back(
      {.kernel = "present",
       .options = fmt::format("-D TONE_MAP={} -D DITHER={} -D SOURCE_FORMAT={} -D OUTPUT_STORAGE={}",
                              curve(tone_maps ? settings.output.tone_map : ToneMap::kClamp),
                              settings.output.dither ? 1 : 0, precision_of(settings.output.linear),
                              storage_option(facts.presented_storage())),
       .reason = "an 8-bit sRGB picture is wanted",
       .uses = {{shown_of(facts), Access::kRead, Area::kDisplay, settings.output.linear},
                {Resource::kPresented, Access::kWrite, Area::kDisplay, PixelFormat::kRGBA8}},
       .make = make_pass<PresentPass>});
}

}  // namespace quincunx
