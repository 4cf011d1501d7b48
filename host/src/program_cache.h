// SPDX-License-Identifier: MIT
// Builds a kernel variant, or loads its binary from disk.
//
// Binaries lie in $QUINCUNX_CACHE_DIR, else $XDG_CACHE_HOME/quincunx, else ~/.cache/quincunx. They are keyed by
// the source with all its includes, the options, the device and the driver. An unusable or damaged entry is
// rebuilt and replaced; a folder that cannot be written only costs time. QUINCUNX_CACHE_DIR set to an empty
// string turns the cache off.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "device_impl.h"

namespace quincunx {

// "-cl-..." options that every kernel is built with.
extern const char* const kCommonBuildOptions;

// A kernel that does not compile. what() holds kernel, options and the compiler's log.
class BuildError : public std::runtime_error {
 public:
  BuildError(const std::string& kernel, const std::string& options, const std::string& log);
};

// The kernel `name` of the embedded source `name`.cl, built with `options` ("-D WEIGHT=1 -D ...") and the
// options common to all kernels. Throws cl::Error; a build failure throws BuildError.
cl::Kernel build_kernel(const Device::Impl& device, const std::string& name, const std::string& options);

// The whole source of kernel `name` with its includes expanded, each once: what build_kernel compiles. Throws
// std::out_of_range for a name that is not embedded.
std::string kernel_source(const std::string& name);

// The folder of everything that is worth keeping between runs; nothing where the user wants none.
std::optional<std::filesystem::path> cache_folder();

// Counts since the process started, for tests and reports. Thread-safe.
struct CacheCounts {
  int compiled = 0;  // built from source
  int loaded = 0;    // taken from disk
};
CacheCounts cache_counts();

}  // namespace quincunx
