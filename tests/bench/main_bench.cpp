#include "tests/bench/command_program.h"
#include "tests/bench/commands.h"

namespace {

constexpr const char* kFooter =
    "Times of queries and ticks are of one thread. Exit code: 0 when all went well, 1 when it did not or\n"
    "methods disagree (a benchmark of different answers is void), 2 for wrong usage.";

void addCommands(CLI::App& program, int, char**) {
  nearfit::bench::addQueryCommand(program);
  nearfit::bench::addBuildCommand(program);
  nearfit::bench::addSceneCommand(program);
  nearfit::bench::addProgramCommand(program);
  nearfit::bench::addCheckCommand(program);
  nearfit::bench::addCertifyCommand(program);
  nearfit::bench::addPathCommand(program);
  nearfit::bench::addSuggestCommand(program);
  nearfit::bench::addVerdictsCommand(program);
  nearfit::bench::addFeelCommand(program);
  nearfit::bench::addErrorCommand(program);
  nearfit::bench::addPaperCommand(program);
  nearfit::bench::addSkipsCommand(program);
  nearfit::bench::addImportCommand(program);
}

}  // namespace

int main(int argc, char** argv) {
  const int code = nearfit::bench::runProgram(
      {"nearfit-bench", "Measures Nearfit's queries and hierarchies beside those of other libraries.",
       kFooter, addCommands},
      argc, argv);
  nearfit::bench::endProgram(code);
}
