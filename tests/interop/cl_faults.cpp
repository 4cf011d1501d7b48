// SPDX-License-Identifier: MIT
// The calls that cl_interposer.cpp replaces ask injected_fault() there.
#include "cl_faults.h"

#include <atomic>
#include <cstring>
#include <vector>

#include "real_function.h"

namespace quincunx::gl::testing {
namespace {

struct LateCopy {
  cl_command_queue queue;
  cl_mem buffer;
  size_t offset;
  cl_event gate;
  std::vector<unsigned char> given;
};
bool g_late = false;
std::vector<LateCopy> g_copies;
std::size_t g_let_through = 0;

std::atomic<bool> g_active = false;
std::atomic<bool> g_for_good = false;
std::atomic<int> g_left = 0;  // calls before the one that fails
std::atomic<cl_int> g_code = CL_SUCCESS;

}  // namespace

PretendFault::PretendFault(int at, cl_int code, Lasts lasts) {
  g_left = at;
  g_code = code;
  g_for_good = lasts == Lasts::kForGood;
  g_active = true;
}

PretendFault::~PretendFault() {
  g_active = false;
}

bool PretendFault::struck() const {
  return g_left < 0;
}

cl_int injected_fault() {
  if (!g_active) return CL_SUCCESS;
  const int left = g_left--;
  return left == 0 || (left < 0 && g_for_good) ? g_code.load() : CL_SUCCESS;
}

void let_copies_through() {
  static const auto set = REAL(clSetUserEventStatus);
  for (; g_let_through < g_copies.size(); ++g_let_through)
    set(g_copies[g_let_through].gate, CL_COMPLETE);
}

PretendLateCopies::PretendLateCopies() {
  g_late = true;
}

PretendLateCopies::~PretendLateCopies() {
  g_late = false;
  let_copies_through();
  for (const LateCopy& copy : g_copies) {
    REAL(clFinish)(copy.queue);
    clReleaseEvent(copy.gate);
    clReleaseMemObject(copy.buffer);
  }
  g_copies.clear();
  g_let_through = 0;
}

int PretendLateCopies::count() const {
  return static_cast<int>(g_copies.size());
}

bool PretendLateCopies::copied_what_was_given() const {
  let_copies_through();
  bool right = true;
  for (const LateCopy& copy : g_copies) {
    std::vector<unsigned char> copied(copy.given.size());
    static_cast<void>(REAL(clEnqueueReadBuffer)(copy.queue, copy.buffer, CL_TRUE, copy.offset, copied.size(),
                                                copied.data(), 0, nullptr, nullptr));
    right = right && copied == copy.given;
  }
  return right;
}

}  // namespace quincunx::gl::testing

using quincunx::gl::testing::injected_fault;
using namespace quincunx::gl::testing;

// A function that returns its error, one that may also wait for the device, and one that returns an object and hands
// its error out through `code`.
#define FAILS(name, ...)                                                        \
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault; \
  static const auto real = REAL(name);                                          \
  return real(__VA_ARGS__)
#define FAILS_TO_WAIT(waits, name, ...)                                         \
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault; \
  if (waits) let_copies_through();                                              \
  static const auto real = REAL(name);                                          \
  return real(__VA_ARGS__)
#define FAILS_TO_MAKE(name, ...)                                    \
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) { \
    if (code != nullptr) *code = fault;                             \
    return nullptr;                                                 \
  }                                                                 \
  static const auto real = REAL(name);                              \
  return real(__VA_ARGS__)

extern "C" {

cl_command_queue CL_API_CALL clCreateCommandQueue(cl_context context, cl_device_id device,
                                                  cl_command_queue_properties properties, cl_int* code) {
  FAILS_TO_MAKE(clCreateCommandQueue, context, device, properties, code);
}

cl_program CL_API_CALL clCreateProgramWithSource(cl_context context, cl_uint count, const char** texts,
                                                 const size_t* lengths, cl_int* code) {
  FAILS_TO_MAKE(clCreateProgramWithSource, context, count, texts, lengths, code);
}

cl_program CL_API_CALL clCreateProgramWithBinary(cl_context context, cl_uint count,
                                                 const cl_device_id* devices, const size_t* lengths,
                                                 const unsigned char** binaries, cl_int* states,
                                                 cl_int* code) {
  FAILS_TO_MAKE(clCreateProgramWithBinary, context, count, devices, lengths, binaries, states, code);
}

cl_int CL_API_CALL clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                                  const char* options, void(CL_CALLBACK* notify)(cl_program, void*),
                                  void* user) {
  FAILS(clBuildProgram, program, count, devices, options, notify, user);
}

cl_kernel CL_API_CALL clCreateKernel(cl_program program, const char* name, cl_int* code) {
  FAILS_TO_MAKE(clCreateKernel, program, name, code);
}

cl_int CL_API_CALL clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void* value) {
  FAILS(clSetKernelArg, kernel, index, size, value);
}

cl_int CL_API_CALL clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                          const size_t* offset, const size_t* global, const size_t* local,
                                          cl_uint count, const cl_event* wait, cl_event* event) {
  FAILS(clEnqueueNDRangeKernel, queue, kernel, dimensions, offset, global, local, count, wait, event);
}

cl_int CL_API_CALL clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern,
                                       size_t pattern_size, size_t offset, size_t size, cl_uint count,
                                       const cl_event* wait, cl_event* event) {
  FAILS(clEnqueueFillBuffer, queue, buffer, pattern, pattern_size, offset, size, count, wait, event);
}

cl_int CL_API_CALL clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                                       size_t size, void* to, cl_uint count, const cl_event* wait,
                                       cl_event* event) {
  FAILS_TO_WAIT(blocking, clEnqueueReadBuffer, queue, buffer, blocking, offset, size, to, count, wait, event);
}

cl_int CL_API_CALL clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                        size_t offset, size_t size, const void* from, cl_uint count,
                                        const cl_event* wait, cl_event* event) {
  if (!g_late || blocking || count != 0) {
    FAILS_TO_WAIT(blocking, clEnqueueWriteBuffer, queue, buffer, blocking, offset, size, from, count, wait,
                  event);
  }
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  cl_context context = nullptr;
  clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof(context), &context, nullptr);
  const auto* bytes = static_cast<const unsigned char*>(from);
  clRetainMemObject(buffer);
  g_copies.push_back({queue, buffer, offset, clCreateUserEvent(context, nullptr), {bytes, bytes + size}});
  static const auto real = REAL(clEnqueueWriteBuffer);
  return real(queue, buffer, blocking, offset, size, from, 1, &g_copies.back().gate, event);
}

cl_int CL_API_CALL clFlush(cl_command_queue queue) {
  FAILS(clFlush, queue);
}

cl_int CL_API_CALL clWaitForEvents(cl_uint count, const cl_event* events) {
  FAILS_TO_WAIT(true, clWaitForEvents, count, events);
}

cl_int CL_API_CALL clGetEventInfo(cl_event event, cl_event_info name, size_t room, void* value,
                                  size_t* bytes_ret) {
  FAILS(clGetEventInfo, event, name, room, value, bytes_ret);
}

}  // extern "C"
