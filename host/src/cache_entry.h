// SPDX-License-Identifier: MIT
// Files of cache_folder(): what is worth keeping between runs, by device and driver. Safe to use from any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device_impl.h"
#include "quincunx/cache_folder.h"

namespace quincunx {

// 32 hex digits that stand for the device, its driver, `source` and `options`.
std::string cache_key(const Device::Impl& device, const std::string& source, const std::string& options);

// Nothing where there is no such entry, or it is torn or damaged.
std::optional<std::vector<unsigned char>> read_cache_entry(const std::filesystem::path& path);

// Whole or not at all: whether it was written. Makes the folder where there is none.
bool write_whole_file(const std::filesystem::path& path, std::string_view bytes);

// The same as an entry; a folder that cannot be written is no error.
void write_cache_entry(const std::filesystem::path& path, const std::vector<unsigned char>& bytes);

}  // namespace quincunx
