// SPDX-License-Identifier: MIT
#include <exception>
#include <new>

#include "c_interface/c_objects.h"

namespace quincunx::c {
namespace {

thread_local std::string message;

quincunx_status code_of(StatusCode code) {
  switch (code) {
    case StatusCode::kOk:
      return QUINCUNX_OK;
    case StatusCode::kInvalidArgument:
      return QUINCUNX_INVALID_ARGUMENT;
    case StatusCode::kUnsupported:
      return QUINCUNX_UNSUPPORTED;
    case StatusCode::kDeviceFailure:
      return QUINCUNX_DEVICE_FAILURE;
    case StatusCode::kIoFailure:
      return QUINCUNX_IO_FAILURE;
  }
  return QUINCUNX_INTERNAL;
}

}  // namespace

quincunx_status report(const Status& status) {
  if (!status.ok()) message = status.message();
  return code_of(status.code());
}

quincunx_status report(quincunx_status code, const char* text) noexcept {
  try {
    message = text;
  } catch (...) {
    message.clear();
  }
  return code;
}

quincunx_status report_exception() noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return report(QUINCUNX_OUT_OF_MEMORY, "out of host memory");
  } catch (const std::exception& error) {
    return report(QUINCUNX_INTERNAL, error.what());
  } catch (...) {
    return report(QUINCUNX_INTERNAL, "an unknown error in the library");
  }
}

const char* last_error() noexcept {
  return message.c_str();
}

}  // namespace quincunx::c
