// SPDX-License-Identifier: MIT
// Status and Result: how every public call of Quincunx reports failure.
//
// No public call throws for a reason a caller can cause. A failure is a Status: a code to branch on and one
// sentence that says what is wrong, where, and what would be right. Both types are values; any thread may use
// its own copy.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace quincunx {

enum class StatusCode {
  kOk = 0,
  kInvalidArgument,  // the caller passed something that can never work; the message names the field
  kUnsupported,      // valid, but this device, driver or build cannot do it
  kDeviceFailure,    // an OpenCL or OpenGL call failed; the message names call, kernel and device
  kIoFailure,        // a file could not be read or written; the message names the path
};

class [[nodiscard]] Status {
 public:
  Status() = default;  // ok
  Status(StatusCode code, std::string message) : code_(code), message_(std::move(message)) {}

  static Status invalid(std::string message) { return {StatusCode::kInvalidArgument, std::move(message)}; }
  static Status unsupported(std::string message) { return {StatusCode::kUnsupported, std::move(message)}; }
  static Status device(std::string message) { return {StatusCode::kDeviceFailure, std::move(message)}; }
  static Status io(std::string message) { return {StatusCode::kIoFailure, std::move(message)}; }

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }  // empty when ok

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
};

// Either a value or the Status that says why there is none. value() may be called only when ok().
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Status status) : state_(std::move(status)) {}

  bool ok() const { return std::holds_alternative<T>(state_); }
  Status status() const { return ok() ? Status() : std::get<Status>(state_); }
  T& value() & { return std::get<T>(state_); }
  const T& value() const& { return std::get<T>(state_); }
  T&& value() && { return std::get<T>(std::move(state_)); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, Status> state_;
};

}  // namespace quincunx
