// SPDX-License-Identifier: MIT
// The stages of a frame that quincunx-dump can show, and how each becomes EXR channels and a picture for a
// person.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"
#include "tools/image/image_io.h"
#include "tools/image/text_painter.h"

namespace quincunx::scenes {

enum class Stage : std::uint8_t {
  kColour,  // the viewport as it was drawn
  kDepth,
  kVelocity,
  kReactive,
  kParticles,  // in a viewport of their own
  kFocus,      // the region of a focus as it was drawn
  kClear,      // what a partial clear touches of the target
  kHistory,    // what the resolve reads of the past
  kTiles,      // classes of the motion blur's tiles
  kResolved,
  kBlurred,
  kDisplayed,  // in the size in which it is shown, where the output is dynamic
  kPresented,
  kTruth,
  kError,  // absolute, of the tone-mapped resolved picture against truth
  kFlip,   // as the FLIP paper maps it
};

constexpr int kStageCount = 16;

const char* name_of(Stage stage);  // "colour"
std::optional<Stage> stage_named(const std::string& name);
std::string stage_names();  // "colour, depth, ..."

bool needs_truth(Stage stage);

// Planes of one extent, row by row; one EXR channel each.
struct StagePlanes {
  Extent extent;
  std::vector<std::string> channels;  // "R" or "backward.u"; without the stage's name
  std::vector<std::vector<float>> planes;
  tools::ChannelType stored = tools::ChannelType::kFloat;
};

// RGBA values to planes R, G, B, A.
StagePlanes colour_planes(Extent extent, const std::vector<float>& rgba, tools::ChannelType stored);

// The picture of a stage whose data is not colour: false colours with a legend.
tools::Canvas false_colour_of(Stage stage, const StagePlanes& planes);

}  // namespace quincunx::scenes
