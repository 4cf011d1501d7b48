// SPDX-License-Identifier: MIT
// SequenceHistories: the histories of frames that wait to be merged and shown. Up to a limit they are in memory; beyond
// it each is a temporary file without a name, which is gone with the process, however that ends.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>

#include "quincunx/status.h"
#include "src/passes/two_way.h"

namespace quincunx::tools {

inline constexpr std::uint64_t kDefaultHistoryBytes = 4'000'000'000;

// Not thread-safe.
class SequenceHistories {
 public:
  explicit SequenceHistories(std::uint64_t limit) : limit_(limit) {}

  // Keeps a history under a key that has none. Errors: kIoFailure, naming the folder of temporary files.
  Status put(std::size_t key, KeptHistory history);

  // Gives back what was put under a key, byte by byte, once. Errors: as of put(); kInvalidArgument where nothing was.
  Result<KeptHistory> take(std::size_t key);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  struct Kept {
    KeptHistory history;  // empty where there is a file
    std::array<std::size_t, 4> sizes = {};
    std::unique_ptr<std::FILE, Close> file;
  };

  std::uint64_t limit_;
  std::uint64_t held_ = 0;  // bytes in memory
  bool has_spilled_ = false;
  std::map<std::size_t, Kept> kept_;
};

}  // namespace quincunx::tools
