// SPDX-License-Identifier: MIT
#include "external_memory.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "cl_handle.h"
#include "probe.h"
#include "quincunx/advanced/log.h"
#include "state_scope.h"

namespace quincunx::gl {
namespace {

void copy_buffer(GLuint from, std::size_t from_offset, GLuint to, std::size_t to_offset, std::size_t bytes) {
  const BindingScope read(BindingScope::bind_buffer, GL_COPY_READ_BUFFER, GL_COPY_READ_BUFFER_BINDING, from);
  const BindingScope written = BindingScope::buffer(to);
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(from_offset),
                      static_cast<GLintptr>(to_offset), static_cast<GLsizeiptr>(bytes));
}

}  // namespace

GLuint MemoryObjectTraits::create() {
  GLuint name = 0;
  glCreateMemoryObjectsEXT(1, &name);
  return name;
}

GLuint GlSemaphoreTraits::create() {
  GLuint name = 0;
  glGenSemaphoresEXT(1, &name);
  return name;
}

DeviceUuid gl_device_uuid() {
  DeviceUuid uuid = {};
  if (!epoxy_has_gl_extension("GL_EXT_memory_object")) return uuid;
  const ErrorScope callers;
  GLint count = 0;
  glGetIntegerv(GL_NUM_DEVICE_UUIDS_EXT, &count);
  if (count > 0) glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, 0, uuid.data());
  return uuid;
}

const std::uint8_t* BufferReader::read(GLuint buffer, std::size_t offset, std::size_t bytes) {
  release();
  if (!staging_) staging_ = Buffer::create();
  const auto size = static_cast<GLsizeiptr>(bytes);
  if (std::exchange(size_, bytes) != bytes) {
    const BindingScope bound = BindingScope::buffer(staging_.get());
    glBufferData(GL_COPY_WRITE_BUFFER, size, nullptr, GL_STREAM_READ);
  }
  copy_buffer(buffer, offset, staging_.get(), 0, bytes);
  const BindingScope bound = BindingScope::buffer(staging_.get());
  const void* const mapped = glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, size, GL_MAP_READ_BIT);
  mapped_ = mapped != nullptr;
  return static_cast<const std::uint8_t*>(mapped);
}

void BufferReader::release() {
  if (!std::exchange(mapped_, false)) return;
  const BindingScope bound = BindingScope::buffer(staging_.get());
  glUnmapBuffer(GL_COPY_WRITE_BUFFER);
}

DeviceOrder::Direction DeviceOrder::make(const VulkanDevice& vulkan, const Device& device) {
  auto [for_gl, for_cl, kept, semaphore] = vulkan.semaphore();
  Direction made;
  made.kept = std::move(kept);
  made.gl = Handle<GlSemaphoreTraits>::create();
  glImportSemaphoreFdEXT(made.gl.get(), GL_HANDLE_TYPE_OPAQUE_FD_EXT, for_gl.get());
  check_gl("glImportSemaphoreFdEXT");
  for_gl.give_away();
  auto imported = device.import_semaphore(for_cl.get());
  check_status(imported.status());
  made.cl = std::move(imported).value();
  return made;
}

DeviceOrder::DeviceOrder(const VulkanDevice& vulkan, const Device& device)
    : device_(device), to_cl_(make(vulkan, device)), to_gl_(make(vulkan, device)) {}

void DeviceOrder::gl_done(GLuint buffer) {
  if (to_cl_.signalled) {  // a frame that nobody took
    cl_waits();
    check_status(device_.finish());
  }
  glSignalSemaphoreEXT(to_cl_.gl.get(), 1, &buffer, 0, nullptr, nullptr);
  glFlush();
  to_cl_.signalled = true;
}

void DeviceOrder::cl_waits() {
  if (std::exchange(to_cl_.signalled, false)) check_status(to_cl_.cl->wait());
}

void DeviceOrder::cl_done() {
  check_status(to_gl_.cl->signal());
  to_gl_.signalled = true;
}

void DeviceOrder::gl_waits(GLuint buffer) {
  if (std::exchange(to_gl_.signalled, false))
    glWaitSemaphoreEXT(to_gl_.gl.get(), 1, &buffer, 0, nullptr, nullptr);
}

ExternalBuffer Exporter::allocate(const Device& device, std::size_t bytes) const {
  ExternalBuffer made;
  made.memory =
      vulkan_->allocate(bytes, mapped_ ? VulkanDevice::Place::kMapped : VulkanDevice::Place::kDevice);
  made.start = made.memory->start();
  made.bytes = made.memory->mapped();

  made.memory_object = Handle<MemoryObjectTraits>::create();
  if (made.memory->dedicated()) {
    const GLint dedicated = GL_TRUE;
    glMemoryObjectParameterivEXT(made.memory_object.get(), GL_DEDICATED_MEMORY_OBJECT_EXT, &dedicated);
  }
  Fd for_gl = made.memory->fd();
  glImportMemoryFdEXT(made.memory_object.get(), made.memory->size(), GL_HANDLE_TYPE_OPAQUE_FD_EXT,
                      for_gl.get());
  check_gl("glImportMemoryFdEXT");
  for_gl.give_away();
  made.gl = Buffer::create();
  {
    const BindingScope bound = BindingScope::buffer(made.gl.get());
    glBufferStorageMemEXT(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(made.start + bytes),
                          made.memory_object.get(), 0);
  }
  check_gl("glBufferStorageMemEXT");

  made.cl = made.memory->import_to(device, bytes);
  return made;
}

std::optional<DeviceOrder> Exporter::order(const Device& device) const {
  if (!semaphores_) return std::nullopt;
  return DeviceOrder(*vulkan_, device);
}

void Exporter::probe(const Device& device) const {
  const Device own = probe_device(device);
  ExternalBuffer shared = allocate(own, kProbeBytes);
  std::optional<DeviceOrder> order = this->order(own);
  const std::vector<std::uint8_t> from_gl = probe_bytes(1), from_cl = probe_bytes(2);
  std::vector<std::uint8_t> seen;

  const Buffer source = Buffer::create();
  {
    const BindingScope bound = BindingScope::buffer(source.get());
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(kProbeBytes), from_gl.data(), GL_STATIC_COPY);
  }
  copy_buffer(source.get(), 0, shared.gl.get(), shared.start, kProbeBytes);
  order ? order->gl_done(shared.gl.get()) : glFinish();
  if (order) order->cl_waits();
  check_status(shared.cl->acquire());
  try {
    seen = read_probe(own, shared.cl->memory(), "OpenGL");
  } catch (...) {
    keep_for_ever(std::make_shared<ExternalBuffer>(std::move(shared)));
    throw;
  }
  if (seen != from_gl) throw InteropError("OpenCL read other bytes than OpenGL wrote");

  check_cl(clEnqueueWriteBuffer(own.queue(), shared.cl->memory(), CL_TRUE, 0, kProbeBytes, from_cl.data(), 0,
                                nullptr, nullptr),
           "clEnqueueWriteBuffer");
  check_status(shared.cl->release());
  if (order) order->cl_done();
  check_cl(clFinish(own.queue()), "clFinish");
  if (order) order->gl_waits(shared.gl.get());
  BufferReader reader;
  const std::uint8_t* const back = reader.read(shared.gl.get(), shared.start, kProbeBytes);
  check_gl("reading the probe's buffer");
  const bool same = back != nullptr && std::equal(from_cl.begin(), from_cl.end(), back);
  reader.release();
  if (!same) throw InteropError("OpenGL read other bytes than OpenCL wrote");
}

std::shared_ptr<const Exporter> Exporter::create(const Device& device, bool semaphores) {
  if (!epoxy_has_gl_extension("GL_EXT_memory_object_fd"))
    throw InteropError("OpenGL does not offer GL_EXT_memory_object_fd");
  const DeviceInfo& info = device.info();
  std::shared_ptr<Exporter> made(new Exporter);
  const DeviceUuid uuid = gl_device_uuid();
  made->mapped_ = !info.imports_opaque_fds;
  if (made->mapped_ && !info.host_unified_memory) {
    throw InteropError(fmt::format(
        "'{}' does not offer cl_khr_external_memory_opaque_fd, and its memory is not the host's", info.name));
  }
  if (!made->mapped_ && info.uuid != uuid) {
    throw InteropError(fmt::format("'{}' is the device {}, and OpenGL draws on the device {}", info.name,
                                   uuid_text(info.uuid), uuid_text(uuid)));
  }
  made->vulkan_ = &VulkanDevice::open(uuid);
  made->semaphores_ = semaphores && info.imports_semaphores && made->vulkan_->has_semaphores() &&
                      epoxy_has_gl_extension("GL_EXT_semaphore_fd");
  try {
    made->probe(device);
  } catch (const std::exception& error) {
    if (!std::exchange(made->semaphores_, false)) throw;
    ErrorScope::take();
    log_line(LogLevel::kWarning, fmt::format("interop: semaphores are left out: {}", error.what()));
    made->probe(device);
  }
  made->reason_ = fmt::format("OpenGL and '{}' use memory of Vulkan's, ordered by {}, as a probe has shown",
                              info.name, made->semaphores_ ? "semaphores" : "waits of the host");
  return made;
}

}  // namespace quincunx::gl
