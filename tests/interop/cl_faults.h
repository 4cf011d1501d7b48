// SPDX-License-Identifier: MIT
// A device that fails: while a PretendFault lives, a call of OpenCL from this executable returns an error instead of
// being made. Calls that release, and those that ask what a device is, never fail.
#pragma once

#include <CL/cl.h>

namespace quincunx::gl::testing {

class PretendFault {
 public:
  enum class Lasts { kOneCall, kForGood };
  // Call `at`, counted from 0 from now on, returns `code`; with kForGood so do all that follow.
  PretendFault(int at, cl_int code, Lasts lasts = Lasts::kOneCall);
  ~PretendFault();
  PretendFault(const PretendFault&) = delete;
  PretendFault& operator=(const PretendFault&) = delete;

  bool struck() const;  // whether a call has failed so far
};

// What the call that asks is to return; CL_SUCCESS: it is made.
cl_int injected_fault();

}  // namespace quincunx::gl::testing
