// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_histories.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace quincunx::tools {
namespace {

// Not /tmp, which may be memory itself.
std::string folder_of_temporary_files() {
  const char* const named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/var/tmp";
}

Status refused(std::uint64_t bytes) {
  const std::string reason = std::strerror(errno);
  return Status::io(
      fmt::format("folder '{}' takes no temporary file of {:.1f} MB: {}; say a larger --memory, or name "
                  "another in TMPDIR",
                  folder_of_temporary_files(), static_cast<double>(bytes) / 1e6, reason));
}

std::array<std::vector<std::byte>*, 4> parts_of(KeptHistory& history) {
  return {&history.texels, &history.alpha, &history.velocity, &history.depth};
}

std::FILE* open_temporary_file() {
  std::string path = folder_of_temporary_files() + "/quincunx-XXXXXX";
  const int descriptor = ::mkstemp(path.data());
  if (descriptor < 0) return nullptr;
  ::unlink(path.c_str());
  return ::fdopen(descriptor, "w+b");
}

}  // namespace

Status SequenceHistories::put(std::size_t key, KeptHistory history) {
  Kept kept;
  const auto parts = parts_of(history);
  for (std::size_t i = 0; i < parts.size(); ++i)
    kept.sizes[i] = parts[i]->size();
  const std::uint64_t bytes = std::accumulate(kept.sizes.begin(), kept.sizes.end(), std::uint64_t{0});
  if (held_ + bytes <= limit_) {
    kept.history = std::move(history);
    held_ += bytes;
  } else {
    kept.history.exposure = history.exposure;
    kept.file.reset(open_temporary_file());
    if (!kept.file) return refused(bytes);
    for (const std::vector<std::byte>* part : parts) {
      const bool written = part->empty() || std::fwrite(part->data(), part->size(), 1, kept.file.get()) == 1;
      if (!written) return refused(bytes);
    }
    if (std::fflush(kept.file.get()) != 0) return refused(bytes);
    if (!std::exchange(has_spilled_, true)) {
      spdlog::info("histories of more than {:.1f} MB (--memory) are put into files in '{}'",
                   static_cast<double>(limit_) / 1e6, folder_of_temporary_files());
    }
  }
  kept_.emplace(key, std::move(kept));
  return {};
}

Result<KeptHistory> SequenceHistories::take(std::size_t key) {
  auto node = kept_.extract(key);
  if (node.empty()) return Status::invalid(fmt::format("no history is kept under the key {}", key));
  Kept& kept = node.mapped();
  if (!kept.file) {
    held_ -= std::accumulate(kept.sizes.begin(), kept.sizes.end(), std::uint64_t{0});
    return std::move(kept.history);
  }
  std::rewind(kept.file.get());
  const auto parts = parts_of(kept.history);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i]->resize(kept.sizes[i]);
    if (kept.sizes[i] > 0 && std::fread(parts[i]->data(), kept.sizes[i], 1, kept.file.get()) != 1) {
      return Status::io(fmt::format("a temporary file in '{}' cannot be read: {}",
                                    folder_of_temporary_files(), std::strerror(errno)));
    }
  }
  return std::move(kept.history);
}

}  // namespace quincunx::tools
