// SPDX-License-Identifier: MIT
#include "cl_interposer.h"

#include <CL/cl_ext.h>
#include <CL/cl_gl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cl_faults.h"
#include "cl_imports.h"
#include "real_function.h"
#include "state_scope.h"

namespace quincunx::gl::testing {
namespace {

// Whether an object is not to be made; its error is then in *code.
bool refuses(cl_int* code) {
  const cl_int fault = injected_fault();
  if (fault != CL_SUCCESS && code != nullptr) *code = fault;
  return fault != CL_SUCCESS;
}

constexpr std::uint8_t kJunk = 0xcd;

struct SharedTexture {
  GLuint texture = 0;
  GLenum format = GL_NONE;
  GLenum type = GL_NONE;
  std::size_t texel = 0;
  GLint width = 0;
  GLint height = 0;
  cl_image_format reported = {};
  bool writable = false;
  bool acquired = false;
};

struct ImageOnBuffer {
  cl_mem buffer = nullptr;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t pitch = 0;
};

struct State {
  ClCounts counts;
  bool sharing = false;
  bool gl_event = false;
  PretendSharing::Flaw flaw = PretendSharing::Flaw::kNone;
  bool images_on_buffers = false;
  bool separate_memory = false;
  std::optional<PretendBrokenDriver::Flaw> broken;
  std::map<cl_mem, ImageOnBuffer> on_buffers;
  std::map<cl_mem, SharedTexture> textures;
  std::map<cl_context, std::vector<cl_context_properties>> properties;
};

// Never destroyed: OpenCL may be called while the process ends.
State& state() {
  static State* const instance = new State;
  return *instance;
}

struct KnownFormat {
  GLint internal;
  GLenum format;
  GLenum type;
  std::size_t texel;
  cl_image_format reported;
};

constexpr std::array kKnownFormats = {
    KnownFormat{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16, {CL_RGBA, CL_FLOAT}},
    KnownFormat{GL_RG32F, GL_RG, GL_FLOAT, 8, {CL_RG, CL_FLOAT}},
    KnownFormat{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8, {CL_RGBA, CL_HALF_FLOAT}},
    KnownFormat{GL_RG16F, GL_RG, GL_HALF_FLOAT, 4, {CL_RG, CL_HALF_FLOAT}},
    KnownFormat{GL_R32F, GL_RED, GL_FLOAT, 4, {CL_R, CL_FLOAT}},
    KnownFormat{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, {CL_RGBA, CL_UNORM_INT8}},
    KnownFormat{GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1, {CL_R, CL_UNORM_INT8}},
};

// Any format of the right size will do: texels only pass through.
cl_image_format stand_in_of(std::size_t texel) {
  if (texel == 16) return {CL_RGBA, CL_UNSIGNED_INT32};
  if (texel == 8) return {CL_RGBA, CL_UNORM_INT16};
  if (texel == 1) return {CL_R, CL_UNORM_INT8};
  return {CL_RGBA, CL_UNORM_INT8};
}

std::size_t texel_bytes(const cl_image_format& format) {
  const auto known = std::find_if(kKnownFormats.begin(), kKnownFormats.end(), [&](const KnownFormat& entry) {
    return entry.reported.image_channel_order == format.image_channel_order &&
           entry.reported.image_channel_data_type == format.image_channel_data_type;
  });
  return known == kKnownFormats.end() ? 0 : known->texel;
}

cl_mem create_on_buffer(cl_context context, cl_mem_flags flags, const cl_image_format& format,
                        const cl_image_desc& desc, cl_int* code) {
  const std::size_t texel = texel_bytes(format);
  std::size_t bytes = 0;
  clGetMemObjectInfo(desc.buffer, CL_MEM_SIZE, sizeof(bytes), &bytes, nullptr);
  const bool right = texel != 0 && desc.image_row_pitch % (kImagePitchTexels * texel) == 0 &&
                     desc.image_row_pitch >= desc.image_width * texel &&
                     bytes >= desc.image_row_pitch * desc.image_height;
  if (!right) {
    *code = CL_INVALID_IMAGE_DESCRIPTOR;
    return nullptr;
  }
  const cl_image_format stand_in = stand_in_of(texel);
  cl_image_desc plain = desc;
  plain.buffer = nullptr;
  plain.image_row_pitch = 0;
  const cl_mem image = REAL(clCreateImage)(context, flags, &stand_in, &plain, nullptr, code);
  if (image != nullptr)
    state().on_buffers[image] = {desc.buffer, desc.image_width, desc.image_height, desc.image_row_pitch};
  return image;
}

void update_images_on_buffers(cl_command_queue queue) {
  for (const auto& [image, on] : state().on_buffers) {
    std::vector<std::uint8_t> rows(on.pitch * on.height);
    const std::array<std::size_t, 3> origin = {0, 0, 0};
    const std::array<std::size_t, 3> region = {on.width, on.height, 1};
    REAL(clEnqueueReadBuffer)(queue, on.buffer, CL_TRUE, 0, rows.size(), rows.data(), 0, nullptr, nullptr);
    static_cast<void>(REAL(clEnqueueWriteImage)(queue, image, CL_TRUE, origin.data(), region.data(), on.pitch,
                                                0, rows.data(), 0, nullptr, nullptr));
  }
}

bool describe(GLuint texture, SharedTexture* shared) {
  GLint internal = 0;
  glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_INTERNAL_FORMAT, &internal);
  glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &shared->width);
  glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &shared->height);
  const auto known = std::find_if(kKnownFormats.begin(), kKnownFormats.end(),
                                  [&](const KnownFormat& entry) { return entry.internal == internal; });
  if (known == kKnownFormats.end()) return false;
  shared->texture = texture;
  shared->format = known->format;
  shared->type = known->type;
  shared->texel = known->texel;
  shared->reported = known->reported;
  return true;
}

std::size_t bytes_of(const SharedTexture& shared) {
  return shared.texel * static_cast<std::size_t>(shared.width) * static_cast<std::size_t>(shared.height);
}

cl_int write_image(cl_command_queue queue, cl_mem image, const SharedTexture& shared, const void* texels) {
  const std::array<std::size_t, 3> origin = {0, 0, 0};
  const std::array<std::size_t, 3> region = {static_cast<std::size_t>(shared.width),
                                             static_cast<std::size_t>(shared.height), 1};
  return REAL(clEnqueueWriteImage)(queue, image, CL_TRUE, origin.data(), region.data(), 0, 0, texels, 0,
                                   nullptr, nullptr);
}

cl_int to_opencl(cl_command_queue queue, cl_mem image, const SharedTexture& shared) {
  std::vector<std::uint8_t> texels(bytes_of(shared));
  const PackScope packs;
  const UnpackScope unpacks;
  glGetTextureImage(shared.texture, 0, shared.format, shared.type, static_cast<GLsizei>(texels.size()),
                    texels.data());
  if (state().flaw == PretendSharing::Flaw::kWrongBytes) texels.back() ^= 1;
  return write_image(queue, image, shared, texels.data());
}

cl_int to_opengl(cl_command_queue queue, cl_mem image, const SharedTexture& shared) {
  std::vector<std::uint8_t> texels(bytes_of(shared));
  const std::array<std::size_t, 3> origin = {0, 0, 0};
  const std::array<std::size_t, 3> region = {static_cast<std::size_t>(shared.width),
                                             static_cast<std::size_t>(shared.height), 1};
  const cl_int code = REAL(clEnqueueReadImage)(queue, image, CL_TRUE, origin.data(), region.data(), 0, 0,
                                               texels.data(), 0, nullptr, nullptr);
  if (code != CL_SUCCESS) return code;
  if (shared.writable) {
    const PackScope packs;
    const UnpackScope unpacks;
    glTextureSubImage2D(shared.texture, 0, 0, 0, shared.width, shared.height, shared.format, shared.type,
                        texels.data());
  }
  std::fill(texels.begin(), texels.end(), kJunk);
  return write_image(queue, image, shared, texels.data());
}

using Mover = cl_int (*)(cl_command_queue, cl_mem, const SharedTexture&);

cl_int change_sides(cl_command_queue queue, cl_uint count, const cl_mem* images, bool acquire,
                    cl_event* event) {
  for (cl_uint i = 0; i < count; ++i) {
    const auto found = state().textures.find(images[i]);
    if (found == state().textures.end() || found->second.acquired == acquire) return CL_INVALID_GL_OBJECT;
  }
  const Mover move = acquire ? to_opencl : to_opengl;
  for (cl_uint i = 0; i < count; ++i) {
    SharedTexture& shared = state().textures[images[i]];
    if (const cl_int code = move(queue, images[i], shared); code != CL_SUCCESS) return code;
    shared.acquired = acquire;
  }
  if (event == nullptr) return CL_SUCCESS;
  return clEnqueueMarkerWithWaitList(queue, 0, nullptr, event);
}

std::string without(const std::string& extensions, const std::string& name) {
  std::istringstream words(extensions);
  std::string rest, word;
  while (words >> word)
    if (word != name) rest += (rest.empty() ? "" : " ") + word;
  return rest;
}

cl_int copy_out(const void* value, std::size_t bytes, std::size_t room, void* to, std::size_t* bytes_ret) {
  if (bytes_ret != nullptr) *bytes_ret = bytes;
  if (to == nullptr) return CL_SUCCESS;
  if (room < bytes) return CL_INVALID_VALUE;
  std::memcpy(to, value, bytes);
  return CL_SUCCESS;
}

}  // namespace

ClCounts& cl_counts() {
  return state().counts;
}

PretendSharing::PretendSharing(bool with_gl_event, Flaw flaw) {
  state().sharing = true;
  state().gl_event = with_gl_event;
  state().flaw = flaw;
}

PretendSharing::~PretendSharing() {
  state().sharing = false;
  state().textures.clear();
  state().properties.clear();
}

PretendImagesOnBuffers::PretendImagesOnBuffers() {
  state().images_on_buffers = true;
}

PretendImagesOnBuffers::~PretendImagesOnBuffers() {
  state().images_on_buffers = false;
  state().on_buffers.clear();
}

PretendSeparateMemory::PretendSeparateMemory() {
  state().separate_memory = true;
}

PretendSeparateMemory::~PretendSeparateMemory() {
  state().separate_memory = false;
}

PretendBrokenDriver::PretendBrokenDriver(Flaw flaw) {
  state().broken = flaw;
}

PretendBrokenDriver::~PretendBrokenDriver() {
  state().broken.reset();
}

int acquired_textures() {
  return static_cast<int>(std::count_if(state().textures.begin(), state().textures.end(),
                                        [](const auto& entry) { return entry.second.acquired; }));
}

}  // namespace quincunx::gl::testing

using namespace quincunx::gl::testing;

// Names of what the broken driver has. No call about them may reach the loader, which would look into them.
static int g_broken_place = 0;
static const auto kBrokenPlatform = reinterpret_cast<cl_platform_id>(&g_broken_place);
static const auto kBrokenDevice = reinterpret_cast<cl_device_id>(&g_broken_place);

extern "C" {

cl_int CL_API_CALL clGetPlatformIDs(cl_uint room, cl_platform_id* to, cl_uint* count) {
  const auto real = REAL(clGetPlatformIDs);
  if (!state().broken) return real(room, to, count);
  if (*state().broken == PretendBrokenDriver::Flaw::kNoPlatforms) return CL_OUT_OF_HOST_MEMORY;
  if (to != nullptr) *to++ = kBrokenPlatform;
  const cl_int code = real(to != nullptr ? room - 1 : 0, to, count);
  if (count != nullptr) ++*count;
  return code;
}

cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info name, std::size_t room,
                                     void* value, std::size_t* bytes_ret) {
  if (platform == kBrokenPlatform) return CL_OUT_OF_HOST_MEMORY;
  return REAL(clGetPlatformInfo)(platform, name, room, value, bytes_ret);
}

cl_int CL_API_CALL clGetDeviceIDs(cl_platform_id platform, cl_device_type type, cl_uint room,
                                  cl_device_id* to, cl_uint* count) {
  if (platform != kBrokenPlatform) return REAL(clGetDeviceIDs)(platform, type, room, to, count);
  if (*state().broken == PretendBrokenDriver::Flaw::kNoDevices) return CL_OUT_OF_HOST_MEMORY;
  if (to != nullptr) *to = kBrokenDevice;
  if (count != nullptr) *count = 1;
  return CL_SUCCESS;
}

cl_int CL_API_CALL clRetainDevice(cl_device_id device) {
  return device == kBrokenDevice ? CL_SUCCESS : REAL(clRetainDevice)(device);
}

cl_int CL_API_CALL clReleaseDevice(cl_device_id device) {
  return device == kBrokenDevice ? CL_SUCCESS : REAL(clReleaseDevice)(device);
}

cl_int CL_API_CALL clGetDeviceInfo(cl_device_id device, cl_device_info name, std::size_t room, void* value,
                                   std::size_t* bytes_ret) {
  const auto real = REAL(clGetDeviceInfo);
  if (device == kBrokenDevice) {
    const bool tells = state().broken == PretendBrokenDriver::Flaw::kMuteButForItsKind;
    if (!tells || name != CL_DEVICE_TYPE) return CL_OUT_OF_HOST_MEMORY;
    const cl_device_type kind = CL_DEVICE_TYPE_GPU;
    return copy_out(&kind, sizeof(kind), room, value, bytes_ret);
  }
  if (cl_int code = CL_SUCCESS; tells_of_imports(name, room, value, bytes_ret, &code)) return code;
  if (name == CL_DEVICE_HOST_UNIFIED_MEMORY && state().separate_memory) {
    const cl_bool unified = CL_FALSE;
    return copy_out(&unified, sizeof(unified), room, value, bytes_ret);
  }
  if (name == CL_DEVICE_IMAGE_PITCH_ALIGNMENT_KHR && state().images_on_buffers) {
    const cl_uint texels = kImagePitchTexels;
    return copy_out(&texels, sizeof(texels), room, value, bytes_ret);
  }
  if (name != CL_DEVICE_EXTENSIONS) return real(device, name, room, value, bytes_ret);
  std::size_t bytes = 0;
  if (const cl_int code = real(device, name, 0, nullptr, &bytes); code != CL_SUCCESS) return code;
  std::string all(bytes, '\0');
  if (const cl_int code = real(device, name, bytes, all.data(), nullptr); code != CL_SUCCESS) return code;
  all.resize(std::strlen(all.c_str()));
  if (state().sharing) {
    // A driver that does not share may list the other all the same: NVIDIA's for its H200 does.
    all = without(without(all, "cl_khr_gl_sharing"), "cl_khr_gl_event") + " cl_khr_gl_sharing";
    if (state().gl_event) all += " cl_khr_gl_event";
  }
  if (state().images_on_buffers) all += " cl_khr_image2d_from_buffer";
  all += extensions_of_imports();
  return copy_out(all.c_str(), all.size() + 1, room, value, bytes_ret);
}

cl_context CL_API_CALL clCreateContext(
    const cl_context_properties* properties, cl_uint count, const cl_device_id* devices,
    void(CL_CALLBACK* notify)(const char*, const void*, std::size_t, void*), void* user, cl_int* code) {
  if (refuses(code)) return nullptr;
  std::vector<cl_context_properties> plain;
  std::vector<cl_context_properties> all;
  for (const cl_context_properties* p = properties; p != nullptr && *p != 0; p += 2) {
    all.insert(all.end(), {p[0], p[1]});
    const bool of_gl = p[0] == CL_GL_CONTEXT_KHR || p[0] == CL_EGL_DISPLAY_KHR || p[0] == CL_GLX_DISPLAY_KHR;
    if (!of_gl) plain.insert(plain.end(), {p[0], p[1]});
  }
  const bool with_gl = all.size() != plain.size();
  if (with_gl && state().flaw == PretendSharing::Flaw::kNoContext) {
    if (code != nullptr) *code = CL_INVALID_GL_SHAREGROUP_REFERENCE_KHR;
    return nullptr;
  }
  plain.push_back(0);
  all.push_back(0);
  const cl_context context =
      REAL(clCreateContext)(with_gl ? plain.data() : properties, count, devices, notify, user, code);
  if (with_gl) state().properties[context] = all;
  return context;
}

cl_int CL_API_CALL clGetContextInfo(cl_context context, cl_context_info name, std::size_t room, void* value,
                                    std::size_t* bytes_ret) {
  const auto found = state().properties.find(context);
  if (name == CL_CONTEXT_PROPERTIES && found != state().properties.end()) {
    return copy_out(found->second.data(), found->second.size() * sizeof(cl_context_properties), room, value,
                    bytes_ret);
  }
  return REAL(clGetContextInfo)(context, name, room, value, bytes_ret);
}

cl_mem CL_API_CALL clCreateFromGLTexture(cl_context context, cl_mem_flags flags, cl_GLenum, cl_GLint,
                                         cl_GLuint texture, cl_int* code) {
  SharedTexture shared;
  if (!describe(texture, &shared)) {
    *code = CL_INVALID_IMAGE_FORMAT_DESCRIPTOR;
    return nullptr;
  }
  const cl_image_format stand_in = stand_in_of(shared.texel);
  cl_image_desc desc = {};
  desc.image_type = CL_MEM_OBJECT_IMAGE2D;
  desc.image_width = static_cast<std::size_t>(shared.width);
  desc.image_height = static_cast<std::size_t>(shared.height);
  const cl_mem image = REAL(clCreateImage)(context, CL_MEM_READ_WRITE, &stand_in, &desc, nullptr, code);
  shared.writable = (flags & CL_MEM_READ_ONLY) == 0;
  if (image != nullptr) state().textures[image] = shared;
  return image;
}

cl_int CL_API_CALL clGetImageInfo(cl_mem image, cl_image_info name, std::size_t room, void* value,
                                  std::size_t* bytes_ret) {
  const auto found = state().textures.find(image);
  if (name == CL_IMAGE_FORMAT && found != state().textures.end()) {
    cl_image_format reported = found->second.reported;
    if (state().flaw == PretendSharing::Flaw::kWrongFormat) reported.image_channel_order = CL_BGRA;
    return copy_out(&reported, sizeof(reported), room, value, bytes_ret);
  }
  return REAL(clGetImageInfo)(image, name, room, value, bytes_ret);
}

cl_int CL_API_CALL clEnqueueAcquireGLObjects(cl_command_queue queue, cl_uint count, const cl_mem* images,
                                             cl_uint, const cl_event*, cl_event* event) {
  ++state().counts.acquires;
  return change_sides(queue, count, images, true, event);
}

cl_int CL_API_CALL clEnqueueReleaseGLObjects(cl_command_queue queue, cl_uint count, const cl_mem* images,
                                             cl_uint, const cl_event*, cl_event* event) {
  ++state().counts.releases;
  return change_sides(queue, count, images, false, event);
}

cl_int CL_API_CALL clReleaseMemObject(cl_mem memory) {
  // A released image that OpenCL still holds stays in the list, for acquired_textures() to show.
  const auto found = state().textures.find(memory);
  if (found != state().textures.end() && !found->second.acquired) state().textures.erase(found);
  state().on_buffers.erase(memory);
  return REAL(clReleaseMemObject)(memory);
}

cl_mem CL_API_CALL clCreateBuffer(cl_context context, cl_mem_flags flags, std::size_t bytes, void* host,
                                  cl_int* code) {
  if (refuses(code)) return nullptr;
  ++state().counts.creations;
  return REAL(clCreateBuffer)(context, flags, bytes, host, code);
}

cl_mem CL_API_CALL clCreateImage(cl_context context, cl_mem_flags flags, const cl_image_format* format,
                                 const cl_image_desc* desc, void* host, cl_int* code) {
  if (refuses(code)) return nullptr;
  ++state().counts.creations;
  if (desc->buffer != nullptr && state().images_on_buffers)
    return create_on_buffer(context, flags, *format, *desc, code);
  return REAL(clCreateImage)(context, flags, format, desc, host, code);
}

cl_mem CL_API_CALL clCreateSubBuffer(cl_mem buffer, cl_mem_flags flags, cl_buffer_create_type type,
                                     const void* info, cl_int* code) {
  if (refuses(code)) return nullptr;
  ++state().counts.creations;
  return REAL(clCreateSubBuffer)(buffer, flags, type, info, code);
}

cl_int CL_API_CALL clEnqueueUnmapMemObject(cl_command_queue queue, cl_mem memory, void* mapped, cl_uint count,
                                           const cl_event* wait, cl_event* event) {
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  const cl_int code = REAL(clEnqueueUnmapMemObject)(queue, memory, mapped, count, wait, event);
  update_images_on_buffers(queue);
  return code;
}

cl_int CL_API_CALL clEnqueueWriteBufferRect(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                            const std::size_t* to, const std::size_t* from,
                                            const std::size_t* region, std::size_t row, std::size_t slice,
                                            std::size_t host_row, std::size_t host_slice, const void* host,
                                            cl_uint count, const cl_event* wait, cl_event* event) {
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  const cl_int code = REAL(clEnqueueWriteBufferRect)(queue, buffer, blocking, to, from, region, row, slice,
                                                     host_row, host_slice, host, count, wait, event);
  update_images_on_buffers(queue);
  return code;
}

cl_int CL_API_CALL clFinish(cl_command_queue queue) {
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  let_copies_through();
  ++state().counts.blocking_waits;
  return REAL(clFinish)(queue);
}

void* CL_API_CALL clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                     cl_map_flags flags, std::size_t offset, std::size_t bytes, cl_uint count,
                                     const cl_event* wait, cl_event* event, cl_int* code) {
  if (refuses(code)) return nullptr;
  ++state().counts.maps;
  if (blocking != CL_FALSE) ++state().counts.blocking_waits;
  return REAL(clEnqueueMapBuffer)(queue, buffer, blocking, flags, offset, bytes, count, wait, event, code);
}

}  // extern "C"
