// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace quincunx::tools {

// Bytes as text (RFC 4648, with padding), as pages carry pictures.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace quincunx::tools
