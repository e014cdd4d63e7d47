#include "core/realtime/spsc_queue.h"

#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace nearfit::spsc_queue_test {
namespace {

TEST(SpscQueue, AnEmptyOneGivesNothing) {
  SpscQueue<int, 4> queue;
  int value = 9;
  EXPECT_FALSE(queue.pop(value));
  EXPECT_EQ(value, 9);
}

TEST(SpscQueue, KeepsOrderThroughManyTurns) {
  SpscQueue<int, 4> queue;
  int next = 0;
  for (int i = 0; i < 100; i += 3) {
    for (int k = 0; k < 3; ++k)
      ASSERT_TRUE(queue.push(i + k));
    for (int value = 0; queue.pop(value);)
      EXPECT_EQ(value, next++);
  }
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(SpscQueue, AFullOneDropsTheNewestAndCountsIt) {
  SpscQueue<int, 4> queue;
  for (int i = 0; i < 4; ++i)
    EXPECT_TRUE(queue.push(i));
  EXPECT_FALSE(queue.push(4));
  EXPECT_FALSE(queue.push(5));
  EXPECT_EQ(queue.dropped(), 2U);
  int value = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(queue.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(queue.pop(value));
}

TEST(SpscQueue, EverythingPushedArrivesOnceInOrderAcrossThreads) {
  struct Item {
    std::uint64_t number, twice;
  };
  constexpr std::uint64_t kItems = 300000;
  SpscQueue<Item, 64> queue;
  std::thread producer([&queue] {
    for (std::uint64_t i = 0; i < kItems; ++i) {
      while (!queue.push({i, 2 * i}))
        std::this_thread::yield();
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < kItems; ++i) {
    Item item{};
    while (!queue.pop(item))
      std::this_thread::yield();
    wrong += item.number != i || item.twice != 2 * i ? 1 : 0;
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace nearfit::spsc_queue_test
