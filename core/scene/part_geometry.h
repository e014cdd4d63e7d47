#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_import.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A mesh file with everything that is derived from it once: hierarchy and mass properties.
/// Immutable; shared by every part that shows the same file in the same unit.
struct PartGeometry {
  std::filesystem::path file;  ///< Absolute, normalised.
  std::string sha256;          ///< Of the file's bytes, hexadecimal.
  double metresPerUnit = 1.0;
  TriangleMesh mesh;
  MeshBuildReport report;
  NormalConeTree tree;
  MassProperties mass;
};

using PartGeometryPtr = std::shared_ptr<const PartGeometry>;

/// Imports a mesh and derives what queries need. Blocking: call it off the GUI and servo threads.
/// Throws FileError, Cancelled.
PartGeometryPtr loadPartGeometry(const std::filesystem::path& file, double metresPerUnit,
                                 const ProgressCallback& progress = {});

}  // namespace nearfit
