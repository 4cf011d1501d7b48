// SPDX-License-Identifier: MIT
// PixelBuffer: one piece of host memory that GL transfers pixels with and OpenCL reads or writes.
//
// A GL pixel buffer, mapped persistently and coherently. Where the OpenCL device shares the host's memory
// (kZeroCopy), the mapped memory itself is an OpenCL buffer (CL_MEM_USE_HOST_PTR) that changes owner by
// map and unmap; elsewhere (kExplicit) OpenCL has a buffer of its own and rectangles are copied.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cl_handle.h"
#include "quincunx/device.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {

enum class Transfer { kZeroCopy, kExplicit };

class PixelBuffer {
 public:
  // `bytes` of memory; the host (and GL) own it first. Throws InteropError.
  PixelBuffer(const Device& device, std::size_t bytes, Transfer transfer);
  ~PixelBuffer();
  PixelBuffer(PixelBuffer&&) noexcept = default;
  PixelBuffer& operator=(PixelBuffer&&) = delete;
  PixelBuffer(const PixelBuffer&) = delete;
  PixelBuffer& operator=(const PixelBuffer&) = delete;

  GLuint gl_buffer() const { return buffer_.get(); }
  std::size_t gl_offset() const { return gl_offset_; }  // of byte 0 in gl_buffer()
  const std::uint8_t* bytes() const { return bytes_; }
  cl_mem cl_buffer() const { return memory_.get(); }
  Transfer transfer() const { return transfer_; }
  bool host_owns() const { return host_owns_; }

  // kZeroCopy: enqueues the return to the host. Work enqueued before it may still use the memory; wait()
  // waits for it. The old content is kept only for kRead.
  enum class Access { kRead, kOverwrite };
  void take_back(Access access);
  void wait() { wait_and_reset(pending_); }

  // kZeroCopy: hands the memory to the commands that are enqueued after this.
  void hand_over();

  // kExplicit: copies without waiting; wait() waits for the last of them.
  void enqueue_write(const ImageView& view, Extent extent);
  void enqueue_read();

 private:
  Device device_;
  Transfer transfer_;
  std::size_t size_;
  Buffer buffer_;
  std::size_t gl_offset_ = 0;
  std::uint8_t* bytes_ = nullptr;
  ClMem memory_;
  ClEvent pending_;
  bool host_owns_ = true;
};

}  // namespace quincunx::gl
