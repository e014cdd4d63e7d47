#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/import/step_request.h"
#include "core/report/mesh_export.h"

namespace nearfit {

/// Kinds of files that a scene can be exported to.
enum class ExportKind : std::uint8_t {
  PlacementJson,  ///< placement_export.h
  PlacementCsv,   ///< placement_table.h
  MeshStl,        ///< mesh_export.h
  MeshObj,
  MeshPly,
  ClearanceMapPly,        ///< clearance_map_export.h
  ClearanceHistogramCsv,  ///< clearance_histogram.h
  AssemblyGlb,            ///< glb_export.h
  AssemblyThreeMf,        ///< threemf_export.h
  AssemblyUrdf,           ///< urdf_export.h
  AssemblyStep,           ///< step_export.h
};

/// File name extension: "json", "csv", "stl", "obj", "ply", "glb", "3mf", "urdf" or "step".
std::string_view extensionOf(ExportKind kind) noexcept;
/// The kind that a file's extension stands for, in any case, also "stp"; std::nullopt if none. Never a map or its histogram: other
/// kinds have the same extensions.
std::optional<ExportKind> exportKindOf(const std::filesystem::path& file);
/// The same, but throws UsageError if the extension is that of no known format.
ExportKind knownExportKindOf(const std::filesystem::path& file);
/// The kind of mesh file; std::nullopt for others.
std::optional<MeshFileKind> meshKindOf(ExportKind kind) noexcept;
/// True for formats that keep parts apart, with names, groups, colours and poses.
bool isAssembly(ExportKind kind) noexcept;
/// True for formats of chosen parts: meshes and assemblies.
bool hasChosenParts(ExportKind kind) noexcept;
/// True if the numbers in the file are in a unit of choice; others are in metres, or in the one of their format.
bool hasUnitOfChoice(ExportKind kind) noexcept;

/// The map of clearance to export.
struct MapExport {
  std::vector<PartId> subject;  ///< Parts that are mapped as one; empty: what is in hand.
  double range = 0.0;           ///< [m]; 0: automatic.
  bool hasNearParts = false;    ///< Surfaces of near parts too.
};

/// What to export.
struct SceneExport {
  ExportKind kind = ExportKind::PlacementJson;
  double metresPerUnit = 1e-3;  ///< Unit of the numbers in the file [m]; see hasUnitOfChoice().
  /// Parts of a mesh or an assembly; empty: all visible ones. Placements have all parts.
  std::vector<PartId> only;
  MapExport map;                          ///< For a map of clearance or its histogram.
  StepSchema schema = StepSchema::Ap214;  ///< Of a STEP file.
};

/// Exports a scene to a file, atomically. Returns sentences about what the file does not hold as a user may expect it, as a
/// rule none. Blocking: a JSON placement and a map build missing hierarchies.
/// @param worldFromMoving  Present pose of the moving part; unused if there is none.
/// Throws FileError, UsageError, Cancelled (meshes, assemblies, maps).
std::vector<std::string> exportScene(const Scene& scene, const RigidTransform& worldFromMoving,
                                     const SceneExport& what, const std::filesystem::path& file,
                                     const ProgressCallback& progress = {});

}  // namespace nearfit
