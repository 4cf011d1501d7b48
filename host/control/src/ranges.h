// SPDX-License-Identifier: MIT
// Ranges: checks that fields lie in their ranges, and keeps a sentence about the first that does not.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"

namespace quincunx {

enum class Ends : std::uint8_t { kClosed, kOpenLow, kOpenHigh };

class Ranges {
 public:
  template <typename Number>
  void lies_in(const char* field, Number value, std::type_identity_t<Number> low,
               std::type_identity_t<Number> high, Ends ends = Ends::kClosed) {
    const bool is_end =
        (ends == Ends::kOpenLow && value == low) || (ends == Ends::kOpenHigh && value == high);
    if (value >= low && value <= high && !is_end) return;
    refuse(fmt::format("{} is {}; it must lie in {}{}, {}{}", field, value,
                       ends == Ends::kOpenLow ? '(' : '[', low, high, ends == Ends::kOpenHigh ? ')' : ']'));
  }

  template <typename Number>
  void at_least(const char* field, Number value, std::type_identity_t<Number> low) {
    constexpr bool kWhole = std::is_integral_v<Number>;
    if (value >= low && std::isfinite(static_cast<double>(value))) return;
    refuse(fmt::format("{} is {}; it must be {}at least {}", field, value, kWhole ? "" : "finite and ", low));
  }

  // Both sides lie in [1, most]; `most` 0: they have no bound.
  void sides_of(const char* field, Extent extent, int most = 0) {
    if (extent.width >= 1 && extent.height >= 1 &&
        (most == 0 || (extent.width <= most && extent.height <= most)))
      return;
    refuse(fmt::format("{} is {}x{}; both sides must {}", field, extent.width, extent.height,
                       most == 0 ? "be at least 1" : fmt::format("lie in [1, {}]", most)));
  }

  const Status& status() const { return status_; }

 private:
  void refuse(std::string sentence) {
    if (status_.ok()) status_ = Status::invalid(std::move(sentence));
  }

  Status status_;
};

}  // namespace quincunx
