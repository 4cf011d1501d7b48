// SPDX-License-Identifier: MIT
#include "pixel_buffer.h"

#include <fmt/format.h>

#include <array>
#include <mutex>
#include <new>
#include <utility>

#include "quincunx/advanced/log.h"
#include "quincunx_gl/capabilities.h"
#include "state_scope.h"

namespace quincunx::gl {
std::size_t PixelMemory::whole_pages(std::size_t bytes) {
  return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
}

PixelMemory::PixelMemory(const Device& device, std::size_t bytes, Transfer transfer, const Exporter* exporter)
    : transfer_(transfer), size_(whole_pages(bytes)) {
  if (transfer_ == Transfer::kShared) {
    shared_ = exporter->allocate(device, size_);
    gl_start_ = static_cast<std::intptr_t>(shared_->start);
    bytes_ = shared_->bytes;
    return;
  }
  std::uint8_t* const memory = capabilities().persistent_map ? map_buffer() : client_memory();
  bytes_ = memory + bytes_to_page(memory);
  gl_start_ = buffer_ ? bytes_ - memory : reinterpret_cast<std::intptr_t>(bytes_);

  cl_int code = CL_SUCCESS;
  const bool in_place = transfer_ == Transfer::kZeroCopy;
  memory_ = ClMem::adopt(
      clCreateBuffer(device.context(), CL_MEM_READ_WRITE | (in_place ? CL_MEM_USE_HOST_PTR : cl_mem_flags{0}),
                     size_, in_place ? bytes_ : nullptr, &code));
  check_cl(code, "clCreateBuffer for a pixel buffer");
}

ClMem PixelMemory::sub_buffer(std::size_t offset, std::size_t bytes) const {
  const cl_buffer_region region = {offset, bytes};
  cl_int code = CL_SUCCESS;
  ClMem part = ClMem::adopt(clCreateSubBuffer(cl_buffer(), 0, CL_BUFFER_CREATE_TYPE_REGION, &region, &code));
  check_cl(code, "clCreateSubBuffer for a part of a pixel buffer");
  return part;
}

// A list without allocations, as little else may work when this is called.
void PixelMemory::never_free(const std::shared_ptr<PixelMemory>& memory) noexcept {
  static std::mutex mutex;
  alignas(std::shared_ptr<PixelMemory>) static std::byte place[sizeof(std::shared_ptr<PixelMemory>)];
  static auto* const newest = new (place) std::shared_ptr<PixelMemory>;  // never destroyed
  const std::lock_guard lock(mutex);
  if (std::exchange(memory->is_kept_, true)) return;
  memory->kept_before_ = std::exchange(*newest, memory);
}

PixelBuffer::PixelBuffer(const Device& device, std::size_t bytes, Transfer transfer, const Exporter* exporter)
    : PixelBuffer(device, std::make_shared<PixelMemory>(device, bytes, transfer, exporter), 0,
                  PixelMemory::whole_pages(bytes)) {
  if (exporter != nullptr) order_ = exporter->order(device);
}

PixelBuffer::PixelBuffer(const Device& device, std::shared_ptr<PixelMemory> memory, std::size_t offset,
                         std::size_t bytes)
    : device_(device), memory_(std::move(memory)), offset_(offset), size_(bytes) {
  if (size_ < memory_->size()) part_ = memory_->sub_buffer(offset_, size_);
  if (transfer() == Transfer::kZeroCopy) {
    host_owns_ = false;
    try {
      take_back(Access::kOverwrite);
      wait();
    } catch (...) {
      settle();
      throw;
    }
  }
}

std::uint8_t* PixelMemory::map_buffer() {
  constexpr GLbitfield kAccess =
      GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto allocated = static_cast<GLsizeiptr>(size_ + kPageBytes);
  buffer_ = Buffer::create();
  const BindingScope bound = BindingScope::buffer(buffer_.get());
  glBufferStorage(GL_COPY_WRITE_BUFFER, allocated, nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
  void* const mapped = glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, allocated, kAccess);
  if (mapped == nullptr) {
    throw InteropError(fmt::format("OpenGL could not map a pixel buffer of {} bytes", allocated));
  }
  return static_cast<std::uint8_t*>(mapped);
}

std::uint8_t* PixelMemory::client_memory() {
  client_.resize(size_ + kPageBytes);
  return client_.data();
}

PixelBuffer::~PixelBuffer() {
  if (memory_) settle();  // else moved from
}

// Waits until OpenCL is done with the memory that GL is about to free.
void PixelBuffer::settle() noexcept {
  const auto unmap = [this] {
    return transfer() == Transfer::kZeroCopy && host_owns_
               ? clEnqueueUnmapMemObject(device_.queue(), cl_buffer(), own_bytes(), 0, nullptr, nullptr)
               : CL_SUCCESS;
  };
  const bool unmapped = unmap() == CL_SUCCESS;
  Status done = device_.finish();
  if (!unmapped && done.ok()) {  // once more, with an empty queue: what stays mapped, the driver never frees
    if (const cl_int code = unmap(); code != CL_SUCCESS) log_release_failure(code);
    done = device_.finish();
  }
  if (done.ok()) return;
  log_line(LogLevel::kWarning, fmt::format("interop: {}", done.message()));
  PixelMemory::never_free(memory_);  // a device that does not answer may still be at work
}

void PixelBuffer::begin_gl() {
  if (order_) order_->gl_waits(gl_buffer());
}

void PixelBuffer::end_gl() {
  if (order_) order_->gl_done(gl_buffer());
}

void PixelBuffer::take_back(Access access) {
  if (transfer() == Transfer::kShared) {
    cl_event released = nullptr;
    check_status(memory_->shared().release(order_ ? nullptr : &released));
    pending_ = ClEvent::adopt(released);
    host_owns_ = true;
    if (order_) order_->cl_done();
    return;
  }
  const cl_map_flags flags = access == Access::kRead ? CL_MAP_READ : CL_MAP_WRITE_INVALIDATE_REGION;
  cl_int code = CL_SUCCESS;
  cl_event event = nullptr;
  const void* mapped =
      clEnqueueMapBuffer(device_.queue(), cl_buffer(), CL_FALSE, flags, 0, size_, 0, nullptr, &event, &code);
  check_cl(code, "clEnqueueMapBuffer");
  pending_ = ClEvent::adopt(event);
  host_owns_ = true;
  if (mapped != own_bytes())
    throw InteropError("clEnqueueMapBuffer did not give back the host memory it was made of");
}

void PixelBuffer::hand_over() {
  if (!host_owns_) return;
  if (transfer() == Transfer::kShared) {
    if (order_) order_->cl_waits();
    check_status(memory_->shared().acquire());
    host_owns_ = false;
    return;
  }
  wait();
  check_cl(clEnqueueUnmapMemObject(device_.queue(), cl_buffer(), own_bytes(), 0, nullptr, nullptr),
           "clEnqueueUnmapMemObject");
  host_owns_ = false;
}

void PixelBuffer::enqueue_write(const ImageView& view, Extent extent) {
  // Rusticl of Mesa 25.0 takes rows for tight where there are as many of them as a row has bytes (docs/testing.md): the
  // last one is then written by itself.
  const auto height = static_cast<std::size_t>(extent.height);
  const std::size_t last = height > 1 && height == view.pitch ? 1 : 0;
  enqueue_write_rows(view, extent.width, 0, height - last);
  if (last != 0) enqueue_write_rows(view, extent.width, height - 1, 1);
}

void PixelBuffer::enqueue_write_rows(const ImageView& view, int width, std::size_t first, std::size_t rows) {
  const std::array<std::size_t, 3> origin = {view.offset % view.pitch, view.offset / view.pitch + first, 0};
  const std::array<std::size_t, 3> region = {width * bytes_per_pixel(view.format), rows, 1};
  cl_event event = nullptr;
  check_cl(
      clEnqueueWriteBufferRect(device_.queue(), cl_buffer(), CL_FALSE, origin.data(), origin.data(),
                               region.data(), view.pitch, 0, view.pitch, 0, own_bytes(), 0, nullptr, &event),
      "clEnqueueWriteBufferRect");
  pending_ = ClEvent::adopt(event);
}

void PixelBuffer::enqueue_read() {
  cl_event event = nullptr;
  check_cl(
      clEnqueueReadBuffer(device_.queue(), cl_buffer(), CL_FALSE, 0, size_, own_bytes(), 0, nullptr, &event),
      "clEnqueueReadBuffer");
  pending_ = ClEvent::adopt(event);
}

}  // namespace quincunx::gl
