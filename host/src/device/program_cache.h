// SPDX-License-Identifier: MIT
// Builds a kernel variant, or loads its binary from disk; and the files of cache_folder().
//
// Binaries lie in cache_folder(), keyed by source with all its includes, options, device and driver; an
// unusable or damaged entry is rebuilt and replaced, a folder that cannot be written only costs time. Without
// a folder every kernel is compiled by each process. A driver that keeps its programs itself is handed the source.
// Within a process each is built once for a device: services on it share the programs.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "device/device_impl.h"
#include "quincunx/advanced/cache_folder.h"

namespace quincunx {

// "-cl-..." options that every kernel is built with.
extern const char* const kCommonBuildOptions;

// A kernel that does not compile. what() holds kernel, options and the compiler's log.
class BuildError : public std::runtime_error {
 public:
  BuildError(const std::string& kernel, const std::string& options, const std::string& log);
};

// Builds or loads the kernel `name` of the embedded source `name`.cl, with `options` ("-D WEIGHT=1 -D ..."), the
// device's LANES and the options common to all kernels. The kernel object is the caller's own. Thread-safe. Throws
// cl::Error; a build failure throws BuildError.
cl::Kernel build_kernel(const Device::Impl& device, const std::string& name, const std::string& options);

// Returns the whole source of kernel `name` with its includes expanded, each once, as build_kernel compiles it. Throws
// std::out_of_range for a name that is not embedded.
std::string kernel_source(const std::string& name);

// Counts since the process started, for tests and reports; a program that the device has already is in neither.
// Thread-safe.
struct CacheCounts {
  int compiled = 0;  // built from source
  int loaded = 0;    // taken from disk
};
CacheCounts cache_counts();

// Entries of cache_folder() hold what is worth keeping between runs, by device and driver. Safe to use from any thread.

// Returns 32 hex digits that stand for the device, its driver, `source` and `options`.
std::string cache_key(const Device::Impl& device, const std::string& source, const std::string& options);

// Returns nothing where there is no such entry, or it is torn or damaged.
std::optional<std::vector<unsigned char>> read_cache_entry(const std::filesystem::path& path);

// Writes a file whole or not at all, and returns whether it was written. Makes the folder where there is none.
bool write_whole_file(const std::filesystem::path& path, std::string_view bytes);

// Writes the same as an entry; a folder that cannot be written is no error.
void write_cache_entry(const std::filesystem::path& path, const std::vector<unsigned char>& bytes);

}  // namespace quincunx
