// SPDX-License-Identifier: MIT
// The two tasks of quincunx-dump: one frame stage by stage (DumpSession), or a whole run as a sequence (dump_sequence).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "frames/picture_options.h"
#include "quincunx/resolve_service.h"
#include "quincunx/status.h"
#include "tools/image/false_colour.h"
#include "tools/image/image_io.h"
#include "tools/program/command_line.h"

namespace quincunx::scenes {

// The stages of a frame, and how each becomes EXR channels and a picture for a person (dump_stages.cpp).
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

// The command line's wishes.
struct DumpOptions : PictureOptions {
  std::int64_t frame = 0;     // index in the run
  std::vector<Stage> stages;  // empty: all that the plan has
  std::string out;            // folder of the stages
  bool png = true;
  bool exr = true;
  int truth = 0;             // N: N x N samples a pixel; 0: no truth, 8 where a stage needs it
  std::int64_t warm_up = 1;  // frames drawn and resolved before `frame`, for its history

  std::string sequence;  // pattern: the whole run in the exchange format instead
  bool device_depth =
      false;  // in its files Z is the reversed device depth as it was drawn: nothing is rounded
  bool dilate_velocity = false;  // the same: dilate_velocity()
};

// Returns the table of options; they write into `options`, which must outlive the parsing.
tools::CommandLine command_line(DumpOptions& options);

// Draws every frame of the options and writes it with all its targets in the exchange format (docs/inputs.md), and
// sequence.json with what is constant; truth, where it is asked for, beside it. Errors: of any part, as it words them.
Status dump_sequence(const DumpOptions& options);

// Draws and resolves one frame, with the frames that its history needs, and writes its stages.
class DumpSession {
 public:
  // Errors: of any part, as that part words them; kInvalidArgument for a stage that this plan does not have,
  // with the reason.
  static Result<std::unique_ptr<DumpSession>> create(const DumpOptions& options);

  Status run();

  const std::vector<std::string>& files() const { return files_; }  // what was written, after run()

 private:
  explicit DumpSession(const DumpOptions& options) : options_(options) {}
  Status open();
  Status choose_stages();
  std::string why_missing(Stage stage) const;  // empty: it is there
  Status resolve_up_to_the_frame();
  Status resolve_next();
  Status collect_history();
  Status collect_targets();
  Status collect_output();
  Status write_exr_files();
  Status write_pictures();
  Result<std::vector<float>> accumulated() const;
  bool wants(Stage stage) const;
  bool is_display_referred() const;
  std::string path_of(const std::string& ending) const;

  DumpOptions options_;
  std::unique_ptr<FrameSource> source_;
  std::optional<ResolveService> service_;
  Image linear_;  // the finished picture
  float exposure_ = 1;
  std::optional<DrawnFrame> current_;    // the last one that was resolved
  std::vector<std::uint8_t> presented_;  // RGBA8
  std::map<Stage, StagePlanes> planes_;
  std::vector<std::string> files_;
};

}  // namespace quincunx::scenes
