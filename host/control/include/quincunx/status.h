// SPDX-License-Identifier: MIT
// Status and Result: how every public call of Quincunx reports failure.
//
// No public call throws for a reason a caller can cause. A failure is a Status: a code to branch on and one
// sentence that says what is wrong, where, and what would be right. Both types are values; any thread may use
// its own copy.
#pragma once

#include <cstdio>
#include <cstdlib>
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

// Either a value or the Status that says why there is none. Asking for a missing value ends the process, with that
// sentence on stderr: enough for a program that cannot go on without it.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Status status) : state_(std::move(status)) {}

  bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  Status status() const { return ok() ? Status() : std::get<Status>(state_); }
  // Returns why there is no value, as one sentence; empty when ok.
  std::string error() const { return status().message(); }

  T& value() & { return *checked(this); }
  const T& value() const& { return *checked(this); }
  T&& value() && { return std::move(*checked(this)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  template <typename Self>
  static auto* checked(Self* self) {
    auto* const value = std::get_if<T>(&self->state_);
    if (value == nullptr) {
      std::fprintf(stderr, "quincunx: a result without a value is used: %s\n", self->error().c_str());
      std::abort();
    }
    return value;
  }

  std::variant<T, Status> state_;
};

}  // namespace quincunx
