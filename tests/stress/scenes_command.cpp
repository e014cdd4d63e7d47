#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/stress/commands.h"
#include "tests/stress/stress_scene.h"
#include "tests/support/places.h"

namespace nearfit::stress {

void addScenesCommand(CLI::App& program) {
  CLI::App* command = program.add_subcommand("scenes", "Lists the scenes of the other commands");
  command->callback([] {
    for (const StressEntry& entry : stressScenes(test::sharedFolder()))
      fmt::print("{:<18} {}\n", entry.name, entry.description);
  });
}

}  // namespace nearfit::stress
