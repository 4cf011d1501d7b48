// SPDX-License-Identifier: MIT
#include "cache_entry.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <xxhash.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace quincunx {

namespace fs = std::filesystem;

std::optional<fs::path> cache_folder() {
  if (const char* own = std::getenv("QUINCUNX_CACHE_DIR")) {
    return *own == '\0' ? std::nullopt : std::optional<fs::path>(own);
  }
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != '\0') {
    return fs::path(xdg) / "quincunx";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return fs::path(home) / ".cache" / "quincunx";
  }
  return std::nullopt;
}

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
  if (!write_whole_file(path, entry)) spdlog::debug("cache: cannot write {}", path.string());
}

}  // namespace quincunx
