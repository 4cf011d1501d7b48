// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "quincunx_record/record.h"
#include "tools/program/atomic_file.h"
#include "tools/record/recorded_frame.h"
#include "tools/record/recorded_settings.h"

namespace quincunx {
namespace {

// Prepares a folder that may have a recording. Frames go first: what is left when this is broken off is none.
Status clear_folder(const std::string& folder, bool overwrite) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) return {};
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name == tools::kSettingsFile || tools::is_frame_file(name)) files.push_back(entry->path());
  }
  if (error) return Status::io(fmt::format("'{}' cannot be listed: {}", folder, error.message()));
  if (!files.empty() && !overwrite) {
    return Status::io(
        fmt::format("'{}' holds '{}', of another recording; give another folder, or set overwrite", folder,
                    files.front().filename().string()));
  }
  for (const std::filesystem::path& file : files) {
    if (!std::filesystem::remove(file, error) && error)
      return Status::io(fmt::format("'{}' cannot be removed: {}", file.string(), error.message()));
  }
  return {};
}

}  // namespace

struct Recording::State {
  // Returns whether another frame is wanted.
  bool record(const FrameInputs& inputs, const FocusInputs* focus) {
    if (ended) return false;
    auto frame = tools::download(device, plan, inputs, focus);
    status = frame.ok() ? tools::write_frame(folder, written, plan, frame.value()) : frame.status();
    if (status.ok()) ++written;
    ended = !status.ok() || written == frames;
    return !ended;
  }

  Device device;
  ResolvePlan plan;
  std::string folder;
  int frames = 0;
  int written = 0;
  bool ended = false;
  Status status = {};
};

Recording::Recording(std::shared_ptr<State> state) : state_(std::move(state)) {}
Recording::Recording(Recording&& other) noexcept = default;

Recording& Recording::operator=(Recording&& other) noexcept {
  Recording incoming(std::move(other));
  state_.swap(incoming.state_);  // what this one recorded ends as `incoming`
  return *this;
}

Recording::~Recording() {
  if (state_) state_->ended = true;
}

int Recording::frames() const {
  return state_->written;
}
bool Recording::done() const {
  return state_->ended;
}
const Status& Recording::status() const {
  return state_->status;
}

Result<Recording> record_frames(ResolveService& service, const std::string& folder,
                                const RecordOptions& options) {
  if (options.frames < 1)
    return Status::invalid(fmt::format("frames is {}; at least 1 must be recorded", options.frames));
  if (folder.empty()) return Status::invalid("folder is empty; name one to record into");
  if (Status status = clear_folder(folder, options.overwrite); !status.ok()) return status;
  const Device& device = service.device();
  const ResolvePlan& plan = service.plan();
  const tools::RecordedSettings recorded = {.device = device.info().platform + " " + device.info().name,
                                            .needs = plan.needs,
                                            .settings = plan.settings};
  const std::string path = (std::filesystem::path(folder) / tools::kSettingsFile).string();
  if (Status status = tools::write_text(path, tools::to_json(recorded)); !status.ok()) return status;
  auto state = std::make_shared<Recording::State>(
      Recording::State{.device = device, .plan = plan, .folder = folder, .frames = options.frames});
  service.observe(
      [state](const FrameInputs& inputs, const FocusInputs* focus) { return state->record(inputs, focus); });
  return Recording(std::move(state));
}

}  // namespace quincunx
