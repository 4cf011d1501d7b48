// SPDX-License-Identifier: MIT
// Log: where the library's lines go.
//
// Failures are told by Status. A line tells what else is worth knowing: what the library chose, what it does without,
// and what failed where nobody can be told, as in destructors.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "quincunx/advanced/export.h"

namespace quincunx {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError };

QUINCUNX_API const char* name_of(LogLevel level);  // "warning"

// `message`: one line of UTF-8 without its end.
using LogCallback = std::function<void(LogLevel level, const std::string& message)>;

// Gives all lines of the process to `callback`, whichever their level; an empty one brings back the default: warnings
// and errors go to stderr, all else nowhere. May be called at any time from any thread, from the callback too. The
// callback is called by whichever thread has something to say, by one at a time, and not any more once set_log() has
// returned, but where that was called from within it. Lines that come of what a callback does go nowhere, and so does
// what it throws. It must not wait for another thread that uses the library.
QUINCUNX_API void set_log(LogCallback callback);

// Says a line, as the library does; line breaks in it become spaces.
QUINCUNX_API void log_line(LogLevel level, std::string message);

}  // namespace quincunx
