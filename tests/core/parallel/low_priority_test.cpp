#include "core/parallel/low_priority.h"

#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace nearfit {
namespace {

int niceOfThread() {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
}

TEST(ThreadPriority, IsLoweredForTheThreadAndThoseThatItStartsAndNeverRaised) {
  const int own = niceOfThread();
  int background = -1, inherited = -1, lowest = -1, after = -1;
  std::thread([&] {
    lowerThreadPriority(ThreadPriority::Background);
    background = niceOfThread();
    std::thread([&] { inherited = niceOfThread(); }).join();
    lowerThreadPriority(ThreadPriority::Lowest);
    lowest = niceOfThread();
    lowerThreadPriority(ThreadPriority::Background);
    after = niceOfThread();
  }).join();
  EXPECT_GE(background, own);
  EXPECT_GE(background, 10);
  EXPECT_EQ(inherited, background);
  EXPECT_EQ(lowest, 19);
  EXPECT_EQ(after, 19);
  EXPECT_EQ(niceOfThread(), own);
}

}  // namespace
}  // namespace nearfit
