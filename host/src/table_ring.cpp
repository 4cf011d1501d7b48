// SPDX-License-Identifier: MIT
#include "table_ring.h"

#include "never_freed.h"

namespace quincunx {
namespace {

// Waits for it; false where nobody can tell whether it is done.
bool has_ended(cl_event event) {
  if (clWaitForEvents(1, &event) == CL_SUCCESS) return true;
  cl_int state = CL_QUEUED;
  const cl_int code =
      clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof(state), &state, nullptr);
  return code == CL_SUCCESS && state <= CL_COMPLETE;  // negative: it failed
}

}  // namespace

TableRing::TableRing(const Device::Impl& device, std::size_t bytes) {
  for (Slot& slot : slots_) {
    slot.bytes.resize(bytes);
    slot.buffer = cl::Buffer(device.context, CL_MEM_READ_ONLY, bytes);
  }
}

TableRing::~TableRing() {
  for (Slot& slot : slots_) {
    if (slot.written() != nullptr && !has_ended(slot.written())) never_free(std::move(slot.bytes));
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
  try {
    queue.enqueueWriteBuffer(slot.buffer, CL_FALSE, 0, bytes, slot.bytes.data(), nullptr, &slot.written);
  } catch (const cl::Error&) {
    slot.last_use = 0;  // it holds no table now
    throw;
  }
}

}  // namespace quincunx
