// SPDX-License-Identifier: MIT
// The clocks of benchmarks, and CopyKernel: the copy of a picture of floats, the unit in which quincunx-bench and the
// kernel benchmark give costs.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

#include "quincunx/device.h"

namespace quincunx::bench {

// What ends a measurement that cannot go on. The main function says why.
struct Failure : std::runtime_error {
  explicit Failure(const Status& why) : std::runtime_error(why.message()), status(why) {}
  Status status;
};

// Throw a Failure where there is no success.
inline void checked(const Status& status) {
  if (!status.ok()) throw Failure(status);
}
template <typename T>
T checked(Result<T> result) {
  checked(result.status());
  return std::move(result).value();
}

// Whether a benchmark may measure this device by its OpenCL events (see quincunx/advanced/pass_timer.h). Errors:
// kUnsupported, naming the device.
Status check_event_times(const Device& device);

// Processor time of this process so far, all threads, ms.
double processor_ms();

// A kernel of one float4 a work item, in groups of 64 of a row. One thread at a time. Move-only.
class CopyKernel {
 public:
  // Two pictures of `extent`, one of which is copied to the other. Errors: kDeviceFailure.
  static Result<CopyKernel> create(const Device& device, Extent extent);

  CopyKernel(CopyKernel&&) noexcept;
  CopyKernel& operator=(CopyKernel&&) noexcept;
  ~CopyKernel();

  std::uint64_t bytes() const;  // read and written

  // Once, to the end: milliseconds by its event. Errors: kDeviceFailure, also where the queue takes no times.
  Result<double> run();

 private:
  struct Impl;
  explicit CopyKernel(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx::bench
