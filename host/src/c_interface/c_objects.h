// SPDX-License-Identifier: MIT
// What the opaque types of quincunx.h hold, and how its functions report failure.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "c_interface/host_images.h"
#include "quincunx/quincunx.h"
#include "quincunx/resolve_service.h"

struct quincunx_device {
  quincunx::Device device;
};

struct quincunx_plan {
  quincunx::ResolvePlan plan;
  std::string text;
};

struct quincunx_service {
  quincunx::c::HostImages host;  // before the service, which waits for its frames when it ends
  quincunx::ResolveService service;
};

namespace quincunx::c {

// Keeps the message for quincunx_last_error(), of this thread; the code for the caller.
quincunx_status report(const Status& status);
quincunx_status report(quincunx_status code, const char* message) noexcept;
quincunx_status report_exception() noexcept;  // within a catch
const char* last_error() noexcept;

// Runs what gives a Status, and lets no exception out.
template <typename Call>
quincunx_status guarded(const Call& call) noexcept {
  try {
    return report(call());
  } catch (...) {
    return report_exception();
  }
}

inline Status null(const char* what) {
  return Status::invalid(std::string(what) + " is NULL; it must point to one");
}

}  // namespace quincunx::c
