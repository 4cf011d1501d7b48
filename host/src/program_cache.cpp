// SPDX-License-Identifier: MIT
#include "program_cache.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "cache_entry.h"
#include "embedded_kernels.h"

namespace quincunx {

// No -cl-finite-math-only: the kernels meet NaN and Inf on purpose, and as they are written it gains nothing.
const char* const kCommonBuildOptions = "-cl-std=CL1.2";

namespace {

namespace fs = std::filesystem;

std::atomic<int> g_compiled = 0;
std::atomic<int> g_loaded = 0;

std::string_view embedded(std::string_view name) {
  for (const EmbeddedFile& file : embedded_kernel_files()) {
    if (file.name == name) return file.text;
  }
  throw std::out_of_range(fmt::format("no embedded kernel file '{}'", name));
}

// The embedded file of a kernel, in whatever folder it lies.
std::string_view path_of(const std::string& kernel) {
  const std::string name = kernel + ".cl", in_folder = "/" + name;
  for (const EmbeddedFile& file : embedded_kernel_files()) {
    if (file.name == name || file.name.ends_with(in_folder)) return file.name;
  }
  throw std::out_of_range(fmt::format("no embedded kernel '{}'", kernel));
}

// Device compilers have no search path to our headers, so includes are expanded here.
void expand(std::string_view name, std::set<std::string>& seen, std::string& out) {
  if (!seen.insert(std::string(name)).second) return;
  std::istringstream lines{std::string(embedded(name))};
  int number = 1;
  out += fmt::format("#line 1 \"{}\"\n", name);
  for (std::string line; std::getline(lines, line); ++number) {
    constexpr std::string_view kInclude = "#include \"";
    if (line.starts_with(kInclude)) {
      expand(line.substr(kInclude.size(), line.rfind('"') - kInclude.size()), seen, out);
      out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    } else if (line != "#pragma once") {
      out += line + '\n';
    }
  }
}

std::optional<cl::Kernel> load(const Device::Impl& device, const fs::path& path, const std::string& name,
                               const std::string& options) {
  std::optional<std::vector<unsigned char>> binary = read_cache_entry(path);
  if (!binary) return std::nullopt;
  try {
    cl::Program program(device.context, {device.device}, cl::Program::Binaries{std::move(*binary)});
    program.build(device.device, options.c_str());
    return cl::Kernel(program, name.c_str());
  } catch (const cl::Error& error) {
    spdlog::debug("program cache: {} rejected ({}); rebuilding", path.string(), error_name(error.err()));
    return std::nullopt;
  }
}

cl::Program compile(const Device::Impl& device, const std::string& name, const std::string& source,
                    const std::string& options) {
  cl::Program program(device.context, source);
  const cl_device_id id = device.device();
  // Not by CLHPP, which asks for the log after any failure: where that fails too, it is all that one is told.
  const cl_int code = clBuildProgram(program(), 1, &id, options.c_str(), nullptr, nullptr);
  if (code == CL_SUCCESS) return program;
  if (code != CL_BUILD_PROGRAM_FAILURE) throw cl::Error(code, "clBuildProgram");
  throw BuildError(name, options, program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.device));
}

}  // namespace

BuildError::BuildError(const std::string& kernel, const std::string& options, const std::string& log)
    : std::runtime_error(
          fmt::format("kernel {} does not compile with options '{}':\n{}", kernel, options, log)) {}

std::string kernel_source(const std::string& name) {
  std::string source;
  std::set<std::string> seen;
  expand(path_of(name), seen, source);
  return source;
}

cl::Kernel build_kernel(const Device::Impl& device, const std::string& name, const std::string& options) {
  const std::string source = kernel_source(name);
  const std::string all_options = fmt::format("{} {}", kCommonBuildOptions, options);
  const std::optional<fs::path> folder = device.keeps_programs ? std::nullopt : cache_folder();
  const fs::path path =
      folder ? *folder / fmt::format("{}-{}.bin", name, cache_key(device, source, all_options)) : fs::path();
  if (folder) {
    if (std::optional<cl::Kernel> kernel = load(device, path, name, all_options)) {
      ++g_loaded;
      return *kernel;
    }
  }
  const cl::Program program = compile(device, name, source, all_options);
  ++g_compiled;
  if (folder) {
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    if (!binaries.empty() && !binaries.front().empty()) write_cache_entry(path, binaries.front());
  }
  return cl::Kernel(program, name.c_str());
}

CacheCounts cache_counts() {
  return {g_compiled, g_loaded};
}

}  // namespace quincunx
