// SPDX-License-Identifier: MIT
#include "tools/program/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace quincunx::tools {

namespace {

constexpr std::size_t kLongestFileName = 255;  // bytes

// Unique among processes (id) and threads (counter).
std::string temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string end = fmt::format(".{}-{}.part", ::getpid(), counter.fetch_add(1));
  // Where the whole name would be too long for a file system, its beginning stands for it.
  const std::string name = path.filename().string().substr(0, kLongestFileName - 1 - end.size());
  return (path.parent_path() / ("." + name + end)).string();
}

Status cannot_store(const std::string& path, const std::string& reason) {
  return Status::io(fmt::format("'{}' cannot be written: {}", path, reason));
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Returns the name in ".NAME.PROCESS-COUNT.part", as temporary_name() makes it. By hand, because <regex> compiles for
// seconds.
std::optional<std::string> target_in(const std::string& name) {
  constexpr std::string_view kEnd = ".part";
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return std::nullopt;
  const std::string_view text = std::string_view(name).substr(1, name.size() - 1 - kEnd.size());
  const std::size_t dot = text.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return std::nullopt;
  const std::string_view numbers = text.substr(dot + 1);
  const std::size_t dash = numbers.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  if (!is_number(numbers.substr(0, dash)) || !is_number(numbers.substr(dash + 1))) return std::nullopt;
  return std::string(text.substr(0, dot));
}

// Locks a new file, and returns whether it still has its name: remove_abandoned() of another process may have come in
// between. Where files cannot be locked none is taken for abandoned.
bool is_kept(int descriptor) {
  while (::flock(descriptor, LOCK_EX) != 0 && errno == EINTR) {
  }
  struct stat found = {};
  return ::fstat(descriptor, &found) == 0 && found.st_nlink > 0;
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  const std::filesystem::path target(path);
  std::error_code error;
  if (!target.has_filename()) return cannot_store(path, "the path names no file");
  if (std::filesystem::is_directory(target, error)) return cannot_store(path, "it is a folder");
  if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error))
    return cannot_store(path, "it is a device or a pipe; a file is written under another name and renamed");
  if (target.filename().string().size() > kLongestFileName)
    return cannot_store(path, fmt::format("its name has more than {} bytes", kLongestFileName));
  if (target.has_parent_path()) {
    std::filesystem::create_directories(target.parent_path(), error);
    if (error) {
      return cannot_store(path, fmt::format("folder '{}' cannot be made: {}", target.parent_path().string(),
                                            error.message()));
    }
  }
  // Opened once here so that a folder without write permission is reported before any work is done.
  for (;;) {
    std::string temporary = temporary_name(target);
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return cannot_store(path, std::strerror(errno));
    if (is_kept(descriptor)) return AtomicFile(path, std::move(temporary), descriptor);
    ::close(descriptor);
  }
}

AtomicFile::AtomicFile(std::string path, std::string temporary, int lock)
    : path_(std::move(path)), temporary_(std::move(temporary)), lock_(lock) {}

AtomicFile::~AtomicFile() {
  discard();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, std::string())),
      lock_(std::exchange(other.lock_, -1)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, std::string());
    lock_ = std::exchange(other.lock_, -1);
  }
  return *this;
}

Status AtomicFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) {
    discard();
    return cannot_store(path_, error.message());
  }
  temporary_.clear();
  discard();
  return {};
}

void AtomicFile::discard() noexcept {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
}

bool remove_abandoned(const std::filesystem::path& file,
                      const std::function<bool(const std::string&)>& wanted) {
  const auto target = target_in(file.filename().string());
  if (!target || !wanted(*target)) return false;
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  // Under the lock, so that whoever makes the file at this moment sees that it has gone.
  const bool removed = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::unlink(file.c_str()) == 0;
  ::close(descriptor);
  return removed;
}

Status try_to_write(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path first_made;
  for (auto folder = path.parent_path(); !folder.empty() && !std::filesystem::exists(folder, error);
       folder = folder.parent_path()) {
    first_made = folder;
  }
  const Status status = AtomicFile::create(path.string()).status();
  if (first_made.empty()) return status;
  for (auto folder = path.parent_path();; folder = folder.parent_path()) {
    std::filesystem::remove(folder, error);  // only where it is empty
    if (folder == first_made) return status;
  }
}

Status check_readable(const std::string& path) {
  const auto bad = [&path](const std::string& reason) {
    return Status::io(fmt::format("'{}' cannot be read: {}", path, reason));
  };
  std::error_code error;
  const auto file = std::filesystem::status(path, error);
  if (!std::filesystem::exists(file))
    return bad(std::filesystem::status_known(file) ? "there is no such file" : error.message());
  if (std::filesystem::is_directory(file)) return bad("it is a folder");
  if (!std::filesystem::is_regular_file(file))
    return bad("it is a pipe or a device; save it to a file first");
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return bad(std::strerror(errno));
  ::close(descriptor);
  return {};
}

Result<std::string> read_text(const std::string& path) {
  if (Status status = check_readable(path); !status.ok()) return status;
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) return Status::io(fmt::format("'{}' cannot be read: {}", path, std::strerror(errno)));
  return text;
}

Status write_text(const std::string& path, std::string_view text) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) return file.status();
  std::FILE* stream = std::fopen(file->temporary_path().c_str(), "wb");
  if (stream == nullptr) return cannot_store(path, std::strerror(errno));
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const int write_error = errno;
  // fclose() is where a full disk shows for a short file.
  if (std::fclose(stream) != 0) return cannot_store(path, std::strerror(errno));
  if (!written) return cannot_store(path, std::strerror(write_error));
  return file->commit();
}

}  // namespace quincunx::tools
