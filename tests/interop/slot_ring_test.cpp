// SPDX-License-Identifier: MIT
#include "slot_ring.h"

#include <gtest/gtest.h>

namespace quincunx::gl {
namespace {

void run_frame(SlotRing& ring, int slot) {
  ASSERT_TRUE(ring.begin_draw(slot, {4, 4}).ok());
  ASSERT_TRUE(ring.submit(slot).ok());
  ASSERT_TRUE(ring.acquire(slot).ok());
}

TEST(SlotRing, HistoryIsHeldAndTheOneBeforeIsRetired) {
  SlotRing ring(3, {8, 8});
  run_frame(ring, 0);
  EXPECT_FALSE(ring.is_retired(0));
  run_frame(ring, 1);
  EXPECT_FALSE(ring.is_retired(0));
  EXPECT_FALSE(ring.is_retired(1));
  run_frame(ring, 2);
  EXPECT_TRUE(ring.is_retired(0));
  EXPECT_FALSE(ring.is_retired(1));
  EXPECT_FALSE(ring.is_retired(2));
}

TEST(SlotRing, AnyOrderOfSlotsKeepsHistory) {
  SlotRing ring(3, {8, 8});
  for (const int slot : {0, 2, 1, 0, 2})
    run_frame(ring, slot);
  EXPECT_FALSE(ring.is_retired(2));
  EXPECT_FALSE(ring.is_retired(0));
  EXPECT_TRUE(ring.is_retired(1));
}

TEST(SlotRing, TwoSlotsNeverRetire) {
  SlotRing ring(2, {8, 8});
  for (const int slot : {0, 1, 0, 1, 0}) {
    run_frame(ring, slot);
    EXPECT_FALSE(ring.is_retired(0));
    EXPECT_FALSE(ring.is_retired(1));
  }
}

TEST(SlotRing, ASlotThatIsDrawnAgainIsNotRetired) {
  SlotRing ring(3, {8, 8});
  for (const int slot : {0, 1, 2})
    run_frame(ring, slot);
  ASSERT_TRUE(ring.begin_draw(0, {4, 4}).ok());
  EXPECT_FALSE(ring.is_retired(0));
}

TEST(SlotRing, CallsOutOfTurnSayWhatComesFirst) {
  SlotRing ring(3, {8, 8});
  EXPECT_NE(ring.submit(1).message().find("begin_draw(1"), std::string::npos);
  EXPECT_NE(ring.acquire(1).message().find("submit(1)"), std::string::npos);
  ASSERT_TRUE(ring.begin_draw(1, {4, 4}).ok());
  EXPECT_FALSE(ring.acquire(1).ok());
  ASSERT_TRUE(ring.submit(1).ok());
  ASSERT_TRUE(ring.acquire(1).ok());
  EXPECT_FALSE(ring.acquire(1).ok());
}

TEST(SlotRing, BadSlotsAndViewportsAreNamed) {
  SlotRing ring(3, {8, 6});
  EXPECT_NE(ring.begin_draw(3, {4, 4}).message().find("slot is 3; it must be 0 to 2"), std::string::npos);
  EXPECT_EQ(ring.begin_draw(-1, {4, 4}).code(), StatusCode::kInvalidArgument);
  for (const Extent bad : {Extent{0, 4}, Extent{4, 0}, Extent{9, 6}, Extent{8, 7}, Extent{-1, -1}}) {
    const Status status = ring.begin_draw(0, bad);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("8x6"), std::string::npos) << status.message();
  }
  EXPECT_TRUE(ring.begin_draw(0, {8, 6}).ok());
}

}  // namespace
}  // namespace quincunx::gl
