// SPDX-License-Identifier: MIT
// Memory that a device may still read or write, because it does not even answer whether it is done.
#pragma once

#include <list>
#include <mutex>
#include <utility>

namespace quincunx {

// Keeps it, whole and where it is, until the process ends. Thread-safe.
template <typename Owner>
void never_free(Owner owner) {
  static std::mutex mutex;
  static auto* const kept = new std::list<Owner>;  // never destroyed: the device may outlive static objects
  const std::lock_guard lock(mutex);
  kept->push_back(std::move(owner));
}

}  // namespace quincunx
