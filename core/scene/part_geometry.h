#pragma once

#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_import.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/normal_cone_tree.h"
#include "core/scene/hierarchy_on_demand.h"
#include "core/scene/surface_on_demand.h"

namespace nearfit {

/// How many metres a unit of a mesh file may be: from nanometres to beyond miles.
constexpr double kMinMetresPerUnit = 1e-9, kMaxMetresPerUnit = 1e4;
/// Throws UsageError when the unit is not finite or out of these limits.
void checkMetresPerUnit(double metresPerUnit);

/// A mesh file with everything that is derived from it once: mass properties at once, the hierarchy when it
/// is first needed. Immutable but for that; shared by every part that shows the same file in the same unit.
struct PartGeometry {
  std::filesystem::path file;  ///< As normalisedPath gives it.
  std::string sha256;          ///< Of the file's bytes, hexadecimal.
  double metresPerUnit = 1.0;
  TriangleMesh mesh;
  MeshBuildReport report;
  MassProperties mass;
  std::shared_ptr<HierarchyOnDemand> hierarchy = std::make_shared<HierarchyOnDemand>();
  std::shared_ptr<SurfaceOnDemand> surfaceOnDemand = std::make_shared<SurfaceOnDemand>();

  /// What queries search; built now where it has not been (seconds for millions of triangles: call
  /// prepareHierarchies first where nobody may wait). Any thread. Real-time safe once hierarchy->isReady().
  const NormalConeTree& tree() const { return hierarchy->get(mesh); }

  /// Whether the mesh encloses its material: where it does not, distance is that of unsided surfaces.
  bool isSolid() const { return surfaceOnDemand->isSolid(mesh); }
  /// The surface without sides, made when it is first asked for. Any thread.
  std::shared_ptr<const UnsidedSurface> surface() const { return surfaceOnDemand->get(mesh, tree()); }
};

/// The path from the root, with links among its folders resolved, so that paths to one file compare equal.
std::filesystem::path normalisedPath(const std::filesystem::path& file);

using PartGeometryPtr = std::shared_ptr<const PartGeometry>;

/// Imports a mesh and derives its mass properties, or takes both from the cache where the file is known there
/// (tree_cache.h). Blocking: call it off the GUI and servo threads. Throws FileError, UsageError (the unit),
/// Cancelled.
PartGeometryPtr loadPartGeometry(const std::filesystem::path& file, double metresPerUnit,
                                 const ProgressCallback& progress = {});

struct MeshSource {
  std::filesystem::path file;
  double metresPerUnit = 1.0;
  std::string sha256;  ///< That the file must have; empty: any.
};

struct LoadedPart {
  PartGeometryPtr geometry;    ///< Null when there was a problem, or the file has another SHA-256.
  std::exception_ptr problem;  ///< As loadPartGeometry throws it.
};

/// Loads each source as loadPartGeometry does, in parallel. Throws Cancelled only.
std::vector<LoadedPart> loadPartGeometries(std::span<const MeshSource> sources,
                                           const ProgressCallback& progress = {});

/// Makes every hierarchy that is not there yet, so that tree() of each answers at once; in parallel, across
/// parts and inside one, on as many threads as there are processors. Blocking, as loadPartGeometry. Throws
/// Cancelled, also in the middle of one; what is done by then stays, the rest is made when needed.
void prepareHierarchies(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress = {});

/// Whether tree() of each answers at once.
bool areHierarchiesReady(std::span<const PartGeometryPtr> geometries) noexcept;

}  // namespace nearfit
