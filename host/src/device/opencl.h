// SPDX-License-Identifier: MIT
// The one place that configures CLHPP, and the edge where its exceptions become Status.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <cstddef>
#include <list>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "quincunx/status.h"

namespace quincunx {

// CLHPP's constructors and `=` from a raw handle take ownership silently; these two say which is meant.
template <typename Wrapper>
Wrapper adopt(typename Wrapper::cl_type handle) {
  return Wrapper(handle, false);
}
template <typename Wrapper>
Wrapper borrow(typename Wrapper::cl_type handle) {
  return Wrapper(handle, true);
}

const char* error_name(cl_int code);  // "CL_OUT_OF_RESOURCES"

// A Status on its way to the public call that returns it.
class StatusError : public std::runtime_error {
 public:
  explicit StatusError(const Status& status) : std::runtime_error(status.message()), status_(status) {}
  const Status& status() const { return status_; }

 private:
  Status status_;
};

// Returns the exception that is being handled as a Status: "clEnqueueNDRangeKernel(resolve_quincunx) on 'pthread-...'
// failed: CL_OUT_OF_RESOURCES (-5)". Every public call ends with it; called within a catch block only.
Status caught(const std::string& subject, const std::string& device_name);

// Keeps memory that a device may still read or write, because it does not even answer whether it is done: whole and
// where it is, until the process ends. Thread-safe.
template <typename Owner>
void never_free(Owner owner) noexcept {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  try {
    static auto* const kept = new std::list<Owner>;  // never destroyed: the device may outlive static objects
    kept->push_back(std::move(owner));
  } catch (const std::bad_alloc&) {
    alignas(Owner) std::byte place[sizeof(Owner)];
    new (place) Owner(std::move(owner));  // never destroyed either
  }
}

}  // namespace quincunx
