// SPDX-License-Identifier: MIT
#include "tools/program/program.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

#include "quincunx/advanced/device_profile.h"
#include "quincunx/advanced/log.h"
#include "quincunx/device.h"

namespace quincunx::tools {
namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

// %*: the message, as printable() has it.
class PrintableFlag : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string text = printable({message.payload.data(), message.payload.size()});
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<PrintableFlag>();
  }
};

constexpr char kNoMemory[] =
    "there is too little memory, or there are too many threads; allow more (ulimit -v, -u), or ask for "
    "smaller pictures";

int no_memory() {
  std::fprintf(stderr, "error: %s\n", kNoMemory);
  return kFailed;
}

// Drivers, and the compiler within them, abort where they have no memory.
void end_in_a_sentence(int) {
  constexpr char kBegin[] = "error: a library gave up, most likely as ";
  for (const std::string_view text :
       {std::string_view(kBegin), std::string_view(kNoMemory), std::string_view("\n")}) {
    if (::write(STDERR_FILENO, text.data(), text.size()) < 0) break;
  }
  ::_exit(kFailed);
}

constexpr int kBarWidth = 24;
constexpr double kEstimateAfterSeconds = 1.0;
constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr const char* kEraseLine = "\r\033[K";

std::string minutes_and_seconds(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

bool has_plain_terminal() {
  const char* terminal = std::getenv("TERM");
  return terminal != nullptr && std::string_view(terminal) == "dumb";
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto code = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    const bool second_set = code == 0xc2 && next >= 0x80 && next < 0xa0;  // U+0080 to U+009F
    if (second_set) {
      out += fmt::format("\\x{:02x}", next);
      ++i;
    } else if ((code < 0x20 && code != '\n' && code != '\t') || code == 0x7f) {
      out += fmt::format("\\x{:02x}", code);
    } else {
      out += text[i];
    }
  }
  return out;
}

void set_up_log(bool quiet, int verbosity) {
  const char* no_color = std::getenv("NO_COLOR");
  const bool plain = has_plain_terminal() || (no_color != nullptr && *no_color != '\0');
  auto log =
      spdlog::stderr_color_mt("quincunx", plain ? spdlog::color_mode::never : spdlog::color_mode::automatic);
  auto pattern = std::make_unique<spdlog::pattern_formatter>();
  pattern->add_flag<PrintableFlag>('*').set_pattern("%^%l:%$ %*");
  log->set_formatter(std::move(pattern));
  log->set_level(quiet            ? spdlog::level::err
                 : verbosity > 1  ? spdlog::level::trace
                 : verbosity == 1 ? spdlog::level::debug
                                  : spdlog::level::info);
  spdlog::set_default_logger(log);
  set_log([](LogLevel level, const std::string& message) { spdlog::log(spdlog_level(level), message); });
}

int fail(const Status& status) {
  spdlog::error("{}", status.message());
  return status.code() == StatusCode::kInvalidArgument ? kUsage : kFailed;
}

int run_program(const char* program, int (*run)(int argc, char** argv), int argc, char** argv) {
  // Where memory has no limit, an abort is a fault, and a debugger's.
  struct rlimit addresses = {};
  if (::getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur != RLIM_INFINITY) {
    std::set_terminate([] { std::abort(); });  // without a text of its own
    std::signal(SIGABRT, end_in_a_sentence);
  }
  try {
    const int code = run(argc, argv);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    std::fprintf(stderr, "error: standard output cannot be written: %s\n", std::strerror(errno));
    return code == kDone ? kFailed : code;
  } catch (const std::system_error& error) {
    const bool output = std::ferror(stdout) != 0;  // fmt throws where it cannot print
    if (!output && error.code() == std::errc::resource_unavailable_try_again) return no_memory();
    std::fprintf(stderr, "error: %s%s\n", output ? "standard output cannot be written: " : "internal error: ",
                 output ? error.code().message().c_str() : error.what());
    return kFailed;
  } catch (const std::bad_alloc&) {
    return no_memory();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: internal error: %s\n", program, error.what());
    return kFailed;
  }
}

std::string parse_extent(const std::string& text, Extent& extent) {
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, extent.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, extent.height);
    if (height.ec == std::errc() && height.ptr == end && extent.width > 0 && extent.height > 0) {
      if (std::max(extent.width, extent.height) <= kLargestSide) return {};
      return fmt::format("'{}' is too large; both sides must lie in [1, {}]", text, kLargestSide);
    }
  }
  return fmt::format("'{}' is no size; write WIDTHxHEIGHT, for example 1280x720", text);
}

void print_opencl_devices() {
  const std::vector<DeviceInfo> devices = Device::list();
  for (const DeviceInfo& device : devices) {
    fmt::print("OpenCL {}  {} ({}, {})\n          {} units, {:.1f} GiB{}{}\n", device.index, device.name,
               device.platform, device.driver, device.compute_units,
               static_cast<double>(device.global_memory_bytes) / (1 << 30), device.images ? ", images" : "",
               device.gl_sharing ? ", GL sharing advertised" : "");
  }
  if (devices.empty()) fmt::print("OpenCL    no device\n");
}

std::string command_line_text(const std::string& program, int argc, const char* const* argv) {
  std::string line = program;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain = !word.empty() && word.find_first_of(" \t'\"%#*?$&;()<>|") == std::string::npos;
    line += plain ? " " + word : " '" + word + "'";
  }
  return line;
}

std::string date_now() {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
}

std::string device_lines(const Result<Device>& device) {
  if (!device.ok()) return fmt::format("Device         none: {}\n", device.status().message());
  const DeviceInfo& info = device.value().info();
  return fmt::format("Device         {}, {} {}\nProfile        {}\n", info.name, info.platform, info.driver,
                     device.value().profile().describe());
}

std::string progress_line(const std::string& what, std::int64_t done, std::int64_t total,
                          std::chrono::duration<double> elapsed, const std::string& note) {
  const double part =
      total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(part * kBarWidth);
  std::string line = fmt::format("{}  [{}{}]  {}/{}  {:3.0f} %", what, std::string(filled, '#'),
                                 std::string(kBarWidth - filled, '.'), done, total, part * 100);
  if (elapsed.count() >= kEstimateAfterSeconds && done > 0) {
    const double rate = static_cast<double>(done) / elapsed.count();
    const double left = static_cast<double>(std::max<std::int64_t>(total - done, 0)) / rate;
    line += fmt::format("  {:.{}f} fps  {} left", rate, rate < 10 ? 1 : 0, minutes_and_seconds(left));
  }
  if (!note.empty()) line += "  " + note;
  return line;
}

Progress::Progress(std::string what, std::int64_t total, Show show)
    : what_(std::move(what)),
      total_(total),
      visible_(show == Show::kOnTerminal && ::isatty(STDERR_FILENO) == 1 && !has_plain_terminal()),
      start_(Clock::now()),
      last_draw_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::update(std::int64_t done, const std::string& note) {
  if (!visible_) return;
  const Clock::time_point now = Clock::now();
  if (drawn_ && now - last_draw_ < kRedrawInterval) return;
  last_draw_ = now;
  drawn_ = true;
  fmt::print(stderr, "{}{}", kEraseLine, progress_line(what_, done, total_, now - start_, note));
  std::fflush(stderr);
}

void Progress::clear() {
  if (!visible_ || !drawn_) return;
  fmt::print(stderr, "{}", kEraseLine);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace quincunx::tools
