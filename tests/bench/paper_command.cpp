#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/paper_arguments.h"
#include "tests/bench/paper_judge.h"
#include "tests/bench/paper_run.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

namespace fs = std::filesystem;

struct PaperOptions {
  PaperRunOptions run;
  ArgumentOptions arguments;
  std::vector<std::string> parts{"all"}, rows{"all"};
  std::size_t judgedPoses = 25, maxPaperTriangles = 140'000, maxTriangles = 1'100'000;
  fs::path sharedFolder, csv, samples;
  bool isSearch = false;
};

/// What is measured so far.
struct PaperResults {
  std::vector<PaperFigure> figures;
  std::vector<ForceSample> samples;

  void add(const std::vector<PaperFigure>& more) {
    fmt::print("{}", paperFigureTable(more));
    std::fflush(stdout);
    figures.insert(figures.end(), more.begin(), more.end());
  }
};

/// As `chosen` asks for names.
struct NamedRow {
  std::string name;
  PaperRow row;
};

std::vector<PaperRow> chosenRows(const PaperOptions& options) {
  std::vector<NamedRow> all;
  for (const PaperRow& row : paperRows())
    all.push_back({row.name, row});
  all.push_back({scanRow().name, scanRow()});
  std::vector<PaperRow> rows;
  for (const NamedRow& named : chosen(all, options.rows, "--rows"))
    rows.push_back(named.row);
  return rows;
}

/// Evenly spread over a row's path, its own pose first.
std::vector<RigidTransform> judgedPosesOf(const PaperRow& row, BenchScene meshes,
                                          const PaperOptions& options) {
  meshes.range = 0.02 * meshes.size();
  const std::vector<RigidTransform> path =
      pathOfRow(PreparedScene(std::move(meshes), row.cutoffFraction), options.run.poses, options.run.seed);
  std::vector<RigidTransform> poses;
  const std::size_t stride = std::max<std::size_t>(1, path.size() / options.judgedPoses);
  for (std::size_t i = 0; i < path.size() && poses.size() < options.judgedPoses; i += stride)
    poses.push_back(path[i]);
  return poses;
}

void runAppendix(const PaperRow& row, const BenchScene& meshes, const PaperOptions& options,
                 PaperResults& results) {
  results.add(appendixFigures(row, meshes, options.run));
}

void runCutoff(const PaperRow& row, const BenchScene& meshes, const PaperOptions& options,
               PaperResults& results) {
  results.add(cutoffFigures(row, meshes, options.run));
}

void runJudge(const PaperRow& row, const BenchScene& meshes, const PaperOptions& options,
              PaperResults& results) {
  if (!row.printed) results.add(judgedTimes(row, meshes, options.run));
  const ErrorScene scene(meshes.scene, meshes.part, row.cutoffFraction * meshes.size());
  results.add(
      judgeFigures({"judge", meshes.name, ""}, scene, judgedMethods(), judgedPosesOf(row, meshes, options)));
}

void runArguments(const PaperRow& row, const BenchScene& meshes, const PaperOptions& options,
                  PaperResults& results) {
  results.add(
      argumentFigures(row, meshes, options.arguments, options.samples.empty() ? nullptr : &results.samples));
}

/// A part of the command that goes through the rows.
struct RowPart {
  std::string name;
  bool isForScans;  ///< Not of the appendix's rows alone.
  void (*run)(const PaperRow&, const BenchScene&, const PaperOptions&, PaperResults&);
};

/// All parts; "triangles" has no rows and no function.
std::vector<RowPart> allParts() {
  return {{"appendix", false, runAppendix},
          {"judge", true, runJudge},
          {"arguments", false, runArguments},
          {"cutoff", false, runCutoff},
          {"triangles", false, nullptr}};
}

void runTriangles(const PaperOptions& options, PaperResults& results) {
  for (const SweptBody& body : sweptBodies()) {
    for (const std::size_t triangles : sweptTriangles()) {
      if (triangles > options.maxTriangles) continue;
      results.add(trianglesFigures(body, triangles, options.maxPaperTriangles, options.run));
    }
  }
}

std::string settingsComment(const PaperOptions& o) {
  return fmt::format(
      "# paths: {} poses (sweeps {}), seed {}; times: {} clock, but builds by the wall's; the paper's "
      "methods answer "
      "each {}th pose; judged at {} poses of each row; arguments: {} ticks at {} m/s\n"
      "# springs push with 1 N when pressed all the way (printed law: where it pushes most)\n",
      o.run.poses, o.run.sweepPoses, o.run.seed, o.run.clock == BenchClock::Wall ? "wall" : "thread",
      o.run.slowStride, o.judgedPoses, o.arguments.ticks, o.arguments.speed);
}

void printSearch(const PaperOptions& options) {
  for (const PaperRow& row : chosenRows(options)) {
    const std::optional<RigidTransform> pose = searchPose(row, paperScene(row, options.sharedFolder));
    if (!pose) {
      throw Error(fmt::format("row {}", row.name),
                  fmt::format("no pose of {} has {} minima by the paper's rule", kMaxPoses,
                              row.printed ? fmt::format("{}", row.printed->minima) : "any"),
                  "give it another region in tests/bench/paper_rows.cpp");
    }
    const glm::dquat& q = pose->rotation;
    const glm::dvec3& t = pose->translation;
    fmt::print("{}: {{{{{}, {}, {}, {}}}, {{{}, {}, {}}}}}\n", row.name, q.w, q.x, q.y, q.z, t.x, t.y, t.z);
  }
}

std::string samplesText(const std::vector<ForceSample>& samples) {
  std::string text = "scene,mode,tick,springs,fx,fy,fz,tx,ty,tz\n";
  for (const ForceSample& s : samples) {
    const glm::dvec3 &f = s.wrench.force, &t = s.wrench.torque;
    text += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", s.scene, s.mode, s.tick,
                        s.springs, f.x, f.y, f.z, t.x, t.y, t.z);
  }
  return text;
}

void runPaper(const PaperOptions& options) {
  const std::vector<RowPart> parts = chosen(allParts(), options.parts, "--part");
  const bool needsMeshes = options.isSearch || std::any_of(parts.begin(), parts.end(),
                                                           [](const RowPart& p) { return p.run != nullptr; });
  if (needsMeshes && options.sharedFolder.empty()) {
    throw UsageError("--shared", "the meshes of the appendix are not in this repository",
                     "name the folder that has models/public/paper_counts, or choose --part triangles");
  }
  if (options.isSearch) return printSearch(options);
  const std::string machine = machineComment(options.csv) + settingsComment(options);
  fmt::print("{}", machine);
  PaperResults results;
  for (const RowPart& part : parts) {
    if (part.run == nullptr) {
      runTriangles(options, results);
      continue;
    }
    for (const PaperRow& row : chosenRows(options)) {
      if (row.printed || part.isForScans)
        part.run(row, paperScene(row, options.sharedFolder), options, results);
    }
  }
  const std::string header = machine + fmt::format("# load at end: {}\n", loadAverages());
  std::string csv;
  for (const PaperFigure& figure : results.figures)
    csv += paperFigureCsvLine(figure);
  if (!options.csv.empty()) atomicWrite(options.csv, header + paperFigureCsvHeader() + csv);
  if (!options.samples.empty()) atomicWrite(options.samples, header + samplesText(results.samples));
}

void addSizes(CLI::App& command, PaperOptions& o) {
  const auto number = [&command](const char* name, std::size_t& value, const char* text) {
    command.add_option(name, value, text)->check(CLI::PositiveNumber)->capture_default_str();
  };
  number("--poses", o.run.poses, "Poses of the path of each row");
  number("--sweep-poses", o.run.sweepPoses, "Poses of the path at each setting of a sweep");
  number("--stride", o.run.slowStride, "The paper's methods answer each so-many-th pose");
  number("--block", o.run.block, "Poses that a method answers before the next has its turn");
  number("--judged", o.judgedPoses, "Poses of each row that exact arithmetic judges");
  number("--ticks", o.arguments.ticks, "Ticks of the hand in \"arguments\"");
  number("--examined", o.arguments.maxExamined, "Ticks of each mode that are halved to find jumps");
  number("--max-triangles", o.maxTriangles, "Leave out larger bodies of \"triangles\"");
  number("--max-paper-triangles", o.maxPaperTriangles, "Do not ask the paper's methods about larger ones");
}

}  // namespace

void addPaperCommand(CLI::App& program) {
  const auto options = std::make_shared<PaperOptions>();
  PaperOptions& o = *options;
  CLI::App* command = program.add_subcommand(
      "paper",
      "Reproduces Appendix A and the arguments of Johnson and Willemsen (2003), and judges their algorithm.");
  command->add_option("--shared", o.sharedFolder, "Folder of shared models, with the meshes of the appendix")
      ->check(CLI::ExistingDirectory);
  command->add_option("--part", o.parts, "appendix, judge, arguments, cutoff, triangles, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--rows", o.rows,
                   "Rows of the appendix, a to f, and scan, which only judge takes; commas between")
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag("--search", o.isSearch,
                    "Search the poses of the rows anew and print them; measure nothing");
  addSizes(*command, o);
  command->add_option("--seed", o.run.seed, "Of the paths")->capture_default_str();
  command->add_option("--clock", o.run.clock, "wall, or thread: time on the processor alone (the default)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
  command->add_option("--csv", o.csv, "File for the figures");
  command->add_option("--samples", o.samples, "File for the forces of \"arguments\", tick by tick");
  command->callback([options] {
    options->arguments.seed = options->run.seed;
    options->arguments.clock = options->run.clock;
    runPaper(*options);
  });
}

}  // namespace nearfit::bench
