#pragma once

#include <QtTest>

/// QTRY_VERIFY and its like wait as long as other tests do (eventually.h), not five seconds: time decides no
/// test, however loaded the machine is.
namespace nearfit::test {
constexpr int kQtPatienceMs = 60'000;
}

#undef QTRY_VERIFY
#undef QTRY_VERIFY2
#undef QTRY_COMPARE
#define QTRY_VERIFY(condition) QTRY_VERIFY_WITH_TIMEOUT((condition), nearfit::test::kQtPatienceMs)
#define QTRY_VERIFY2(condition, message) \
  QTRY_VERIFY2_WITH_TIMEOUT((condition), message, nearfit::test::kQtPatienceMs)
#define QTRY_COMPARE(actual, expected) \
  QTRY_COMPARE_WITH_TIMEOUT((actual), (expected), nearfit::test::kQtPatienceMs)
