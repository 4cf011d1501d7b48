// SPDX-License-Identifier: MIT
// record_frames(): writes an engine's frames into a folder, from which quincunx-resolve makes the same pictures again,
// bit for bit: a bug report, a test case.
//
//   auto recording = quincunx::record_frames(service, "seen", {.frames = 60});
//   ... service.dispatch(...) as ever, until recording->done() ...
//   $ quincunx-resolve seen --out "again/again.%04d.exr"
//
// The folder then has sequence.json, with all settings, and EXR files of the exchange format (docs/inputs.md): one a
// frame, and one of each thing of another size: particles, a focus and its mask, a picture to fade from. Each is of its
// viewport, top row first, with the values that were given, which conventions in the settings explain.
#pragma once

#include <memory>
#include <string>

#include "quincunx/advanced/export.h"
#include "quincunx/resolve_service.h"
#include "quincunx/status.h"

namespace quincunx {

struct RecordOptions {
  int frames = 60;         // to record; at least 1
  bool overwrite = false;  // a recording that is in the folder is removed first; else it is an error
};

// A recording under way. It ends with its last frame, with the first error, or with this object. Move-only; used from
// the thread that calls dispatch().
class QUINCUNX_API Recording {
 public:
  ~Recording();
  Recording(Recording&& other) noexcept;
  Recording& operator=(Recording&& other) noexcept;

  int frames() const;            // whole frames in the folder
  bool done() const;             // the last frame is written
  const Status& status() const;  // the error that ended it early; the files of the frames before are whole

 private:
  friend QUINCUNX_API Result<Recording> record_frames(ResolveService& service, const std::string& folder,
                                                      const RecordOptions& options);
  struct QUINCUNX_HIDDEN State;
  explicit Recording(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

// Records the frames of dispatch() from the next one on, which begins without history, as after a cut; replaces another
// observer of the service. Each dispatch() then waits for its inputs, reads those back that the plan reads, and
// writes them; its pictures stay the same. So the events that it waits for (FrameSync) must come without further calls
// of its thread. Errors: kInvalidArgument, kIoFailure where the folder cannot be written.
QUINCUNX_API Result<Recording> record_frames(ResolveService& service, const std::string& folder,
                                             const RecordOptions& options = {});

}  // namespace quincunx
