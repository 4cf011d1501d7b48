// SPDX-License-Identifier: MIT
// PixelMemory, PixelBuffer: memory that GL transfers pixels with and OpenCL reads or writes, and a part of it that
// changes owner as a whole.
//
// kShared: memory that both have imported (external_memory.h). Else a GL pixel buffer, mapped persistently and
// coherently; where GL cannot do that, client memory, and GL is waited for. Where the OpenCL device shares the host's
// memory (kZeroCopy), that memory itself is an OpenCL buffer (CL_MEM_USE_HOST_PTR) that changes owner by map and unmap;
// elsewhere (kExplicit) OpenCL has a buffer of its own and rectangles are copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cl_handle.h"
#include "external_memory.h"
#include "quincunx/device.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {

enum class Transfer { kZeroCopy, kExplicit, kShared };

class PixelMemory {
 public:
  // At least `bytes`; `exporter` for kShared. Throws InteropError.
  PixelMemory(const Device& device, std::size_t bytes, Transfer transfer, const Exporter* exporter = nullptr);
  PixelMemory(const PixelMemory&) = delete;
  PixelMemory& operator=(const PixelMemory&) = delete;

  static std::size_t whole_pages(std::size_t bytes);
  // Keeps memory until the process ends. Thread-safe.
  static void never_free(const std::shared_ptr<PixelMemory>& memory) noexcept;

  GLuint gl_buffer() const { return shared_ ? shared_->gl.get() : buffer_.get(); }  // 0: client memory
  void* gl_pointer(std::size_t offset) const {
    return reinterpret_cast<void*>(gl_start_ + static_cast<std::intptr_t>(offset));
  }
  std::uint8_t* bytes() const { return bytes_; }  // null: memory of the device's
  std::size_t size() const { return size_; }
  cl_mem cl_buffer() const { return shared_ ? shared_->cl->memory() : memory_.get(); }
  SharedMemory& shared() { return *shared_->cl; }
  Transfer transfer() const { return transfer_; }

  // An OpenCL buffer of a part, which begins on a page.
  ClMem sub_buffer(std::size_t offset, std::size_t bytes) const;

 private:
  std::uint8_t* map_buffer();
  std::uint8_t* client_memory();

  Transfer transfer_;
  std::size_t size_;
  std::optional<ExternalBuffer> shared_;
  Buffer buffer_;
  std::vector<std::uint8_t> client_;  // where there is no buffer
  std::intptr_t gl_start_ = 0;        // byte 0: its offset in the buffer, or its address
  std::uint8_t* bytes_ = nullptr;
  ClMem memory_;
  bool is_kept_ = false;  // by never_free()
  std::shared_ptr<PixelMemory> kept_before_;
};

class PixelBuffer {
 public:
  // Memory of its own, or `bytes` of shared memory from `offset`, both whole pages. The host (and GL) own it first.
  // Throws InteropError.
  PixelBuffer(const Device& device, std::size_t bytes, Transfer transfer, const Exporter* exporter = nullptr);
  PixelBuffer(const Device& device, std::shared_ptr<PixelMemory> memory, std::size_t offset,
              std::size_t bytes);
  ~PixelBuffer();
  PixelBuffer(PixelBuffer&&) noexcept = default;
  PixelBuffer& operator=(PixelBuffer&&) = delete;
  PixelBuffer(const PixelBuffer&) = delete;
  PixelBuffer& operator=(const PixelBuffer&) = delete;

  GLuint gl_buffer() const { return memory_->gl_buffer(); }  // 0: client memory
  // Returns the pointer that GL takes for byte `offset` while gl_buffer() is bound.
  void* gl_pointer(std::size_t offset) const { return memory_->gl_pointer(offset_ + offset); }
  const std::uint8_t* bytes() const { return own_bytes(); }  // null: see gl_buffer() and offset()
  std::size_t offset() const { return reinterpret_cast<std::size_t>(gl_pointer(0)); }
  std::size_t size() const { return size_; }
  cl_mem cl_buffer() const { return part_ ? part_.get() : memory_->cl_buffer(); }
  Transfer transfer() const { return memory_->transfer(); }
  bool host_owns() const { return host_owns_; }

  // An OpenCL buffer of a part, which begins on a page. It changes owner with this one.
  ClMem sub_buffer(std::size_t offset, std::size_t bytes) const {
    return memory_->sub_buffer(offset_ + offset, bytes);
  }

  // Enclose GL's commands on the memory: where the device keeps the order, they come after take_back() and before what
  // follows hand_over().
  void begin_gl();
  void end_gl();
  bool device_orders() const { return order_.has_value(); }

  // kZeroCopy, kShared: enqueues the return to the host and GL. Work enqueued before it may still use the memory;
  // wait() waits for it, unless the device keeps the order. The old content is kept only for kRead.
  enum class Access { kRead, kOverwrite };
  void take_back(Access access);
  void wait() { wait_and_reset(pending_); }

  // kZeroCopy, kShared: hands the memory to the commands that are enqueued after this.
  void hand_over();

  // kExplicit: copies without waiting; wait() waits for the last of them. `view` is a part of this buffer.
  void enqueue_write(const ImageView& view, Extent extent);
  void enqueue_read();

 private:
  void enqueue_write_rows(const ImageView& view, int width, std::size_t first, std::size_t rows);
  std::uint8_t* own_bytes() const {
    return memory_->bytes() != nullptr ? memory_->bytes() + offset_ : nullptr;
  }
  void settle() noexcept;

  Device device_;
  std::shared_ptr<PixelMemory> memory_;
  std::size_t offset_;
  std::size_t size_;
  ClMem part_;  // empty where this is all of the memory
  std::optional<DeviceOrder> order_;
  ClEvent pending_;
  bool host_owns_ = true;
};

}  // namespace quincunx::gl
