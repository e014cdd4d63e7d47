#include "tests/bench/command_program.h"
#include "tests/stress/commands.h"

namespace {

constexpr const char* kFooter =
    "Every run is the same again with the same seed. Exit code: 0 when all that is checked held, 1 when it "
    "did\n"
    "not, 2 for wrong usage.";

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Looks for what breaks Nearfit, for as long as it is given.");
  program.name("nearfit-stress");
  program.footer(kFooter);
  nearfit::stress::addScenesCommand(program);
  nearfit::stress::addHandCommand(program);
  nearfit::stress::addOracleCommand(program);
  nearfit::stress::addRestCommand(program);
  nearfit::stress::addLimitCommand(program);
  nearfit::stress::addHoursCommand(program);
  return nearfit::bench::runCommand(program, argc, argv);
}
