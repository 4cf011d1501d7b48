// SPDX-License-Identifier: MIT
#include "gl_sharing.h"

#include <CL/cl_gl.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <string>

#include "caller_texture.h"
#include "fence.h"
#include "frame_layout.h"
#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"
#include "state_scope.h"

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
  const bool is_float =
      format == PixelFormat::kR32F || format == PixelFormat::kRG32F || format == PixelFormat::kRGBA32F;
  const std::size_t channel = is_float ? 4 : 2;
  for (std::size_t top = channel - 1; !is_byte && top < texels.size(); top += channel) {
    texels[top] = static_cast<std::uint8_t>((texels[top] & 0x80u) | 0x3cu);
  }
  return texels;
}

bool has_cl_extension(cl_device_id device, const char* name) {
  std::size_t bytes = 0;
  if (clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, 0, nullptr, &bytes) != CL_SUCCESS || bytes == 0)
    return false;
  std::string all(bytes, ' ');
  if (clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, bytes, all.data(), nullptr) != CL_SUCCESS) return false;
  all.back() = ' ';  // was the final zero
  return (" " + all).find(fmt::format(" {} ", name)) != std::string::npos;
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

// Moves a 16x16 texture of `format` both ways and compares byte for byte. Empty when that worked, else one
// clause that says what did not.
std::string probe_sharing(const Device& device, PixelFormat format) {
  const ErrorScope callers;
  const PackScope packs;
  const UnpackScope unpacks;
  try {
    probe(device, format);
  } catch (const std::exception& error) {
    return fmt::format("sharing a {} texture was tried and {}", name_of(format), error.what());
  }
  return {};
}

// Copies the top left `extent` bit for bit. `callers`: the one of the two that is the caller's, whose filter may ask
// for levels that it has not; a texture cannot be copied while it is incomplete.
void copy_texels(GLuint from, GLuint to, Extent extent, GLuint callers, const TextureFacts& facts) {
  const bool incomplete = facts.largest_level > 0;
  if (incomplete) glTextureParameteri(callers, GL_TEXTURE_MAX_LEVEL, 0);
  glCopyImageSubData(from, GL_TEXTURE_2D, 0, 0, 0, 0, to, GL_TEXTURE_2D, 0, 0, 0, 0, extent.width,
                     extent.height, 1);
  if (incomplete) glTextureParameteri(callers, GL_TEXTURE_MAX_LEVEL, facts.largest_level);
}

// Returns what clCreateContext was told: zero where `name` is not among it.
cl_context_properties context_property(cl_context context, cl_context_properties name) {
  std::size_t bytes = 0;
  if (clGetContextInfo(context, CL_CONTEXT_PROPERTIES, 0, nullptr, &bytes) != CL_SUCCESS) return 0;
  std::vector<cl_context_properties> all(bytes / sizeof(cl_context_properties));
  if (all.empty() ||
      clGetContextInfo(context, CL_CONTEXT_PROPERTIES, bytes, all.data(), nullptr) != CL_SUCCESS) {
    return 0;
  }
  for (std::size_t i = 0; i + 1 < all.size() && all[i] != 0; i += 2) {
    if (all[i] == name) return all[i + 1];
  }
  return 0;
}

// Returns nothing when the device shares with the context, else one clause that says why not.
std::string find_obstacle(const Context& context, const Device& device, const BridgeSettings& settings) {
  if (context.info().api != Api::kGl45) return "sharing is made for desktop OpenGL, and this is OpenGL ES";
  const std::string& name = device.info().name;
  const auto picture =
      static_cast<std::uint64_t>(settings.output_extent.area()) * bytes_per_pixel(settings.picture);
  if (picture > std::numeric_limits<GLsizei>::max())
    return fmt::format("the picture has {} bytes, and OpenGL hands out {} at most", picture,
                       std::numeric_limits<GLsizei>::max());
  if (!device.info().gl_sharing) return fmt::format("'{}' does not offer cl_khr_gl_sharing", name);
  const auto wanted = reinterpret_cast<cl_context_properties>(context.context());
  if (context_property(device.context(), CL_GL_CONTEXT_KHR) != wanted) {
    return fmt::format("the OpenCL context of '{}' was not made for this OpenGL context", name);
  }
  std::set<PixelFormat> formats = {settings.picture};
  for (const Plane& plane : planes_of(settings))
    formats.insert(plane.format);
  for (const PixelFormat format : formats) {
    if (std::string failure = probe_sharing(device, format); !failure.empty()) {
      return fmt::format("on '{}' {}", name, failure);
    }
  }
  return {};
}

}  // namespace

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

Result<std::unique_ptr<Bridge>> GlSharing::create(const Context& context, const Device& device,
                                                  const BridgeSettings& settings) {
  if (std::string obstacle = find_obstacle(context, device, settings); !obstacle.empty()) {
    return Status::unsupported(std::move(obstacle));
  }
  std::string reason = fmt::format("'{}' shares textures with '{}', as a probe of every format has shown",
                                   device.info().name, context.info().renderer);
  try {
    return std::unique_ptr<Bridge>(new GlSharing(device, settings, std::move(reason)));
  } catch (const std::exception& error) {
    return Status::device(
        fmt::format("sharing textures with '{}' failed: {}", device.info().name, error.what()));
  }
}

GlSharing::GlSharing(const Device& device, const BridgeSettings& settings, std::string reason)
    : Bridge(settings, std::move(reason)),
      device_(device),
      planes_(planes_of(settings)),
      ring_(settings.slots, settings.target_extent),
      presented_(Texture::create()),
      output_(device),
      pixels_(static_cast<std::size_t>(settings.output_extent.area()) * bytes_per_pixel(settings.picture)) {
  if (settings.depth) depth_copy_ = DepthCopy::create();
  slots_.reserve(static_cast<std::size_t>(settings.slots));
  for (int i = 0; i < settings.slots; ++i)
    slots_.push_back(make_slot());

  texture_storage(presented_.get(), 1, gl_format(settings.picture).internal, settings.output_extent);
  texture_parameter(presented_.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST});
  output_image_ = output_.add(presented_.get(), settings.picture, CL_MEM_READ_WRITE);
  output_view_ = {.memory = output_image_,
                  .storage = Storage::kImage,
                  .format = settings.picture,
                  .extent = settings.output_extent};
  if (settings.picture == PixelFormat::kRGBA8) return;
  cl_int code = CL_SUCCESS;
  linear_ =
      ClMem::adopt(clCreateBuffer(device_.context(), CL_MEM_READ_WRITE, pixels_.size(), nullptr, &code));
  check_cl(code, "clCreateBuffer for the linear picture");
  output_view_.memory = linear_.get();
  output_view_.storage = Storage::kBuffer;
}

GlSharing::~GlSharing() {
  // Neither side may still be at work on textures that go now.
  if (const cl_int code = clFinish(device_.queue()); code != CL_SUCCESS) log_release_failure(code);
  glFinish();
}

// Whether OpenCL is given a copy of the plane, of its own format and the largest viewport's size.
bool GlSharing::is_copied(const Plane& plane) const {
  return settings_.imports || plane.kind == PlaneKind::kDepth;
}

GlSharing::Slot GlSharing::make_slot() {
  Slot slot = {.targets = {}, .own = {}, .shared = SharedTextures(device_), .views = {}};
  FrameTextures targets;
  if (!settings_.imports) {
    auto made = RenderTargets::create(target_needs(settings_));
    if (!made.ok()) throw InteropError(made.error());
    targets = textures_of(slot.targets.emplace(std::move(made).value()));
  }
  for (const Plane& plane : planes_) {
    Texture& own = slot.own.emplace_back();
    if (is_copied(plane)) {
      own = Texture::create();
      texture_storage(own.get(), 1, gl_format(plane.format).internal, settings_.target_extent);
    } else if (plane.format == PixelFormat::kRGBA8) {
      // OpenCL 1.2 has no name for an encoded texture: it is given the codes. A view needs a name without a texture.
      GLuint name = 0;
      glGenTextures(1, &name);
      own = Texture::adopt(name);
      glTextureView(name, GL_TEXTURE_2D, targets.colour, GL_RGBA8, 0, 1, 0, 1);
    }
    if (own) texture_parameter(own.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST});
    const GLuint texture = own ? own.get() : texture_of(targets, plane.kind);
    view_of(slot.views, plane.kind) = {.memory = slot.shared.add(texture, plane.format, CL_MEM_READ_ONLY),
                                       .storage = Storage::kImage,
                                       .format = plane.format,
                                       .extent = settings_.target_extent};
  }
  return slot;
}

Bridge::Memory GlSharing::memory() const {
  Memory memory;
  for (const Slot& slot : slots_) {
    if (slot.targets) memory.gl_bytes += slot.targets->bytes();
    for (const Plane& plane : planes_) {
      if (!is_copied(plane)) continue;
      memory.gl_bytes +=
          static_cast<std::uint64_t>(settings_.target_extent.area()) * bytes_per_pixel(plane.format);
    }
  }
  return memory;
}

Result<const RenderTargets*> GlSharing::begin_draw(int slot, Extent render) {
  if (Status status = check_owner("begin_draw", false); !status.ok()) return status;
  if (Status status = ring_.begin_draw(slot, render); !status.ok()) return status;
  if (Status status = take_back("begin_draw", slot); !status.ok()) return status;
  return &*slot_at(slot).targets;
}

Status GlSharing::take_back(const char* call, int slot) {
  try {
    slot_at(slot).shared.release();  // nothing to do where acquire() of a later slot has done it
    slot_at(slot).shared.wait_for_release();
    return {};
  } catch (const std::exception& error) {
    return Status::device(fmt::format("{}({}) on '{}': {}", call, slot, device_.info().name, error.what()));
  }
}

void GlSharing::copy_planes(const Slot& slot, const FrameTextures& from, Extent render) {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (!is_copied(planes_[i])) continue;
    const PlaneKind kind = planes_[i].kind;
    const GLuint texture = texture_of(from, kind);
    if (kind == PlaneKind::kDepth && has_depth_format(texture)) {
      depth_copy_.copy(texture, slot.own[i].get(), render, before());
    } else {
      copy_texels(texture, slot.own[i].get(), render, texture, textures_->facts(kind, texture));
    }
  }
  glFlush();
}

Status GlSharing::submit(int slot) {
  if (Status status = ring_.submit(slot); !status.ok()) return status;
  copy_planes(slot_at(slot), textures_of(*slot_at(slot).targets), ring_.render(slot));
  return {};
}

Status GlSharing::submit(int slot, const FrameTextures& textures, Extent render) {
  if (Status status = check_owner("submit", true); !status.ok()) return status;
  if (Status status = textures_->check(planes_, textures, render); !status.ok()) return status;
  if (Status status = ring_.begin_draw(slot, render); !status.ok()) return status;
  if (Status status = take_back("submit", slot); !status.ok()) return status;
  copy_planes(slot_at(slot), textures, render);
  return ring_.submit(slot);
}

Result<SharedFrame> GlSharing::acquire(int slot) {
  if (Status status = ring_.acquire(slot); !status.ok()) return status;
  const Stopwatch watch;
  try {
    // The readers of a retired slot are all enqueued by now, and this frame's are not yet: begin_draw() will
    // then wait for the last frame only.
    for (int other = 0; other < slots(); ++other) {
      if (ring_.is_retired(other)) slot_at(other).shared.release();
    }
    slot_at(slot).shared.acquire();
  } catch (const std::exception& error) {
    return Status::device(fmt::format("acquire({}) on '{}': {}", slot, device_.info().name, error.what()));
  }
  traffic_.bytes_in = 0;
  traffic_.acquire_ms = watch.milliseconds();
  return slot_at(slot).views;
}

Result<ImageView> GlSharing::begin_present() {
  try {
    output_.acquire();
    presenting_ = true;
    return output_view_;
  } catch (const std::exception& error) {
    return Status::device(fmt::format("begin_present() on '{}': {}", device_.info().name, error.what()));
  }
}

void GlSharing::copy_linear() const {
  const std::array<std::size_t, 3> origin = {0, 0, 0};
  const std::array<std::size_t, 3> region = {static_cast<std::size_t>(settings_.output_extent.width),
                                             static_cast<std::size_t>(settings_.output_extent.height), 1};
  check_cl(clEnqueueCopyBufferToImage(device_.queue(), linear_.get(), output_image_, 0, origin.data(),
                                      region.data(), 0, nullptr, nullptr),
           "clEnqueueCopyBufferToImage");
}

Status GlSharing::present(GLuint into) {
  if (Status status = check_present(presenting_, into); !status.ok()) return status;
  const Stopwatch watch;
  try {
    if (linear_) copy_linear();
    output_.release();
    output_.wait_for_release();
    if (into != 0)
      copy_texels(presented_.get(), into, settings_.output_extent, into, textures_->picture_facts(into));
  } catch (const std::exception& error) {
    return Status::device(fmt::format("present() on '{}': {}", device_.info().name, error.what()));
  }
  presenting_ = false;
  pixels_are_current_ = false;
  traffic_.bytes_out = 0;
  traffic_.present_ms = watch.milliseconds();
  return {};
}

const std::uint8_t* GlSharing::presented_pixels() {
  if (!pixels_are_current_ && !presenting_) {
    const PackScope restore(before());
    const GlFormat names = gl_format(settings_.picture);
    glGetTextureImage(presented_.get(), 0, names.format, names.type, static_cast<GLsizei>(pixels_.size()),
                      pixels_.data());
    pixels_are_current_ = true;
  }
  return pixels_.data();
}

}  // namespace quincunx::gl
