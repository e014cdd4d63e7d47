#include "device/thread/realtime_thread.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace nearfit::realtime_thread_test {
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

TEST(AwakeProcessors, HoldTheRequestWhileTheyLive) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "latency";
  std::ofstream(file) << "";
  RealtimeGrant grant;
  {
    const AwakeProcessors awake(grant, file.c_str());
    EXPECT_TRUE(grant.areProcessorsAwake);
    // What the kernel reads: four bytes, microseconds.
    std::ifstream written(file, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), std::string(4, '\0'));
  }
  grant.priority = 70;
  EXPECT_EQ(grant.describe(), "SCHED_FIFO 70, processors kept awake");
}

TEST(AwakeProcessors, TellWhereTheyMayNotBeKeptSo) {
  RealtimeGrant grant;
  grant.priority = 70;
  grant.awakeError = EACCES;
  EXPECT_THAT(grant.describe(), AllOf(HasSubstr("may sleep (Permission denied"), HasSubstr("udev rules")));
}

/// Containers and other systems have none: nothing that the user could do about it.
TEST(AwakeProcessors, SayNothingWhereThereIsNoSuchRequest) {
  RealtimeGrant grant;
  const AwakeProcessors awake(grant, "/nowhere/latency");
  EXPECT_FALSE(grant.areProcessorsAwake);
  EXPECT_EQ(grant.awakeError, ENOENT);
  grant.priority = 70;
  EXPECT_EQ(grant.describe(), "SCHED_FIFO 70");
}

}  // namespace
}  // namespace nearfit::realtime_thread_test
