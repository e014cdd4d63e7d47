#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/scene/scene.h"

namespace nearfit::bench {

/// What a scene of many parts that show one mesh takes.
struct InstancesRow {
  std::string name;
  std::size_t parts = 0;
  std::size_t geometries = 0;                ///< Different ones among the parts.
  std::size_t meshBytes = 0, treeBytes = 0;  ///< Of those, each once.
  /// Of the process, before the mesh is made or read and when the servo could start.
  std::uint64_t residentBefore = 0, residentAfter = 0;
  double sceneSeconds = 0.0;       ///< To make the scene, or to read it from its file.
  double servoSceneSeconds = 0.0;  ///< To make the ServoScene, the hierarchy included where it is missing.
  double trackedSeconds = 0.0;     ///< To the first TrackedScene.
};

/// Parts in a cubic grid, the first in hand, with half a diagonal of air between their spheres.
/// @param geometries  Of one mesh; shown in turn.
Scene gridOf(std::span<const PartGeometryPtr> geometries, std::size_t parts);

/// Of the parts' geometries, each once.
struct GeometryTotals {
  std::size_t geometries = 0, meshBytes = 0, treeBytes = 0;
};
GeometryTotals geometryTotals(const Scene& scene);

/// Memory of this process that is in main memory [bytes], without what has been freed.
std::uint64_t residentBytes();

/// Measures a scene of so many parts that is made in memory, then one that is read from a scene file, each
/// with a mesh of its own. @param parts  At least 2; at most kMaxSceneFileParts.
InstancesRow measureInstancesInMemory(const TriangleMesh& mesh, std::size_t parts);
InstancesRow measureInstancesFromFile(const TriangleMesh& mesh, std::size_t parts);

std::string instancesTable(const std::vector<InstancesRow>& rows);
std::string instancesCsv(const std::vector<InstancesRow>& rows);

}  // namespace nearfit::bench
