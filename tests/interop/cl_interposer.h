// SPDX-License-Identifier: MIT
// Stands between this executable and the OpenCL loader: counts what a steady frame must not do, and can play
// a driver that shares with OpenGL, which no driver on a machine without a GPU does.
//
// The stand-in is no simulation of a GPU: it moves texels through host memory when textures change sides.
// It does check the protocol. A texture that is taken twice, or given back without having been taken, is
// CL_INVALID_GL_OBJECT as the specification has it; an image holds junk while OpenGL owns the texture.
#pragma once

#include <CL/cl.h>

namespace quincunx::gl::testing {

struct ClCounts {
  int creations = 0;       // buffers, parts of them, and images
  int blocking_waits = 0;  // clFinish, and transfers and maps that block
  int acquires = 0;        // calls of clEnqueueAcquireGLObjects, and of its counterpart
  int releases = 0;
  int maps = 0;  // buffers mapped into the host's memory
};

ClCounts& cl_counts();

// While it lives, every device offers cl_khr_gl_sharing, and cl_khr_gl_event only if told so. The GL context must be
// current on this thread.
class PretendSharing {
 public:
  enum class Flaw { kNone, kWrongBytes, kWrongFormat, kNoContext };
  explicit PretendSharing(bool with_gl_event, Flaw flaw = Flaw::kNone);
  ~PretendSharing();
  PretendSharing(const PretendSharing&) = delete;
  PretendSharing& operator=(const PretendSharing&) = delete;
};

// While it lives, every device makes images on buffers (cl_khr_image2d_from_buffer), with rows at multiples of
// kImagePitchTexels. What such an image must be is checked; its texels are copied from the buffer when the buffer is
// unmapped or written.
class PretendImagesOnBuffers {
 public:
  PretendImagesOnBuffers();
  ~PretendImagesOnBuffers();
  PretendImagesOnBuffers(const PretendImagesOnBuffers&) = delete;
  PretendImagesOnBuffers& operator=(const PretendImagesOnBuffers&) = delete;
};

// While it lives, every device says that its memory is not the host's (CL_DEVICE_HOST_UNIFIED_MEMORY).
class PretendSeparateMemory {
 public:
  PretendSeparateMemory();
  ~PretendSeparateMemory();
  PretendSeparateMemory(const PretendSeparateMemory&) = delete;
  PretendSeparateMemory& operator=(const PretendSeparateMemory&) = delete;
};

// While it lives, a broken driver stands before the others: one platform more, the first, with one device.
class PretendBrokenDriver {
 public:
  enum class Flaw { kNoPlatforms, kNoDevices, kMuteDevice, kMuteButForItsKind };
  explicit PretendBrokenDriver(Flaw flaw);
  ~PretendBrokenDriver();
  PretendBrokenDriver(const PretendBrokenDriver&) = delete;
  PretendBrokenDriver& operator=(const PretendBrokenDriver&) = delete;
};

constexpr int kImagePitchTexels = 16;

int acquired_textures();  // how many OpenCL holds now

}  // namespace quincunx::gl::testing
