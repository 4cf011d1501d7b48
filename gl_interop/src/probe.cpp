// SPDX-License-Identifier: MIT
#include "probe.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace quincunx::gl {
namespace {

// Waits for a command that may hang for ever.
void wait_for(const ClEvent& event, const char* peer) {
  constexpr std::chrono::milliseconds kLimit(2000);
  const auto end = std::chrono::steady_clock::now() + kLimit;
  for (;;) {
    cl_int state = CL_QUEUED;
    check_cl(clGetEventInfo(event.get(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof(state), &state, nullptr),
             "clGetEventInfo");
    if (state == CL_COMPLETE) return;
    if (state < 0) check_cl(state, "a command of the probe");
    if (std::chrono::steady_clock::now() > end) {
      throw InteropError(fmt::format("a semaphore that {} signalled did not reach OpenCL within {} ms", peer,
                                     kLimit.count()));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace

std::vector<std::uint8_t> probe_bytes(std::uint32_t seed) {
  std::vector<std::uint8_t> made(kProbeBytes);
  for (std::uint8_t& byte : made) {
    seed = seed * 1664525u + 1013904223u;
    byte = static_cast<std::uint8_t>(seed >> 24);
  }
  return made;
}

Device probe_device(const Device& device) {
  cl_int code = CL_SUCCESS;
  const cl_command_queue queue = clCreateCommandQueue(device.context(), device.id(), 0, &code);
  check_cl(code, "clCreateCommandQueue");
  auto borrowed = Device::borrow(device.context(), device.id(), queue);
  clReleaseCommandQueue(queue);
  check_status(borrowed.status());
  return std::move(borrowed).value();
}

void keep_for_ever(std::shared_ptr<const void> used) {
  static std::mutex mutex;
  static auto* const kept = new std::vector<std::shared_ptr<const void>>;
  const std::lock_guard lock(mutex);
  kept->push_back(std::move(used));
}

std::vector<std::uint8_t> read_probe(const Device& own, cl_mem memory, const char* peer) {
  const auto seen = std::make_shared<std::vector<std::uint8_t>>(kProbeBytes);
  cl_event event = nullptr;
  check_cl(
      clEnqueueReadBuffer(own.queue(), memory, CL_FALSE, 0, kProbeBytes, seen->data(), 0, nullptr, &event),
      "clEnqueueReadBuffer");
  const ClEvent read = ClEvent::adopt(event);
  try {
    check_cl(clFlush(own.queue()), "clFlush");
    wait_for(read, peer);
  } catch (...) {
    keep_for_ever(std::make_shared<Device>(own));
    keep_for_ever(seen);  // it may be written yet
    throw;
  }
  return std::move(*seen);
}

}  // namespace quincunx::gl
