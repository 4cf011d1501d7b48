// SPDX-License-Identifier: MIT
#include "passes/pass_measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "passes/frame_params.h"
#include "passes/pass.h"
#include "plan/pass_spec.h"
#include "temporal/tile.h"

namespace quincunx {

// check_motion: whether velocity foretells frames.

namespace {

constexpr unsigned kLeastSamples = 32;  // of a frame that tells
constexpr double kClearDb = 3;          // of all frames: mirrors and moving shadows foretell badly, too
constexpr double kAgreeDb = 1;          // of each of them

Extent motion_items(Extent render) {
  constexpr int kSide = kMotionStep * kMotionSamples;
  return {(render.width + kSide - 1) / kSide, (render.height + kSide - 1) / kSide};
}

class CheckMotionPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent, previous = frame.previous.render_extent;
    const Extent items = motion_items(render);
    const PreviousPlaces places = previous_places(frame.inputs, frame.previous);
    const MotionCheckParams params{.width = render.width,
                                   .height = render.height,
                                   .previous_width = previous.width,
                                   .previous_height = previous.height,
                                   .items_x = items.width,
                                   .items_y = items.height,
                                   .velocity = layout_of(frame[Resource::kVelocity]),
                                   .colour0 = layout_of(frame[Resource::kColour]),
                                   .colour1 = layout_of(frame[Resource::kPreviousColour]),
                                   .step_x = places.step_x,
                                   .step_y = places.step_y,
                                   .start_x = places.start_x,
                                   .start_y = places.start_y,
                                   .motion_x = places.motion_x,
                                   .motion_y = places.motion_y};
    bind(frame, params, Resource::kVelocity, Resource::kColour, Resource::kPreviousColour,
         Resource::kMotionSums);
    launch(frame, items, 1, event);
  }
};

}  // namespace

const char* name_of(MotionVerdict verdict) {
  switch (verdict) {
    case MotionVerdict::kUnknown:
      return "cannot tell";
    case MotionVerdict::kRightX:
      return "x right";
    case MotionVerdict::kRightY:
      return "y right";
    case MotionVerdict::kRight:
      return "right";
    case MotionVerdict::kSignOfX:
      return "sign of x";
    case MotionVerdict::kSignOfY:
      return "sign of y";
    case MotionVerdict::kDirection:
      return "direction";
  }
  return "?";
}

const char* sentence_of(MotionVerdict verdict) {
  switch (verdict) {
    case MotionVerdict::kUnknown:
      return nullptr;
    case MotionVerdict::kRightX:
      return "velocity.x points the right way";
    case MotionVerdict::kRightY:
      return "velocity.y points the right way";
    case MotionVerdict::kRight:
      return "velocity points the right way";
    case MotionVerdict::kSignOfX:
      return "velocity.x seems to point the other way";
    case MotionVerdict::kSignOfY:
      return "velocity.y seems to point the other way";
    case MotionVerdict::kDirection:
      return "velocity seems to point the other way";
  }
  return nullptr;
}

std::string text_of(const MotionCheck& check) {
  const char* sentence = sentence_of(check.verdict);
  return sentence != nullptr ? fmt::format("{}: {:.1f} dB better", sentence, check.margin_db)
                             : name_of(check.verdict);
}

double MotionWatch::Axis::Errors::margin_db() const {
  return 10 * std::log10(turned / as_said);
}

void MotionWatch::Axis::add(unsigned samples, double as_said, double turned) {
  if (samples < kLeastSamples) return;
  // A floor under perfect forecasts: at most 40 dB lie between two.
  const double floor = 1e-4 * static_cast<double>(kMotionUnits) * samples;
  frames_[count_++ % kFrames] = {as_said + floor, turned + floor};
  if (count_ < kFrames) return;
  Errors all;
  for (const Errors& frame : frames_) {
    all.as_said += frame.as_said;
    all.turned += frame.turned;
  }
  const double margin = all.margin_db();
  const bool agree = std::all_of(frames_.begin(), frames_.end(), [&](const Errors& frame) {
    return std::copysign(1.0, margin) * frame.margin_db() >= kAgreeDb;
  });
  margin_db_ = agree && std::abs(margin) >= kClearDb ? margin : 0;
}

// The kernel's readings of velocity: as it is, with x turned, with y turned, with both. An axis is judged with the
// better sign of the other one.
void MotionWatch::add(const MotionSums& frame) {
  const auto better = [](const MotionAxisSums& sums, int one, int other) {
    return static_cast<double>(std::min(sums.errors[one], sums.errors[other]));
  };
  x_.add(frame.x.samples, better(frame.x, 0, 2), better(frame.x, 1, 3));
  y_.add(frame.y.samples, better(frame.y, 0, 1), better(frame.y, 2, 3));
}

MotionCheck MotionWatch::check() const {
  const double x = x_.margin_db(), y = y_.margin_db();
  const double least = std::min(std::abs(x), std::abs(y));
  if (x < 0 && y < 0) return {MotionVerdict::kDirection, least};
  if (x < 0) return {MotionVerdict::kSignOfX, -x};
  if (y < 0) return {MotionVerdict::kSignOfY, -y};
  if (x > 0 && y > 0) return {MotionVerdict::kRight, least};
  if (x > 0) return {MotionVerdict::kRightX, x};
  if (y > 0) return {MotionVerdict::kRightY, y};
  return {};
}

void plan_check_motion(const PlanFacts& facts, PassList& list) {
  if (!facts.settings.checks_motion) return;
  if (!facts.checks_motion()) {
    const char* reason = !facts.reads_velocity() ? "no pass reads velocity"
                         : facts.velocity == VelocitySource::kCamera
                             ? "velocity comes from depth and the camera"
                             : "the method uses one frame only";
    list.left_out.push_back({"check_motion", reason});
    return;
  }
  const ResolveSettings& settings = facts.settings;
  PassSpec spec{
      .kernel = "check_motion",
      .options = colour_options(settings),
      .reason = "whether velocity foretells frames is wanted: a sample of it",
      .uses = uses_of(settings, {.reads = {Resource::kVelocity, Resource::kColour, Resource::kPreviousColour},
                                 .sums = {Resource::kMotionSums}}),
      .make = make_pass<CheckMotionPass>,
      .frames = Frames::kWithHistory};
  if (settings.targets.storage == Storage::kBuffer)
    spec.options += std::string(" -D VELOCITY_FORMAT=") + precision_of(settings.velocity);
  list.passes.push_back(std::move(spec));
}

// measure_content: what a frame shows.

namespace {

constexpr double kSpeedUnits = 16;  // steps of ContentSums::speed in an output pixel

constexpr double kThinReach = 3;  // output pixels to either side of what is thin

int reach(int render, int output) {
  return std::max(1, static_cast<int>(std::lround(kThinReach * render / output)));
}

float step(int output, int tiles) {
  return static_cast<float>(static_cast<double>(output) / (tiles * kContentSamples));
}

class MeasureContentPass : public Pass {
 public:
  using Pass::Pass;

  void enqueue(const PassFrame& frame, cl::Event* event) override {
    const Extent render = frame.inputs.render_extent;
    const Extent tiles = content_tiles(frame.output);
    const VelocityScale pixels = velocity_scale_to(frame.inputs, frame.output);
    const bool is_judged = uses(Resource::kTileLight) && frame.has_history && !is_dense(render, frame.output);
    const Extent judged = is_judged ? frame.output : Extent{};
    const ContentParams params{.width = render.width,
                               .height = render.height,
                               .tiles_x = tiles.width,
                               .tiles_y = tiles.height,
                               .velocity = layout_of(frame[Resource::kVelocity]),
                               .depth = layout_of(frame[Resource::kDepth]),
                               .reactive = layout_of(frame[Resource::kReactive]),
                               .reach_x = reach(render.width, frame.output.width),
                               .reach_y = reach(render.height, frame.output.height),
                               .pixels_x = static_cast<float>(pixels.x),
                               .pixels_y = static_cast<float>(pixels.y),
                               .step_x = step(frame.output.width, tiles.width),
                               .step_y = step(frame.output.height, tiles.height),
                               .judged_width = judged.width,
                               .judged_height = judged.height};
    bind(frame, params, Resource::kVelocity, Resource::kDepth, Resource::kReactive, Resource::kTileLight,
         Resource::kContentSums);
    launch(frame, tiles, 1, event);
  }
};

}  // namespace

Extent content_tiles(Extent output) {
  return {(output.width + kContentTile - 1) / kContentTile,
          (output.height + kContentTile - 1) / kContentTile};
}

ContentStatistics statistics_of(const ContentSums& sums, Extent output) {
  constexpr int kSamples = kContentSamples * kContentSamples;
  const auto all = static_cast<double>(content_tiles(output).area() * kSamples);
  ContentStatistics content;
  content.moving = sums.moving / all;
  if (sums.moving > 0) content.speed_px = sums.speed / kSpeedUnits / sums.moving;
  content.apart = sums.apart / all;
  content.thin = sums.thin / all;
  content.light = sums.light / all;
  content.zoom = sums.zoom / all;
  content.judged = sums.judged > 0;
  return content;
}

void plan_measure_content(const PlanFacts& facts, PassList& list) {
  if (!facts.measures_content()) return;
  PassSpec spec{.kernel = "measure_content",
                .reason = "what the picture shows is wanted: a sample of it",
                .uses = uses_of(facts.settings, {.reads = {Resource::kVelocity, Resource::kDepth},
                                                 .sums = {Resource::kContentSums}}),
                .make = make_pass<MeasureContentPass>};
  spec.add_where(facts.needs.transparents, "REACTIVE", facts.settings, {.reads = {Resource::kReactive}});
  spec.add_options(velocity_options(facts.settings));
  if (facts.accumulates()) spec.uses.push_back(use(Resource::kTileLight, facts.settings));
  list.passes.push_back(std::move(spec));
}

}  // namespace quincunx
