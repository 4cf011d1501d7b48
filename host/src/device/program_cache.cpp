// SPDX-License-Identifier: MIT
#include "device/program_cache.h"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "embedded_kernel_files.h"
#include "quincunx/advanced/log.h"

namespace quincunx {

// No -cl-finite-math-only: the kernels meet NaN and Inf on purpose, and as they are written it gains nothing.
// No warnings (-w), which a driver may print to the program's stderr; the build has shown them (kernels/cmake).
const char* const kCommonBuildOptions = "-cl-std=CL1.2 -w";

namespace fs = std::filesystem;

std::string cache_key(const Device::Impl& device, const std::string& source, const std::string& options) {
  const std::string text = fmt::format("{}\n{}\n{}\n{}\n{}\n{}", options, device.info.platform,
                                       device.info.name, device.info.version, device.info.driver, source);
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

// An entry is the XXH3 of its bytes (16 hex digits) followed by the bytes, so that a torn or damaged file
// is noticed before the driver sees it.
std::optional<std::vector<unsigned char>> read_cache_entry(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  constexpr std::size_t kDigits = 16;
  if (bytes.size() <= kDigits) return std::nullopt;
  const std::string stated(bytes.begin(), bytes.begin() + kDigits);
  bytes.erase(bytes.begin(), bytes.begin() + kDigits);
  if (stated != fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()))) return std::nullopt;
  return bytes;
}

bool write_whole_file(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  // Several processes may write the same file at once: each writes its own, the last rename wins.
  const fs::path temporary = path.string() + fmt::format(".{}", getpid());
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) {
      file.close();
      fs::remove(temporary, error);
      return false;
    }
  }
  fs::rename(temporary, path, error);
  if (!error) return true;
  fs::remove(temporary, error);
  return false;
}

void write_cache_entry(const fs::path& path, const std::vector<unsigned char>& bytes) {
  std::string entry = fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
  entry.append(bytes.begin(), bytes.end());
  if (!write_whole_file(path, entry))
    log_line(LogLevel::kDebug, fmt::format("cache: cannot write {}", path.string()));
}

namespace {

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

std::optional<cl::Program> load(const Device::Impl& device, const fs::path& path, const std::string& name,
                                const std::string& options) {
  std::optional<std::vector<unsigned char>> binary = read_cache_entry(path);
  if (!binary) return std::nullopt;
  try {
    cl::Program program(device.context, {device.device}, cl::Program::Binaries{std::move(*binary)});
    program.build(device.device, options.c_str());
    cl::Kernel(program, name.c_str());  // which a damaged program may lack
    return program;
  } catch (const cl::Error& error) {
    log_line(LogLevel::kDebug, fmt::format("program cache: {} rejected ({}); rebuilding", path.string(),
                                           error_name(error.err())));
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

// Takes the program from disk, or compiles it.
cl::Program make_program(const Device::Impl& device, const std::string& name, const std::string& options) {
  const std::string source = kernel_source(name);
  const std::optional<fs::path> folder = device.keeps_programs ? std::nullopt : cache_folder();
  const fs::path path =
      folder ? *folder / fmt::format("{}-{}.bin", name, cache_key(device, source, options)) : fs::path();
  if (folder) {
    if (std::optional<cl::Program> program = load(device, path, name, options)) {
      ++g_loaded;
      return *program;
    }
  }
  const cl::Program program = compile(device, name, source, options);
  ++g_compiled;
  if (folder) {
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    if (!binaries.empty() && !binaries.front().empty()) write_cache_entry(path, binaries.front());
  }
  return program;
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
  const std::string all_options =
      fmt::format("{} -D LANES={} {}", kCommonBuildOptions, device.lanes, options);
  const std::string key = fmt::format("{} {}", name, all_options);
  BuiltPrograms& built = *device.built;
  {
    const std::lock_guard lock(built.mutex);
    if (const auto found = built.programs.find(key); found != built.programs.end())
      return cl::Kernel(found->second, name.c_str());
  }
  const cl::Program program = make_program(device, name, all_options);
  cl::Kernel kernel(program, name.c_str());
  const std::lock_guard lock(built.mutex);
  built.programs.emplace(key, program);
  return kernel;
}

CacheCounts cache_counts() {
  return {g_compiled, g_loaded};
}

}  // namespace quincunx
