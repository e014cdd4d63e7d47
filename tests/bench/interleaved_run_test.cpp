#include "tests/bench/interleaved_run.h"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::interleaved_run_test {
namespace {

/// Answers with the x of each pose, and writes its letter and that into a log.
class LoggingMethod : public QueryMethod {
 public:
  LoggingMethod(char letter, std::string& log) : letter_(letter), log_(log) {}
  Answer query(const RigidTransform& sceneFromPart) override {
    log_ += letter_ + std::to_string(static_cast<int>(sceneFromPart.translation.x)) + ' ';
    return {sceneFromPart.translation.x, 1, true};
  }

 private:
  char letter_;
  std::string& log_;
};

MethodEntry entryOf(char letter, AnswerKind kind, std::string& log) {
  return {std::string(1, letter), kind, "", 1e-9,
          [letter, &log](const PreparedScene&) { return std::make_unique<LoggingMethod>(letter, log); }};
}

/// Poses at x = 0, 1, 2, ...
std::vector<RigidTransform> pathOf(int count) {
  std::vector<RigidTransform> path(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    path[static_cast<std::size_t>(i)].translation.x = i;
  return path;
}

const PreparedScene& anyScene() {
  static const PreparedScene scene({"any", test::tetrahedronMesh(), test::tetrahedronMesh(), {}, {}}, 0.05);
  return scene;
}

TEST(RunInterleaved, MethodsTakeTurnsAndWarmUpOnThePosesBefore) {
  std::string log;
  const std::vector<MethodEntry> methods{entryOf('a', AnswerKind::FullSet, log),
                                         entryOf('b', AnswerKind::Distance, log)};
  RunOptions options;
  options.block = 2;
  options.warmUp = 1;
  const std::vector<MethodRun> runs = runInterleaved(methods, anyScene(), pathOf(4), options);
  EXPECT_EQ(log, "a0 a1 b0 b1 a1 a2 a3 b1 b2 b3 ");
  EXPECT_EQ(runs[0].times.size(), 4U);
  ASSERT_EQ(runs[1].answers.size(), 4U);
  EXPECT_EQ(runs[1].answers[3].distance, 3.0);
}

TEST(RunInterleaved, EachRoundBeginsWithTheNextMethod) {
  std::string log;
  const std::vector<MethodEntry> methods{entryOf('a', AnswerKind::FullSet, log),
                                         entryOf('b', AnswerKind::Distance, log)};
  RunOptions options;
  options.warmUp = 0;
  options.rounds = 2;
  const std::vector<MethodRun> runs = runInterleaved(methods, anyScene(), pathOf(2), options);
  EXPECT_EQ(log, "a0 a1 b0 b1 b0 b1 a0 a1 ");
  EXPECT_EQ(runs[0].times.size(), 4U);
  EXPECT_EQ(runs[0].answers.size(), 2U);
}

TEST(RunInterleaved, MethodsOfPairsAnswerEachSoManythPoseOfThePath) {
  std::string log;
  const std::vector<MethodEntry> methods{entryOf('p', AnswerKind::Pairs, log)};
  RunOptions options;
  options.block = 4;
  options.warmUp = 0;
  options.pairsStride = 3;
  const std::vector<MethodRun> runs = runInterleaved(methods, anyScene(), pathOf(10), options);
  EXPECT_EQ(runs[0].poses, (std::vector<std::size_t>{0, 3, 6, 9}));
}

TEST(RunInterleaved, TicksKeepQueriesApart) {
  std::string log;
  const std::vector<MethodEntry> methods{entryOf('a', AnswerKind::FullSet, log)};
  RunOptions options;
  options.period = 0.001;
  const auto start = std::chrono::steady_clock::now();
  runInterleaved(methods, anyScene(), pathOf(20), options);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(20));
}

TEST(RunInterleaved, AProcessorThatIsNotThereIsRefused) {
  std::string log;
  const std::vector<MethodEntry> methods{entryOf('a', AnswerKind::FullSet, log)};
  RunOptions options;
  options.cpu = 1023;
  EXPECT_THROW(runInterleaved(methods, anyScene(), pathOf(1), options), UsageError);
}

}  // namespace
}  // namespace nearfit::bench::interleaved_run_test
