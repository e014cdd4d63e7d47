#include "core/scene/part_check.h"

#include <utility>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/mesh/check/soup_faults.h"

namespace nearfit {
namespace {

/// Share of the work that the mesh takes; reading the file again takes the rest.
constexpr double kMeshChecked = 0.7;

/// None if the file cannot be read any more, or is another one. None for a document either: only its importer knows the
/// triangles as they were.
SoupFaults faultsOfFile(const PartGeometry& geometry, const ProgressCallback& progress) {
  if (!geometry.shapeKey.empty()) return {};
  try {
    const ImportedPolygons read = importPolygons(geometry.file, progress);
    if (read.sha256 != geometry.sha256) return {};
    MeshBuildOptions options;
    options.metresPerUnit = geometry.metresPerUnit;
    return findSoupFaults(read.soup, options);
  } catch (const FileError&) {
    return {};
  }
}

}  // namespace

MeshCheck checkPart(const PartGeometry& geometry, const MeshCheckOptions& options,
                    const ProgressCallback& progress) {
  const MeshBuildReport& report = geometry.report;
  const bool isMended = report.degenerateFaces > 0 || report.duplicateFaces > 0;
  MeshCheck check =
      checkMesh(geometry.mesh, options, stageCallback(progress, 0.0, isMended ? kMeshChecked : 1.0));
  if (!isMended) return check;
  SoupFaults faults = faultsOfFile(geometry, stageCallback(progress, kMeshChecked, 1.0));
  addMended(check, FindingKind::DegenerateFaces, report.degenerateFaces, std::move(faults.degenerate));
  addMended(check, FindingKind::DuplicateFaces, report.duplicateFaces, std::move(faults.duplicate));
  stageOf(progress, 0.0, 1.0)(1.0);
  return check;
}

}  // namespace nearfit
