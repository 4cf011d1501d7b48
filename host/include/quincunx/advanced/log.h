// SPDX-License-Identifier: MIT
// Log: the library's log lines.
//
// Failures are reported by Status. The log has the rest: the library's choices, missing parts, and failures in
// destructors, which cannot return them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "quincunx/advanced/export.h"

namespace quincunx {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError };

QUINCUNX_API const char* name_of(LogLevel level);  // "warning"

// Gets one line of UTF-8 without its end.
using LogCallback = std::function<void(LogLevel level, const std::string& message)>;

// Gives all lines of the process to `callback`, of every level. An empty one brings back the default: warnings and
// errors go to stderr, all else nowhere. May be called at any time from any thread, from the callback too. Any thread
// may call the callback, one at a time; after set_log() has returned no thread calls the old one. Messages logged from
// inside a callback are dropped; its exceptions are swallowed. It must not wait for another thread that uses the
// library.
QUINCUNX_API void set_log(LogCallback callback);

// Logs a line; line breaks in it become spaces.
QUINCUNX_API void log_line(LogLevel level, std::string message);

}  // namespace quincunx
