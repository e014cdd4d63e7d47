#include <cstdio>
#include <exception>

#include "tests/bench/command_program.h"
#include "tests/bench/commands.h"

namespace {

constexpr const char* kFooter =
    "Times are of one thread. Exit code: 0 when all went well, 1 when it did not or methods disagree (a\n"
    "benchmark of different answers is void), 2 for wrong usage.";

int run(int argc, char** argv) {
  CLI::App program("Measures Nearfit's queries and hierarchies beside those of other libraries.");
  program.name("nearfit-bench");
  program.footer(kFooter);
  nearfit::bench::addQueryCommand(program);
  nearfit::bench::addBuildCommand(program);
  nearfit::bench::addSceneCommand(program);
  nearfit::bench::addProgramCommand(program);
  nearfit::bench::addCertifyCommand(program);
  nearfit::bench::addFeelCommand(program);
  nearfit::bench::addErrorCommand(program);
  nearfit::bench::addSkipsCommand(program);
  return nearfit::bench::runCommand(program, argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "nearfit-bench: %s\n", e.what());
    return 1;
  }
}
