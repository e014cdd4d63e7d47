#include "app/cli/scene_check_run.h"

#include <filesystem>
#include <optional>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/progress_line.h"
#include "app/cli/rule_options.h"
#include "app/cli/scene_part.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/scene_check_export.h"
#include "core/scene/scene_file.h"

namespace nearfit::cli {
namespace {

constexpr const char* kStdout = "-";

/// Rules of the command line come first: they are what is asked for now.
std::vector<PairRule> rulesFor(const Scene& scene, const SceneCheckOptions& options) {
  std::vector<PairRule> rules = rulesOf(options.rules);
  rules.insert(rules.end(), scene.pairRules().begin(), scene.pairRules().end());
  return rules;
}

/// Throws UsageError if an output would replace an input or the other output.
void checkCheckOutputs(const std::filesystem::path& sceneFile, const Scene& scene,
                       const SceneCheckOptions& options) {
  const bool areBoth = !options.json.empty() && !options.csv.empty();
  const bool isOne = areBoth && (options.json == kStdout || options.csv == kStdout
                                     ? options.json == options.csv
                                     : isSameTarget(options.json, options.csv));
  if (isOne) throw UsageError("--csv", "it is where the JSON goes", "name another file");
  for (const std::string& target : {options.json, options.csv}) {
    if (target.empty() || target == kStdout) continue;
    checkTarget(target, std::span(&sceneFile, 1));
    checkTarget(target, partFiles(scene));
  }
}

/// File of an option; stdout if it was given without one.
std::string checkTargetOf(const CLI::Option* option, const std::string& file) {
  return option != nullptr && !option->empty() && file.empty() ? std::string(kStdout) : file;
}

void writeTo(const std::string& target, const std::string& text) {
  if (target == kStdout) {
    print(text);
  } else {
    atomicWrite(target, text);
  }
}

}  // namespace

void addSceneCheckOptions(CLI::App& command, CLI::Option& all,
                          const std::shared_ptr<SceneCheckOptions>& options) {
  command
      .add_option("--threshold", options->threshold,
                  "With --all: find pairs no farther apart [m, or with a unit]; default: the scene's cutoff")
      ->type_name("D")
      ->needs(&all);
  options->jsonOption = command.add_option(
      "--json", options->json, "With --all: write all findings as JSON; without a file, or to -, on stdout");
  options->csvOption = command.add_option(
      "--csv", options->csv, "With --all: write the findings as CSV; without a file, or to -, on stdout");
  for (CLI::Option* option : {options->jsonOption, options->csvOption})
    option->type_name("[FILE]")->expected(0, 1)->needs(&all);
  command
      .add_option("--minima", options->minima,
                  "With --all: minima to keep of a pair, the nearest; 0: all; default: 100")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N")
      ->needs(&all);
  addRuleOptions(command, options->rules, &all, "With --all: ");
  command
      .add_flag("--save", options->isSaved,
                "With --all: keep the findings in the scene file, for the next check")
      ->needs(&all);
  command
      .add_flag("--strict", options->isStrict,
                "With --all: exit code 3 for clashes too that were accepted as they are")
      ->needs(&all);
}

void runSceneCheck(const std::string& sceneFile, const SceneCheckOptions& given) {
  SceneCheckOptions options = given;
  options.json = checkTargetOf(given.jsonOption, given.json);
  options.csv = checkTargetOf(given.csvOption, given.csv);
  const InterruptGuard interrupt;
  std::optional<SceneCheck> check;
  Scene scene;
  {
    ProgressLine line("checking");
    const ProgressCallback reading = [](double) { return !InterruptGuard::isInterrupted(); };
    const ProgressCallback checking = [&line](double fraction) {
      line.show(fraction);
      return !InterruptGuard::isInterrupted();
    };
    scene = readSceneFile(sceneFile, reading);
    checkCheckOutputs(sceneFile, scene, options);
    SceneCheckRequest request = sceneCheckRequest(scene, scene.haptics().springs.cutoff);
    if (!options.threshold.empty()) request.threshold = parseLength("--threshold", options.threshold);
    checkPositive("--threshold", request.threshold, true);
    request.rules = rulesFor(scene, options);
    request.maxMinima = options.minima.value_or(request.maxMinima);
    check = checkScene(request, checking);
  }
  const std::vector<ComparedFinding> compared = compareFindings(*check, scene.pairRecords());
  const bool isStdoutTaken = options.json == kStdout || options.csv == kStdout;
  if (!options.json.empty()) writeTo(options.json, sceneCheckJson(scene, *check, compared));
  if (!options.csv.empty()) writeTo(options.csv, sceneCheckCsv(scene, *check, compared));
  if (!isStdoutTaken)
    print(sceneCheckTable(scene, *check, compared) + sceneCheckSummary(*check, compared) +
          sceneCheckChanges(compared));
  if (options.isSaved) {
    scene.setPairRecords(recordsOf(compared));
    writeSceneFile(scene, sceneFile);
    if (findingsNotKept(compared) > 0) printError("warning: " + notKeptText(compared));
  }
  printCacheWarnings();
  if (check->forbidden() == (options.isStrict ? 0 : acceptedIn(compared))) return;
  flushOutput();
  throw NegativeVerdict();
}

}  // namespace nearfit::cli
