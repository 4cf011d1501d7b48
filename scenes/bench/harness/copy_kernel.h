// SPDX-License-Identifier: MIT
// CopyKernel: the copy of a picture of floats, the unit in which quincunx-bench and the kernel benchmark give costs.
#pragma once

#include <cstdint>
#include <memory>

#include "quincunx/device.h"

namespace quincunx::bench {

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
