#include "device/servo/realtime_thread.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nearfit {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(RealtimeGrant, TellsWhatWasGranted) {
  RealtimeGrant grant;
  grant.priority = 70;
  grant.isMemoryLocked = true;
  EXPECT_EQ(grant.describe(), "SCHED_FIFO 70, memory locked");
}

TEST(RealtimeGrant, TellsWhatWasRefusedAndWhatToDo) {
  RealtimeGrant grant;
  grant.schedulingError = grant.lockError = EPERM;
  EXPECT_THAT(grant.describe(),
              AllOf(HasSubstr("no SCHED_FIFO (Operation not permitted)"),
                    HasSubstr("memory not locked (Operation not permitted)"), HasSubstr("limits.d")));
}

/// `nearfit-cli devices --test` locks none, and said "memory not locked (Success)".
TEST(RealtimeGrant, SaysNothingOfMemoryThatNobodyAskedToLock) {
  RealtimeGrant grant;
  grant.priority = 70;
  EXPECT_EQ(grant.describe(), "SCHED_FIFO 70");
}

}  // namespace
}  // namespace nearfit
