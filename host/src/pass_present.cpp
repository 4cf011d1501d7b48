// SPDX-License-Identifier: MIT
// present: the picture as 8-bit sRGB: exposed, tone mapped, dithered.
#include <fmt/format.h>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "picture_params.h"

namespace quincunx {
namespace {

class PresentPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const ImageView& source = frame[shown_of(facts())];
    const ImageView& presented = frame[Resource::kPresented];
    const float exposure = facts().is_display_referred() ? 1 : frame.current.exposure;
    const PresentParams params{
        .width = frame.display.width,
        .height = frame.display.height,
        .source = layout_of(source),
        .output = layout_of(presented),
        .counter = frame.counter.index,
        .columns_per_item = columns_per_item(shape(), frame.display.width, kPresentBlock),
        .exposure = exposure == 0 ? 1 : exposure};
    bind(params, source, presented, frame.counter);
    launch(frame, frame.display, params.columns_per_item, event);
  }
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
  if (!settings.present) {
    list.left_out.push_back({"present", "no 8-bit picture is wanted"});
    return;
  }
  const bool tone_maps = !facts.is_display_referred();
  if (!tone_maps)
    list.left_out.push_back({"exposure and tone map", "RGBA8 colour has both when it is drawn"});
  list.passes.push_back(
      {.kernel = "present",
       .options = fmt::format("-D TONE_MAP={} -D DITHER={} -D SOURCE_FORMAT={} -D OUTPUT_STORAGE={}",
                              curve(tone_maps ? settings.tone_map : ToneMap::kClamp), settings.dither ? 1 : 0,
                              precision_of(settings.resolved), storage_option(facts.presented_storage())),
       .reason = "an 8-bit sRGB picture is wanted",
       .uses = {{shown_of(facts), Access::kRead, Area::kDisplay, settings.resolved},
                {Resource::kPresented, Access::kWrite, Area::kDisplay, PixelFormat::kRGBA8}},
       .make = make_pass<PresentPass>});
}

}  // namespace quincunx
