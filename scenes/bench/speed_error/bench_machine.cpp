// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_machine.h"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

namespace quincunx::bench {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string system_name() {
  utsname names{};
  return uname(&names) == 0 ? fmt::format("{} {} {}", names.sysname, names.release, names.machine)
                            : "unknown";
}

}  // namespace

void describe_machine(const scenes::FrameSource& source, Machine& machine) {
  machine.processor = processor_name();
  machine.processors = static_cast<int>(std::thread::hardware_concurrency());
  machine.memory_gib =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 30);
  machine.system = system_name();
  const DeviceInfo& cl = source.device().info();
  machine.cl_device = cl.name;
  machine.cl_platform = cl.platform;
  machine.cl_driver = cl.driver;
  machine.cl_version = cl.version;
  machine.cl_on_processor = cl.kind == DeviceKind::kCpu;
  const gl::ContextInfo& gl = source.context().info();
  machine.gl_renderer = gl.renderer;
  machine.gl_version = gl.version;
}

double load_of_last_minute() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

nlohmann::ordered_json json_of(const Machine& machine) {
  return {{"processor", machine.processor},     {"processors", machine.processors},
          {"system", machine.system},           {"cl_device", machine.cl_device},
          {"cl_platform", machine.cl_platform}, {"cl_driver", machine.cl_driver},
          {"gl_renderer", machine.gl_renderer}, {"gl_version", machine.gl_version},
          {"interop", machine.interop},         {"load_before", machine.load_before},
          {"load_after", machine.load_after}};
}

}  // namespace quincunx::bench
