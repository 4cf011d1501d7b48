// SPDX-License-Identifier: MIT
// Front files: where measured ErrorFronts lie, by device, driver and scene, and which one serves.
//
// They lie in cache_folder(), beside the compiled kernels, as JSON text: front-KEY.json. All functions may be called
// from any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "quincunx/advanced/export.h"
#include "quincunx/control/error_front.h"

namespace quincunx {

// Device, driver and scene that a front was measured on, and for. front_key() in quincunx/device.h makes it.
struct FrontKey {
  std::string device;  // FrontSource::device: "platform name" of the OpenCL device
  std::string driver;
  std::string scene;  // empty: any
};

// Returns where the front of a key lies; nothing where there is no cache folder. The file may not exist yet.
QUINCUNX_API std::optional<std::filesystem::path> front_path(const FrontKey& key);

struct FoundFront {
  ErrorFront front;
  std::string explanation;  // one clause: which it is, where it lies, and why one that is there was not taken
};

// The device's front for this scene; else the device's for any scene; else the one that is built in. A file that
// cannot be read, or is of something else than its name says, is passed over.
QUINCUNX_API FoundFront find_front(const FrontKey& key);

}  // namespace quincunx
