#include "tests/bench/import_run.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "tests/bench/import_load.h"
#include "tests/support/documents.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench::import_run_test {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

TEST(ImportRun, ReadsBackAsItWasWritten) {
  const ImportRun run{1.0 / 3.0, 0.25, true, {2, 3, 40, 60}, std::uint64_t{1} << 40, 5, 3};
  const ImportRun read = readImportRun(textOf(run));
  EXPECT_EQ(read.seconds, run.seconds);
  EXPECT_EQ(read.loadSeconds, run.loadSeconds);
  EXPECT_TRUE(read.isFromCache);
  EXPECT_EQ(read.counts, run.counts);
  EXPECT_EQ(read.ownPeakBytes, run.ownPeakBytes);
  EXPECT_EQ(read.importPeakBytes, run.importPeakBytes);
  EXPECT_EQ(read.besideImportBytes, run.besideImportBytes);
}

TEST(ImportRun, ThatOfOpenCascadeReadsBackAndItsTimeIsThatOfAllStages) {
  const OccRun run{"7.6.3", 0.5, 0.25, 2.0, {1, 300, 4000, 1'200'000}, 7};
  const OccRun read = readOccRun(textOf(run));
  EXPECT_EQ(read.version, "7.6.3");
  EXPECT_EQ(read.counts, run.counts);
  EXPECT_EQ(read.peakBytes, 7U);
  EXPECT_EQ(read.seconds(), 2.75);
}

TEST(ImportRun, AnotherTextIsAnError) {
  EXPECT_THROW(readImportRun("no run"), Error);
  EXPECT_THROW(readImportRun(""), Error);
  EXPECT_THROW(readImportRun("{}"), Error);
  EXPECT_THROW(readOccRun(textOf(ImportRun{})), Error);
}

TEST(ImportRun, PeaksAreOfThisProcessAndOfItsLargestChild) {
  constexpr std::size_t kMebibytes = 64, kChildMebibytes = 96;
  {
    const std::vector<char> filled(kMebibytes * kMebibyte, 'x');
    // Memory is there once it is read or written.
    EXPECT_EQ(std::ranges::count(filled, 'x'), std::ssize(filled));
    EXPECT_GE(peakResidentBytes(), filled.size());
  }
  // What was freed still counts.
  EXPECT_GE(peakResidentBytes(), kMebibytes * kMebibyte);
  const ::pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const std::vector<char> more(kChildMebibytes * kMebibyte, 'x');
    ::_exit(std::ranges::count(more, 'x') == std::ssize(more) ? 0 : 1);
  }
  int status = 1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_GE(peakChildBytes(), kChildMebibytes * kMebibyte);
}

TEST(LoadToFeel, CountsInstancesAndSharedTrianglesAndKnowsTheCache) {
  const test::TemporaryFolder folder, cache;
  const test::ScopedVariable variable("NEARFIT_CACHE", cache.path().string());
  const test::FakeImporter importer;
  const CadDocument vise = test::viseDocument();
  const std::size_t body = vise.shapes[0].triangles.size(), pin = vise.shapes[1].triangles.size();
  const std::filesystem::path file = folder.write("vise.step", "the vise");
  const ImportRun first = loadToFeel(file), second = loadToFeel(file);
  EXPECT_EQ(first.counts, (DocumentCounts{2, 3, body + pin, body + 2 * pin}));
  EXPECT_EQ(second.counts, first.counts);
  EXPECT_FALSE(first.isFromCache);
  EXPECT_TRUE(second.isFromCache);
  EXPECT_EQ(second.importPeakBytes, 0U);
  EXPECT_EQ(importer.runs(), 1);
  EXPECT_LE(first.loadSeconds, first.seconds);
  EXPECT_GE(first.ownPeakBytes, first.besideImportBytes);
}

TEST(LoadToFeel, ADocumentThatCannotBeReadIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(loadToFeel(folder.path() / "missing.step"), FileError);
}

}  // namespace
}  // namespace nearfit::bench::import_run_test
