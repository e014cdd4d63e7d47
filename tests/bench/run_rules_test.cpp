#include "tests/bench/run_rules.h"

#include <sstream>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench::run_rules_test {
namespace {

ProcessorTimes timesOf(const std::string& line) {
  std::istringstream stat(line);
  return readProcessorTimes(stat);
}

TEST(RunRules, CountsAsBusyAllButIdleAndWaiting) {
  const ProcessorTimes times = timesOf("cpu  1 2 4 100 200 8 16 32 1000 1000\ncpu0 9 9 9 9 9 9 9 9 9 9\n");
  EXPECT_EQ(times.busy, 63.0);
  EXPECT_EQ(times.all, 363.0);
}

TEST(RunRules, ReadsNothingFromALineThatIsNotOfAllProcessors) {
  EXPECT_EQ(timesOf("cpu0 1 2 3 4 5 6 7 8\n").all, 0.0);
  EXPECT_EQ(timesOf("cpu 1 2 three\n").all, 0.0);
  EXPECT_EQ(timesOf("").all, 0.0);
}

TEST(RunRules, TellsHowManyProcessorsWereAtWork) {
  EXPECT_DOUBLE_EQ(processorsAtWork({10.0, 100.0}, {60.0, 200.0}, 2.0), 1.0);
  EXPECT_EQ(processorsAtWork({10.0, 100.0}, {10.0, 100.0}, 2.0), 0.0);
  EXPECT_TRUE(isBusy(1.0));
  EXPECT_FALSE(isBusy(0.1));
}

TEST(RunRules, TakesFilesAmongTheSourcesButNotUnderBuildForCommit) {
  const test::TemporaryFolder folder;
  const auto& sources = folder.path();
  EXPECT_TRUE(isForCommit(sources / "tests" / "bench" / "results" / "feel.csv", sources));
  EXPECT_TRUE(isForCommit(sources / "build" / ".." / "tests" / "feel.csv", sources));
  EXPECT_FALSE(isForCommit(sources / "build" / "feel.csv", sources));
  EXPECT_FALSE(isForCommit(sources / ".." / "feel.csv", sources));
}

TEST(RunRules, RefusesForCommitWhatCannotBeRepeated) {
  const test::TemporaryFolder folder;
  const auto& sources = folder.path();
  const auto file = sources / "feel.csv";
  EXPECT_THROW(checkRepeatable(file, sources, "0123456789ab-dirty", 0.0, true), Error);
  EXPECT_THROW(checkRepeatable(file, sources, "unknown", 0.0, true), Error);
  EXPECT_THROW(checkRepeatable(file, sources, "0123456789ab", 1.0, false), Error);
  EXPECT_NO_THROW(checkRepeatable(file, sources, "0123456789ab", 1.0, true));
  EXPECT_NO_THROW(checkRepeatable(file, sources, "0123456789ab", 0.0, false));
}

TEST(RunRules, RefusesNothingForTheScreenOrElsewhere) {
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(checkRepeatable({}, folder.path(), "0123456789ab-dirty", 2.0, false));
  EXPECT_NO_THROW(
      checkRepeatable(folder.path() / "build" / "x.csv", folder.path(), "0123456789ab-dirty", 2.0, false));
}

}  // namespace
}  // namespace nearfit::bench::run_rules_test
