#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/scene/scene_file.h"
#include "tests/bench/check_figures.h"
#include "tests/bench/check_report.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

/// Parts and instances that goals are for.
constexpr std::size_t kGoalParts = 200, kGoalInstances = 10'000;
/// Goals: seconds on two cores, bytes, times as long as a peer takes, near pairs; seconds of a report.
constexpr CheckGoals kPartsGoals{5.0, 0.0, 5.0, 0}, kInstancesGoals{60.0, 4.0 * (1 << 30), 0.0, 50'000};
constexpr double kReportGoal = 10.0;
/// Poses of the path in a report.
constexpr std::size_t kGoalReportPoses = 4000;
/// Shares of the diagonal. That of the instances brings more than 50,000 pairs within.
constexpr double kPartsThreshold = 0.01, kInstancesThreshold = 0.0125;
/// Triangles: 20 times the square of this and of the next number, by turns. Some 10,000 and some 1,000.
constexpr std::uint32_t kPartsFrequency = 22, kInstancesFrequency = 7;
/// Cuts of each triangle of the parts that fit.
constexpr std::uint32_t kFittedFineness = 4;
constexpr std::size_t kInstanceShapes = 12, kInstanceClashEvery = 500;
/// Unit of a document that stores none [m].
constexpr double kDocumentUnit = 1e-3;

struct CheckCommandOptions {
  std::vector<std::string> scenes{"all"};
  std::size_t parts = kGoalParts, shapes = 20, instances = kGoalInstances;
  std::uint32_t frequency = kPartsFrequency, fineness = kFittedFineness;
  std::vector<std::filesystem::path> files;
  std::filesystem::path shared, csv;
  bool hasReport = true;
  std::size_t reportPoses = kGoalReportPoses;
  CheckRunOptions run;
};

/// A scene to be checked, made when it is wanted.
struct CheckSceneEntry {
  std::string name;
  CheckGoals goals;
  double reportGoal = 0.0;
  bool isReported = false;
  std::function<ManyPartsScene()> make;
};

CheckSceneEntry documentEntry(const char* name, const std::filesystem::path& file) {
  return {name, {}, 0.0, false, [=] {
            const LoadedDocument document = loadDocument(file, kDocumentUnit, {});
            Scene scene;
            addTo(scene, partsOfDocument(document, scene));
            return manyPartsOf(name, scene, kPartsThreshold);
          }};
}

std::vector<CheckSceneEntry> userScenes(const std::vector<std::filesystem::path>& files) {
  std::vector<CheckSceneEntry> entries;
  for (const std::filesystem::path& file : files) {
    const std::string name = file.stem().string();
    entries.push_back(
        {name, {}, 0.0, false, [=] { return manyPartsOf(name, readSceneFile(file), kPartsThreshold); }});
  }
  return entries;
}

std::vector<CheckSceneEntry> checkScenes(const CheckCommandOptions& o) {
  if (!o.files.empty()) return userScenes(o.files);
  const bool areGoalParts = o.parts == kGoalParts && o.frequency == kPartsFrequency;
  const ManyPartsSize parts{
      .parts = o.parts, .shapes = o.shapes, .frequency = o.frequency, .thresholdFraction = kPartsThreshold};
  const ManyPartsSize instances{.parts = o.instances,
                                .shapes = kInstanceShapes,
                                .frequency = kInstancesFrequency,
                                .clashEvery = kInstanceClashEvery,
                                .thresholdFraction = kInstancesThreshold};
  const std::string partsName = fmt::format("parts{}", o.parts),
                    instancesName = fmt::format("instances{}", o.instances);
  std::vector<CheckSceneEntry> scenes{
      // First, so that little memory of others is counted.
      {instancesName, o.instances == kGoalInstances ? kInstancesGoals : CheckGoals(), 0.0, false,
       [=] { return stackedParts(instancesName, instances); }},
      {partsName, areGoalParts ? kPartsGoals : CheckGoals(), areGoalParts ? kReportGoal : 0.0, true,
       [=] { return stackedParts(partsName, parts); }}};
  const FittedPartsSize fitted{
      .pegs = o.parts / 2, .fineness = o.fineness, .thresholdFraction = kPartsThreshold};
  const std::string fittedName = fmt::format("fitted{}", 2 * fitted.pegs);
  const bool areGoalFits = o.parts == kGoalParts && o.fineness == kFittedFineness;
  scenes.push_back({fittedName, areGoalFits ? kPartsGoals : CheckGoals(), 0.0, false,
                    [=] { return fittedParts(fittedName, fitted); }});
  if (!o.shared.empty()) {
    const std::filesystem::path folder = o.shared / "models" / "public";
    scenes.push_back(documentEntry("box-assembly", folder / "trimesh_box_assembly.STEP"));
  }
  return scenes;
}

std::string checkSettings(const CheckCommandOptions& o) {
  return fmt::format(
      "# {} turns, each method in turn; {} shapes of parts{}; pairs of a peer end after {} s; threads: as "
      "many as processors\n",
      o.run.repeats, o.shapes, o.parts, o.run.maxPeerSeconds);
}

void showFigures(const std::vector<CheckFigure>& figures, std::string& csv) {
  for (const CheckFigure& figure : figures) {
    fmt::print("{}", checkTableLine(figure));
    csv += checkCsvLine(figure);
  }
  std::fflush(stdout);
}

CheckFigure reportFigure(const ManyPartsScene& scene, double goal, const CheckCommandOptions& options) {
  const LiftedPart lifted = liftOut(scene, options.reportPoses);
  CheckFigure figure = checkFigureOf(scene, "nearfit-cli report", "files to report", "s",
                                     reportTimes(cliProgram(), lifted, scene.threshold, options.run.repeats));
  figure.goal = options.reportPoses == kGoalReportPoses ? goal : 0.0;
  figure.remark = fmt::format("with a path of {} poses and its certificate", options.reportPoses);
  return figure;
}

void runCheck(const CheckCommandOptions& options) {
  const std::string machine = machineComment(options.csv) + checkSettings(options);
  fmt::print("{}\n{}", machine, checkTableHeader());
  const bool canReport = options.hasReport && !cliProgram().empty();
  std::string csv, problem;
  for (const CheckSceneEntry& entry : chosen(checkScenes(options), options.scenes, "--scenes")) {
    const ManyPartsScene scene = entry.make();
    if (scene.parts.size() < 2)
      throw Error(entry.name, "it has fewer than two parts with triangles", "choose others (--scenes)");
    const std::vector<CheckMethodRuns> runs = runChecks(scene, checkPeers(), options.run);
    showFigures(checkFigures(scene, entry.goals, runs), csv);
    for (const std::string& sentence : checkProblems(scene, runs)) {
      fmt::print("{}\n", sentence);
      if (problem.empty()) problem = sentence;
    }
    if (entry.isReported && canReport) showFigures({reportFigure(scene, entry.reportGoal, options)}, csv);
  }
  if (options.hasReport && !canReport)
    fmt::print("Reports are not timed: nearfit-cli is not beside this program.\n");
  if (!options.csv.empty())
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + checkCsvHeader() + csv);
  if (!problem.empty()) throw Error("check", problem, "find out which is right: the figures are void");
}

}  // namespace

void addCheckCommand(CLI::App& program) {
  const auto options = std::make_shared<CheckCommandOptions>();
  CLI::App* command =
      program.add_subcommand("check",
                             "Times checks of whole scenes, hierarchies included, beside what other "
                             "libraries say of the same pairs, "
                             "and a report. Exit code 1 if a distance or a clash differs from theirs.");
  command->add_option("files", options->files, "Scene files to check instead of generated scenes")
      ->check(CLI::ExistingFile);
  command
      ->add_option(
          "--scenes", options->scenes,
          "With commas between: instances10000, parts200, fitted200 (or as many as are asked for), with "
          "--shared box-assembly; all by default")
      ->delimiter(',');
  command
      ->add_option("--parts", options->parts,
                   "Parts of the scene of large meshes, and of that of parts that fit")
      ->check(CLI::Range(std::size_t{2}, std::size_t{100'000}))
      ->capture_default_str();
  command->add_option("--shapes", options->shapes, "Different meshes among these")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--frequency", options->frequency,
                   "These have 20 times the square of this, and of the next number, triangles")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--fineness", options->fineness,
                   "Each triangle of the parts that fit is cut in four so many times")
      ->check(CLI::Range(0, 6))
      ->capture_default_str();
  command->add_option("--instances", options->instances, "Parts of the scene of small meshes")
      ->check(CLI::Range(std::size_t{2}, std::size_t{1'000'000}))
      ->capture_default_str();
  command->add_option("--shared", options->shared,
                      "Folder of the shared models; without, generated scenes alone");
  command->add_option("--repeat", options->run.repeats, "Turns")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--peer-seconds", options->run.maxPeerSeconds,
                   "Time after which another library measures no further pairs of a scene [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("!--no-report", options->hasReport, "Do not time nearfit-cli report");
  command->add_option("--report-poses", options->reportPoses, "Poses of the path in the report")
      ->check(CLI::Range(std::size_t{2}, std::size_t{100'000}))
      ->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runCheck(*options); });
}

}  // namespace nearfit::bench
