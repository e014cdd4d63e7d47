#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/report/clearance.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ClearanceOptions {
  std::string scene, part;
  std::optional<double> cutoff;
};

PartId chosenPart(const Scene& scene, const std::string& name) {
  if (name.empty()) {
    if (scene.movingPart()) return *scene.movingPart();
    throw UsageError("--part", "the scene has no moving part", "name one of its parts");
  }
  const Part* part = scene.findByName(name);
  if (part == nullptr)
    throw UsageError("--part", fmt::format("there is no part \"{}\"", name), "name one of the scene");
  return part->id;
}

void runClearance(const ClearanceOptions& options) {
  if (options.cutoff) checkPositive("--cutoff", *options.cutoff);
  const Scene scene = readSceneFile(options.scene);
  const PartId part = chosenPart(scene, options.part);
  const double cutoff = options.cutoff.value_or(scene.haptics().springs.cutoff);
  print(clearanceCsv(scene, part, clearancesOf(scene, part, cutoff)));
}

}  // namespace

void addClearanceCommand(CLI::App& program) {
  const auto options = std::make_shared<ClearanceOptions>();
  CLI::App* command = program.add_subcommand(
      "clearance", "Prints how near a part of a scene is to each other visible one, as CSV.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  command->add_option("--part", options->part, "The part; the moving one without it")->type_name("NAME");
  command->add_option("--cutoff", options->cutoff,
                      "Minima are counted within that [m]; the scene's without it");
  command->footer(
      "Columns: part, other, distance [m] (however far; 0 where they overlap), the points where it is, x y z "
      "of\n"
      "each [m] in the world frame, minima within the cutoff, every_minimum (0 where there are more than "
      "are\n"
      "looked for), overlap (decided exactly: no, surfaces meet, inside the other, the other inside).");
  command->callback([options] { runClearance(*options); });
}

}  // namespace nearfit::cli
