#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/files/atomic_write.h"
#include "core/import/mesh_import.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/query_method.h"
#include "tests/bench/selection.h"
#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

struct BuildOptions {
  std::vector<std::string> meshes{"all"}, methods{"all"};
  std::vector<std::filesystem::path> files;
  std::filesystem::path csv;
  std::size_t repeats = 3;
};

std::vector<MeshEntry> meshesOf(const BuildOptions& options) {
  if (options.files.empty()) return chosen(generatedMeshes(), options.meshes, "--meshes");
  std::vector<MeshEntry> entries;
  for (const std::filesystem::path& file : options.files)
    entries.push_back({file.stem().string(), [file] { return importMesh(file, {}).mesh; }});
  return entries;
}

/// Prints a line of the table and returns one of CSV.
std::string measure(const std::string& name, const TriangleMesh& mesh, const BuildEntry& method,
                    std::size_t repeats) {
  std::vector<double> seconds;
  std::size_t bytes = 0;
  const auto timed = method.prepare ? method.prepare(mesh) : [&] { return method.build(mesh); };
  for (std::size_t i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const BuiltHierarchy built = timed();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    bytes = built.bytes;
  }
  const std::size_t triangles = mesh.triangles().size();
  const double perTriangle = static_cast<double>(bytes) / static_cast<double>(triangles);
  const double least = *std::min_element(seconds.begin(), seconds.end());
  const double median = SampleSummary(seconds).percentile(0.5);
  fmt::print("{:<16}{:>11}  {:<20}{:>12.4f}{:>12.4f}{:>14.1f}\n", name, triangles, method.name, least, median,
             perTriangle);
  std::fflush(stdout);
  return fmt::format("{},{},{},{:.6f},{:.6f},{:.2f}\n", name, triangles, method.name, least, median,
                     perTriangle);
}

void runBuild(const BuildOptions& options) {
  const std::vector<BuildEntry> methods = chosen(allBuilds(), options.methods, "--methods");
  const std::string machine = machineComment(options.csv);
  fmt::print("{}\n{:<16}{:>11}  {:<20}{:>12}{:>12}{:>14}\n", machine, "mesh", "triangles", "method",
             "least s", "median s", "bytes/triangle");
  std::string rows;
  for (const MeshEntry& entry : meshesOf(options)) {
    const TriangleMesh mesh = entry.make();
    for (const BuildEntry& method : methods)
      rows += measure(entry.name, mesh, method, options.repeats);
  }
  if (options.csv.empty()) return;
  atomicWrite(options.csv, machine + fmt::format("# load at end: {}\n", loadAverages()) +
                               "mesh,triangles,method,least_s,median_s,bytes_per_triangle\n" + rows);
}

}  // namespace

void addBuildCommand(CLI::App& program) {
  const auto options = std::make_shared<BuildOptions>();
  CLI::App* command = program.add_subcommand("build",
                                             "Times the building of hierarchies from meshes in memory and "
                                             "their way to and from the cache, and their "
                                             "size.");
  command->add_option("files", options->files, "Meshes to build instead of generated ones")
      ->check(CLI::ExistingFile);
  command->add_option("--meshes", options->meshes, "Generated meshes, with commas between; all by default")
      ->delimiter(',');
  command->add_option("--methods", options->methods, "With commas between; all by default")->delimiter(',');
  command->add_option("--repeat", options->repeats, "Times to build each")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runBuild(*options); });
}

}  // namespace nearfit::bench
