#include "tests/bench/command_program.h"
#include "tests/stress/commands.h"

namespace {

constexpr const char* kFooter =
    "Every run is the same again with the same seed. Exit code: 0 when all that is checked held, 1 when it "
    "did\n"
    "not, 2 for wrong usage.";

void addCommands(CLI::App& program, int, char**) {
  nearfit::stress::addScenesCommand(program);
  nearfit::stress::addHandCommand(program);
  nearfit::stress::addOracleCommand(program);
  nearfit::stress::addRestCommand(program);
  nearfit::stress::addLimitCommand(program);
  nearfit::stress::addHoursCommand(program);
}

}  // namespace

int main(int argc, char** argv) {
  return nearfit::bench::runProgram(
      {"nearfit-stress", "Looks for what breaks Nearfit, for as long as it is given.", kFooter, addCommands},
      argc, argv);
}
