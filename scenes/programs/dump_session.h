// SPDX-License-Identifier: MIT
// DumpSession: draws and resolves one frame, with the frames that its history needs, and writes its stages.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "programs/dump_options.h"
#include "programs/frame_source.h"
#include "quincunx/resolve_service.h"

namespace quincunx::scenes {

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
  Image resolved_;
  Image blurred_;    // empty without motion blur
  Image displayed_;  // empty where the output is not dynamic
  float exposure_ = 1;
  std::optional<DrawnFrame> current_;    // the last one that was resolved
  std::vector<std::uint8_t> presented_;  // RGBA8
  std::map<Stage, StagePlanes> planes_;
  std::vector<std::string> files_;
};

}  // namespace quincunx::scenes
