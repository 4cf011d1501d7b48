// SPDX-License-Identifier: MIT
#include "slot_ring.h"

#include <fmt/format.h>

namespace quincunx::gl {

Status SlotRing::check_slot(const char* call, int slot) const {
  const int count = static_cast<int>(slots_.size());
  if (slot >= 0 && slot < count) return {};
  return Status::invalid(fmt::format("{}: slot is {}; it must be 0 to {}", call, slot, count - 1));
}

Status SlotRing::begin_draw(int slot, Extent render) {
  if (Status status = check_slot("begin_draw", slot); !status.ok()) return status;
  if (render.width < 1 || render.height < 1 || render.width > target_.width ||
      render.height > target_.height) {
    return Status::invalid(
        fmt::format("begin_draw: render extent is {}x{}; it must lie within 1x1 and the target's "
                    "{}x{}",
                    render.width, render.height, target_.width, target_.height));
  }
  at(slot) = {Owner::kDrawing, render};
  return {};
}

Status SlotRing::submit(int slot) {
  if (Status status = check_slot("submit", slot); !status.ok()) return status;
  if (at(slot).owner != Owner::kDrawing) {
    return Status::invalid(
        fmt::format("submit: slot {} is not being drawn; call begin_draw({}, ...) first", slot, slot));
  }
  at(slot).owner = Owner::kSubmitted;
  return {};
}

Status SlotRing::acquire(int slot) {
  if (Status status = check_slot("acquire", slot); !status.ok()) return status;
  if (at(slot).owner != Owner::kSubmitted) {
    return Status::invalid(
        fmt::format("acquire: slot {} holds no submitted frame; call submit({}) first", slot, slot));
  }
  at(slot).owner = Owner::kOpenCl;
  if (newest_ != slot) previous_ = newest_;
  newest_ = slot;
  return {};
}

bool SlotRing::is_retired(int slot) const {
  return at(slot).owner == Owner::kOpenCl && slot != newest_ && slot != previous_;
}

}  // namespace quincunx::gl
