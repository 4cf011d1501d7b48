// SPDX-License-Identifier: MIT
// SlotRing: who owns each slot of a bridge, and whether a call comes in its turn. Bookkeeping only.
#pragma once

#include <vector>

#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx::gl {

class SlotRing {
 public:
  SlotRing(int slots, Extent target) : target_(target), slots_(static_cast<std::size_t>(slots)) {}

  // Each checks the call of the same name on the bridge and, when it is right, takes note of it. Errors:
  // kInvalidArgument.
  Status begin_draw(int slot, Extent render);
  Status submit(int slot);
  Status acquire(int slot);

  Extent render(int slot) const { return at(slot).render; }

  // True where OpenCL holds the slot but no later dispatch reads it: it is neither the one acquired last nor
  // the one before, which is history.
  bool is_retired(int slot) const;

 private:
  enum class Owner { kNobody, kDrawing, kSubmitted, kOpenCl };
  struct Slot {
    Owner owner = Owner::kNobody;
    Extent render;
  };

  Status check_slot(const char* call, int slot) const;
  Slot& at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  const Slot& at(int slot) const { return slots_[static_cast<std::size_t>(slot)]; }

  Extent target_;
  std::vector<Slot> slots_;
  int newest_ = -1;
  int previous_ = -1;
};

}  // namespace quincunx::gl
