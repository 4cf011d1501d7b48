// SPDX-License-Identifier: MIT
// Structs of the C interface that know their size, so that programs and libraries of different age go together.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "quincunx/c/frame.h"
#include "quincunx/c/settings.h"
#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx::c {

// Sizes in the first version of the interface, which never change. A struct that is smaller is none.
template <typename Struct>
inline constexpr std::size_t kFirstSize = 0;
template <>
inline constexpr std::size_t kFirstSize<quincunx_settings> = 144;
template <>
inline constexpr std::size_t kFirstSize<quincunx_needs> = 48;
template <>
inline constexpr std::size_t kFirstSize<quincunx_image> = 48;
template <>
inline constexpr std::size_t kFirstSize<quincunx_inputs> = 152;
template <>
inline constexpr std::size_t kFirstSize<quincunx_outputs> = 24;
template <>
inline constexpr std::size_t kFirstSize<quincunx_report> = 64;
template <>
inline constexpr std::size_t kFirstSize<quincunx_particles> = 40;
template <>
inline constexpr std::size_t kFirstSize<quincunx_focus> = 48;
template <>
inline constexpr std::size_t kFirstSize<quincunx_fade> = 24;
template <>
inline constexpr std::size_t kFirstSize<quincunx_sync> = 32;
template <>
inline constexpr std::size_t kFirstSize<quincunx_content> = 64;
template <>
inline constexpr std::size_t kFirstSize<quincunx_external_memory> = 48;
template <typename Struct>
Status check_size(const Struct* given, const char* name) {
  if (given == nullptr) return Status::invalid(fmt::format("{} is NULL; it must point to one", name));
  // Another remainder is none of a struct's, and would cut a field in two; no later struct will be as large as a page.
  constexpr std::size_t kLargest = 4096;
  if (given->struct_size >= kFirstSize<Struct> && given->struct_size <= kLargest &&
      given->struct_size % alignof(Struct) == 0)
    return {};
  return Status::invalid(fmt::format("{}.struct_size is {}; it must be the sizeof of the struct, in [{}, {}]",
                                     name, given->struct_size, kFirstSize<Struct>, kLargest));
}

// Reads the fields that the caller has; those that only this library has keep their value in `own`. Errors:
// kInvalidArgument where a newer caller has set a field that this library does not know.
template <typename Struct>
Status read_sized(const Struct* given, const char* name, Struct& own) {
  if (Status status = check_size(given, name); !status.ok()) return status;
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  const bool unknown =
      given->struct_size > sizeof(Struct) && std::any_of(bytes + sizeof(Struct), bytes + given->struct_size,
                                                         [](unsigned char byte) { return byte != 0; });
  if (unknown) {
    return Status::invalid(
        fmt::format("{}.struct_size is {}, and a field beyond the {} bytes that this library knows is set; "
                    "leave it 0, or use a library that is as new as the header",
                    name, given->struct_size, sizeof(Struct)));
  }
  std::memcpy(&own, given, std::min(given->struct_size, sizeof(Struct)));
  return {};
}

// Reads numbers that name values; keeps what is wrong with the first that is none.
class Reader {
 public:
  explicit Reader(const char* name) : name_(name) {}

  template <typename Value>
  void value(const char* field, std::int32_t number, Value last, Value& to, int first = 0) {
    const int highest = static_cast<int>(last);
    if (number >= first && number <= highest) {
      to = static_cast<Value>(number);
    } else if (status_.ok()) {
      status_ = Status::invalid(
          fmt::format("{}.{} is {}; it must lie in [{}, {}]", name_, field, number, first, highest));
    }
  }
  // As the function that pairs fields calls it: see ToC.
  template <typename Value>
  void operator()(const char* field, std::int32_t number, Value& to, Value last) {
    value(field, number, last, to, std::is_same_v<Value, PixelFormat> ? QUINCUNX_R8 : 0);
  }
  template <typename Field, typename Value>
  void operator()(const char*, const Field& from, Value& to) {
    if constexpr (std::is_same_v<Value, bool>) {
      to = from != 0;
    } else {
      to = from;
    }
  }
  const Status& status() const { return status_; }

 private:
  const char* name_;
  Status status_;
};

// Copies the library's fields to those of C. A function pairs both, so that each pair stands in one place: it calls
// ToC, or a Reader for the way back, with a name, C's field, the library's, and of an enumeration its last value.
struct ToC {
  template <typename Field, typename Value>
  void operator()(const char*, Field& to, const Value& from, Value = {}) const {
    to = static_cast<Field>(from);
  }
};

// Writes the fields that the caller has; its size stays.
template <typename Struct>
void write_sized(Struct own, Struct* to) {
  own.struct_size = to->struct_size;
  std::memcpy(to, &own, std::min(to->struct_size, sizeof(Struct)));
}

template <typename Struct, typename Own, typename Pairs>
Struct to_c(const Own& own, const Pairs& pairs) {
  Struct to = {};
  constexpr ToC kCopy;
  pairs(to, own, kCopy);
  return to;
}

// Reads what the caller gives into `own`, which holds the defaults; `from`: the struct of C.
template <typename Struct, typename Own, typename Pairs>
Status read_settings(const Struct* given, Struct& from, Own& own, const Pairs& pairs) {
  from = to_c<Struct>(own, pairs);
  if (Status status = read_sized(given, "settings", from); !status.ok()) return status;
  Reader read("settings");
  pairs(from, own, read);
  return read.status();
}

}  // namespace quincunx::c
