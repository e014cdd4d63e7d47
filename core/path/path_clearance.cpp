#include "core/path/path_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/path/path_bodies.h"
#include "core/proximity/surface/surface_distance.h"
#include "core/report/csv_text.h"

namespace nearfit {
namespace {

constexpr double kBeyondRange = std::numeric_limits<double>::infinity();

/// Least distance of the moving parts to another at a pose [m].
double distanceAtPose(const PathBodies& bodies, const Part& other, const RigidTransform& worldFromLead,
                      double range, LmdScratch& scratch) {
  double least = kBeyondRange;
  for (const PathPart& moving : bodies.moving) {
    const PartGeometry &mine = *moving.part->geometry, &its = *other.geometry;
    const RigidTransform pose = otherFromPart(other, worldFromLead, moving);
    const double within = std::min(least, range);
    if (boxGap(its.mesh.bounds(), mine.mesh.bounds(), pose) > within || !(within > 0.0)) continue;
    least = std::min(least, leastSurfaceDistance(its.tree(), mine.tree(), pose, within, scratch,
                                                 std::numeric_limits<std::uint64_t>::max())
                                .distance);
  }
  return least;
}

/// True if boxes do not tell that a part stays beyond the range.
bool isEverNear(const PathBodies& bodies, const Part& other, const AssemblyPath& path, double range) {
  return std::ranges::any_of(path.poses, [&](const PathPose& pose) {
    return std::ranges::any_of(bodies.moving, [&](const PathPart& moving) {
      return boxGap(other.geometry->mesh.bounds(), moving.part->geometry->mesh.bounds(),
                    otherFromPart(other, pose.worldFromLead, moving)) <= range;
    });
  });
}

}  // namespace

std::vector<PathClearance> clearancesAlong(const Scene& scene, const AssemblyPath& path, double range,
                                           const ProgressCallback& progress) {
  constexpr std::size_t kPosesAtOnce = 32;
  constexpr double kHierarchiesDone = 0.2;
  checkPath(path, "path");
  if (!(range > 0.0) || !std::isfinite(range))
    throw UsageError("path", fmt::format("{} m is not a valid range", range), "give a length greater than 0");
  PathBodies bodies = pathBodies(scene, path);
  std::vector<char> isNear(bodies.others.size(), 0);
  parallelFor(isNear.size(),
              [&](std::size_t i) { isNear[i] = isEverNear(bodies, *bodies.others[i], path, range) ? 1 : 0; });
  std::vector<PartGeometryPtr> geometries;
  for (const PathPart& moving : bodies.moving)
    geometries.push_back(moving.part->geometry);
  std::vector<Scene::PartPtr> near;
  for (std::size_t i = 0; i < isNear.size(); ++i) {
    if (isNear[i] == 0) continue;
    near.push_back(bodies.others[i]);
    geometries.push_back(bodies.others[i]->geometry);
  }
  bodies.others = std::move(near);
  prepareHierarchies(geometries, stageCallback(progress, 0.0, kHierarchiesDone));

  const std::size_t poses = path.poses.size(), blocks = (poses + kPosesAtOnce - 1) / kPosesAtOnce;
  std::vector<PathClearance> all;
  for (const Scene::PartPtr& other : bodies.others)
    all.push_back({other->id, std::vector<double>(poses, kBeyondRange)});
  const ProgressCallback rest = stageCallback(progress, kHierarchiesDone, 1.0);
  SharedProgress done(rest, static_cast<double>(blocks));
  parallelFor(blocks, [&](std::size_t block) {
    LmdScratch scratch(1);
    const std::size_t end = std::min(poses, (block + 1) * kPosesAtOnce);
    for (std::size_t pose = block * kPosesAtOnce; pose < end; ++pose) {
      for (std::size_t i = 0; i < all.size(); ++i)
        all[i].distances[pose] =
            distanceAtPose(bodies, *bodies.others[i], path.poses[pose].worldFromLead, range, scratch);
    }
    done.add(1.0);
  });
  std::erase_if(all, [](const PathClearance& clearance) {
    return std::ranges::all_of(clearance.distances, [](double d) { return d == kBeyondRange; });
  });
  return all;
}

std::optional<LeastPathClearance> leastOf(const std::vector<PathClearance>& clearances,
                                          const AssemblyPath& path) {
  std::optional<LeastPathClearance> least;
  for (const PathClearance& clearance : clearances) {
    for (std::size_t i = 0; i < clearance.distances.size(); ++i) {
      const double distance = clearance.distances[i];
      if (distance < (least ? least->distance : kBeyondRange))
        least = LeastPathClearance{distance, path.poses[i].time, clearance.other};
    }
  }
  return least;
}

std::string pathClearanceCsv(const Scene& scene, const AssemblyPath& path,
                             const std::vector<PathClearance>& clearances) {
  std::string text = "t_s";
  for (const PathClearance& clearance : clearances) {
    const Part* part = scene.find(clearance.other);
    text += ',' + csvField((part != nullptr ? part->name : std::string()) + " [m]");
  }
  text += '\n';
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{}", path.poses[i].time);
    for (const PathClearance& clearance : clearances)
      fmt::format_to(std::back_inserter(text), ",{}", clearance.distances[i]);
    text += '\n';
  }
  return text;
}

}  // namespace nearfit
