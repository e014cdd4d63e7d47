#pragma once

#include <QApplication>
#include <QtTest>

/// One program holds the Qt Test suites of a folder; a run takes one of them, in a process of its own:
/// `ui_tests SUITE [OPTIONS...]`. A suite has the name of its source file, without the suffix.
namespace nearfit::test {

/// Main function of a suite; `argv` holds no suite name.
using QtSuiteMain = int (*)(int argc, char** argv);

/// Adds a suite to the program that it is linked into. Constructed before main, by NEARFIT_QT_SUITE.
class QtSuite {
 public:
  QtSuite(const char* file, QtSuiteMain main);
};

/// Runs the test functions of `Test` as QTEST_MAIN and, with QCoreApplication, QTEST_GUILESS_MAIN do.
template <class Test, class Application = QApplication>
int runQtTest(int argc, char** argv) {
  Application application(argc, argv);
  QCoreApplication::setAttribute(Qt::AA_Use96Dpi);
  Test test;
  return QTest::qExec(&test, argc, argv);
}

}  // namespace nearfit::test

/// @param Test  The class of the tests.
/// @param ...   Its main: a QtSuiteMain.
#define NEARFIT_QT_SUITE(Test, ...) static const nearfit::test::QtSuite Test##Suite(__FILE__, __VA_ARGS__);
