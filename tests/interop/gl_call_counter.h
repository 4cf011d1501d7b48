// SPDX-License-Identifier: MIT
// CallCounter: counts the calls of one GL function while it lives, through the pointer that libepoxy keeps.
#pragma once

#include <epoxy/gl.h>

#include <type_traits>

namespace quincunx::gl::testing {

// `pointer` is the address of libepoxy's variable, as in CallCounter<&epoxy_glFinish>. The function must have
// been called before, for libepoxy fills its pointers in at the first call.
template <auto* pointer>
class CallCounter {
 public:
  CallCounter() : real_(*pointer) {
    count_ = 0;
    shared_real_ = real_;
    *pointer = make_hook(real_);
  }
  ~CallCounter() { *pointer = real_; }
  CallCounter(const CallCounter&) = delete;
  CallCounter& operator=(const CallCounter&) = delete;

  int count() const { return count_; }

 private:
  template <typename R, typename... Args>
  static auto make_hook(R (*)(Args...)) -> R (*)(Args...) {
    return [](Args... args) -> R {
      ++count_;
      return shared_real_(args...);
    };
  }

  using Function = std::remove_reference_t<decltype(*pointer)>;
  Function real_;
  static inline Function shared_real_ = nullptr;
  static inline int count_ = 0;
};

}  // namespace quincunx::gl::testing
