#pragma once

#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/import/cad_document.h"
#include "core/import/mesh_import.h"
#include "core/mesh/check/mesh_repair.h"
#include "core/mesh/exact_surface.h"
#include "core/mesh/mass_properties.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/surface/solidity.h"
#include "core/proximity/surface/unsided_surface.h"
#include "core/scene/hierarchy_on_demand.h"

namespace nearfit {

/// Limits of metres per file unit: from nanometres to beyond miles.
constexpr double kMinMetresPerUnit = 1e-9, kMaxMetresPerUnit = 1e4;
/// Throws UsageError if the unit is not finite or out of these limits.
void checkMetresPerUnit(double metresPerUnit);

/// Solidity and unsided surface of one mesh, each determined when first needed. Only meshes that enclose
/// nothing, and parts near them, need the surface. Thread-safe: one thread builds, others wait for it.
class SurfaceOnDemand {
 public:
  /// isSolidThroughout() of the hierarchy's mesh, computed once.
  bool isSolid(const NormalConeTree& tree) {
    std::call_once(solidOnce_, [&] { isSolid_ = isSolidThroughout(tree.mesh()); });
    return isSolid_;
  }
  /// Supplies the result in advance, such as from the cache; no-op if already known.
  void setSolid(bool isSolid) {
    std::call_once(solidOnce_, [&] { isSolid_ = isSolid; });
  }

  /// The unsided surface of the hierarchy's mesh; it must be the same hierarchy in each call.
  std::shared_ptr<const UnsidedSurface> get(const NormalConeTree& tree) {
    std::call_once(once_, [&] { surface_ = std::make_shared<const UnsidedSurface>(tree); });
    return surface_;
  }

 private:
  std::once_flag solidOnce_, once_;
  bool isSolid_ = false;
  std::shared_ptr<const UnsidedSurface> surface_;
};

/// A file that a document was read from besides its own.
struct CompanionFile {
  std::filesystem::path file;
  std::string sha256;  ///< SHA-256 of its bytes, hexadecimal.
};
using CompanionFiles = std::vector<CompanionFile>;

/// A mesh file, or a shape of a CAD document, and what is derived from it: mass properties on loading, hierarchy and
/// unsided surface on demand. Otherwise immutable. Shared by all parts with the same file, unit, shape, tessellation and
/// repairs.
struct PartGeometry {
  std::filesystem::path file;  ///< As normalisedPath() returns it.
  std::string sha256;          ///< Of the file's bytes, hexadecimal.
  double metresPerUnit = 1.0;
  /// In metres, in the part's frame.
  TriangleMesh mesh;
  MeshBuildReport report;
  MassProperties mass;
  std::shared_ptr<HierarchyOnDemand> hierarchy = std::make_shared<HierarchyOnDemand>();
  std::shared_ptr<SurfaceOnDemand> surfaceOnDemand = std::make_shared<SurfaceOnDemand>();
  /// Made to the mesh after it was read; the file stays as it is.
  MeshRepairs repairs = {};
  /// Names the mesh without repairs in the cache, together with its unit.
  std::string cacheName = {};

  std::string shapeKey = {};  ///< CadShape::key; empty for a mesh file.
  /// Of the document; null if it has none, or not all are known. Shared by its shapes.
  std::shared_ptr<const CompanionFiles> companions = {};
  /// As asked for: what the shape is loaded by. Zeros: chosen from its size.
  Tessellation tessellation = {};
  /// In effect; zeros for a mesh file.
  Tessellation effectiveTessellation = {};
  /// Exact surfaces [m, part's frame] and the face of each triangle of the mesh; null if there are none.
  std::shared_ptr<const SurfaceFaces> surfaces = {};
  /// For each of the faces, or empty: std::nullopt for a face in the part's colour.
  std::vector<std::optional<CadColour>> faceColours = {};
  bool isExact = false;     ///< Came from exact surfaces, so that it can be refined.
  bool hasOwnUnit = false;  ///< The file stores its unit: metresPerUnit is 1 unless it is corrected.
  /// Metres per unit that a document states for its numbers, where it may state a wrong one (3MF); else 1.
  double statedUnit = 1.0;
  /// Metres per unit of the numbers in the file, as it is read.
  double unitOfNumbers() const noexcept { return metresPerUnit * statedUnit; }
  double exactVolume = 0.0;  ///< Of the exact solid [m^3]; 0 if unknown.

  /// Hierarchy for queries, of the mesh with its flats merged (tree().mesh()); built on first use (seconds for
  /// millions of triangles; call prepareHierarchies() first if the caller must not wait). Thread-safe. Real-time
  /// safe once hierarchy->isReady().
  const NormalConeTree& tree() const { return hierarchy->get(mesh); }

  /// True if the mesh encloses its material. If not, distances treat both sides of its surface alike.
  /// Determined on first use.
  bool isSolid() const { return surfaceOnDemand->isSolid(tree()); }
  /// The unsided surface, built on first use. Thread-safe.
  std::shared_ptr<const UnsidedSurface> surface() const { return surfaceOnDemand->get(tree()); }
};

/// Absolute path with symbolic links among its folders resolved, so that paths to one file compare equal.
std::filesystem::path normalisedPath(const std::filesystem::path& file);

using PartGeometryPtr = std::shared_ptr<const PartGeometry>;

/// Imports a mesh and computes its mass properties, or takes both from the cache (tree_cache.h). Of a CAD document, it
/// loads the only shape. Blocking: not for the GUI or servo thread. Throws FileError, UsageError (invalid unit, or a
/// document of several shapes: names them), Cancelled.
PartGeometryPtr loadPartGeometry(const std::filesystem::path& file, double metresPerUnit,
                                 const ProgressCallback& progress = {});

/// A mesh file, or a shape of a CAD document, to load.
struct MeshSource {
  std::filesystem::path file;
  double metresPerUnit = 1.0;  ///< Ignored for a document that stores its unit.
  std::string sha256 = {};     ///< Required SHA-256; empty: any.
  /// Key of the document's shape; empty: its only one. Must be empty for a mesh file.
  std::string shape = {};
  Tessellation tessellation = {};
  MeshRepairs repairs = {};  ///< To be made to the mesh; see PartGeometry::repairs.
};

/// A geometry after repairs.
struct GeometryRepair {
  PartGeometryPtr geometry;  ///< Null if there was nothing to repair.
  std::vector<RepairStep> steps;
  MeshChange change;
};

/// Makes repairs to a geometry besides those that it has. The result is what loading the file with all of them gives.
/// Blocking, like loadPartGeometry(). Throws UsageError (checkRepairs), FileError naming the file if no face would be
/// left, Cancelled.
GeometryRepair repairGeometry(const PartGeometry& original, const MeshRepairs& repairs,
                              const ProgressCallback& progress = {});

/// Result of loading a MeshSource.
struct LoadedPart {
  PartGeometryPtr geometry;    ///< Null if loading failed or the SHA-256 differs.
  std::exception_ptr problem;  ///< What loadPartGeometry() throws.
};

/// Loads sources in parallel, each like loadPartGeometry(). Imports a document once for each tessellation, whatever
/// the number of its shapes, and not at all if the cache has them. Results are in the order of `sources`; equal sources
/// of a document share a geometry. Throws only Cancelled.
std::vector<LoadedPart> loadPartGeometries(std::span<const MeshSource> sources,
                                           const ProgressCallback& progress = {});

/// Builds all missing hierarchies, so that tree() returns at once. Parallel across and within parts, on all
/// processors. Blocking, like loadPartGeometry(). Throws Cancelled, even in the middle of one hierarchy;
/// keeps what is finished.
void prepareHierarchies(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress = {});

/// True if tree() returns at once for all of them.
bool areHierarchiesReady(std::span<const PartGeometryPtr> geometries) noexcept;

}  // namespace nearfit
