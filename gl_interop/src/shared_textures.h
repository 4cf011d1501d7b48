// SPDX-License-Identifier: MIT
// SharedTextures: GL textures that OpenCL knows as images, and which side owns them.
#pragma once

#include <epoxy/gl.h>

#include <vector>

#include "cl_handle.h"
#include "quincunx/device.h"

namespace quincunx::gl {

// A set of textures that changes sides together. GL owns them first. Where OpenCL still owns them at the end,
// the destructor gives them back. All functions throw InteropError.
class SharedTextures {
 public:
  explicit SharedTextures(const Device& device);
  ~SharedTextures();
  SharedTextures(SharedTextures&& other) noexcept;
  SharedTextures& operator=(SharedTextures&&) = delete;
  SharedTextures(const SharedTextures&) = delete;
  SharedTextures& operator=(const SharedTextures&) = delete;

  // The image of a complete GL_TEXTURE_2D, which must outlive this object. `format` is what OpenCL must see
  // in it.
  cl_mem add(GLuint texture, PixelFormat format, cl_mem_flags flags);

  // Enqueues the change to OpenCL, after what GL was told to do so far.
  void acquire();
  // Enqueues the change to GL, after what OpenCL was told to do so far.
  void release();
  // Before GL touches the textures again: waits for release() where the driver does not order the two itself.
  void wait_for_release();

  bool acquired() const { return acquired_; }

 private:
  Device device_;
  bool driver_synchronises_;  // cl_khr_gl_event
  std::vector<ClMem> images_;
  std::vector<cl_mem> raw_;
  ClEvent released_;
  bool acquired_ = false;
};

bool has_cl_extension(cl_device_id device, const char* name);

// Moves a 16x16 texture of `format` both ways and compares byte for byte. Empty when that worked, else one
// clause that says what did not.
std::string probe_sharing(const Device& device, PixelFormat format);

}  // namespace quincunx::gl
