// SPDX-License-Identifier: MIT
#include "program_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "../tools/own_cache.h"

namespace quincunx {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKernel = "scale_point";
constexpr const char* kOptions = "-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT=HALF -D OUTPUT_FORMAT=FLOAT";

class ProgramCache : public ::testing::Test {
 protected:
  ProgramCache() : folder_(fs::temp_directory_path() / ("quincunx-cache-test-" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
  }
  ~ProgramCache() override { fs::remove_all(folder_); }

  std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    if (!fs::exists(folder_)) return found;
    for (const auto& entry : fs::directory_iterator(folder_))
      found.push_back(entry.path());
    return found;
  }

  // What one build did: {compiled, loaded}.
  CacheCounts build(const std::string& options = kOptions) const {
    const CacheCounts before = cache_counts();
    EXPECT_NE(build_kernel(impl_, kKernel, options)(), nullptr);
    const CacheCounts after = cache_counts();
    return {after.compiled - before.compiled, after.loaded - before.loaded};
  }

  fs::path folder_;
  testing::OwnCache cache_{folder_.string()};
  Device device_ = Device::open().value();
  Device::Impl impl_ = keeping_no_programs();

 private:
  Device::Impl keeping_no_programs() const {
    Device::Impl impl = *device_.impl();
    impl.keeps_programs = false;
    return impl;
  }
};

TEST_F(ProgramCache, CompilesOnceThenLoads) {
  const CacheCounts first = build();
  EXPECT_EQ(first.compiled, 1);
  EXPECT_EQ(first.loaded, 0);
  ASSERT_EQ(entries().size(), 1u);
  const CacheCounts second = build();
  EXPECT_EQ(second.compiled, 0);
  EXPECT_EQ(second.loaded, 1);
}

TEST_F(ProgramCache, OtherOptionsAreAnotherEntry) {
  build();
  EXPECT_EQ(build("-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT=FLOAT -D OUTPUT_FORMAT=FLOAT").compiled, 1);
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(ProgramCache, ADamagedEntryIsRebuiltAndReplaced) {
  build();
  const fs::path entry = entries().at(0);
  const auto size = fs::file_size(entry);
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{10}, size / 2}) {
    fs::resize_file(entry, kept);
    EXPECT_EQ(build().compiled, 1) << "cut to " << kept;
    EXPECT_EQ(fs::file_size(entry), size);
    EXPECT_EQ(build().loaded, 1);
  }
  {
    std::fstream file(entry, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file.write("damage", 6);
  }
  EXPECT_EQ(build().compiled, 1);
}

TEST_F(ProgramCache, AFolderThatCannotBeWrittenOnlyCostsTime) {
  const fs::path file = folder_.string() + "-file";
  std::ofstream(file) << "not a folder";
  cache_.use((file / "below").string());
  EXPECT_EQ(build().compiled, 1);
  EXPECT_EQ(build().compiled, 1);
  fs::remove(file);
}

TEST_F(ProgramCache, AnEmptyNameTurnsItOff) {
  cache_.use("");
  EXPECT_EQ(build().compiled, 1);
  EXPECT_EQ(build().compiled, 1);
  EXPECT_TRUE(entries().empty());
}

TEST_F(ProgramCache, ADriverThatKeepsItsProgramsGetsTheSource) {
  impl_.keeps_programs = true;
  EXPECT_EQ(build().compiled, 1);
  EXPECT_EQ(build().compiled, 1);
  EXPECT_TRUE(entries().empty());
}

TEST_F(ProgramCache, ABuildFailureShowsKernelOptionsAndLog) {
  try {
    build("-D SOURCE_FORMAT=NONSENSE");
    FAIL() << "a misspelt option must not compile";
  } catch (const BuildError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(kKernel), std::string::npos);
    EXPECT_NE(text.find("NONSENSE"), std::string::npos);
    EXPECT_NE(text.find("SOURCE_FORMAT must be"), std::string::npos) << text;
  }
}

TEST(KernelSource, ExpandsEachIncludeOnce) {
  const std::string source = kernel_source("resolve_quincunx");
  EXPECT_EQ(source.find("#include"), std::string::npos);
  const std::string guard = "typedef struct TexelLayout {";
  ASSERT_NE(source.find(guard), std::string::npos);
  EXPECT_EQ(source.find(guard), source.rfind(guard));
  EXPECT_THROW(kernel_source("no_such_kernel"), std::out_of_range);
}

}  // namespace
}  // namespace quincunx
