// SPDX-License-Identifier: MIT
#include "tools/program/date.h"

#include <fmt/chrono.h>

#include <ctime>

namespace quincunx::tools {

std::string date_now() {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
}

}  // namespace quincunx::tools
