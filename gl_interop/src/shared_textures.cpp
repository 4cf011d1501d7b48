// SPDX-License-Identifier: MIT
#include "shared_textures.h"

#include <CL/cl_gl.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>

#include "plane.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {
namespace {

constexpr int kProbeSide = 16;

// Every byte takes many values; no half or float of it is NaN or infinite, which a driver may rewrite.
std::vector<std::uint8_t> probe_texels(PixelFormat format, std::uint32_t seed) {
  std::vector<std::uint8_t> texels(kProbeSide * kProbeSide * bytes_per_pixel(format));
  std::uint32_t state = seed;
  for (std::uint8_t& byte : texels) {
    state = state * 1664525u + 1013904223u;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  const bool is_byte = format == PixelFormat::kR8 || format == PixelFormat::kRGBA8;
  // Normal numbers only: 0x3c in the top byte of a half or float, whose sign stays free.
  const std::size_t channel = format == PixelFormat::kR32F ? 4 : 2;
  for (std::size_t top = channel - 1; !is_byte && top < texels.size(); top += channel) {
    texels[top] = static_cast<std::uint8_t>((texels[top] & 0x80u) | 0x3cu);
  }
  return texels;
}

void check_gl(const char* what) {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw InteropError(fmt::format("{} failed with OpenGL error 0x{:04x}", what, error));
  }
}

void probe(const Device& device, PixelFormat format) {
  const GlFormat names = gl_format(format);
  const Texture texture = Texture::create();
  glTextureStorage2D(texture.get(), 1, names.internal, kProbeSide, kProbeSide);
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  const std::vector<std::uint8_t> from_gl = probe_texels(format, 1);
  const std::vector<std::uint8_t> from_cl = probe_texels(format, 2);
  std::vector<std::uint8_t> seen(from_gl.size());
  const std::array<std::size_t, 3> origin = {0, 0, 0};
  const std::array<std::size_t, 3> region = {kProbeSide, kProbeSide, 1};
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.get(), 0, 0, 0, kProbeSide, kProbeSide, names.format, names.type,
                      from_gl.data());
  {
    SharedTextures shared(device);
    const cl_mem image = shared.add(texture.get(), format, CL_MEM_READ_WRITE);
    shared.acquire();
    check_cl(clEnqueueReadImage(device.queue(), image, CL_TRUE, origin.data(), region.data(), 0, 0,
                                seen.data(), 0, nullptr, nullptr),
             "clEnqueueReadImage");
    if (seen != from_gl) throw InteropError("OpenCL read other bytes than OpenGL wrote");
    check_cl(clEnqueueWriteImage(device.queue(), image, CL_TRUE, origin.data(), region.data(), 0, 0,
                                 from_cl.data(), 0, nullptr, nullptr),
             "clEnqueueWriteImage");
    shared.release();
    shared.wait_for_release();
  }
  glGetTextureImage(texture.get(), 0, names.format, names.type, static_cast<GLsizei>(seen.size()),
                    seen.data());
  check_gl("reading the probe's texture");
  if (seen != from_cl) throw InteropError("OpenGL read other bytes than OpenCL wrote");
}

}  // namespace

bool has_cl_extension(cl_device_id device, const char* name) {
  std::size_t bytes = 0;
  if (clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, 0, nullptr, &bytes) != CL_SUCCESS || bytes == 0)
    return false;
  std::string all(bytes, ' ');
  if (clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, bytes, all.data(), nullptr) != CL_SUCCESS) return false;
  all.back() = ' ';  // was the final zero
  return (" " + all).find(fmt::format(" {} ", name)) != std::string::npos;
}

SharedTextures::SharedTextures(const Device& device)
    : device_(device), driver_synchronises_(has_cl_extension(device.id(), "cl_khr_gl_event")) {}

SharedTextures::SharedTextures(SharedTextures&& other) noexcept
    : device_(other.device_),
      driver_synchronises_(other.driver_synchronises_),
      images_(std::move(other.images_)),
      raw_(std::move(other.raw_)),
      released_(std::move(other.released_)),
      acquired_(std::exchange(other.acquired_, false)) {}

SharedTextures::~SharedTextures() {
  if (!acquired_) return;
  cl_int code = clEnqueueReleaseGLObjects(device_.queue(), static_cast<cl_uint>(raw_.size()), raw_.data(), 0,
                                          nullptr, nullptr);
  if (code != CL_SUCCESS) log_release_failure(code);
  code = clFinish(device_.queue());
  if (code != CL_SUCCESS) log_release_failure(code);
}

cl_mem SharedTextures::add(GLuint texture, PixelFormat format, cl_mem_flags flags) {
  cl_int code = CL_SUCCESS;
  ClMem image =
      ClMem::adopt(clCreateFromGLTexture(device_.context(), flags, GL_TEXTURE_2D, 0, texture, &code));
  check_cl(code, "clCreateFromGLTexture");
  cl_image_format seen = {};
  check_cl(clGetImageInfo(image.get(), CL_IMAGE_FORMAT, sizeof(seen), &seen, nullptr), "clGetImageInfo");
  const cl_image_format wanted = cl_format(format);
  if (seen.image_channel_order != wanted.image_channel_order ||
      seen.image_channel_data_type != wanted.image_channel_data_type) {
    throw InteropError(
        fmt::format("OpenCL sees channel order 0x{:x} and type 0x{:x} where 0x{:x} and 0x{:x} are right",
                    seen.image_channel_order, seen.image_channel_data_type, wanted.image_channel_order,
                    wanted.image_channel_data_type));
  }
  raw_.push_back(image.get());
  images_.push_back(std::move(image));
  return raw_.back();
}

void SharedTextures::acquire() {
  if (acquired_) return;
  if (!driver_synchronises_) glFinish();
  check_cl(clEnqueueAcquireGLObjects(device_.queue(), static_cast<cl_uint>(raw_.size()), raw_.data(), 0,
                                     nullptr, nullptr),
           "clEnqueueAcquireGLObjects");
  acquired_ = true;
}

void SharedTextures::release() {
  if (!acquired_) return;
  cl_event event = nullptr;
  check_cl(clEnqueueReleaseGLObjects(device_.queue(), static_cast<cl_uint>(raw_.size()), raw_.data(), 0,
                                     nullptr, &event),
           "clEnqueueReleaseGLObjects");
  acquired_ = false;
  released_ = ClEvent::adopt(event);
  check_cl(clFlush(device_.queue()), "clFlush");
}

void SharedTextures::wait_for_release() {
  if (driver_synchronises_) {
    released_.reset();
  } else {
    wait_and_reset(released_);
  }
}

std::string probe_sharing(const Device& device, PixelFormat format) {
  while (glGetError() != GL_NO_ERROR) {
  }
  std::string failure;
  try {
    probe(device, format);
  } catch (const std::exception& error) {
    failure = fmt::format("sharing a {} texture was tried and {}", name_of(format), error.what());
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  return failure;
}

}  // namespace quincunx::gl
