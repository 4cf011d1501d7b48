// SPDX-License-Identifier: MIT
// The frame of every function of the C interface: what it makes, what is wrong, and no exception that gets out.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include "quincunx/device.h"
#include "quincunx/quincunx.h"
#include "quincunx/status.h"

struct quincunx_device {
  quincunx::Device device;
  std::string profile;
};

namespace quincunx::c {

// Keeps the message for this thread, and returns the code for the caller.
quincunx_status report(const Status& status);

// Does so within a catch.
quincunx_status report_exception() noexcept;

// Runs what gives a Status, and lets no exception out.
template <typename Call>
quincunx_status guarded(const Call& call) noexcept {
  try {
    return report(call());
  } catch (...) {
    return report_exception();
  }
}

inline Status null(const char* name) {
  return Status::invalid(std::string(name) + " is NULL; it must point to one");
}

// A pointer that must not be NULL, with the name of its parameter.
struct Needed {
  const char* name;
  const void* pointer;
};

// The same, if none of those is NULL.
template <typename Call>
quincunx_status guarded(std::initializer_list<Needed> all, const Call& call) noexcept {
  return guarded([&]() -> Status {
    for (const Needed& needed : all)
      if (needed.pointer == nullptr) return null(needed.name);
    return call();
  });
}

template <typename Object>
using Made = Result<std::unique_ptr<Object>>;

// Hands out the object of a *_create: NULL unless `make` gives one.
template <typename Object, typename Make>
quincunx_status create(const char* name, Object** to, const Make& make) noexcept {
  if (to != nullptr) *to = nullptr;
  return guarded([&]() -> Status {
    if (to == nullptr) return null(name);
    auto made = make();
    if (!made.ok()) return made.status();
    *to = std::move(made).value().release();
    return {};
  });
}

}  // namespace quincunx::c
