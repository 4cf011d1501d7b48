// SPDX-License-Identifier: MIT
// Move-only owners of OpenCL objects, and the check that turns an error code into an exception. Exceptions
// stay inside this library: Bridge's functions return them as Status.
#pragma once

#include <CL/cl.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "quincunx/status.h"

namespace quincunx::gl {

class InteropError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws InteropError "clEnqueueMapBuffer failed: CL_MAP_FAILURE (-12)" unless `code` is CL_SUCCESS.
void check_cl(cl_int code, const char* call);

void check_status(const Status& status);  // throws InteropError of its message unless it is ok

void log_release_failure(cl_int code);

// Owns one reference. `Release` is called once; its failure is logged.
template <typename T, cl_int (*Release)(T)>
class ClHandle {
 public:
  ClHandle() = default;
  static ClHandle adopt(T raw) {
    ClHandle handle;
    handle.raw_ = raw;
    return handle;
  }

  ~ClHandle() { reset(); }
  ClHandle(ClHandle&& other) noexcept : raw_(std::exchange(other.raw_, nullptr)) {}
  ClHandle& operator=(ClHandle&& other) noexcept {
    if (this != &other) {
      reset();
      raw_ = std::exchange(other.raw_, nullptr);
    }
    return *this;
  }
  ClHandle(const ClHandle&) = delete;
  ClHandle& operator=(const ClHandle&) = delete;

  T get() const { return raw_; }
  explicit operator bool() const { return raw_ != nullptr; }
  void reset() {
    if (raw_ == nullptr) return;
    if (const cl_int code = Release(std::exchange(raw_, nullptr)); code != CL_SUCCESS)
      log_release_failure(code);
  }

 private:
  T raw_ = nullptr;
};

using ClMem = ClHandle<cl_mem, clReleaseMemObject>;
using ClEvent = ClHandle<cl_event, clReleaseEvent>;

// Blocks until the command of `event` is done, then drops the event. Nothing to do for an empty one.
void wait_and_reset(ClEvent& event);

}  // namespace quincunx::gl
