// SPDX-License-Identifier: MIT
#include "table_ring.h"

namespace quincunx {

TableRing::TableRing(const Device::Impl& device, std::size_t bytes) {
  for (Slot& slot : slots_) {
    slot.bytes.resize(bytes);
    slot.buffer = cl::Buffer(device.context, CL_MEM_READ_ONLY, bytes);
  }
}

TableRing::~TableRing() {
  for (Slot& slot : slots_) {
    if (slot.written() != nullptr) clWaitForEvents(1, &slot.written());
  }
}

TableRing::Slot& TableRing::find(const TableKey& key) {
  Slot* oldest = &slots_[0];
  for (Slot& slot : slots_) {
    if (slot.holds(key)) return slot;
    if (slot.last_use < oldest->last_use) oldest = &slot;
  }
  return *oldest;
}

// Only a caller eight viewports ahead of the device ever waits here.
void TableRing::wait_for(Slot& slot) {
  if (slot.written() != nullptr && slot.written.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() > CL_COMPLETE) {
    slot.written.wait();
  }
}

void TableRing::write(const cl::CommandQueue& queue, Slot& slot, std::size_t bytes) {
  queue.enqueueWriteBuffer(slot.buffer, CL_FALSE, 0, bytes, slot.bytes.data(), nullptr, &slot.written);
}

}  // namespace quincunx
