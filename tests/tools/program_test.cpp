// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "temporary_folder.h"
#include "tools/program/atomic_file.h"
#include "tools/program/program.h"
#include "tools/program/work_queue.h"

namespace quincunx::tools {
namespace {

using testing::read_file;

TEST(AtomicFile, AppearsOnlyOnCommit) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("a.txt");
  Result<AtomicFile> file = AtomicFile::create(path);
  ASSERT_TRUE(file.ok()) << file.status().message();
  std::ofstream(file->temporary_path()) << "whole";
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(read_file(path), "whole");
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
  EXPECT_EQ(read_file(folder.file("a.txt")), "before");
}

// That a killed process leaves such a file behind is tested with quincunx-resolve, in resume_test.cpp.
TEST(AtomicFile, IsAbandonedWhereNobodyHoldsIt) {
  const testing::TemporaryFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder.file("a.0001.exr"));
  ASSERT_TRUE(file.ok());
  const std::filesystem::path part = file->temporary_path();
  std::ofstream(part) << "half";
  const auto any = [](const std::string&) { return true; };
  EXPECT_FALSE(remove_abandoned(part, any));
  const std::filesystem::path copy = folder.file(part.filename().string().replace(0, 2, ".b"));
  std::filesystem::copy_file(part, copy);
  EXPECT_FALSE(remove_abandoned(copy, [](const std::string& target) { return target != "b.0001.exr"; }));
  EXPECT_TRUE(remove_abandoned(copy, [](const std::string& target) { return target == "b.0001.exr"; }));
  EXPECT_FALSE(std::filesystem::exists(copy));
  std::ofstream(folder.file(".b.part")) << "another program's";
  EXPECT_FALSE(remove_abandoned(folder.file(".b.part"), any));
}

TEST(AtomicFile, IsNeverTakenForAbandonedWhileItIsMade) {
  const testing::TemporaryFolder folder;
  std::atomic<bool> done = false;
  std::thread remover([&] {
    while (!done) {
      std::error_code error;
      for (std::filesystem::directory_iterator entry(folder.file(""), error), end; !error && entry != end;
           entry.increment(error))
        remove_abandoned(entry->path(), [](const std::string&) { return true; });
    }
  });
  int lost = 0;
  for (int i = 0; i < 3000; ++i) {
    const Result<AtomicFile> file = AtomicFile::create(folder.file("a.txt"));
    if (!file.ok() || !std::filesystem::exists(file->temporary_path())) ++lost;
  }
  done = true;
  remover.join();
  EXPECT_EQ(lost, 0);
}

TEST(AtomicFile, MakesMissingFolders) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("one/two/a.txt");
  ASSERT_TRUE(write_text(path, "x").ok());
  EXPECT_EQ(read_file(path), "x");
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

TEST(AtomicFile, ANameMayBeAsLongAsTheSystemAllows) {
  const testing::TemporaryFolder folder;
  const std::string longest = folder.file(std::string(255, 'n'));
  ASSERT_TRUE(write_text(longest, "x").ok());
  EXPECT_EQ(read_file(longest), "x");
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_NE(write_text(folder.file(std::string(256, 'n')), "x").message().find("more than 255 bytes"),
            std::string::npos);
}

TEST(ReadText, NamesThePathAndTheReason) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_text(folder.file("plain"), "x\n").ok());
  EXPECT_EQ(read_text(folder.file("plain")).value(), "x\n");
  ASSERT_EQ(::mkfifo(folder.file("fifo").c_str(), 0600), 0);
  const std::pair<const char*, const char*> cases[] = {
      {"none", "there is no such file"},
      {".", "it is a folder"},
      {"fifo", "it is a pipe or a device; save it to a file first"}};
  for (const auto& [name, reason] : cases)
    EXPECT_EQ(read_text(folder.file(name)).error(), "'" + folder.file(name) + "' cannot be read: " + reason);
}

TEST(WorkQueue, OneThreadKeepsTheOrder) {
  std::vector<int> order;
  WorkQueue queue(1, 2);
  for (int i = 0; i < 20; ++i) {
    const Status pushed = queue.push([&order, i] {
      order.push_back(i);
      return Status();
    });
    ASSERT_TRUE(pushed.ok());
  }
  ASSERT_TRUE(queue.finish().ok());
  ASSERT_EQ(order.size(), 20u);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

// A job's contents count as long as the job lives: `threads` run, `depth` wait, one is being handed over.
TEST(WorkQueue, HoldsNoMoreJobsThanItsDepth) {
  constexpr int kThreads = 2;
  constexpr int kDepth = 3;
  static std::atomic<int> alive = 0;
  static std::atomic<int> most = 0;
  struct Counted {
    Counted() { most = std::max(most.load(), ++alive); }
    Counted(const Counted&) { ++alive; }
    ~Counted() { --alive; }
  };
  WorkQueue queue(kThreads, kDepth);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(queue.push([item = std::make_shared<Counted>()] { return Status(); }).ok());
  }
  ASSERT_TRUE(queue.finish().ok());
  EXPECT_LE(most, kThreads + kDepth + 1);
  EXPECT_EQ(alive, 0);
}

TEST(WorkQueue, TheFirstErrorStopsWhatFollows) {
  WorkQueue queue;
  std::promise<void> go;
  ASSERT_TRUE(queue
                  .push([&] {
                    go.get_future().wait();
                    return Status::io("first");
                  })
                  .ok());
  ASSERT_TRUE(queue.push([] { return Status::io("second"); }).ok());
  go.set_value();
  EXPECT_EQ(queue.finish().message(), "first");
  bool ran = false;
  EXPECT_EQ(queue
                .push([&] {
                  ran = true;
                  return Status();
                })
                .message(),
            "first");
  EXPECT_EQ(queue.finish().message(), "first");
  EXPECT_FALSE(ran);
}

// What leaves a thread ends the process.
TEST(WorkQueue, AJobThatThrowsIsAnError) {
  WorkQueue queue;
  ASSERT_TRUE(queue.push([]() -> Status { throw std::runtime_error("what a library said"); }).ok());
  EXPECT_EQ(queue.finish().message(), "work on another thread failed: what a library said");
  WorkQueue starved;
  ASSERT_TRUE(starved.push([]() -> Status { throw std::bad_alloc(); }).ok());
  EXPECT_EQ(starved.finish().message(), "out of memory");
}

TEST(ReadAhead, AReaderThatThrowsIsAnError) {
  ReadAhead<int> ahead(2, 1, 1, [](std::size_t index, int& item) -> Status {
    if (index == 0) throw std::runtime_error("what a library said");
    item = 7;
    return {};
  });
  EXPECT_EQ(ahead.take().status().message(), "work on another thread failed: what a library said");
  ahead.release();
  EXPECT_EQ(*ahead.take().value(), 7);
}

TEST(ReadAhead, GivesItemsInOrderWhateverTheThreads) {
  ReadAhead<std::size_t> ahead(100, 4, 5, [](std::size_t index, std::size_t& item) {
    item = index * index;
    return index % 10 == 7 ? Status::io("seven") : Status();
  });
  for (std::size_t i = 0; i < 100; ++i) {
    const auto item = ahead.take();
    ASSERT_EQ(item.ok(), i % 10 != 7);
    if (item.ok()) {
      EXPECT_EQ(*item.value(), i * i);
    }
    ahead.release();
  }
}

TEST(ReadAhead, NeverReadsFartherThanItsDepth) {
  constexpr std::size_t kDepth = 3;
  std::atomic<std::size_t> read = 0;
  ReadAhead<int> ahead(50, 2, kDepth, [&](std::size_t, int&) {
    ++read;
    return Status();
  });
  for (std::size_t taken = 0; taken < 50; ++taken) {
    ASSERT_TRUE(ahead.take().ok());
    EXPECT_LE(read, taken + kDepth);
    ahead.release();
  }
}

TEST(ReadAhead, MayBeLeftInTheMiddle) {
  ReadAhead<int> ahead(1000, 2, 4, [](std::size_t, int&) { return Status(); });
  ASSERT_TRUE(ahead.take().ok());
}

using Seconds = std::chrono::duration<double>;

TEST(Progress, SaysHowFarAndHowLong) {
  const std::string line = progress_line("rendering", 60, 240, Seconds(2.0), "0.71");
  EXPECT_EQ(line, "rendering  [######..................]  60/240   25 %  30 fps  0:06 left  0.71");
}

TEST(Progress, EstimatesOnlyAfterASecond) {
  const std::string line = progress_line("rendering", 1, 240, Seconds(0.5), "");
  EXPECT_EQ(line.find("left"), std::string::npos);
  EXPECT_NE(progress_line("rendering", 1, 7201, Seconds(1.0), "").find("2:00:00 left"), std::string::npos);
}

TEST(Progress, SurvivesOddCounts) {
  EXPECT_NE(progress_line("x", 0, 0, Seconds(5), "").find("0/0"), std::string::npos);
  EXPECT_NE(progress_line("x", 9, 3, Seconds(5), "").find("100 %"), std::string::npos);
}

TEST(Progress, IsSilentWithoutATerminal) {
  ::testing::internal::CaptureStderr();  // stderr is a file now
  {
    Progress progress("rendering", 10);
    EXPECT_FALSE(progress.visible());
    progress.update(1, "note");
    progress.clear();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace

}  // namespace quincunx::tools
