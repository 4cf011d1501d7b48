// SPDX-License-Identifier: MIT
// A device that fails, or is late: while a PretendFault lives, a call of OpenCL from this executable returns an error
// instead of being made. Calls that release, and those that ask what a device is, never fail.
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

// While it lives, the device is late: copies that do not block, from host memory into buffers, are made when the host
// waits for anything, or when this object is asked about them.
class PretendLateCopies {
 public:
  PretendLateCopies();
  ~PretendLateCopies();  // all are made
  PretendLateCopies(const PretendLateCopies&) = delete;
  PretendLateCopies& operator=(const PretendLateCopies&) = delete;

  int count() const;  // returns the copies so far
  // Makes what is left: whether each copied what the memory held when it was asked for.
  bool copied_what_was_given() const;
};

// The host waits for the device.
void let_copies_through();

// Returns the error for the call that asks; CL_SUCCESS: the call is made.
cl_int injected_fault();

}  // namespace quincunx::gl::testing
