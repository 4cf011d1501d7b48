// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

namespace quincunx::tools {

// The text with its ASCII capitals made small, whatever the locale. A header alone, so that every library may use it.
inline std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return text;
}

}  // namespace quincunx::tools
