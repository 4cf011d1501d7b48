// SPDX-License-Identifier: MIT
// Plays a driver that imports opaque fds, which no driver of a processor does: cl_khr_external_memory_opaque_fd and
// cl_khr_external_semaphore_opaque_fd. Memory is imported by Vulkan (lavapipe) and used where it is mapped; an eventfd
// stands for a semaphore. The protocol is checked: memory that is taken twice, or given back without having been taken,
// is CL_INVALID_OPERATION.
#pragma once

#include <CL/cl.h>

#include <cstddef>

namespace quincunx::gl::testing {

class PretendImports {
 public:
  enum class Flaw {
    kNone,
    kWrongBytes,   // OpenCL sees other bytes than were written
    kRefuses,      // it takes no fd
    kWrongUuid,    // it is another device than OpenGL's
    kNoFunctions,  // the extension is listed, and its functions are missing
  };
  // The GL context must be current on this thread: the device is its own.
  explicit PretendImports(Flaw flaw = Flaw::kNone);
  ~PretendImports();
  PretendImports(const PretendImports&) = delete;
  PretendImports& operator=(const PretendImports&) = delete;

  int dma_bufs() const;  // memory that was imported as one
  int acquired() const;  // memory objects that OpenCL owns now
};

// The extensions that it lists, each after a space; nothing where no driver is played.
const char* extensions_of_imports();

// Answers clGetDeviceInfo() where it is about imports; false: it is not.
bool tells_of_imports(cl_device_info name, std::size_t room, void* value, std::size_t* bytes_ret,
                      cl_int* code);

}  // namespace quincunx::gl::testing
