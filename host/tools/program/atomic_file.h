// SPDX-License-Identifier: MIT
// AtomicFile: a file that appears under its name only when it is whole.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "quincunx/status.h"

namespace quincunx::tools {

// Makes missing folders, hands out a temporary name beside the final one, and renames on commit(); without
// commit() the destructor removes what was written. Move-only. Two processes may write the same path; the
// last commit stays.
class AtomicFile {
 public:
  // Errors: kIoFailure when the folder cannot be made or written, or `path` is there and no file.
  static Result<AtomicFile> create(const std::string& path);

  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;

  const std::string& temporary_path() const { return temporary_; }
  const std::string& path() const { return path_; }
  Status commit();  // errors: kIoFailure; the temporary file is then gone

 private:
  AtomicFile(std::string path, std::string temporary, int lock);
  void discard() noexcept;

  std::string path_;
  std::string temporary_;  // empty: nothing to remove
  int lock_;  // descriptor that holds the temporary file's lock, which ends with the process; -1: none
};

// Removes a temporary file that was meant to get a name which `wanted` accepts, if the process that left it behind is
// no longer there: it had the file locked. Sees other machines' processes where locks are shared. Returns whether the
// file was removed.
bool remove_abandoned(const std::filesystem::path& file,
                      const std::function<bool(const std::string&)>& wanted);

// Returns what AtomicFile::create() would say of the path, and leaves nothing behind.
Status try_to_write(const std::filesystem::path& path);

// Returns why a file cannot be read, in one sentence that names it: it is missing, a folder, a pipe or forbidden.
Status check_readable(const std::string& path);

// Returns the bytes of a file. Errors: as of check_readable().
Result<std::string> read_text(const std::string& path);

// Writes a text file whole or not at all. Errors: kIoFailure.
Status write_text(const std::string& path, std::string_view text);

}  // namespace quincunx::tools
