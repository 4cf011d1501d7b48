// SPDX-License-Identifier: MIT
// Front files: the files of measured ErrorFronts, by device, driver and scene, and the choice among them.
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

// Returns the file's path, which may not exist yet; nothing without a cache folder.
QUINCUNX_API std::optional<std::filesystem::path> front_path(const FrontKey& key);

struct FoundFront {
  ErrorFront front;
  std::string explanation;  // one clause: its kind, its path, and why another file was not taken
};

// Returns the device's front for this scene; else the device's for any scene; else the built-in one. A file that cannot
// be read, or belongs to something else than its name says, is passed over.
QUINCUNX_API FoundFront find_front(const FrontKey& key);

}  // namespace quincunx
