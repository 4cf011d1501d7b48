// SPDX-License-Identifier: MIT
// What the tests of a failing device share. They let each call of OpenCL that may fail do so in turn.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "cl_faults.h"
#include "quincunx/extent.h"
#include "quincunx/status.h"

namespace quincunx::gl::testing {

constexpr Extent kOutput = {24, 16};
constexpr Extent kRender = {17, 11};
constexpr int kMoreThanAnyCalls = 2000;

// One sentence: what was called, on which device, what it said.
inline void expect_told(const Status& status, const char* code) {
  EXPECT_EQ(status.code(), StatusCode::kDeviceFailure) << status.message();
  EXPECT_NE(status.message().find(code), std::string::npos) << status.message();
  EXPECT_EQ(status.message().find('\n'), std::string::npos) << status.message();
}

// A cache of its own: what a failing device answers must not stay in the user's.
class DeviceFault : public ::testing::Test {
 protected:
  DeviceFault()
      : folder_(std::filesystem::temp_directory_path() /
                ("quincunx-fault-test-" + std::to_string(getpid()))) {
    if (const char* before = std::getenv("QUINCUNX_CACHE_DIR")) before_ = before;
    setenv("QUINCUNX_CACHE_DIR", folder_.c_str(), 1);
  }
  ~DeviceFault() override {
    clear_cache();
    if (before_) {
      setenv("QUINCUNX_CACHE_DIR", before_->c_str(), 1);
    } else {
      unsetenv("QUINCUNX_CACHE_DIR");
    }
  }

  bool cache_is_empty() const { return !std::filesystem::exists(folder_); }

  void clear_cache() const {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

 private:
  std::filesystem::path folder_;
  std::optional<std::string> before_;
};

}  // namespace quincunx::gl::testing
