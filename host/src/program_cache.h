// SPDX-License-Identifier: MIT
// Builds a kernel variant, or loads its binary from disk.
//
// Binaries lie in cache_folder(), keyed by source with all its includes, options, device and driver; an
// unusable or damaged entry is rebuilt and replaced, a folder that cannot be written only costs time. Without
// a folder every kernel is compiled each time. A driver that keeps its programs itself is handed the source each time.
#pragma once

#include <stdexcept>
#include <string>

#include "device_impl.h"
#include "quincunx/cache_folder.h"

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

// Counts since the process started, for tests and reports. Thread-safe.
struct CacheCounts {
  int compiled = 0;  // built from source
  int loaded = 0;    // taken from disk
};
CacheCounts cache_counts();

}  // namespace quincunx
