// SPDX-License-Identifier: MIT
#include "tools/program/atomic_file.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "temporary_folder.h"

namespace quincunx::tools {
namespace {

std::string content(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(AtomicFile, AppearsOnlyOnCommit) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("a.txt");
  Result<AtomicFile> file = AtomicFile::create(path);
  ASSERT_TRUE(file.ok()) << file.status().message();
  std::ofstream(file->temporary_path()) << "whole";
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(content(path), "whole");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_text(folder.file("a.txt"), "before").ok());
  {
    Result<AtomicFile> file = AtomicFile::create(folder.file("a.txt"));
    ASSERT_TRUE(file.ok());
    AtomicFile moved = std::move(file).value();
    std::ofstream(moved.temporary_path()) << "half";
    EXPECT_EQ(folder.entries(), 2);
  }
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_EQ(content(folder.file("a.txt")), "before");
}

TEST(AtomicFile, MakesMissingFolders) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("one/two/a.txt");
  ASSERT_TRUE(write_text(path, "x").ok());
  EXPECT_EQ(content(path), "x");
}

TEST(AtomicFile, NamesThePathAndTheReason) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_text(folder.file("plain"), "x").ok());
  for (const std::string& path : {folder.file("plain/below.txt"), folder.file("."), folder.file("x/")}) {
    const Status status = write_text(path, "y");
    EXPECT_EQ(status.code(), StatusCode::kIoFailure);
    EXPECT_NE(status.message().find(path), std::string::npos) << status.message();
  }
  EXPECT_NE(write_text(folder.file("plain/below.txt"), "y").message().find("folder"), std::string::npos);
}

}  // namespace
}  // namespace quincunx::tools
