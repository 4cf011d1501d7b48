// SPDX-License-Identifier: MIT
#include "tools/program/program.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <cstdio>
#include <ctime>
#include <exception>

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

}  // namespace

void set_up_log(bool quiet, int verbosity) {
  auto log = spdlog::stderr_color_mt("quincunx");
  log->set_pattern("%^%l:%$ %v");
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
  try {
    return run(argc, argv);
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
    if (height.ec == std::errc() && height.ptr == end && extent.width > 0 && extent.height > 0) return {};
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

}  // namespace quincunx::tools
