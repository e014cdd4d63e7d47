#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "tests/bench/commands.h"
#include "tests/bench/import_load.h"
#include "tests/bench/import_row.h"
#include "tests/bench/machine.h"
#include "tests/bench/occ_program.h"
#include "tests/bench/selection.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {
namespace {

/// The command that a run of its own is started with.
constexpr const char* kOnce = "import-once";

/// From the cache, for any document [s]; for parts, whatever the number of their faces [s]; of an assembly of a million
/// triangles, as a multiple of OpenCASCADE's time and in bytes a triangle.
constexpr double kCachedGoal = 0.3, kPartGoal = 2.0, kViseGoal = 1.5, kBoxesGoal = 1.0, kRatioGoal = 1.5,
                 kBytesGoal = 400.0;
/// Shapes of the assembly that has few.
constexpr std::size_t kFewShapes = 12;

struct ImportCommandOptions {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> documents{"all"};
  std::filesystem::path shared, csv;
  std::size_t instances = 300, triangles = 1'000'000;
  std::size_t repeats = 5;
};

struct DocumentEntry {
  std::string name, description;
  ImportGoals goals;
  /// Its file; one that is made goes into the folder.
  std::function<std::filesystem::path(const std::filesystem::path& folder)> file;
};

std::vector<DocumentEntry> sharedDocuments(const std::filesystem::path& folder) {
  const auto entry = [&](const char* name, const char* description, double goal, const char* file) {
    const std::filesystem::path path = folder / "models" / "public" / file;
    return DocumentEntry{name, description, {goal, kCachedGoal}, [path](const auto&) { return path; }};
  };
  return {
      entry("vise", "628 faces, one solid of several shells", kViseGoal, "steptools_vise.stp"),
      entry("box-assembly", "ten instances of six parts, 310 faces", kBoxesGoal, "trimesh_box_assembly.STEP"),
      entry("nist-1", "a part of 113 faces", kPartGoal, "nist_mbe_pmi_1.stp"),
      entry("nist-3", "a part of 120 faces", kPartGoal, "nist_mbe_pmi_3.stp"),
      entry("nist-4", "a part of 495 faces", kPartGoal, "nist_mbe_pmi_4.stp"),
      entry("nist-5", "a part of 163 faces", kPartGoal, "nist_mbe_pmi_5.stp")};
}

std::vector<DocumentEntry> madeDocuments(const ImportCommandOptions& options,
                                         const std::filesystem::path& program) {
  const auto entry = [&](const char* name, const char* description, std::size_t shapes) {
    const AssemblySize size{options.instances, std::min(shapes, options.instances), options.triangles};
    return DocumentEntry{name,
                         description,
                         {0.0, kCachedGoal, kRatioGoal, kBytesGoal},
                         [size, program, file = fmt::format("{}.step", name)](const auto& folder) {
                           makeAssembly(program, size, folder / file);
                           return folder / file;
                         }};
  };
  return {entry("assembly-few", "perforated plates, each shape placed often", kFewShapes),
          entry("assembly-many", "perforated plates, each shape placed once", options.instances)};
}

std::vector<DocumentEntry> userDocuments(const std::vector<std::filesystem::path>& files) {
  std::vector<DocumentEntry> entries;
  for (const std::filesystem::path& file : files)
    entries.push_back({file.stem().string(), file.string(), {}, [file](const auto&) { return file; }});
  return entries;
}

std::vector<DocumentEntry> documentsOf(const ImportCommandOptions& options,
                                       const std::filesystem::path& program) {
  if (!options.files.empty()) return userDocuments(options.files);
  std::vector<DocumentEntry> entries;
  if (!options.shared.empty()) entries = sharedDocuments(options.shared);
  if (program.empty()) {
    fmt::print(
        "Assemblies and OpenCASCADE's own times are not measured: nearfit-bench-occ is not there (it is "
        "built with nearfit-import).\n");
  } else {
    for (DocumentEntry& entry : madeDocuments(options, program))
      entries.push_back(std::move(entry));
  }
  return chosen(entries, options.documents, "--documents");
}

/// Loads a document in a process of its own, by a cache.
ImportRun runOnce(const std::filesystem::path& file, const std::filesystem::path& cache) {
  const test::ScopedVariable variable("NEARFIT_CACHE", cache.string());
  const std::string program = std::filesystem::canonical("/proc/self/exe").string();
  const test::ProcessResult result = test::runProcess({program, kOnce, file.string()});
  if (result.exitCode != 0)
    throw Error(file.string(), result.err, fmt::format("run {} {} {}", program, kOnce, file.string()));
  return readImportRun(result.out);
}

void takeTurn(const std::filesystem::path& file, const std::filesystem::path& program, bool isOccFirst,
              ImportSamples& samples) {
  const auto byOcc = [&] {
    if (!program.empty()) samples.occ.push_back(runOcc(program, file));
  };
  if (isOccFirst) byOcc();
  const test::TemporaryFolder cache;
  samples.fresh.push_back(runOnce(file, cache.path()));
  samples.cached.push_back(runOnce(file, cache.path()));
  if (!isOccFirst) byOcc();
}

ImportSamples measureDocument(const DocumentEntry& entry, const std::filesystem::path& program,
                              std::size_t repeats) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = entry.file(folder.path());
  ImportSamples samples{entry.name, entry.goals, {}, {}, {}};
  // In turns first, so that neither gains by its place.
  for (std::size_t i = 0; i < repeats; ++i)
    takeTurn(file, program, i % 2 != 0, samples);
  return samples;
}

std::string settingsComment(const ImportCommandOptions& options) {
  return fmt::format(
      "# {} turns, each run a process of its own, the files in the system's memory; made assemblies: {} "
      "instances, some {} triangles\n",
      options.repeats, options.instances, options.triangles);
}

void runImport(const ImportCommandOptions& options) {
  const std::filesystem::path program = occProgram();
  const std::vector<DocumentEntry> documents = documentsOf(options, program);
  std::string machine = machineComment(options.csv) + settingsComment(options), lines;
  fmt::print("{}{}", machine, importTableHeader());
  std::vector<std::string> problems;
  std::string version;
  for (const DocumentEntry& entry : documents) {
    const ImportSamples samples = measureDocument(entry, program, options.repeats);
    for (const ImportFigure& figure : figuresOf(samples)) {
      fmt::print("{}", importTableLine(figure));
      lines += importCsvLine(figure);
    }
    std::fflush(stdout);
    for (std::string& problem : problemsOf(samples))
      problems.push_back(std::move(problem));
    if (!samples.occ.empty()) version = samples.occ.front().version;
  }
  if (!version.empty()) machine += fmt::format("# OpenCASCADE: {}\n", version);
  if (!options.csv.empty())
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + importCsvHeader() + lines);
  if (problems.empty()) return;
  std::string all;
  for (const std::string& problem : problems)
    all += (all.empty() ? "" : "; ") + problem;
  throw Error("the comparison", "what is compared is not the same, so the figures are void: " + all,
              "run nearfit-import --times and nearfit-bench-occ read on the file");
}

void addOnceCommand(CLI::App& program) {
  const auto file = std::make_shared<std::filesystem::path>();
  CLI::App* command = program.add_subcommand(
      kOnce,
      "Loads one document until it can be felt, and prints what it took, as JSON: \"import\" starts it.");
  command->add_option("file", *file, "The file")->required()->check(CLI::ExistingFile);
  command->callback([file] { fmt::print("{}", textOf(loadToFeel(*file))); });
}

}  // namespace

void addImportCommand(CLI::App& program) {
  const auto options = std::make_shared<ImportCommandOptions>();
  CLI::App* command = program.add_subcommand(
      "import",
      "Times documents from the file until they can be felt, and weighs them, beside OpenCASCADE alone.");
  command->add_option("files", options->files, "STEP files to read instead; for these there are no goals")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--documents", options->documents,
                   "With commas between: vise, box-assembly, nist-1, nist-3, nist-4, nist-5 (with --shared), "
                   "assembly-few, assembly-many; all by default")
      ->delimiter(',');
  command
      ->add_option("--shared", options->shared, "Folder of the shared models; without, made assemblies alone")
      ->check(CLI::ExistingDirectory);
  command->add_option("--instances", options->instances, "Of the made assemblies")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command->add_option("--triangles", options->triangles, "Of the made assemblies, all instances together")
      ->check(CLI::Range(1000, 100'000'000))
      ->capture_default_str();
  command->add_option("--repeat", options->repeats, "Turns")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runImport(*options); });
  addOnceCommand(program);
}

}  // namespace nearfit::bench
