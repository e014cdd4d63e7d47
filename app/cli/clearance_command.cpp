#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "app/cli/scene_check_run.h"
#include "app/cli/scene_part.h"
#include "core/report/clearance.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

struct ClearanceOptions {
  std::string scene, part;
  std::optional<double> cutoff;
  bool isAll = false;
  std::shared_ptr<SceneCheckOptions> check = std::make_shared<SceneCheckOptions>();
};

constexpr const char* kClearanceFooter =
    "Columns, whose header names the unit of lengths: part, of a group the nearest one; other; distance\n"
    "[m] (not limited by the cutoff; 0 if they overlap); the nearest points of the two, x y z each [m] in\n"
    "the world frame; minima, their number within the cutoff; every_minimum (0 if there are more than are\n"
    "looked for); overlap, decided exactly (no, surfaces meet, inside the other, the other inside);\n"
    "distance_bound, 0: the distance is exact.\n"
    "With --all, a table of all pairs of visible parts within the threshold, the worst first, and a line\n"
    "that counts them. Verdicts are exact: near, touching (within a millionth of the smaller part, at most\n"
    "1 um), clash, contained (one is inside the other). Of the latter two the depth, the least translation\n"
    "known to free them (the least of all for convex bodies, else \"<=\"), and the volume that they share.\n"
    "Rules of the scene count after those given here. A and B are names, or patterns with * and ?; a\n"
    "backslash takes the next character as it is. A press fit allows a clash whose surfaces lie no deeper\n"
    "in each other. State and change compare with the findings saved with the scene, which stays as it is.\n"
    "Exit code 3 if there is a clash, or a part inside another one, that no rule allows and that was not\n"
    "accepted. Once it is deeper than accepted, or of another verdict, it counts again; with --strict "
    "always.\n"
    "Example:\n"
    "nearfit-cli clearance pump.nearfit --all --threshold 0.5mm --press-fit 'Bush*:Housing=0.02mm'";

void runClearance(const ClearanceOptions& options) {
  if (options.isAll) return runSceneCheck(options.scene, *options.check);
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
      "clearance",
      "Prints the clearance between a part and each other visible part, as CSV; or checks all pairs.");
  command->add_option("scene", options->scene, "Scene file (*.nearfit)")->required()->type_name("SCENE");
  CLI::Option* part =
      command->add_option("--part", options->part, "Name of the part; default: the moving part or group")
          ->type_name("NAME");
  CLI::Option* cutoff = command->add_option(
      "--cutoff", options->cutoff, "Count minima within this distance [m]; default: the scene's cutoff");
  CLI::Option* all = command->add_flag("--all", options->isAll, "Check all pairs of visible parts");
  all->excludes(part)->excludes(cutoff);
  addSceneCheckOptions(*command, *all, options->check);
  command->footer(kClearanceFooter);
  command->callback([options] { runClearance(*options); });
}

}  // namespace nearfit::cli
