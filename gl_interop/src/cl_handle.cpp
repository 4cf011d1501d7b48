// SPDX-License-Identifier: MIT
#include "cl_handle.h"
#include "quincunx/advanced/log.h"

#include <fmt/format.h>

namespace quincunx::gl {
namespace {

// The codes that the calls of this library may give.
std::string describe(cl_int code) {
  const char* name = "OpenCL error";
  switch (code) {
#define NAME(value) \
  case value:       \
    name = #value;  \
    break
    NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE);
    NAME(CL_OUT_OF_RESOURCES);
    NAME(CL_OUT_OF_HOST_MEMORY);
    NAME(CL_IMAGE_FORMAT_NOT_SUPPORTED);
    NAME(CL_MAP_FAILURE);
    NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
    NAME(CL_INVALID_VALUE);
    NAME(CL_INVALID_CONTEXT);
    NAME(CL_INVALID_COMMAND_QUEUE);
    NAME(CL_INVALID_HOST_PTR);
    NAME(CL_INVALID_MEM_OBJECT);
    NAME(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR);
    NAME(CL_INVALID_EVENT);
    NAME(CL_INVALID_OPERATION);
    NAME(CL_INVALID_GL_OBJECT);
    NAME(CL_INVALID_BUFFER_SIZE);
    NAME(CL_INVALID_MIP_LEVEL);
#undef NAME
    default:
      break;
  }
  return fmt::format("{} ({})", name, code);
}

}  // namespace

void check_cl(cl_int code, const char* call) {
  if (code != CL_SUCCESS) throw InteropError(fmt::format("{} failed: {}", call, describe(code)));
}

void check_status(const Status& status) {
  if (!status.ok()) throw InteropError(status.message());
}

void log_release_failure(cl_int code) {
  log_line(LogLevel::kWarning,
           fmt::format("releasing an OpenCL object of the bridge failed: {}", describe(code)));
}

void wait_and_reset(ClEvent& event) {
  if (!event) return;
  const cl_event raw = event.get();
  const cl_int code = clWaitForEvents(1, &raw);
  event.reset();
  check_cl(code, "clWaitForEvents");
}

}  // namespace quincunx::gl
