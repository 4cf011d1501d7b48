// SPDX-License-Identifier: MIT
// OwnCache: as long as it lives, cache_folder() is another one, also of programs that the test runs.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace quincunx::testing {

class OwnCache {
 public:
  // An empty `folder`: there is none.
  explicit OwnCache(const std::string& folder) {
    if (const char* before = std::getenv(kName)) before_ = before;
    use(folder);
  }
  ~OwnCache() {
    if (before_) {
      setenv(kName, before_->c_str(), 1);
    } else {
      unsetenv(kName);
    }
  }
  OwnCache(const OwnCache&) = delete;
  OwnCache& operator=(const OwnCache&) = delete;

  void use(const std::string& folder) { setenv(kName, folder.c_str(), 1); }

 private:
  static constexpr const char* kName = "QUINCUNX_CACHE_DIR";
  std::optional<std::string> before_;
};

}  // namespace quincunx::testing
