#include "tests/bench/instances.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include "core/scene/scene_file.h"
#include "core/servo/scene_tracker.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/units.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/part_geometries.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {
namespace {

double secondsSince(double start) {
  return secondsBy(BenchClock::Wall) - start;
}

/// Fills in all but the name, what was before and how long the scene took.
void prepareServo(const Scene& scene, InstancesRow& row) {
  double start = secondsBy(BenchClock::Wall);
  const std::shared_ptr<const ServoScene> servoScene = makeServoScene(scene);
  row.servoSceneSeconds = secondsSince(start);

  start = secondsBy(BenchClock::Wall);
  SceneTracker tracker;
  TrackedScene tracked;
  tracker.setScene(servoScene);
  tracker.refresh({scene.haptics().springs.cutoff}, tracked);
  row.trackedSeconds = secondsSince(start);

  row.residentAfter = residentBytes();
  row.parts = scene.parts().size();
  const GeometryTotals totals = geometryTotals(scene);
  row.geometries = totals.geometries;
  row.meshBytes = totals.meshBytes;
  row.treeBytes = totals.treeBytes;
}

}  // namespace

Scene gridOf(std::span<const PartGeometryPtr> geometries, std::size_t parts) {
  const auto edge = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(parts))));
  const double spacing = 1.5 * geometries[0]->mesh.bounds().diagonal();
  Scene scene;
  for (std::size_t i = 0; i < parts; ++i) {
    RigidTransform pose;
    pose.translation = spacing * glm::dvec3(i % edge, i / edge % edge, i / (edge * edge));
    const PartId id = scene.add(
        test::partOf(geometries[i % geometries.size()], fmt::format("part {}", i + 1).c_str(), pose));
    if (i == 0) scene.setMovingPart(id);
  }
  return scene;
}

GeometryTotals geometryTotals(const Scene& scene) {
  GeometryTotals totals;
  std::set<const PartGeometry*> seen;
  for (const PartGeometryPtr& geometry : scene.geometries()) {
    if (!seen.insert(geometry.get()).second) continue;
    ++totals.geometries;
    totals.meshBytes += geometry->mesh.byteSize();
    if (geometry->hierarchy->isReady()) totals.treeBytes += geometry->tree().byteSize();
  }
  return totals;
}

std::uint64_t residentBytes() {
  malloc_trim(0);
  std::uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

InstancesRow measureInstancesInMemory(const TriangleMesh& mesh, std::size_t parts) {
  InstancesRow row;
  row.name = "memory";
  row.residentBefore = residentBytes();
  // Arrays of its own: those of `mesh` are there already.
  const PartGeometryPtr geometry = test::freshGeometryOf(test::transformed(mesh, 1.0));
  const double start = secondsBy(BenchClock::Wall);
  const Scene scene = gridOf({&geometry, 1}, parts);
  row.sceneSeconds = secondsSince(start);
  prepareServo(scene, row);
  return row;
}

InstancesRow measureInstancesFromFile(const TriangleMesh& mesh, std::size_t parts) {
  // A hierarchy from the cache would not be built.
  const test::ScopedVariable noCache("NEARFIT_CACHE", "off");
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "instances.nearfit";
  const PartGeometryPtr geometry = loadPartGeometry(folder.write("mesh.obj", test::objText(mesh)), 1.0);
  writeSceneFile(gridOf({&geometry, 1}, parts), file);
  InstancesRow row;
  row.name = "scene file";
  row.residentBefore = residentBytes();
  const double start = secondsBy(BenchClock::Wall);
  const Scene scene = readSceneFile(file);
  row.sceneSeconds = secondsSince(start);
  prepareServo(scene, row);
  return row;
}

std::string instancesTable(const std::vector<InstancesRow>& rows) {
  std::string out = fmt::format("{:<12}{:>7}{:>12}{:>10}{:>14}{:>13}{:>12}{:>11}{:>10}{:>14}{:>12}\n", "from",
                                "parts", "geometries", "mesh MB", "hierarchy MB", "before MB", "after MB",
                                "grown MB", "scene s", "servo scene s", "tracked s");
  for (const InstancesRow& r : rows) {
    const auto before = static_cast<double>(r.residentBefore), after = static_cast<double>(r.residentAfter);
    out += fmt::format(
        "{:<12}{:>7}{:>12}{:>10.2f}{:>14.2f}{:>13.1f}{:>12.1f}{:>11.1f}{:>10.3f}{:>14.3f}{:>12.4f}\n", r.name,
        r.parts, r.geometries, static_cast<double>(r.meshBytes) / kMegabyte,
        static_cast<double>(r.treeBytes) / kMegabyte, before / kMegabyte, after / kMegabyte,
        (after - before) / kMegabyte, r.sceneSeconds, r.servoSceneSeconds, r.trackedSeconds);
  }
  return out;
}

std::string instancesCsv(const std::vector<InstancesRow>& rows) {
  std::string out =
      "from,parts,geometries,mesh_bytes,hierarchy_bytes,resident_before_bytes,resident_after_bytes,scene_s,"
      "servo_scene_s,tracked_s\n";
  for (const InstancesRow& r : rows) {
    out += fmt::format("{},{},{},{},{},{},{},{:.6f},{:.6f},{:.6f}\n", r.name, r.parts, r.geometries,
                       r.meshBytes, r.treeBytes, r.residentBefore, r.residentAfter, r.sceneSeconds,
                       r.servoSceneSeconds, r.trackedSeconds);
  }
  return out;
}

}  // namespace nearfit::bench
