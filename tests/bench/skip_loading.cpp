#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/proximity/query/lmd_query.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/bench_scene.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/digest.h"
#include "tests/bench/instances.h"
#include "tests/bench/selection.h"
#include "tests/bench/skips.h"
#include "tests/bench/tick_run.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/part_geometries.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {
namespace {

/// Of the diagonal: reaches from one part of a grid to the next.
constexpr double kAcrossTheGrid = 1.0;
/// Parts of the large scene that are shown, the one in hand among them.
constexpr std::size_t kShown = 3;

/// Once each in turns, timed by the wall: several processors work on it.
RunOptions turnsOf(const SkipOptions& options) {
  RunOptions turns = options.run;
  turns.block = 1;
  turns.warmUp = 0;
  turns.rounds = 1;
  turns.clock = BenchClock::Wall;
  return turns;
}

/// A scene that is made ready for the servo, and what its first tick gives.
struct FirstTick {
  Scene scene;
  std::unique_ptr<ServoSnapshot> snapshot = std::make_unique<ServoSnapshot>();
  ServoTick tick{};

  void run(double cutoff) {
    ServoParameters parameters;
    parameters.haptics.mode = HapticMode::Springs;
    parameters.haptics.springs.cutoff = cutoff;
    SceneTracker tracker;
    TrackedScene tracked;
    tracker.setScene(makeServoScene(scene));
    tracker.refresh(searchReach(parameters.haptics), tracked);
    tick.reset();
    tick.run(tracked, parameters, {.pose = scene.find(*scene.movingPart())->worldFromPart},
             ServoLoop::kPeriod, *snapshot);
  }
  std::uint64_t answer() const {
    if (snapshot->lmdCount == 0) throw Error("first tick", "it has no minima, so that it is no evidence");
    return digestOf(*snapshot);
  }
  std::size_t bytes() const {
    const GeometryTotals totals = geometryTotals(scene);
    return totals.meshBytes + totals.treeBytes;
  }
};

/// Geometries of one mesh, each with arrays of its own.
std::vector<PartGeometryPtr> copiesOf(const TriangleMesh& mesh, std::size_t count) {
  std::vector<PartGeometryPtr> copies;
  while (copies.size() < count)
    copies.push_back(test::freshGeometryOf(test::transformed(mesh, 1.0)));
  return copies;
}

SkipRow measureInstances(const MeshEntry& entry, const SkipOptions& options) {
  const TriangleMesh mesh = entry.make();
  const double cutoff = kAcrossTheGrid * mesh.bounds().diagonal();
  SkipRow row{"instances", entry.name, "to first tick", {}, {}, {}};
  FirstTick with, without;
  const auto open = [&](FirstTick& first, std::size_t geometries) {
    first.scene = gridOf(copiesOf(mesh, geometries), options.instances);
    first.run(cutoff);
  };
  takeTurns(row, options.repeats, {[&](std::size_t) { open(with, 1); }, [&] { return with.answer(); }},
            {[&](std::size_t) { open(without, options.instances); }, [&] { return without.answer(); }},
            turnsOf(options));
  row.with.bytes = with.bytes();
  row.without.bytes = without.bytes();
  row.remark =
      fmt::format("{} of {} geometries with their hierarchies", options.instances - 1, options.instances);
  return row;
}

/// Parts of as many meshes in a grid, all but the first few hidden.
Scene sceneOfManyMeshes(const std::vector<TriangleMesh>& meshes) {
  std::vector<PartGeometryPtr> geometries;
  for (const TriangleMesh& mesh : meshes)
    geometries.push_back(test::freshGeometryOf(mesh));
  Scene scene = gridOf(geometries, geometries.size());
  for (std::size_t i = kShown; i < meshes.size(); ++i) {
    Part part = *scene.parts()[i];
    part.isVisible = false;
    scene.replace(part);
  }
  return scene;
}

SkipRow measureLaziness(const SkipOptions& options) {
  constexpr std::uint32_t kMinTeeth = 20, kTeeth = 20;  // 5,000 to 10,000 triangles.
  std::vector<TriangleMesh> meshes;
  for (std::uint32_t i = 0; i < std::max(options.sceneParts, kShown + 1); ++i)
    meshes.push_back(gearMesh(kMinTeeth + i % kTeeth));
  const double cutoff = kAcrossTheGrid * meshes.front().bounds().diagonal();
  SkipRow row{"laziness", fmt::format("{} parts", meshes.size()), "to first tick", {}, {}, {}};
  FirstTick with, without;
  takeTurns(row, options.repeats,
            {[&](std::size_t) {
               with.scene = sceneOfManyMeshes(meshes);
               with.run(cutoff);
             },
             [&] { return with.answer(); }},
            {[&](std::size_t) {
               without.scene = sceneOfManyMeshes(meshes);
               prepareHierarchies(without.scene.geometries());
               without.run(cutoff);
             },
             [&] { return without.answer(); }},
            turnsOf(options));
  row.with.bytes = with.bytes();
  row.without.bytes = without.bytes();
  row.remark = fmt::format("{} of {} hierarchies: those of parts that are hidden", meshes.size() - kShown,
                           meshes.size());
  return row;
}

/// A file from which a mesh with its hierarchy is had, and what it is beside itself.
class LoadedBeside {
 public:
  explicit LoadedBeside(std::filesystem::path file) : file_(std::move(file)), lmds_(kCapacity) {}

  void load() {
    const PartGeometryPtr geometry = loadPartGeometry(file_, 1.0);
    const Aabb& box = geometry->mesh.bounds();
    const double cutoff = kCutoff * box.diagonal();
    RigidTransform beside;
    beside.translation.x = box.upper.x - box.lower.x + 0.5 * cutoff;
    count_ = findLmds(geometry->tree(), geometry->tree(), beside, cutoff, scratch_, lmds_).count;
  }
  std::uint64_t answer() const {
    Digest digest;
    digest.add(std::span<const Lmd>(lmds_).first(count_));
    return digest.value();
  }

 private:
  static constexpr std::size_t kCapacity = 4096;
  static constexpr double kCutoff = 0.05;  ///< Of the diagonal, as in the query benchmark.

  std::filesystem::path file_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
  std::size_t count_ = 0;
};

SkipRow measureCache(const MeshEntry& entry, const SkipOptions& options) {
  const test::TemporaryFolder folder, cache;
  const std::filesystem::path file = folder.write("mesh.obj", test::objText(entry.make()));
  LoadedBeside with(file), without(file);
  const auto loadWith = [&](LoadedBeside& loaded, const std::string& where) {
    const test::ScopedVariable variable("NEARFIT_CACHE", where);
    loaded.load();
  };
  loadWith(with, cache.path().string());  // What is kept from then on.
  SkipRow row{"cache", entry.name, "load and query", {}, {}, {}};
  takeTurns(row, options.repeats,
            {[&](std::size_t) { loadWith(with, cache.path().string()); }, [&] { return with.answer(); }},
            {[&](std::size_t) { loadWith(without, "off"); }, [&] { return without.answer(); }},
            turnsOf(options));
  row.remark = "parsing and adjacency and the hierarchy of a file that was read before";
  return row;
}

}  // namespace

std::vector<SkipEntry> loadSkips() {
  return {
      {"instances", "Parts that show one mesh share it and its hierarchy",
       [](const SkipOptions& options) {
         std::vector<SkipRow> rows;
         for (const MeshEntry& entry : chosen(generatedMeshes(), {"gear-6k"}, "mesh"))
           rows.push_back(measureInstances(entry, options));
         return rows;
       }},
      {"laziness", "A hierarchy is built when its part is first felt or asked about, not when it is opened",
       [](const SkipOptions& options) { return std::vector{measureLaziness(options)}; }},
      {"cache", "A hierarchy that was built before is read from a file", [](const SkipOptions& options) {
         std::vector<SkipRow> rows;
         for (const MeshEntry& entry : chosen(generatedMeshes(), {"gear-6k", "organic-70k"}, "mesh"))
           rows.push_back(measureCache(entry, options));
         return rows;
       }}};
}

}  // namespace nearfit::bench
