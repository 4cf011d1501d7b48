// SPDX-License-Identifier: MIT
#include "quincunx/advanced/log.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <utility>

namespace quincunx {
namespace {

struct Log {
  std::recursive_mutex mutex;
  std::shared_ptr<const LogCallback> callback;
  bool calling = false;
};

// Lives for ever: destructors of other static objects have things to say.
Log& the_log() {
  static Log& log = *new Log;
  return log;
}

}  // namespace

const char* name_of(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return "debug";
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarning:
      return "warning";
    case LogLevel::kError:
      return "error";
  }
  return "unknown";
}

void set_log(LogCallback callback) {
  auto next = callback ? std::make_shared<const LogCallback>(std::move(callback)) : nullptr;
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  log.callback.swap(next);
}

void log_line(LogLevel level, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  if (log.calling) return;                                           // this thread is in the callback
  const std::shared_ptr<const LogCallback> callback = log.callback;  // which may replace itself
  if (!callback) {
    if (level >= LogLevel::kWarning)
      std::fprintf(stderr, "quincunx: %s: %s\n", name_of(level), message.c_str());
    return;
  }
  log.calling = true;
  try {
    (*callback)(level, message);
  } catch (...) {
  }
  log.calling = false;
}

}  // namespace quincunx
