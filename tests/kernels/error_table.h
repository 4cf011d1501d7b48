// SPDX-License-Identifier: MIT
// The largest errors that the kernel tests observe, as a table for docs/lab/numerics.md.
//
// Rows follow from the tests' names: suite and parameters, without what has no part in the error (storage,
// the format of the inputs). With the environment variable QUINCUNX_ERROR_TABLE the table is written to that
// file at the end of the run.
#pragma once

#include "quincunx/image.h"

namespace quincunx::testing {

// One compared value of the running test: |result - reference|, what the test allows, and the largest tap
// that the value was made from. `stored`: the format of the result, whose last place is the unit of the
// table.
struct ObservedError {
  double error = 0;
  double bound = 0;
  double largest = 0;
  PixelFormat stored = PixelFormat::kRGBA32F;
};

void record_error(const ObservedError& observed);

}  // namespace quincunx::testing
