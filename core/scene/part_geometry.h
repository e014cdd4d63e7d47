#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_import.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// How many metres a unit of a mesh file may be: from nanometres to beyond miles.
constexpr double kMinMetresPerUnit = 1e-9, kMaxMetresPerUnit = 1e4;
/// Throws UsageError when the unit is not finite or out of these limits.
void checkMetresPerUnit(double metresPerUnit);

/// A mesh file with everything that is derived from it once: hierarchy and mass properties.
/// Immutable; shared by every part that shows the same file in the same unit.
struct PartGeometry {
  std::filesystem::path file;  ///< As normalisedPath gives it.
  std::string sha256;          ///< Of the file's bytes, hexadecimal.
  double metresPerUnit = 1.0;
  TriangleMesh mesh;
  MeshBuildReport report;
  NormalConeTree tree;
  MassProperties mass;
  double treeBuildTime = 0.0;  ///< How long building the hierarchy took [s].
};

/// The path from the root, with links among its folders resolved, so that paths to one file compare equal.
std::filesystem::path normalisedPath(const std::filesystem::path& file);

using PartGeometryPtr = std::shared_ptr<const PartGeometry>;

/// Imports a mesh and derives what queries need. `progress` may stop it between its stages. Blocking: call it
/// off the GUI and servo threads. Throws FileError, UsageError (the unit), Cancelled.
PartGeometryPtr loadPartGeometry(const std::filesystem::path& file, double metresPerUnit,
                                 const ProgressCallback& progress = {});

}  // namespace nearfit
