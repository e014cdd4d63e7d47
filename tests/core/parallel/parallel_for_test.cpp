#include "core/parallel/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/parallel/shared_progress.h"
#include "tests/support/eventually.h"

namespace nearfit::parallel_for_test {
namespace {

TEST(ParallelFor, EachIndexIsWorkedOnOnce) {
  for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
    std::vector<std::atomic<int>> calls(count);
    parallelFor(count, [&](std::size_t i) { ++calls[i]; });
    EXPECT_TRUE(std::ranges::all_of(calls, [](const auto& n) { return n == 1; })) << count;
  }
}

TEST(ParallelFor, CallsWithinCallsUseNoMoreThreadsThanProcessors) {
  std::atomic<int> now{0}, most{0};
  parallelFor(8, [&](std::size_t) {
    parallelFor(50, [&](std::size_t) {
      const int running = ++now;
      int seen = most;
      while (running > seen && !most.compare_exchange_weak(seen, running)) {
      }
      std::this_thread::yield();
      --now;
    });
  });
  EXPECT_GE(most, 1);
  EXPECT_LE(most, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

int processorCount() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

TEST(ParallelFor, NobodyHelpsWhileAllProcessorsAreReserved) {
  const std::vector<ReservedProcessor> reserved(static_cast<std::size_t>(processorCount()));
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> calls{0}, helped{0};
  parallelFor(1000, [&](std::size_t) {
    ++calls;
    if (std::this_thread::get_id() != caller) ++helped;
  });
  EXPECT_EQ(calls, 1000);
  EXPECT_EQ(helped, 0);
}

TEST(ParallelFor, HelpersLeaveOnceTheirProcessorsAreReserved) {
  const std::thread::id caller = std::this_thread::get_id();
  const int helpers = processorCount() - 1;
  std::optional<std::vector<ReservedProcessor>> reserved;
  std::atomic<bool> isReserved{helpers == 0};
  std::once_flag once;
  std::atomic<int> calls{0}, helpedAfter{0};
  parallelFor(10'000, [&](std::size_t) {
    ++calls;
    if (std::this_thread::get_id() == caller) {
      // A helper comes, which was hired before the first call.
      EXPECT_TRUE(test::eventually([&] { return isReserved.load(); }));
      return;
    }
    if (isReserved) ++helpedAfter;
    std::call_once(once, [&] {
      reserved.emplace(static_cast<std::size_t>(processorCount()));
      isReserved = true;
    });
  });
  EXPECT_EQ(calls, 10'000);
  // Each helper that was hired may not have begun yet.
  EXPECT_LE(helpedAfter, helpers);
}

TEST(ParallelFor, ExceptionEndsTheWorkAndComesOut) {
  std::atomic<int> calls{0};
  const auto fail = [&](std::size_t i) {
    ++calls;
    if (i == 3) throw std::runtime_error("three");
  };
  EXPECT_THROW(parallelFor(1'000'000, fail), std::runtime_error);
  EXPECT_LT(calls, 1'000'000);
  // Threads that had been hired are free again.
  std::atomic<int> after{0};
  parallelFor(100, [&](std::size_t) { ++after; });
  EXPECT_EQ(after, 100);
}

TEST(SharedProgress, RisesToOneHoweverManyReport) {
  double last = 0.0;
  bool isBusy = false, wasTwoAtOnce = false;
  const ProgressCallback callback = [&](double fraction) {
    wasTwoAtOnce |= std::exchange(isBusy, true);
    EXPECT_GE(fraction, last);
    last = fraction;
    isBusy = false;
    return true;
  };
  SharedProgress progress(callback, 1000.0);
  parallelFor(1000, [&](std::size_t) { progress.add(1.0); });
  progress.add(0.0);
  EXPECT_EQ(last, 1.0);
  EXPECT_FALSE(wasTwoAtOnce);
}

TEST(SharedProgress, AllHearOnceThatItIsToStop) {
  int calls = 0;
  const ProgressCallback callback = [&](double fraction) {
    ++calls;
    return fraction < 0.5;
  };
  SharedProgress progress(callback, 10.0);
  int stopped = 0;
  for (int i = 0; i < 10; ++i) {
    try {
      progress.add(1.0);
    } catch (const Cancelled&) {
      ++stopped;
    }
  }
  EXPECT_EQ(stopped, 6);
  EXPECT_EQ(calls, 5);
}

}  // namespace
}  // namespace nearfit::parallel_for_test
