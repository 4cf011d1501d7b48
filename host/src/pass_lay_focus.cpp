// SPDX-License-Identifier: MIT
// lay_focus: the focus's picture over the picture, within its rectangles.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "pass.h"
#include "pass_list.h"
#include "pass_options.h"
#include "picture_params.h"

namespace quincunx {
namespace {

static_assert(kMostFocusRectangles == FocusInputs::kMostRectangles);

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

// What holds both.
Rectangle around(const Rectangle& a, const Rectangle& b) {
  const int left = std::min(a.x, b.x);
  const int top = std::min(a.y, b.y);
  return {left, top, std::max(a.x + a.width, b.x + b.width) - left,
          std::max(a.y + a.height, b.y + b.height) - top};
}

// What is laid over: its rectangles, and the part of the picture that holds them.
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
                       .mask = layout_if_used(frame, Resource::kFocusMask),
                       .output = output,
                       .columns_per_item = columns_per_item(shape(), laid.part.width),
                       .rectangle_count = laid.count,
                       .rectangles = {}};
    std::copy(laid.rectangles.begin(), laid.rectangles.end(), params.rectangles);
    bind(params, frame[Resource::kFocus], view_or(frame, Resource::kFocusMask, Resource::kFocus), picture);
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
                .options = fmt::format("-D MASK={0} -D SOURCE_FORMAT={1} -D OUTPUT_FORMAT={1}",
                                       settings.focus.mask ? 1 : 0, precision_of(settings.resolved)),
                .reason = "a part is in focus: its own picture is laid over",
                .uses = {{Resource::kFocus, Access::kRead, Area::kFocus, settings.resolved},
                         {shown_of(facts), Access::kUpdate, Area::kFocus, settings.resolved}},
                .make = make_pass<LayFocusPass>,
                .frames = Frames::kWithFocus};
  if (settings.focus.mask)
    spec.uses.push_back({Resource::kFocusMask, Access::kRead, Area::kFocus, PixelFormat::kR8});
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
