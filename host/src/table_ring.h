// SPDX-License-Identifier: MIT
// TableRing: tables on the device that follow from an output, a viewport and a jitter, made on the host when first
// asked for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "device_impl.h"
#include "quincunx/image.h"

namespace quincunx {

// What a table follows from.
struct TableKey {
  Extent output, render;
  Vec2 jitter;

  friend bool operator==(const TableKey&, const TableKey&) = default;
};

// A key that was used lately costs nothing. The table of a new one is filled into the slot that has been unused for
// longest, and written without blocking. There is no allocation after construction. Not thread-safe. Throws cl::Error.
class TableRing {
 public:
  TableRing(const Device::Impl& device, std::size_t bytes);
  ~TableRing();  // waits for writes that still read host memory
  TableRing(const TableRing&) = delete;
  TableRing& operator=(const TableRing&) = delete;

  // `fill` makes the table in host memory, aligned for any type, and gives the bytes of it that are in use.
  // Valid for kernels enqueued on the in-order `queue` before the eighth further call.
  template <typename Fill>
  const cl::Buffer& get(const cl::CommandQueue& queue, const TableKey& key, const Fill& fill) {
    Slot& slot = find(key);
    const bool known = slot.holds(key);
    slot.last_use = ++uses_;
    if (!known) {
      wait_for(slot);
      slot.key = key;
      write(queue, slot, fill(slot.bytes.data()));
    }
    return slot.buffer;
  }

 private:
  // Enough that a slot's host memory is long since written when its turn comes again.
  static constexpr int kSlots = 8;

  struct Slot {
    TableKey key;
    std::uint64_t last_use = 0;
    std::vector<std::byte> bytes;
    cl::Buffer buffer;
    cl::Event written;

    bool holds(const TableKey& of) const { return last_use != 0 && key == of; }
  };

  Slot& find(const TableKey& key);
  static void wait_for(Slot& slot);
  static void write(const cl::CommandQueue& queue, Slot& slot, std::size_t bytes);

  std::uint64_t uses_ = 0;
  std::array<Slot, kSlots> slots_;
};

}  // namespace quincunx
