#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
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
#include "core/math/aabb.h"
#include "core/proximity/query/broad_phase.h"
#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/scene/part_geometry.h"
#include "core/verdict/scene_check.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"
#include "tests/exact/exact_verdicts.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench {
namespace {

namespace fs = std::filesystem;

/// Of the diagonal of the scene as drawn.
constexpr double kVerdictThreshold = 0.01;
/// Unit of the pump's meshes [m].
constexpr double kPumpUnit = 1e-3;
/// How far parts are drawn apart, or pushed into each other, in turn.
constexpr std::array<double, 4> kSpreads{1.02, 0.98, 1.15, 0.85};

struct VerdictOptions {
  fs::path shared, csv;
  std::vector<std::string> scenes{"all"};
  std::size_t rounds = 8;
  test::ClashComparisonOptions clashes;
};

struct VerdictSceneEntry {
  std::string name;
  std::function<Scene()> make;
};

/// Its one solid has several shells, each a part here.
Scene viseScene(const fs::path& file) {
  Scene scene;
  for (const PartGeometryPtr& shape : loadDocument(file, 1.0).shapes) {
    if (!shape) continue;
    for (TriangleMesh& piece : test::meshPieces(shape->mesh))
      scene.add(test::partOf(test::freshGeometryOf(std::move(piece)),
                             fmt::format("shell {}", scene.parts().size() + 1).c_str()));
  }
  return scene;
}

Scene boxScene(const fs::path& file) {
  const LoadedDocument document = loadDocument(file, 1.0);
  Scene scene;
  addTo(scene, partsOfDocument(document, scene));
  return scene;
}

Scene pumpScene(const fs::path& folder) {
  Scene scene;
  for (const char* name : {"Axis_of_bearing", "Bottom", "Top"})
    scene.add(test::partOf(loadPartGeometry(folder / fmt::format("{}.stl", name), kPumpUnit), name));
  return scene;
}

std::vector<VerdictSceneEntry> verdictScenes(const fs::path& shared) {
  const fs::path models = shared / "models" / "public";
  return {{"vise", [=] { return viseScene(models / "steptools_vise.stp"); }},
          {"box-assembly", [=] { return boxScene(models / "trimesh_box_assembly.STEP"); }},
          {"pump", [=] { return pumpScene(models / "pump"); }}};
}

double diagonalOf(const Scene& scene) {
  Aabb all;
  for (const Scene::PartPtr& part : scene.parts()) {
    const Aabb box = boundsOf(part->geometry->mesh.bounds(), part->worldFromPart);
    all.add(box.lower);
    all.add(box.upper);
  }
  return all.diagonal();
}

/// A check held against independent arithmetic.
struct VerdictScene {
  test::VerdictComparison verdicts;
  test::ClashComparison clashes;
};

VerdictScene compareScene(const Scene& scene, double threshold, const VerdictOptions& options) {
  const SceneCheckRequest request = sceneCheckRequest(scene, threshold);
  const SceneCheck check = checkScene(request);
  return {test::compareVerdicts(request, check), test::compareClashes(request, check, options.clashes)};
}

void addComparison(const test::VerdictComparison& one, test::VerdictComparison& all) {
  all.pairs += one.pairs;
  all.agree += one.agree;
  all.clear += one.clear;
  all.near += one.near;
  all.touching += one.touching;
  all.clashes += one.clashes;
  all.contained += one.contained;
  all.worstDistance = std::max(all.worstDistance, one.worstDistance);
  all.differences.insert(all.differences.end(), one.differences.begin(), one.differences.end());
}

void addScene(const VerdictScene& one, VerdictScene& all) {
  addComparison(one.verdicts, all.verdicts);
  all.clashes.add(one.clashes);
}

std::string verdictHeader() {
  return "scene,pairs,agree,worst_distance_difference_m,clear,near,touching,clashes,contained,depths,depths_"
         "free,"
         "depths_least,depths_beaten,depths_exact,depths_exact_least,volumes,volumes_by_rays,worst_by_rays,"
         "booleans,"
         "volumes_by_booleans,worst_by_booleans\n";
}

std::string verdictLine(const std::string& scene, const VerdictScene& s) {
  const test::VerdictComparison& v = s.verdicts;
  const test::ClashComparison& c = s.clashes;
  return fmt::format("{},{},{},{:.3g},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3g},{},{},{:.3g}\n", scene,
                     v.pairs, v.agree, v.worstDistance, v.clear, v.near, v.touching, v.clashes, v.contained,
                     c.depths, c.freed, c.least, c.beaten, c.exactDepths, c.exactLeast, c.volumes,
                     c.raysAgree, c.worstRays, c.booleans, c.booleansAgree, c.worstBoolean);
}

void runVerdicts(const VerdictOptions& options) {
  const std::string machine =
      machineComment(options.csv) +
      fmt::format("# each scene as drawn, and {} times with its parts moved; threshold {} of the diagonal\n",
                  options.rounds, kVerdictThreshold);
  const std::string header = verdictHeader();
  fmt::print("{}{}", machine, header);
  std::string lines, problem;
  for (const VerdictSceneEntry& entry : chosen(verdictScenes(options.shared), options.scenes, "--scenes")) {
    const Scene drawn = entry.make();
    const double threshold = kVerdictThreshold * diagonalOf(drawn);
    VerdictScene asDrawn = compareScene(drawn, threshold, options), moved;
    for (std::size_t i = 0; i < options.rounds; ++i) {
      const Scene spread = test::spreadScene(drawn, kSpreads[i % kSpreads.size()], i + 1);
      addScene(compareScene(spread, threshold, options), moved);
    }
    const std::string line =
        verdictLine(entry.name, asDrawn) + verdictLine(fmt::format("{} moved", entry.name), moved);
    fmt::print("{}", line);
    lines += line;
    addScene(moved, asDrawn);
    std::vector<std::string> differences = asDrawn.verdicts.differences;
    differences.insert(differences.end(), asDrawn.clashes.differences.begin(),
                       asDrawn.clashes.differences.end());
    for (const std::string& difference : differences) {
      fmt::print("# {}: {}\n", entry.name, difference);
      if (problem.empty()) problem = entry.name + ": " + difference;
    }
    std::fflush(stdout);
  }
  if (!options.csv.empty())
    atomicWrite(options.csv, machine + fmt::format("# load at end: {}\n", loadAverages()) + header + lines);
  if (!problem.empty()) throw Error("verdicts", problem, "find out which is right");
}

}  // namespace

void addVerdictsCommand(CLI::App& program) {
  const auto options = std::make_shared<VerdictOptions>();
  CLI::App* command =
      program.add_subcommand("verdicts",
                             "Holds what a check of a scene says of each pair of parts against exact "
                             "arithmetic that shares no code with "
                             "it: verdict, least distance, depth (it frees the pair, and less does not in "
                             "the same direction) and volume (by "
                             "rays and, of small parts, by Nef polyhedra). Exit code 1 on any difference.");
  command->add_option("--shared", options->shared, "Folder of the shared models")
      ->check(CLI::ExistingDirectory)
      ->required();
  command
      ->add_option("--scenes", options->scenes,
                   "With commas between: vise, box-assembly, pump; all by default")
      ->delimiter(',');
  command->add_option("--rounds", options->rounds, "Times that the parts of each scene are moved")
      ->capture_default_str();
  command
      ->add_option("--boolean-triangles", options->clashes.maxBooleanTriangles,
                   "Volumes of two parts with more triangles are not computed by Nef polyhedra")
      ->capture_default_str();
  command
      ->add_option("--booleans", options->clashes.maxBooleans,
                   "Volumes of a check that are computed by Nef polyhedra, at most")
      ->capture_default_str();
  command->add_option("--cells", options->clashes.cells, "Rays along each side of what two boxes share")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runVerdicts(*options); });
}

}  // namespace nearfit::bench
