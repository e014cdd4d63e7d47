#include "core/realtime/triple_buffer.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace nearfit::triple_buffer_test {
namespace {

TEST(TripleBuffer, ReaderSeesTheInitialValueUntilSomethingIsPublished) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 7);
}

TEST(TripleBuffer, ReaderGetsTheNewestOnce) {
  TripleBuffer<int> buffer(0);
  buffer.publish(1);
  buffer.publish(2);
  buffer.publish(3);
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front(), 3);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 3);
}

TEST(TripleBuffer, WritingLeavesTheReadersValueAlone) {
  TripleBuffer<int> buffer(0);
  buffer.publish(1);
  ASSERT_TRUE(buffer.update());
  const int& held = buffer.front();
  for (int i = 2; i < 20; ++i) {
    buffer.publish(i);
    EXPECT_EQ(held, 1);
  }
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front(), 19);
}

TEST(TripleBuffer, ValuesArriveWholeAndInOrderAcrossThreads) {
  using Block = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kLast = 200000;
  TripleBuffer<Block> buffer{Block{}};
  std::thread writer([&buffer] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      buffer.back().fill(i);
      buffer.publish();
    }
  });
  std::uint64_t newest = 0, torn = 0, backwards = 0;
  while (newest < kLast) {
    if (!buffer.update()) continue;
    const Block& block = buffer.front();
    for (const std::uint64_t value : block)
      torn += value != block[0] ? 1 : 0;
    backwards += block[0] <= newest ? 1 : 0;
    newest = block[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(backwards, 0U);
}

}  // namespace
}  // namespace nearfit::triple_buffer_test
