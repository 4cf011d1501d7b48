// SPDX-License-Identifier: MIT
#include "tools/program/work_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>

#include "tools/program/read_ahead.h"

namespace quincunx::tools {
namespace {

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

// What a job holds counts as long as it lives: `threads` run, `depth` wait, one is being handed over.
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

}  // namespace
}  // namespace quincunx::tools
