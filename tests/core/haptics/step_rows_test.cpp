#include "core/haptics/step_rows.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/step_problems.h"

namespace nearfit::step_rows_test {
namespace {

TEST(StepRows, TheLeastClearanceIsThatOfARowByRowSearchAtAnyNumberOfRows) {
  const StepVector y{0.3, -0.2, 0.1, 0.05, -0.4, 0.25};
  for (std::size_t rows = 1; rows <= 100; ++rows) {
    const test::StepProblem problem = test::makeStepProblem(test::StepProblemKind::Random, rows, rows);
    std::size_t row = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows; ++i) {
      const StepVector a = problem.rows.row(i);
      double clearance = 0.0;
      for (std::size_t k = 0; k < 6; ++k)
        clearance += a[k] * y[k];
      clearance += problem.rows.distance(i);
      if (clearance < least) {
        least = clearance;
        row = i;
      }
    }
    for (const SimdLevel level : availableSimdLevels()) {
      StepRows copy(rows, level);
      for (std::size_t i = 0; i < rows; ++i)
        ASSERT_TRUE(copy.add(problem.rows.row(i), problem.rows.distance(i)));
      const StepRows::Least found = copy.leastClearance(y);
      EXPECT_EQ(found.row, row) << static_cast<int>(level);
      EXPECT_EQ(found.clearance, least) << static_cast<int>(level);
    }
  }
}

TEST(StepRows, OfEqualRowsTheFirstCounts) {
  for (const SimdLevel level : availableSimdLevels()) {
    StepRows rows(40, level);
    for (int i = 0; i < 40; ++i)
      rows.add({1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, i < 19 ? 2.0 : 1.0);
    EXPECT_EQ(rows.leastClearance({}).row, 19u);
  }
}

TEST(StepRows, RowsOfBeforeClearDoNotCount) {
  StepRows rows(40);
  for (int i = 0; i < 40; ++i)
    rows.add({1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, -1.0);
  rows.clear();
  EXPECT_GT(rows.leastClearance({}).clearance, StepRows::kLargest);
  rows.add({0.0, 1.0, 0.0, 0.0, 0.0, 0.0}, 5.0);
  EXPECT_EQ(rows.leastClearance({}).clearance, 5.0);
}

TEST(StepRows, RefusesWhatIsNotANumberOrTooLargeOrTooMuch) {
  StepRows rows(1);
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        1e13};
  for (const double value : bad) {
    EXPECT_FALSE(rows.add({0.0, 0.0, 1.0, 0.0, 0.0, value}, 0.0));
    EXPECT_FALSE(rows.add({0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, value));
  }
  EXPECT_EQ(rows.size(), 0u);
  EXPECT_TRUE(rows.add({0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, 0.0));
  EXPECT_FALSE(rows.add({0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, 0.0));
  EXPECT_EQ(rows.size(), 1u);
}

}  // namespace
}  // namespace nearfit::step_rows_test
