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
#include "programs/dump_stages.h"
#include "quincunx/resolve_service.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

// The command line's wishes.
struct DumpOptions : PictureOptions {
  std::int64_t frame = 0;     // index in the run
  std::vector<Stage> stages;  // empty: all that the plan has
  std::string out;            // folder of the stages
  bool png = true;
  bool exr = true;
  int truth = 0;             // N: N x N samples a pixel; 0: no truth, 8 where a stage needs it
  std::int64_t warm_up = 1;  // frames drawn and resolved before `frame`, for its history

  std::string sequence;          // pattern: the whole run in the exchange format instead
  bool device_depth = false;     // device depth in the files of --sequence
  bool dilate_velocity = false;  // the same
};

// A whole run as a sequence in the exchange format (docs/inputs.md), with truth on request.
struct SequenceDump {
  std::string pattern;            // pattern of the frames' files: "seq/courtyard.%04d.exr"
  bool linear_depth = true;       // else Z is the reversed device depth as it was drawn: nothing is rounded
  bool dilates_velocity = false;  // dilate_velocity()
  int truth = 0;                  // N: N x N samples a pixel into truth.%04d.exr beside the frames; 0: none
};

// Draws every frame of the options and writes it with all its targets, and sequence.json with what is
// constant. Errors: of any part, as it words them.
Status dump_sequence(const PictureOptions& options, const SequenceDump& dump);

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
  Result<std::vector<float>> download(const ImageView& image, Extent extent) const;
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
