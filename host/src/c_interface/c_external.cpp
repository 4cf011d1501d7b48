// SPDX-License-Identifier: MIT
// Memory and semaphores of other APIs, in C.
#include <algorithm>
#include <memory>

#include "c_interface/calls.h"
#include "c_interface/sized_struct.h"
#include "quincunx/advanced/external.h"
#include "quincunx/quincunx.h"

struct quincunx_memory {
  quincunx::SharedMemory memory;
};

struct quincunx_semaphore {  // read_sync() takes a pointer to one for a pointer to its only member
  quincunx::Semaphore semaphore;
};

using quincunx::Status;
using quincunx::c::create;
using quincunx::c::guarded;
using quincunx::c::Made;
using quincunx::c::null;

void quincunx_device_uuid(const quincunx_device* device, uint8_t uuid[16]) {
  if (device == nullptr || uuid == nullptr) return;
  const quincunx::DeviceUuid& own = device->device.info().uuid;
  std::copy(own.begin(), own.end(), uuid);
}

quincunx_status quincunx_memory_import(const quincunx_device* device,
                                       const quincunx_external_memory* external, quincunx_memory** memory) {
  return create("memory", memory, [&]() -> Made<quincunx_memory> {
    if (device == nullptr) return null("device");
    quincunx_external_memory from = {};
    if (Status status = quincunx::c::read_sized(external, "external", from); !status.ok()) return status;
    quincunx::ExternalMemory to = {.fd = from.fd, .mapped = from.mapped, .bytes = from.bytes};
    quincunx::c::Reader read("external");
    read.value("handle", from.handle, quincunx::MemoryHandle::kMapped, to.handle);
    if (!read.status().ok()) return read.status();
    std::copy(std::begin(from.device), std::end(from.device), to.device.begin());
    auto made = device->device.import_memory(to);
    if (!made.ok()) return made.status();
    return std::make_unique<quincunx_memory>(quincunx_memory{std::move(made).value()});
  });
}

void quincunx_memory_destroy(quincunx_memory* memory) {
  delete memory;
}

void* quincunx_memory_object(const quincunx_memory* memory) {
  return memory != nullptr ? memory->memory.memory() : nullptr;
}

quincunx_status quincunx_memory_acquire(quincunx_memory* memory) {
  return guarded({{"memory", memory}}, [&] { return memory->memory.acquire(); });
}

quincunx_status quincunx_memory_release(quincunx_memory* memory, void** done) {
  if (done != nullptr) *done = nullptr;
  return guarded({{"memory", memory}}, [&]() -> Status {
    cl_event event = nullptr;
    Status status = memory->memory.release(done != nullptr ? &event : nullptr);
    if (done != nullptr) *done = event;
    return status;
  });
}

quincunx_status quincunx_semaphore_import(const quincunx_device* device, int32_t fd,
                                          quincunx_semaphore** semaphore) {
  return create("semaphore", semaphore, [&]() -> Made<quincunx_semaphore> {
    if (device == nullptr) return null("device");
    auto made = device->device.import_semaphore(fd);
    if (!made.ok()) return made.status();
    return std::make_unique<quincunx_semaphore>(quincunx_semaphore{std::move(made).value()});
  });
}

void quincunx_semaphore_destroy(quincunx_semaphore* semaphore) {
  delete semaphore;
}

quincunx_status quincunx_semaphore_wait(quincunx_semaphore* semaphore) {
  return guarded({{"semaphore", semaphore}}, [&] { return semaphore->semaphore.wait(); });
}

quincunx_status quincunx_semaphore_signal(quincunx_semaphore* semaphore) {
  return guarded({{"semaphore", semaphore}}, [&] { return semaphore->semaphore.signal(); });
}
