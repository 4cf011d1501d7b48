// SPDX-License-Identifier: MIT
// A caller of the C interface who takes little care: missing pointers, structs of other sizes, wild numbers, objects in
// any order. Each call works, or says in one sentence why not and has changed nothing.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "quincunx/quincunx.h"
#include "wild.h"

namespace quincunx::testing {

// A struct before memory that a newer caller's fields may fill.
template <typename Struct>
struct Sized {
  explicit Sized(const Struct& of = {}) : value(of) { value.struct_size = sizeof(value); }
  Struct value;
  std::uint64_t beyond[2] = {};
};

// Objects that the caller holds, few at a time.
template <typename Object, void (*destroy)(Object*)>
class Pool {
 public:
  explicit Pool(Random& random, std::size_t room = 4) : random_(random), room_(room) {}
  ~Pool() { clear(); }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  Object* any() const {  // or NULL
    const std::size_t i = random_.next() % (16 * (all_.size() + 1));
    return i < 16 * all_.size() ? all_[i % all_.size()] : nullptr;
  }
  void add(Object* object) {
    all_.push_back(object);
    if (all_.size() > room_) drop();
  }
  void drop() {
    if (all_.empty()) return destroy(nullptr);
    const auto at = all_.begin() + static_cast<std::ptrdiff_t>(random_.next() % all_.size());
    destroy(*at);
    all_.erase(at);
  }
  void clear() {
    while (!all_.empty())
      drop();
  }

 private:
  Random& random_;
  std::size_t room_;
  std::vector<Object*> all_;
};

class Caller {
 public:
  struct Call {
    const char* name;
    int weight;
    std::function<void()> make;
  };

  explicit Caller(std::uint64_t seed) : random_(seed) {}
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

  // Makes one of the calls after another.
  void run(const std::vector<Call>& calls) {
    int all = 0;
    for (const Call& call : calls)
      all += call.weight;
    for (int round = 0; round < rounds() && !::testing::Test::HasFailure(); ++round) {
      int at = random_.below(all);
      const Call* call = calls.data();
      for (; at >= call->weight; ++call)
        at -= call->weight;
      name_ = call->name;
      SCOPED_TRACE(name_);
      SCOPED_TRACE(round);
      call->make();
    }
    for (const auto& [name, count] : counts_) {
      EXPECT_GT(count[0], 0) << name << " never worked";
      EXPECT_GT(count[1], 0) << name << " never failed";
    }
  }

 protected:
  bool one_in(int n) { return random_.below(n) == 0; }
  template <typename Object>
  Object* or_null(Object* object) {
    return one_in(40) ? nullptr : object;
  }
  std::string word(const std::string& good) { return one_in(3) ? damaged(good, random_) : good; }
  std::string method() {  // or none
    const char* name = quincunx_variant_name(random_.below(16));
    return word(name != nullptr ? name : "best");
  }
  float wild_float(double plausible) { return static_cast<float>(wild(random_, plausible)); }

  // Returns whether the call worked, after a look at what it says.
  bool worked(quincunx_status status) {
    ++counts_[name_][status == QUINCUNX_OK ? 0 : 1];
    if (status == QUINCUNX_OK) return true;
    if (status == QUINCUNX_NOT_READY) return false;
    EXPECT_TRUE(status == QUINCUNX_INVALID_ARGUMENT || status == QUINCUNX_UNSUPPORTED)
        << status << ": " << quincunx_last_error();
    expect_sentence(std::string_view(quincunx_last_error()));
    return false;
  }

  // A call that writes to `to`, or leaves it as it is where it fails.
  template <typename Value, typename Function>
  bool writes(Value& to, const Function& function) {
    std::array<unsigned char, sizeof(to)> before;
    std::memcpy(before.data(), &to, sizeof(to));
    const bool works = worked(function(or_null(&to)));
    EXPECT_TRUE(works || std::memcmp(before.data(), &to, sizeof(to)) == 0) << quincunx_last_error();
    return works;
  }

  template <typename Struct, typename Function>
  bool writes_sized(Sized<Struct>& to, const Function& function) {
    Struct* given = sized(to);
    return writes(to.value, [&](auto*) { return function(given); });
  }

  // A call that makes an object, or gives NULL.
  template <typename Objects, typename Function>
  void makes(Objects& objects, const Function& function) {
    auto* made = objects.any();
    const auto old = made;
    auto** to = or_null(&made);
    if (worked(function(to))) {
      ASSERT_NE(made, nullptr);
      objects.add(made);
    } else {
      EXPECT_EQ(made, to != nullptr ? nullptr : old);
    }
  }

  // Gives the struct another size now and then, or none at all.
  template <typename Struct>
  Struct* sized(Sized<Struct>& of) {
    constexpr std::size_t kNone[] = {
        0, 1, 4096 + 8, std::size_t{1} << 31, ~std::size_t{0} - 7, ~std::size_t{0}};
    std::size_t& size = of.value.struct_size;
    switch (random_.below(40)) {
      case 0:
        size = kNone[random_.next() % std::size(kNone)];
        break;
      case 1:
        size = random_.next() % sizeof(of);
        break;
      case 2:
        size = sizeof(of);
        of.beyond[1] = one_in(2) ? random_.next() : 0;
        break;
      case 3:
        return nullptr;
      default:
        break;
    }
    return &of.value;
  }

  // Overwrites some of the 4-byte numbers between two offsets with bits that are wrong for most.
  template <typename Struct>
  void spoil(Struct& of, std::size_t begin, std::size_t end = sizeof(Struct)) {
    for (int i = random_.below(4); i > 0; --i) {
      const std::size_t at = begin + 4 * (random_.next() % ((end - begin) / 4));
      const auto bits = one_in(2) ? wild_int(random_, 24) : std::bit_cast<int>(wild_float(1));
      std::memcpy(reinterpret_cast<unsigned char*>(&of) + at, &bits, sizeof(bits));
    }
  }

  Random random_;
  const char* name_ = "";
  std::map<std::string, std::array<int, 2>> counts_;  // of each name: how many worked, how many did not
};

}  // namespace quincunx::testing
