#include "tests/support/qt/qt_suite.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

namespace nearfit::test {
namespace {

std::map<std::string, QtSuiteMain>& suites() {
  static std::map<std::string, QtSuiteMain> all;
  return all;
}

int complain(const char* program) {
  std::fprintf(stderr, "usage: %s SUITE [OPTIONS of Qt Test...]\nThe suites:\n", program);
  for (const auto& [name, main] : suites())
    std::fprintf(stderr, "  %s\n", name.c_str());
  return EXIT_FAILURE;
}

}  // namespace

QtSuite::QtSuite(const char* file, QtSuiteMain main) {
  suites().emplace(std::filesystem::path(file).stem().string(), main);
}

int runQtSuite(int argc, char** argv) {
  const auto found = argc > 1 ? suites().find(argv[1]) : suites().end();
  if (found == suites().end()) return complain(argv[0]);
  argv[1] = argv[0];
  return found->second(argc - 1, argv + 1);
}

}  // namespace nearfit::test

int main(int argc, char** argv) {
  return nearfit::test::runQtSuite(argc, argv);
}
