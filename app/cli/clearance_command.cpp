#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "app/cli/scene_part.h"
#include "core/report/clearance.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ClearanceOptions {
  std::string scene, part;
  std::optional<double> cutoff;
};

void runClearance(const ClearanceOptions& options) {
  if (options.cutoff) checkPositive("--cutoff", *options.cutoff);
  const Scene scene = readSceneFile(options.scene);
  const bool isGroup = options.part.empty() && scene.movingGroup();
  const std::vector<PartId> body =
      isGroup ? scene.movingParts() : std::vector{chosenPart(scene, options.part)};
  const double cutoff = options.cutoff.value_or(scene.haptics().springs.cutoff);
  const std::string rows = clearanceCsv(scene, clearancesOf(scene, body, cutoff));
  printCacheWarnings();
  print(rows);
}

}  // namespace

void addClearanceCommand(CLI::App& program) {
  const auto options = std::make_shared<ClearanceOptions>();
  CLI::App* command = program.add_subcommand(
      "clearance", "Prints the clearance between a part and each other visible part, as CSV.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("--part", options->part, "Name of the part; default: the moving part or group")
      ->type_name("NAME");
  command->add_option("--cutoff", options->cutoff,
                      "Count minima within this distance [m]; default: the scene's cutoff");
  command->footer(
      "Columns, whose header names the unit of lengths: part, of a group the nearest one; other; distance\n"
      "[m] (not limited by the cutoff; 0 if they overlap); the nearest points of the two, x y z each [m] in\n"
      "the world frame; minima, their number within the cutoff; every_minimum (0 if there are more than are\n"
      "looked for); overlap, decided exactly (no, surfaces meet, inside the other, the other inside);\n"
      "distance_bound, 0: the distance is exact.");
  command->callback([options] { runClearance(*options); });
}

}  // namespace nearfit::cli
